// SPDX-License-Identifier: Apache-2.0
// The surface of a file in polygons: what the readers of OBJ, OFF, PLY and STL make of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// As kTriangleMax of bake/mesh, which the tools keep to. A file may have thrice as many vertices.
inline constexpr std::uint64_t kPolygonTrianglesMax = 100'000'000;

/// Colours of vertices are read for pictures alone.
enum class PolygonColors : std::uint8_t { kSkip, kRead };

/// Counts of a file, before anything is left out or triangulated; what is used twice counts once.
struct MeshParts {
    std::uint64_t polygons = 0;  ///< faces of at least three corners
    std::uint64_t lines = 0;
    std::uint64_t points = 0;
    std::uint64_t free_forms = 0;  ///< curves, surfaces and patches without polygons
    std::uint64_t vertices = 0;
    std::uint64_t unused = 0;  ///< vertices that no polygon uses
    std::uint64_t loose = 0;   ///< and neither a line nor a point
    std::uint64_t meshes = 0;
    std::uint64_t unplaced = 0;  ///< meshes that no node of the scene places
};

/// Polygons in a row that have the same names.
struct PolygonGroup {
    std::size_t begin = 0;             ///< index of the first; it ends where the next group begins
    std::vector<std::string> names{};  ///< as the file has them
    std::string node{};      ///< of SurfaceName: the group, object or solid; one of a name is one node
    std::string material{};  ///< of SurfaceName
};

struct PolygonMesh {
    std::vector<glm::vec3> positions;  ///< of all its vertices; may be no numbers
    /// Positions, counter-clockwise seen from outside: the corners of all polygons, one polygon after the other.
    std::vector<std::uint32_t> corners;
    std::vector<std::array<std::uint8_t, 4>>
        colors{};  ///< of its positions, sRGB and alpha; empty: they have none, or are not read
    std::vector<std::uint32_t> sizes;   ///< of each polygon, in corners; 1 and 2 are possible, 0 is not
    std::vector<PolygonGroup> groups;   ///< by their beginnings; polygons before the first have no names
    std::vector<std::string> warnings;  ///< without the file's name
    /// Lines and points that are no polygons of it, free forms, and how many vertices only those use. The rest is counted
    /// from the polygons.
    MeshParts others;
    std::vector<std::uint8_t>
        in_others;  ///< of each position, 1 for those that lines and points use; empty: none does
};

/// "line 12: WHAT", kInvalidInput.
[[nodiscard]] inline tl::unexpected<Error> wrongLine(std::size_t line, const std::string& what) {
    return invalidInput("line " + std::to_string(line) + ": " + what);
}

/// kLimit where a file has, or its header announces, more than so many "triangles" or "vertices".
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

}  // namespace relief
