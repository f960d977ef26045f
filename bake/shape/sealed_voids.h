// SPDX-License-Identifier: Apache-2.0
// Finds free space that the sheets and solids of a union enclose together, such as the inside of a pot under its lid.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"

namespace relief {

/// How a triangle of a union seals off space. kNothing: a shell requested with --as, whose two sides stay free.
enum class Wall : std::uint8_t { kSolid, kSheet, kNothing };

/// Finds enclosed free space that would be open to the outside without the sheets. Ignores openings that lie between grid nodes
/// and pass at most 1 % of all rays. A grid of 64 nodes along the longest side finds candidates, whose volume is at
/// least 1e-4 times that side cubed. A grid of 192 nodes refines the box of the candidates. A cavity of a solid is not
/// a void. The result does not depend on the number of threads.
/// \param walls  per triangle.
[[nodiscard]] Voids sealedVoids(const MeshQuery& query, const std::vector<Wall>& walls);

/// Returns the same union with its voids filled. Triangles that face only voids and solids move to the end, like caps
/// (TriangleMesh::cap_triangles).
/// \param part_of  per triangle; reordered like the triangles, and set to kNoLabel for those that move.
/// Errors: those of finishMesh.
[[nodiscard]] Result<PreparedMesh> withVoids(const MeshQuery& query, Voids voids,
                                             std::vector<std::uint32_t>& part_of);

}  // namespace relief
