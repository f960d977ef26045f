// SPDX-License-Identifier: Apache-2.0
// Cuts very large colliders of a world into tiles. Each tile is a collider and a body of the world, so that one part
// of a mesh can be on the GPU without the others. bake/patches/patch_tiles.h makes the cuts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/patches/patch_tiles.h"
#include "formats/collider.h"

namespace relief {

struct ColliderTile {
    std::string name;     ///< position among the tiles, such as 0-1-0; empty: the whole
    Collider collider{};  ///< its bounds are part of the whole collider's bounds
};

/// Cuts a collider. \return only the whole collider if it is small enough, or is not a tree of patches.
[[nodiscard]] std::vector<ColliderTile> cutCollider(Collider whole, const PatchTileOptions& options);

/// Whether text is a valid name of a tile.
[[nodiscard]] bool isTileName(std::string_view text);

/// Returns the maximum number of tiles per mesh that keeps a world within its limits of colliders and bodies. It is a
/// power of two, so that it rarely changes as a level grows.
[[nodiscard]] std::uint32_t maxTiles(std::size_t meshes, std::size_t bodies);

/// Returns the budget for a collider so that its tiles fit into `share` bytes, although tiles duplicate some roots.
[[nodiscard]] std::uint64_t bytesBeforeCut(std::uint64_t share, const PatchTileOptions& options);

}  // namespace relief
