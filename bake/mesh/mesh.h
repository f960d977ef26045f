// SPDX-License-Identifier: Apache-2.0
// Defines the triangle mesh in object space that importers produce and bakes consume.
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

/// The label of a triangle that is not in the file: a cap (TriangleMesh::labels).
inline constexpr std::uint32_t kNoLabel = 0xffffffff;

/// Maximum number of triangles in a mesh, counting each instance.
inline constexpr std::uint64_t kTriangleMax = 100'000'000;
/// Maximum number of names that an import may select, and of bytes per name.
inline constexpr std::size_t kSelectedNamesMax = 255;
inline constexpr std::size_t kSelectedNameBytesMax = 256;
/// Maximum number of distinct surfaces in a file; all further ones share one unnamed entry.
inline constexpr std::size_t kSurfaceNamesMax = 65'536;

/// Node and material of a surface in its file.
struct SurfaceName {
    std::uint32_t node_index = 0;  ///< identifies the node in its file, or an instance of it
    std::string node;              ///< for OBJ, the group or object; "" if unnamed
    std::string material;          ///< "" if unnamed
    float restitution = 1.0F;      ///< of the material in the file, if any (formats/materials.h)
    float friction = 0.0F;

    friend auto operator<=>(const SurfaceName&, const SurfaceName&) = default;
};

/// A distinct mesh of a level. Its positions and triangles follow those of the previous mesh in an importer's
/// TriangleMesh.
struct LevelMesh {
    std::string name;
    std::uint64_t positions = 0;
    std::uint64_t triangles = 0;  ///< indices count from the mesh's first position
};
/// A node that places a mesh: world = position + scale · rotation · mesh.
struct LevelBody {
    std::uint32_t mesh = 0;
    std::string node;
    std::array<double, 3> position{};
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};  ///< unit quaternion x, y, z, w
    double scale = 1.0;                                  ///< above 0
};

/// Invariants after finishMesh: at least one triangle; every index valid; every position finite and used by a triangle;
/// no triangle without area.
struct TriangleMesh {
    std::string name;                  ///< file name without its folder; valid UTF-8
    std::string content_hash;          ///< XXH3-128 of the file
    std::string unit;                  ///< of lengths: "m", or "" if unknown
    std::vector<glm::vec3> positions;  ///< object space
    /// Counter-clockwise seen from outside, if the source is wound consistently.
    std::vector<glm::uvec3> triangles;
    /// Per triangle, 1 + the index of the last selected name that applies to it, or 0. Empty if no names were selected,
    /// or if the triangles are no longer the source's.
    std::vector<std::uint8_t> marks;
    /// Per triangle, an index into `surface_names`. Empty if there is one surface, or if the triangles are no longer
    /// the source's.
    std::vector<std::uint32_t> labels;
    /// One per material of each node, in file order. A single surface has an entry only if its material has a name.
    std::vector<SurfaceName> surface_names;
    std::uint64_t dropped_triangles = 0;  ///< triangles without area
    std::uint64_t unused_vertices = 0;    ///< vertices of the source without a triangle
    /// Number of triangles at the end of `triangles` that are not part of the source's surface: caps over holes
    /// (hole_caps.h), rims of shells, and ground below terrains (bake/shape). Measurements exclude them.
    std::uint64_t cap_triangles = 0;
    std::uint64_t closed_holes = 0;
    std::uint64_t source_triangles = 0;  ///< in the file, if different from surfaceTriangles(); else 0
    double shell_thickness = 0.0;        ///< of its thickest shell (bake/shape), object units; 0: no shells
    Bounds bounds;                       ///< of positions
    std::vector<std::string>
        dependencies;  ///< the file's path as given, then the files that it references, sorted
    std::vector<std::string> dependency_hashes;  ///< XXH3-128 of each dependency, in the same order
    std::vector<std::string> warnings;           ///< from the import, one line each
    /// Set only for a level between the importer and splitLevel() (bake/import/level.h); else empty.
    std::vector<LevelMesh> level_meshes;
    std::vector<LevelBody> level_bodies;
    /// A serialized AnimatedMesh; set only between the importer and ImportSource::finishAnimated().
    std::vector<std::byte> animation;

    [[nodiscard]] std::uint64_t surfaceTriangles() const { return triangles.size() - cap_triangles; }
    [[nodiscard]] std::uint64_t sourceTriangles() const {
        return source_triangles > 0 ? source_triangles : surfaceTriangles();
    }
};

/// Returns a mesh without triangles for a new surface of the same source. Copies the name, hash, unit, dependencies,
/// warnings and number of dropped triangles.
[[nodiscard]] TriangleMesh meshOfSource(const TriangleMesh& source);

/// Establishes the invariants of TriangleMesh: drops triangles without area, with their marks and labels, drops unused
/// positions, and computes the bounds.
/// \param mesh  has no marks or one per triangle, and no labels or one per triangle.
/// Errors, naming mesh.name: kInvalidInput (index out of range, coordinate not finite or beyond 1e15, no triangle with
/// an area, longest side below 1e-15), kLimit (kTriangleMax).
[[nodiscard]] Result<TriangleMesh> finishMesh(TriangleMesh mesh);

/// Truncates triangles, marks and labels to `count`. \pre moveTriangle() has filled the entries that are kept.
void keepTriangles(TriangleMesh& mesh, std::size_t count);
/// Clears `labels` if there is only one surface, and also `surface_names` if that surface's material is unnamed.
void dropSingleLabel(TriangleMesh& mesh);
void moveTriangle(TriangleMesh& mesh, std::size_t from, std::size_t to);

inline void addBounds(Bounds& bounds, const Bounds& other) {
    bounds.add(other.min);
    bounds.add(other.max);
}

[[nodiscard]] Bounds boundsOf(std::span<const glm::vec3> positions);

[[nodiscard]] inline std::array<glm::vec3, 3> cornersOf(const TriangleMesh& mesh, std::uint32_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    return {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
}

inline void addTriangle(Bounds& bounds, const TriangleMesh& mesh, std::uint32_t triangle) {
    for (const glm::vec3& corner : cornersOf(mesh, triangle)) {
        bounds.add(corner);
    }
}

/// Returns the plane of a triangle, which must have an area.
[[nodiscard]] inline TrianglePlane planeOf(const TriangleMesh& mesh, std::uint32_t triangle) {
    return planeOf(mesh.positions, mesh.triangles[triangle]);
}
/// Returns the normal by the right-hand rule. The triangle must have an area.
[[nodiscard]] inline glm::dvec3 unitNormal(const TriangleMesh& mesh, std::uint32_t triangle) {
    return unit(planeOf(mesh, triangle).normal);
}

/// Mean number of triangle boxes on a line through the mesh's box: about the number of triangles tested per ray.
/// It is 2 to 15 for typical models, 70 for forty layers of walls, and 4,000 for a fan of 20,000 long thin triangles,
/// regardless of the BVH.
[[nodiscard]] double boxesOnLine(const TriangleMesh& mesh);

/// Returns the fraction of an ordinary mesh's ray count that is affordable: 1 up to 32 boxes per line, then inversely
/// proportional, so that the total cost stays constant.
[[nodiscard]] double affordableRays(const TriangleMesh& mesh);

}  // namespace relief
