// SPDX-License-Identifier: Apache-2.0
// Maps as shaders/collider/collider.glsl reads them, and what that shader is compiled for.
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

/// The maps that a block of so many bytes has room for.
[[nodiscard]] std::size_t mapsInBlock(std::size_t block_bytes);

[[nodiscard]] BlockMap blockMap(const PlacedMap& map, const MapPlace& at);

/// The shader's u_relief_count.
[[nodiscard]] glm::ivec4 blockHead(std::span<const PlacedMap> maps, const MapLayout& layout);
[[nodiscard]] std::vector<BlockMap> blockMaps(std::span<const PlacedMap> maps, const MapLayout& layout);
/// The whole block of a single collider, std140: the head and the maps.
[[nodiscard]] std::vector<std::byte> colliderBlock(std::span<const PlacedMap> maps, const MapLayout& layout);

/// Lines for makeProgram of a single collider. The shader leaves out what no map needs, because a GL may run every branch for
/// every map, so a program is of one collider only.
[[nodiscard]] std::string colliderDefines(std::span<const PlacedMap> maps, const MapLayout& layout);
/// Those of any maps: widths of the textures, formats and flags.
[[nodiscard]] std::string mapDefines(std::span<const PlacedMap> maps, const MapLayout& layout);

}  // namespace relief
