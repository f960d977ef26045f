// SPDX-License-Identifier: Apache-2.0
#include "bake/world/world_tiles.h"

#include <algorithm>
#include <bit>

#include "formats/world/world.h"

namespace relief {
namespace {

/// A tenth of a share is reserved for the roots that tiles duplicate. They take a fifteenth of the share if a side has
/// thirty roots, and more if it has fewer.
constexpr std::uint64_t kReserveDivisor = 10;

/// Returns the part of a box within the tile's own roots.
Bounds partOf(const Bounds& box, const DepthMap& whole, const PatchTile& tile) {
    const double size = double{whole.object_per_map.x};
    Bounds part = box;
    for (int i = 0; i < 3; ++i) {
        const auto planeAt = [&](std::uint32_t root) {
            return static_cast<float>((static_cast<double>(root) - double{whole.object_to_map.row[i].w}) *
                                      size);
        };
        part.min[i] = std::clamp(planeAt(tile.first[i]), box.min[i], box.max[i]);
        part.max[i] = std::clamp(planeAt(tile.first[i] + tile.own[i]), box.min[i], box.max[i]);
    }
    return part;
}

}  // namespace

std::vector<ColliderTile> cutCollider(Collider whole, const PatchTileOptions& options) {
    std::vector<ColliderTile> colliders;
    if (whole.maps.size() == 1 && whole.maps[0].format == MapFormat::kPatches) {
        std::vector<PatchTile> tiles = cutIntoTiles(whole.maps[0], options);
        for (std::size_t i = 0; tiles.size() > 1 && i < tiles.size(); ++i) {
            const glm::uvec3& at = tiles[i].place;
            ColliderTile tile;
            tile.name = std::to_string(at.x) + "-" + std::to_string(at.y) + "-" + std::to_string(at.z);
            tile.collider.unit = whole.unit;
            tile.collider.provenance = whole.provenance;
            tile.collider.bounds = partOf(whole.bounds, whole.maps[0], tiles[i]);
            tile.collider.maps.push_back(std::move(tiles[i].map));
            colliders.push_back(std::move(tile));
        }
    }
    if (colliders.empty()) {
        colliders.push_back({"", std::move(whole)});
    }
    return colliders;
}

bool isTileName(std::string_view text) {
    return std::count(text.begin(), text.end(), '-') == 2 &&
           text.find_first_not_of("0123456789-") == std::string_view::npos;
}

std::uint32_t maxTiles(std::size_t meshes, std::size_t bodies) {
    const std::size_t most = std::min(
        {std::size_t{PatchTileOptions().most}, kWorldCollidersMax / meshes, kWorldBodiesMax / bodies});
    return static_cast<std::uint32_t>(std::bit_floor(std::max(most, std::size_t{1})));
}

std::uint64_t bytesBeforeCut(std::uint64_t share, const PatchTileOptions& options) {
    return share <= options.bytes || options.most == 1
               ? share
               : std::max(options.bytes, share - share / kReserveDivisor);
}

}  // namespace relief
