// SPDX-License-Identifier: Apache-2.0
// Cuts a tree of patches into tiles. Each tile is a box of the roots, stored as a separate tree.
//
//      roots     0 … 31 32 33 … 63 64 65 … 95
//      tile 0    |--------|
//      tile 1           |--------|
//      tile 2                     |---------|
//
// Each tile extends one root beyond its own roots on the upper sides, so that rounding leaves no gap at a seam. All
// cells are bit-identical to those of the whole tree, and a vote depends only on its cell. The union of the tiles
// therefore has the same inside as the whole tree.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <glm/vec3.hpp>

#include "formats/depth_map.h"

namespace relief {

struct PatchTileOptions {
    std::uint64_t bytes = 4'000'000;                                  ///< target size of a tile
    std::uint64_t total = std::numeric_limits<std::uint64_t>::max();  ///< limit on the bytes of all tiles
    std::uint32_t most = 64;                                          ///< limit on the number of tiles
};

struct PatchTile {
    glm::uvec3 place{0};  ///< position in the grid of tiles
    glm::uvec3 first{0};  ///< first root
    glm::uvec3 own{1};    ///< roots along each axis, without the extra ones
    DepthMap map{};
};

/// Cuts a tree into a grid of tiles. Adds cuts across the longest side of the tiles until every tile is small enough, or
/// until another cut would exceed a limit of the options or make a tile narrower than four roots. Omits tiles whose own
/// roots are all outside, because every other tile classifies their points as far outside.
/// \param whole  a valid map of patches.
/// \return the tiles, x fastest; a single tile without texels if the tree is not cut (then use `whole`).
[[nodiscard]] std::vector<PatchTile> cutIntoTiles(const DepthMap& whole, const PatchTileOptions& options);

/// Returns a tree of a range of roots with all their descendants. The texels are identical to those of `whole` if
/// encodePatches() returned `whole` and the range contains all roots.
/// \param whole  a valid map of patches.
/// \param count  number of roots along each axis; the range must lie within the roots of `whole`.
[[nodiscard]] DepthMap cutPatches(const DepthMap& whole, const glm::uvec3& first, const glm::uvec3& count);

}  // namespace relief
