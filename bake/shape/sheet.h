// Surfaces without thickness made into solids: a sheet into a shell about it, a terrain into the ground below it.
//
//            top: + thickness/2                    terrain:    surface
//      ┌──────────────────────────┐                 __/\_____/\___
//      │· · · · · sheet · · · · · │                │              │ walls
//      └──────────────────────────┘                └──────────────┘ bottom
//            bottom: − thickness/2
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/mesh/mesh.h"

namespace relief {

/// Triangles of a mesh whose edges are joined where two of them meet: what the functions below work on. No two triangles
/// have the same three vertices.
struct Sheet {
    std::vector<glm::vec3> positions;    ///< no two are equal
    std::vector<glm::uvec3> triangles;   ///< indices into positions, wound consistently across joined edges
    std::vector<std::uint32_t> sources;  ///< for each of them the mesh's triangle that it is
    /// For each side of each triangle, from corner i to the next: the triangle that it is joined to, or kNoTriangle (at
    /// the border, where three or more triangles meet, at a one-sided strip's seam, and at folds sharper than
    /// kFoldCosine).
    std::vector<glm::uvec3> neighbours;
    std::uint64_t duplicates = 0;  ///< triangles that were left out, as an earlier one has the same vertices

    static constexpr std::uint32_t kNoTriangle = 0xffffffff;
};

/// Cosine between the normals of two triangles below which their common edge is a fold: there the shell is cut, since a
/// mitre would be more than twice as long as the shell is thick.
inline constexpr double kFoldCosine = -0.5;

/// \param welded     of the mesh (mesh_edges.h).
/// \param triangles  indices into mesh.triangles; those without area once welded are left out.
[[nodiscard]] Sheet sheetOf(const TriangleMesh& mesh, std::span<const std::uint32_t> welded,
                            std::span<const std::uint32_t> triangles);

/// Positions and triangles of closed, consistently wound surfaces, outwards.
struct SolidPart {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t>
        sources;  ///< for each of them the sheet's triangle that it stands for or closes
    std::size_t surface_triangles = 0;  ///< the first of them stand for the sheet; the others close it
};

/// All points within half the thickness of the sheet, along its normals; with mitres at edges and a flat end at the
/// border. Each patch of joined triangles becomes one closed surface.
/// \param thickness  object units, above 0.
[[nodiscard]] SolidPart thickened(const Sheet& sheet, double thickness);

/// Twice the areas of a sheet's shadows along the axes. A height field's are the same, up to the sign.
struct Shadow {
    glm::dvec3 signed_area{0.0};  ///< triangles that look along the axis less those that look against it
    glm::dvec3 area{0.0};
};
[[nodiscard]] Shadow shadowOf(const Sheet& sheet);

/// The ground below a height field: walls down from its border, and a flat bottom.
/// \param axis    0, 1 or 2: of the heights, which grow with the coordinate.
/// \param bottom  coordinate of the bottom along the axis, object units.
[[nodiscard]] SolidPart extruded(const Sheet& sheet, int axis, float bottom);

}  // namespace relief
