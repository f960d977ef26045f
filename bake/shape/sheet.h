// SPDX-License-Identifier: Apache-2.0
// Builds solids from surfaces without thickness: shells around sheets, and the ground below terrains.
//
//            top: + thickness/2                    terrain:    surface
//      ┌──────────────────────────┐                 __/\_____/\___
//      │· · · · · sheet · · · · · │                │              │ walls
//      └──────────────────────────┘                └──────────────┘ bottom
//            bottom: − thickness/2
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/mesh_query.h"

namespace relief {

/// Triangles of a mesh, joined across edges of two triangles. No two triangles have the same vertices.
struct Sheet {
    std::vector<glm::vec3> positions;    ///< unique
    std::vector<glm::uvec3> triangles;   ///< indices into positions, wound consistently across joined edges
    std::vector<std::uint32_t> sources;  ///< per triangle, its index in the mesh
    /// Per side of each triangle, from corner i to the next: the joined triangle, or kNoTriangle at the border, at an
    /// edge of three or more triangles, at the seam of a one-sided strip, and at folds sharper than kFoldCosine.
    std::vector<glm::uvec3> neighbours;
    std::uint64_t duplicates = 0;  ///< triangles dropped because an earlier one has the same vertices

    static constexpr std::uint32_t kNoTriangle = TriangleNeighbours::kNone;
};

/// Cosine between the normals of two triangles below which the shell is cut at their edge; a mitre would be longer than
/// twice the shell's thickness.
inline constexpr double kFoldCosine = -0.5;

/// Builds a sheet.
/// \param welded     weldedVertices() of the mesh.
/// \param triangles  indices into mesh.triangles; those without area after welding are dropped.
[[nodiscard]] Sheet sheetOf(const TriangleMesh& mesh, std::span<const std::uint32_t> welded,
                            std::span<const std::uint32_t> triangles);

/// Returns the sheet as a mesh before finishMesh, with its sources as labels.
[[nodiscard]] TriangleMesh meshOf(const Sheet& sheet, const std::string& name);

/// Closed, consistently wound surfaces that face outwards.
struct SolidPart {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> sources;  ///< per triangle, the sheet's triangle that it represents or closes
    std::size_t surface_triangles = 0;   ///< the first ones, which represent the sheet; the others close it
};

/// Builds the shell within half the thickness along the sheet's normals. Edges have mitres, the border has flat ends,
/// and corners have bevels if a common mitre would leave a side thin. Each patch of joined triangles becomes one closed
/// surface. A region that is thinner than the shell, such as a rod, is filled; its offset surface would turn inside out
/// and is omitted.
/// \param query      for the sheet's triangles.
/// \param thickness  object units, above 0.
[[nodiscard]] SolidPart thickened(Sheet sheet, const MeshQuery& query, double thickness);

/// Twice the projected areas of a sheet along each axis. Both are equal, up to the sign, for a height field.
struct Shadow {
    glm::dvec3 signed_area{0.0};  ///< triangles that face along the axis, minus those that face against it
    glm::dvec3 area{0.0};
};
[[nodiscard]] Shadow shadowOf(const Sheet& sheet);

/// Builds the ground below a height field: walls below its border, and a flat bottom.
/// \param axis    0, 1 or 2: the up axis.
/// \param bottom  coordinate of the bottom along the axis, object units.
[[nodiscard]] SolidPart extruded(const Sheet& sheet, int axis, float bottom);

}  // namespace relief
