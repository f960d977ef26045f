// SPDX-License-Identifier: Apache-2.0
// A triangle mesh in object space, as importers make it and bakes take it.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "bake/mesh/triangle_plane.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// TriangleMesh::labels of a triangle that is not of the file: a cap.
inline constexpr std::uint32_t kNoLabel = 0xffffffff;

/// Limit of a mesh, instances counted one by one.
inline constexpr std::uint64_t kTriangleMax = 100'000'000;
/// Names that one import may select, and bytes per name.
inline constexpr std::size_t kAskedNamesMax = 255;
inline constexpr std::size_t kAskedNameBytesMax = 256;
/// Distinct surfaces of a file; those beyond count as one without a name.
inline constexpr std::size_t kSurfaceNamesMax = 65'536;

/// The place of a surface in its file.
struct SurfaceName {
    std::uint32_t node_index = 0;  ///< counts the nodes that show something: two of one name are two
    std::string node;              ///< of OBJ the group or object; "" without a name
    std::string material;          ///< "" without a name
    float restitution = 1.0F;      ///< of the material, as formats/materials.h has it, where the file has one
    float friction = 0.0F;

    friend auto operator<=>(const SurfaceName&, const SurfaceName&) = default;
};

/// A different mesh of a level: the next positions and triangles of a TriangleMesh that an importer hands over.
struct LevelMesh {
    std::string name;
    std::uint64_t positions = 0;
    std::uint64_t triangles = 0;  ///< whose indices count from the mesh's first position
};
/// A node that places a mesh: world = position + scale · rotation · mesh.
struct LevelBody {
    std::uint32_t mesh = 0;
    std::string node;
    std::array<double, 3> position{};
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};  ///< a unit quaternion x, y, z, w
    double scale = 1.0;                                  ///< above 0
};

/// After finishMesh: at least one triangle, every index valid, every position finite and used by a triangle,
/// no triangle without area.
struct TriangleMesh {
    std::string name;                   ///< file name without its folder; valid UTF-8
    std::string content_hash;           ///< XXH3-128 of the file's bytes
    std::string unit;                   ///< of lengths: "m", or "" if the source has none
    std::vector<glm::vec3> positions;   ///< object space
    std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from outside, if the source keeps to that
    /// Per triangle, 1 + the index of the last of the selected names that it has, or 0. Empty: no names were selected, or
    /// the triangles are no longer the source's.
    std::vector<std::uint8_t> marks;
    /// Per triangle an index into `surface_names`. Empty: one surface, or the triangles are no longer the source's.
    std::vector<std::uint32_t> labels;
    /// One per material of each node, in file order; of a single surface only if its material has a name.
    std::vector<SurfaceName> surface_names;
    std::uint64_t dropped_triangles = 0;  ///< without area
    std::uint64_t unused_vertices = 0;    ///< of the source, that no triangle of it uses
    /// Triangles at the end that are no surface of the source's: caps over holes (hole_caps.h), rims of shells and the
    /// ground below terrains (bake/shape). Nothing is measured on them.
    std::uint64_t cap_triangles = 0;
    std::uint64_t closed_holes = 0;
    std::uint64_t source_triangles =
        0;                         ///< of the file, where they differ from `triangles` without caps; else 0
    double shell_thickness = 0.0;  ///< of the shells among its parts (bake/shape), object units; 0: no shells
    Bounds bounds;                 ///< of positions
    std::vector<std::string>
        dependencies;  ///< the file, by the path that was given, then those it refers to, sorted
    std::vector<std::string> dependency_hashes;  ///< XXH3-128 of each file's bytes, in the same order
    std::vector<std::string> warnings;           ///< of the import, one line each
    /// Of a level, on its way from the importer alone (bake/import/level.h); else empty.
    std::vector<LevelMesh> level_meshes;
    std::vector<LevelBody> level_bodies;
    /// Of an animated mesh, on the same way (bake/import/animated_import.h): bytes of an AnimatedMesh.
    std::vector<std::byte> animation;

    [[nodiscard]] std::uint64_t surfaceTriangles() const { return triangles.size() - cap_triangles; }
    [[nodiscard]] std::uint64_t sourceTriangles() const {
        return source_triangles > 0 ? source_triangles : surfaceTriangles();
    }
};

/// Makes the invariants above true: drops triangles without area with their marks and labels, drops positions without a
/// triangle, and computes the bounds.
/// \param mesh  with no marks, or as many as triangles; labels likewise.
/// Errors, naming mesh.name: kInvalidInput (index out of range, coordinate that is not finite or beyond 1e15,
/// no triangle with an area), kLimit (kTriangleMax).
[[nodiscard]] Result<TriangleMesh> finishMesh(TriangleMesh mesh);

/// Keeps the first `count` triangles, their marks and labels. \pre moveTriangle() has filled them.
void keepTriangles(TriangleMesh& mesh, std::size_t count);
/// Leaves out the labels of a single surface, and its name where that has no material.
void dropSingleLabel(TriangleMesh& mesh);
/// Copies a triangle, its mark and its label.
void moveTriangle(TriangleMesh& mesh, std::size_t from, std::size_t to);

/// Extends a box by another one.
inline void addBounds(Bounds& bounds, const Bounds& other) {
    bounds.add(other.min);
    bounds.add(other.max);
}

[[nodiscard]] Bounds boundsOf(std::span<const glm::vec3> positions);

[[nodiscard]] inline std::array<glm::vec3, 3> cornersOf(const TriangleMesh& mesh, std::uint32_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    return {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
}

/// Extends a box by a triangle.
inline void addTriangle(Bounds& bounds, const TriangleMesh& mesh, std::uint32_t triangle) {
    for (const glm::vec3& corner : cornersOf(mesh, triangle)) {
        bounds.add(corner);
    }
}

/// Of a triangle with an area.
[[nodiscard]] inline TrianglePlane planeOf(const TriangleMesh& mesh, std::uint32_t triangle) {
    return planeOf(mesh.positions, mesh.triangles[triangle]);
}
/// By the right-hand rule, of a triangle with an area.
[[nodiscard]] inline glm::dvec3 unitNormal(const TriangleMesh& mesh, std::uint32_t triangle) {
    return unit(planeOf(mesh, triangle).normal);
}

}  // namespace relief
