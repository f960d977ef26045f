// SPDX-License-Identifier: Apache-2.0
// Orients triangles outwards by rays and volumes, regardless of the corner order in the file.
#pragma once

#include <cstdint>

#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"

namespace relief {

struct Winding {
    PreparedMesh mesh;         ///< the same triangles in the same order
    std::uint64_t turned = 0;  ///< number of flipped triangles, whose second and third corners are swapped
};

/// Flips triangles until neighbours traverse their common edge in opposite directions and each patch faces outwards.
/// Here, a patch is a set of triangles connected by edges of exactly two triangles. A closed patch faces out of its
/// volume. A closed patch entirely inside an odd number of others is a cavity, and faces into its volume. An open patch
/// is flipped if rays (by parity) find the inside in front of most of it. If that is unclear, as on sheets, the patch
/// gets the winding of most of its triangles.
///
/// A mesh of a single, consistently wound patch is unchanged, even if it is inside out (see PreparedMesh::orientation),
/// and keeps its edges() for shapeMesh; the edges of other meshes are freed. The result does not depend on the number
/// of threads.
/// \param mesh  moved; a shared mesh is copied.
/// Errors: those of MeshQuery::build.
[[nodiscard]] Result<Winding> windOutwards(PreparedMesh mesh);

}  // namespace relief
