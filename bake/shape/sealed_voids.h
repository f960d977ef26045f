// SPDX-License-Identifier: Apache-2.0
// Free space that the sheets and solids of a union enclose together, such as that of a pot under its lid.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "bake/mesh/voids.h"
#include "formats/base/result.h"

namespace relief {

/// The kinds of triangles of a union by the space that they close off: kNothing where free space on both sides was asked for.
enum class Wall : std::uint8_t { kSolid, kSheet, kNothing };

/// Free space that leads outside only through a sheet, or through openings that lie between the nodes of a grid and let at
/// most a hundredth of all rays out: of 192 along the longest side, in the box of what 64 find that has at least a
/// ten-thousandth of that side cubed. A hollow of a solid is no void. The same for any number of threads.
/// \param walls  per triangle.
[[nodiscard]] Voids sealedVoids(const MeshQuery& query, const std::vector<Wall>& walls);

/// The same union, with its voids, and without the triangles that face nothing else among those of its surface: they follow
/// it, as caps do (TriangleMesh::cap_triangles).
/// \param part_of  per triangle; reordered with them, and kNoLabel for those that follow. Errors: those of finishMesh.
[[nodiscard]] Result<PreparedMesh> withVoids(const MeshQuery& query, Voids voids,
                                             std::vector<std::uint32_t>& part_of);

}  // namespace relief
