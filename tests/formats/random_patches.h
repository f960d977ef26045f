// SPDX-License-Identifier: Apache-2.0
// Maps of patches with every kind of record, for tests that compare readers.
#pragma once

#include <random>
#include <vector>

#include "formats/depth_map.h"
#include "formats/patch_tree.h"

namespace relief::test {

/// A valid tree of random records, three levels deep, in its own space: object_to_map is one to one.
[[nodiscard]] DepthMap randomPatches(std::mt19937& random);

/// A valid tree of given records, with nothing behind them.
[[nodiscard]] DepthMap patchesOf(const PatchTreeSize& size, const std::vector<PatchRecord>& records);

}  // namespace relief::test
