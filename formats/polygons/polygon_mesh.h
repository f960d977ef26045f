// SPDX-License-Identifier: Apache-2.0
// The polygons of a file, as read from OBJ, OFF, PLY and STL, and the readers of OBJ and PLY, which the runtime also
// needs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Equals kTriangleMax in bake/mesh, the limit of the tools. A file may have three times as many vertices.
inline constexpr std::uint64_t kPolygonTrianglesMax = 100'000'000;

/// Whether to read vertex colours; only pictures need them.
enum class PolygonColors : std::uint8_t { kSkip, kRead };

/// Counts for a file before triangulation and clean-up. A mesh counts once, even if several nodes reference it.
struct MeshParts {
    std::uint64_t polygons = 0;  ///< faces with at least three corners
    std::uint64_t lines = 0;
    std::uint64_t points = 0;
    std::uint64_t free_forms = 0;  ///< curves, surfaces and patches without polygons
    std::uint64_t vertices = 0;
    std::uint64_t unused = 0;  ///< vertices that no polygon uses
    std::uint64_t loose = 0;   ///< vertices that no polygon, line or point uses
    std::uint64_t meshes = 0;
    std::uint64_t unplaced = 0;  ///< meshes that no node of the scene references
};

/// Consecutive polygons with the same names.
struct PolygonGroup {
    std::size_t begin = 0;             ///< index of the first polygon; the group ends where the next begins
    std::vector<std::string> names{};  ///< as in the file
    std::string node{};      ///< for SurfaceName: the group, object or solid; equal names form one node
    std::string material{};  ///< for SurfaceName
};

struct PolygonMesh {
    std::vector<glm::vec3> positions;  ///< all vertices; coordinates may be NaN or infinite
    /// Indices into positions, counter-clockwise seen from outside: the corners of all polygons, polygon by polygon.
    std::vector<std::uint32_t> corners;
    std::vector<std::array<std::uint8_t, 4>>
        colors{};                       ///< for each position, sRGB and alpha; empty if absent or not read
    std::vector<std::uint32_t> sizes;   ///< corners of each polygon; may be 1 or 2, but not 0
    std::vector<PolygonGroup> groups;   ///< ascending by begin; polygons before the first group have no names
    std::vector<std::string> warnings;  ///< without the file name
    /// Counts that are not derived from the polygons: lines, points and free forms.
    MeshParts others;
    std::vector<std::uint8_t>
        used_by_others;  ///< for each position, 1 if lines or points use it; empty if they use no position
};

/// Creates the error "line 12: WHAT", kInvalidInput.
[[nodiscard]] inline tl::unexpected<Error> wrongLine(std::size_t line, const std::string& what) {
    return invalidInput("line " + std::to_string(line) + ": " + what);
}

/// Fails with kLimit if a file contains, or its header declares, more than `most` elements.
/// \param things  "triangles" or "vertices", for the message.
[[nodiscard]] inline Result<void> checkCount(std::uint64_t count, std::uint64_t most, const char* things) {
    return count <= most ? Result<void>()
                         : fail(ErrorCode::kLimit, "it has " + std::to_string(count) + " " + things +
                                                       ", more than the limit of " + std::to_string(most) +
                                                       "; simplify the mesh");
}
[[nodiscard]] inline Result<void> checkTriangleCount(std::uint64_t triangles) {
    return checkCount(triangles, kPolygonTrianglesMax, "triangles");
}
[[nodiscard]] inline Result<void> checkVertexCount(std::uint64_t vertices) {
    return checkCount(vertices, 3 * kPolygonTrianglesMax, "vertices");
}

struct ObjMesh {
    PolygonMesh polygons;
    std::vector<std::string> libraries;  ///< material libraries, as named by mtllib
};

/// Reads Wavefront OBJ: the statements v, f, l, p, g, o, usemtl and mtllib. Free-form surfaces are counted; all other
/// statements are skipped. Statements may be indented, continued by a backslash, and followed by a comment. A vertex
/// has three coordinates, optionally followed by a weight that divides them or by a colour in 0…1. Corners are "7",
/// "7/1", "7//3" or "7/1/3"; negative indices count back from the last vertex so far. Faces may precede their vertices.
/// A face has the name of its material, and the names of the current group or object, whichever started last. The names
/// of a group are its whole line and each of its words. A new material does not end the group.
/// Errors, with the line but without the file name: kInvalidInput, kLimit.
[[nodiscard]] Result<ObjMesh> readObj(std::span<const std::byte> bytes,
                                      PolygonColors colors = PolygonColors::kSkip);

/// Reads PLY, as text or binary of either byte order: the element `vertex`, and the lists `vertex_indices` (or
/// `vertex_index`) of the elements `face` and `tristrips`. In a strip, every three consecutive indices form a triangle,
/// with alternating winding; -1 starts a new strip. Other elements are skipped, with a warning if they look like faces.
/// Vertex colours are red, green and blue as bytes, 16-bit integers, or floats in 0…1.
/// \return at least one polygon.
/// Errors, with the line of a text file but without the file name: kInvalidInput (not a PLY, truncated, a missing
/// vertex, no faces), kLimit.
[[nodiscard]] Result<PolygonMesh> readPly(std::span<const std::byte> bytes,
                                          PolygonColors colors = PolygonColors::kSkip);

}  // namespace relief
