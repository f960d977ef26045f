// Triangles in object space: what every importer makes and what the baker bakes.
#pragma once

#include <compare>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "bake/mesh/triangle_plane.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// TriangleMesh::labels of a triangle that belongs to nothing in the file: a cap.
inline constexpr std::uint32_t kNoLabel = 0xffffffff;

/// Limit of a mesh, instances counted one by one.
inline constexpr std::uint64_t kTriangleMax = 100'000'000;
/// Names that an importer may be asked for at once, and the bytes of one.
inline constexpr std::size_t kAskedNamesMax = 255;
inline constexpr std::size_t kAskedNameBytesMax = 256;
/// Surfaces of a file that are told apart; those beyond count as one without a name.
inline constexpr std::size_t kSurfaceNamesMax = 65'536;

/// The place of a surface in its file.
struct SurfaceName {
    std::uint32_t node_index = 0;  ///< counts the nodes that show something: two of one name are two
    std::string node;              ///< of OBJ the group or object; "" without a name
    std::string material;          ///< "" without a name

    friend auto operator<=>(const SurfaceName&, const SurfaceName&) = default;
};

/// After finishMesh: at least one triangle, every index valid, every position finite and used by a triangle,
/// no triangle without area.
struct TriangleMesh {
    std::string name;                   ///< file name without its folder; valid UTF-8
    std::string content_hash;           ///< XXH3-128 of the file's bytes
    std::string unit;                   ///< of lengths: "m", or "" where the source does not say
    std::vector<glm::vec3> positions;   ///< object space
    std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from outside, if the source keeps to that
    /// For each triangle, which of the names that its importer was asked for it has: 0 for none, else 1 + the index of
    /// the last of them. Empty: nobody asked, or the triangles are no longer the source's.
    std::vector<std::uint8_t> marks;
    /// For each triangle an index into `surface_names`; empty: the file has one surface, or the triangles are no longer
    /// the source's.
    std::vector<std::uint32_t> labels;
    /// One for each material of each node, in the order of the file.
    std::vector<SurfaceName> surface_names;
    std::uint64_t dropped_triangles = 0;  ///< without area, left out
    std::uint64_t unused_vertices = 0;    ///< of the source, that no triangle of it uses; left out
    /// The last of `triangles` are no surface of the source's: caps over holes (hole_caps.h), the rims of shells and the
    /// ground below terrains (bake/shape). Nothing is measured on them.
    std::uint64_t cap_triangles = 0;
    std::uint64_t closed_holes = 0;
    std::uint64_t source_triangles =
        0;  ///< of the file, where `triangles` without caps are not those; 0: they are
    double shell_thickness =
        0.0;        ///< of the shells among its parts (bake/shape), object units; 0: there are none
    Bounds bounds;  ///< of positions
    /// Files that it was read from: first its own, as its path was given, then whatever that refers to,
    /// sorted.
    std::vector<std::string> dependencies;
    std::vector<std::string> dependency_hashes;  ///< XXH3-128 of each file's bytes, in the same order
    std::vector<std::string> warnings;           ///< what its importer has to say; one line each

    [[nodiscard]] std::uint64_t surfaceTriangles() const { return triangles.size() - cap_triangles; }
    [[nodiscard]] std::uint64_t sourceTriangles() const {
        return source_triangles > 0 ? source_triangles : surfaceTriangles();
    }
};

/// Turns raw positions and triangles into a mesh that keeps the invariants above: drops triangles without
/// area, their marks and labels, and positions without triangle, computes the bounds.
/// \param mesh  with no marks, or as many as triangles; labels likewise.
/// Errors, naming mesh.name: kInvalidInput (index out of range, coordinate that is not finite or beyond 1e15,
/// no triangle with an area), kLimit (kTriangleMax).
[[nodiscard]] Result<TriangleMesh> finishMesh(TriangleMesh mesh);

/// Of a triangle that has an area. \param triangle  index into mesh.triangles.
[[nodiscard]] inline TrianglePlane planeOf(const TriangleMesh& mesh, std::uint32_t triangle) {
    return planeOf(mesh.positions, mesh.triangles[triangle]);
}

}  // namespace relief
