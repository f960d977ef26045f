// SPDX-License-Identifier: Apache-2.0
// Maps and bodies as shaders/collider/collider.glsl reads them, and what that shader is compiled for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

#include "runtime/collider/map_layout.h"
#include "runtime/collider/pose.h"

namespace relief {

/// The shader's ReliefMap, std140.
struct BlockMap {
    glm::vec4 row[3];
    glm::vec4 column[3];
    glm::vec4 object_per_map;
    std::int32_t place[4];
    std::int32_t info[4];
};

/// A body in a world: shaders/collider/world.glsl.
struct BlockBody {
    std::int32_t maps[4];
    glm::vec4 response;
    glm::vec4 row[3];
    glm::vec4 move[3];
};
static_assert(sizeof(BlockBody) == 128);

/// The maps that a block of so many bytes has room for.
[[nodiscard]] std::size_t mapsInBlock(std::size_t block_bytes);

/// The rows that take a point of the world to the body's object space, and those that take a point of a body from where it
/// is in one pose to where it is in another.
void writeRows(const Pose& pose, glm::vec4 (&rows)[3]);
void writeMove(const Pose& from, const Pose& to, glm::vec4 (&rows)[3]);
/// A map of patches of a body in this pose: its object space is the world. (Other maps have normals of their own space.)
[[nodiscard]] BlockMap placedMap(const BlockMap& map, const Pose& pose);

[[nodiscard]] BlockMap blockMap(const PlacedMap& map, const MapPlace& at);

/// The shader's u_relief_count.
[[nodiscard]] glm::ivec4 blockHead(std::span<const PlacedMap> maps, const MapLayout& layout);
[[nodiscard]] std::vector<BlockMap> blockMaps(std::span<const PlacedMap> maps, const MapLayout& layout);
/// The whole block of a single collider, std140: the head and the maps.
[[nodiscard]] std::vector<std::byte> colliderBlock(std::span<const PlacedMap> maps, const MapLayout& layout);

/// A collider by itself, or bodies with poses: each with one map of patches, which is placed in the world so that a point of the
/// world finds its cell by one transform; or any.
enum class WorldKind : std::uint8_t { kNone, kPlaced, kAny };

/// Lines for makeProgram: RELIEF_MAP_CAPACITY, and what no map needs is left out of the shader, for a GL may run every
/// branch for every map. So a program is of one collider alone.
[[nodiscard]] std::string colliderDefines(WorldKind world, std::span<const PlacedMap> maps,
                                          const MapLayout& layout);

}  // namespace relief
