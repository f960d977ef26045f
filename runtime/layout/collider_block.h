// SPDX-License-Identifier: Apache-2.0
// Maps in the layout of shaders/collider/collider.glsl, and the defines that this shader is compiled with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

#include "runtime/layout/map_layout.h"

namespace relief {

/// The shader's ReliefMap, std140.
struct BlockMap {
    glm::vec4 row[3];
    glm::vec4 column[3];
    glm::vec4 object_per_map;
    std::int32_t place[4];
    std::int32_t info[4];
};

/// Returns the number of maps that fit into a block of this size.
[[nodiscard]] std::size_t mapsInBlock(std::size_t block_bytes);

[[nodiscard]] BlockMap blockMap(const PlacedMap& map, const MapPlace& at);

/// Returns the shader's u_relief_count.
[[nodiscard]] glm::ivec4 blockHead(std::span<const PlacedMap> maps, const MapLayout& layout);
[[nodiscard]] std::vector<BlockMap> blockMaps(std::span<const PlacedMap> maps, const MapLayout& layout);
/// Returns the whole block of a single collider, std140: u_relief_count, then the maps.
[[nodiscard]] std::vector<std::byte> colliderBlock(std::span<const PlacedMap> maps, const MapLayout& layout);

/// Returns the `defines` of makeProgram for a single collider. They exclude code that no map needs, because a GL driver
/// may execute every branch for every map. A program is therefore specific to a collider.
[[nodiscard]] std::string colliderDefines(std::span<const PlacedMap> maps, const MapLayout& layout);
/// Returns the lines that both single colliders and worlds need: widths of the textures, formats and flags.
[[nodiscard]] std::string mapDefines(std::span<const PlacedMap> maps, const MapLayout& layout);

}  // namespace relief
