// SPDX-License-Identifier: Apache-2.0
// A triangle mesh as collider, with exact distances.
#pragma once

#include "runtime/bench/mesh_tree.h"
#include "runtime/bench/rival_step.h"

namespace relief {

/// Uploads a tree. The textures and defines of the rival also fit bench/mesh_query.frag.
/// \param keeps  stores a bound on the distance with each particle, which avoids queries or limits their range. The
///               particles move exactly as without the bound.
/// Errors: kLimit (GL limits), kFailure.
[[nodiscard]] Result<Rival> makeMeshRival(const MeshTree& tree, bool keeps = false);

}  // namespace relief
