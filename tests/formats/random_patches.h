// SPDX-License-Identifier: Apache-2.0
// Patch maps with every kind of record, for tests that compare readers.
#pragma once

#include <random>
#include <vector>

#include "formats/depth_map.h"
#include "formats/patch_tree.h"

namespace relief::test {

/// A valid tree of random records, three levels deep. object_to_map is the identity.
[[nodiscard]] DepthMap randomPatches(std::mt19937& random);

/// A valid tree of these records, with no texels after them.
[[nodiscard]] DepthMap patchesOf(const PatchTreeSize& size, const std::vector<PatchRecord>& records);

}  // namespace relief::test
