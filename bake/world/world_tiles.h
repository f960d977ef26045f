// SPDX-License-Identifier: Apache-2.0
// Very large colliders of a world cut into tiles, each a collider and a body of the world, so that a part of a mesh can be on
// the GPU without the others. bake/patches/patch_tiles.h has the cuts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/patches/patch_tiles.h"
#include "formats/collider.h"

namespace relief {

struct ColliderTile {
    std::string name;     ///< its place among the tiles, such as 0-1-0; empty: the whole
    Collider collider{};  ///< whose bounds are its part of the whole's
};

/// \return the whole alone where it is not to be cut: it is small enough, or no tree of patches.
[[nodiscard]] std::vector<ColliderTile> cutCollider(Collider whole, const PatchTileOptions& options);

/// Whether text can be the name of a tile.
[[nodiscard]] bool isTileName(std::string_view text);

/// The most tiles of each mesh with which a world has no more colliders and bodies than it may: a power of two, so that a
/// level that grows seldom changes it.
[[nodiscard]] std::uint32_t tilesMost(std::size_t meshes, std::size_t bodies);

/// The bytes that a collider is planned for so that, cut, it takes no more than its share: tiles hold some cells twice.
[[nodiscard]] std::uint64_t bytesBeforeCut(std::uint64_t share, const PatchTileOptions& options);

}  // namespace relief
