// SPDX-License-Identifier: Apache-2.0
// A tree of patches cut into tiles: boxes of its roots, as trees of their own.
//
//      roots     0 … 31 32 33 … 63 64 65 … 95
//      tile 0    |--------|
//      tile 1           |--------|
//      tile 2                     |---------|
//
// Each tile goes a root beyond its own on the upper sides, so that no point of a seam falls between two by rounding. All its
// cells are those of the whole tree, bit by bit, and a vote depends on its cell alone: the union of the tiles has the inside of
// the whole.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <glm/vec3.hpp>

#include "formats/depth_map.h"

namespace relief {

struct PatchTileOptions {
    std::uint64_t bytes = 4'000'000;                                  ///< that a tile should not pass
    std::uint64_t total = std::numeric_limits<std::uint64_t>::max();  ///< bytes that all must not pass
    std::uint32_t most = 64;                                          ///< tiles
};

struct PatchTile {
    glm::uvec3 place{0};  ///< in the grid of tiles
    glm::uvec3 first{0};  ///< root
    glm::uvec3 own{1};    ///< roots along each axis, without those beyond
    DepthMap map{};
};

/// Cuts across the longest side of the tiles, again and again, until each is small enough, or what the options or the number
/// of roots allow ends it. Tiles whose own roots are all outside are left out: points there are far outside of all the others.
/// \param whole  a valid map of patches.
/// \return x fastest; a single one without a copy of the texels where the tree is not to be cut: it is the whole.
[[nodiscard]] std::vector<PatchTile> cutIntoTiles(const DepthMap& whole, const PatchTileOptions& options);

/// Some roots, with all below them. Of all roots of a tree that encodePatches() made: its texels.
/// \param whole  a valid map of patches. \param count  within its roots.
[[nodiscard]] DepthMap cutPatches(const DepthMap& whole, const glm::uvec3& first, const glm::uvec3& count);

}  // namespace relief
