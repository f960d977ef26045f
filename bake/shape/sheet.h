// SPDX-License-Identifier: Apache-2.0
// Solids from surfaces without thickness: shells around sheets, and the ground below terrains.
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

/// Triangles of a mesh, joined across edges of two. No two of them have the same three vertices.
struct Sheet {
    std::vector<glm::vec3> positions;    ///< no two are equal
    std::vector<glm::uvec3> triangles;   ///< indices into positions, wound consistently across joined edges
    std::vector<std::uint32_t> sources;  ///< per triangle, its index in the mesh
    /// Per side of each triangle, from corner i to the next: the triangle joined there, or kNoTriangle (at the border, where
    /// three or more meet, at the seam of a one-sided strip, and at folds sharper than kFoldCosine).
    std::vector<glm::uvec3> neighbours;
    std::uint64_t duplicates = 0;  ///< triangles dropped for an earlier one of the same vertices

    static constexpr std::uint32_t kNoTriangle = TriangleNeighbours::kNone;
};

/// Cosine between the normals of two triangles below which the shell is cut at their edge: a mitre would be more than twice as
/// long as the shell is thick.
inline constexpr double kFoldCosine = -0.5;

/// \param welded     weldedVertices of the mesh.
/// \param triangles  indices into mesh.triangles; those without area once welded are dropped.
[[nodiscard]] Sheet sheetOf(const TriangleMesh& mesh, std::span<const std::uint32_t> welded,
                            std::span<const std::uint32_t> triangles);

/// The mesh of a sheet before finishMesh, with its sources as labels.
[[nodiscard]] TriangleMesh meshOf(const Sheet& sheet, const std::string& name);

/// Positions and triangles of closed, consistently wound surfaces, outwards.
struct SolidPart {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> sources;  ///< per triangle, the sheet's triangle that it stands for or closes
    std::size_t surface_triangles = 0;   ///< the first ones, which stand for the sheet; the others close it
};

/// The shell within half the thickness along the sheet's normals, with mitres at edges, flat ends at the border, and bevels at
/// corners whose common mitre would leave a side thin. Each patch of joined triangles becomes one closed surface. A region that
/// is thinner than the shell, such as a rod, is full: its offset would turn over and is left out.
/// \param query      of the sheet's triangles.
/// \param thickness  object units, above 0.
[[nodiscard]] SolidPart thickened(Sheet sheet, const MeshQuery& query, double thickness);

/// Twice the projected areas of a sheet along the axes, equal up to the sign for a height field.
struct Shadow {
    glm::dvec3 signed_area{0.0};  ///< of triangles facing along the axis less those facing against it
    glm::dvec3 area{0.0};
};
[[nodiscard]] Shadow shadowOf(const Sheet& sheet);

/// The ground below a height field: walls down from its border, and a flat bottom.
/// \param axis    0, 1 or 2: of the heights, which grow with the coordinate.
/// \param bottom  coordinate of the bottom along the axis, object units.
[[nodiscard]] SolidPart extruded(const Sheet& sheet, int axis, float bottom);

}  // namespace relief
