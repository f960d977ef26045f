// SPDX-License-Identifier: Apache-2.0
#include "runtime/layout/collider_block.h"

#include <algorithm>
#include <cstring>
#include <glm/glm.hpp>

#include "formats/patch_constants.h"
#include "shaders/collider/constants.h"

namespace relief {
namespace {

std::int32_t flagsOf(const PlacedMap& placed) {
    const DepthMap& map = *placed.map;
    return (map.compare == Compare::kGreater ? kKeepsFarthest : 0) | (map.encloses ? kEncloses : 0) |
           (map.empty_is_outside ? kEmptyIsOutside : 0) | (map.decode == Decode::kPlane ? kDecodesPlane : 0);
}

/// Returns the unrolled first votes of a step, with constants that let the compiler remove the code of other formats.
std::string unrolledVotes(std::span<const PlacedMap> maps) {
    std::string votes;
    for (std::size_t i = 0; i < std::min<std::size_t>(maps.size(), kUnrolledMaps); ++i) {
        votes += "RELIEF_VOTE_OF(" + std::to_string(i) + "," +
                 std::to_string(static_cast<int>(maps[i].map->format)) + "," +
                 std::to_string(flagsOf(maps[i])) + ") ";
    }
    return votes;
}

}  // namespace

BlockMap blockMap(const PlacedMap& placed, const MapPlace& at) {
    const DepthMap& map = *placed.map;
    BlockMap block{};
    const bool cube = map.projection() == Projection::kCube;
    const bool patches = map.projection() == Projection::kLocal;
    const glm::vec3 size = cube || patches ? glm::vec3(1.0F) : glm::vec3(map.width, map.height, 1.0F);
    const float last[3] = {0.0F, static_cast<float>(map.width - 1), static_cast<float>(map.height - 1)};
    for (int i = 0; i < 3; ++i) {
        // The rows are orthogonal, and their lengths are the reciprocals of object_per_map.
        const glm::vec3 row(map.object_to_map.row[i]);
        block.row[i] = map.object_to_map.row[i] * size[i];
        block.column[i] = glm::vec4(row * map.object_per_map[i] * map.object_per_map[i] / size[i],
                                    patches ? 0.0F : last[i]);
    }
    const PatchConstants patch = patches ? patchConstants(map, at.first) : PatchConstants{};
    block.object_per_map = patches ? patch.size : glm::vec4(map.object_per_map, 0.0F);
    const auto height = static_cast<std::int32_t>(map.height);
    const glm::ivec4 place =
        patches ? patch.place : glm::ivec4(at.first, at.pitch, at.pitch * height, map.width);
    const std::int32_t info[4] = {height, static_cast<std::int32_t>(map.format), flagsOf(placed),
                                  static_cast<std::int32_t>(at.motion_first)};
    std::memcpy(block.place, &place, sizeof(place));
    std::memcpy(block.info, info, sizeof(info));
    return block;
}

std::size_t mapsInBlock(std::size_t block_bytes) {
    return (block_bytes - sizeof(glm::ivec4)) / sizeof(BlockMap);
}

glm::ivec4 blockHead(std::span<const PlacedMap> maps, const MapLayout& layout) {
    return {static_cast<int>(maps.size()), layout.textures[kFloatTexels].log2Width(),
            layout.textures[kFixedTexels].log2Width(), layout.textures[kFrontBackTexels].log2Width()};
}

std::vector<BlockMap> blockMaps(std::span<const PlacedMap> maps, const MapLayout& layout) {
    std::vector<BlockMap> block;
    for (std::size_t m = 0; m < maps.size(); ++m) {
        block.push_back(blockMap(maps[m], layout.places[m]));
    }
    return block;
}

std::vector<std::byte> colliderBlock(std::span<const PlacedMap> maps, const MapLayout& layout) {
    const glm::ivec4 head = blockHead(maps, layout);
    const std::vector<BlockMap> of_maps = blockMaps(maps, layout);
    std::vector<std::byte> block(sizeof(head) + of_maps.size() * sizeof(BlockMap));
    std::memcpy(block.data(), &head, sizeof(head));
    std::memcpy(block.data() + sizeof(head), of_maps.data(), of_maps.size() * sizeof(BlockMap));
    return block;
}

std::string colliderDefines(std::span<const PlacedMap> maps, const MapLayout& layout) {
    return "#define RELIEF_MAP_CAPACITY " + std::to_string(maps.size()) + "\n#define RELIEF_VOTES " +
           unrolledVotes(maps) + "\n" + mapDefines(maps, layout);
}

std::string mapDefines(std::span<const PlacedMap> maps, const MapLayout& layout) {
    std::string defines;
    const auto define = [&](const std::string& name, const std::string& value = {}) {
        defines += "#define RELIEF_" + name + " " + value + "\n";
    };
    const auto log2Width = [&](TexelKind kind) { return std::to_string(layout.textures[kind].log2Width()); };
    define("LOG2_WIDTHS", "ivec3(" + log2Width(kFloatTexels) + "," + log2Width(kFixedTexels) + "," +
                              log2Width(kFrontBackTexels) + ")");
    if (std::any_of(maps.begin(), maps.end(), [](const PlacedMap& one) { return one.live; })) {
        define("LIVE", "1");
    }
    std::int32_t all = ~0;
    for (const PlacedMap& one : maps) {
        all &= flagsOf(one);
    }
    define("ALL", std::to_string(all));
    const auto defineIf = [&](const char* name, auto&& needed) {
        if (std::any_of(maps.begin(), maps.end(), [&](const PlacedMap& one) { return needed(*one.map); })) {
            define(std::string("HAS_") + name);
        }
    };
    for (const TexelKind kind : {kFloatTexels, kFixedTexels, kFrontBackTexels}) {
        if (kind == kFrontBackTexels) {
            defineIf("FRONT_BACK", [](const DepthMap& map) { return isFrontBack(map.format); });
        }
        for (std::size_t i = 0; i < kMapFormats.size(); ++i) {
            const auto format = static_cast<MapFormat>(i);
            if (texelKindOf(format) == kind) {
                defineIf(kMapFormats[i].macro, [&](const DepthMap& map) { return map.format == format; });
            }
        }
    }
    defineIf("PLANE", [](const DepthMap& map) { return map.decode == Decode::kPlane; });
    defineIf("PROJECTED", [](const DepthMap& map) { return map.decode == Decode::kProjected; });
    return defines;
}

}  // namespace relief
