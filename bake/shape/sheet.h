// SPDX-License-Identifier: Apache-2.0
// Surfaces without thickness. solids.h builds solids from them.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "bake/mesh/mesh_edges.h"

namespace relief {

/// Triangles of a mesh, joined across each edge that exactly two of them share. No two triangles have the same
/// vertices.
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

/// If the cosine between two triangles' normals is less, the shell is cut at their edge; a mitre would be longer than
/// the shell's thickness.
inline constexpr double kFoldCosine = -0.5;

/// Builds a sheet.
/// \param welded     weldedVertices() of the mesh.
/// \param triangles  indices into mesh.triangles; those without area after welding are dropped.
[[nodiscard]] Sheet sheetOf(const TriangleMesh& mesh, std::span<const std::uint32_t> welded,
                            std::span<const std::uint32_t> triangles);

/// Returns the sheet as a mesh before finishMesh; Sheet::sources become TriangleMesh::labels.
[[nodiscard]] TriangleMesh meshOf(const Sheet& sheet, const std::string& name);

[[nodiscard]] glm::dvec3 unitNormal(const std::vector<glm::vec3>& positions, const glm::uvec3& t);

/// Twice a sheet's area projected along each axis. Along a height field's axis, |signed_area| equals area.
struct Shadow {
    glm::dvec3 signed_area{0.0};  ///< triangles that face along the axis, minus those that face against it
    glm::dvec3 area{0.0};
};
[[nodiscard]] Shadow shadowOf(const Sheet& sheet);

}  // namespace relief
