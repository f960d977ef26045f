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

/// A body in a world: shaders/collider/world.glsl.
struct BlockBody {
    glm::vec4 row[3];
    glm::vec4 before[3];
    glm::vec4 response;
    std::int32_t maps[4];
};
static_assert(sizeof(BlockBody) == 128);

/// The maps that a block of so many bytes has room for.
[[nodiscard]] std::size_t mapsInBlock(std::size_t block_bytes);

/// Writes the rows that take a point of the world to the body's object space.
void writeRows(const Pose& pose, glm::vec4 (&rows)[3]);

/// The shader's u_relief_count.
[[nodiscard]] glm::ivec4 blockHead(std::span<const PlacedMap> maps, const MapLayout& layout);
/// The shader's ReliefMap of each map, one after the other.
[[nodiscard]] std::vector<std::byte> blockMaps(std::span<const PlacedMap> maps, const MapLayout& layout);
/// The whole block of a single collider, std140: the head and the maps.
[[nodiscard]] std::vector<std::byte> colliderBlock(std::span<const PlacedMap> maps, const MapLayout& layout);

/// Lines for makeProgram: RELIEF_MAP_CAPACITY, and what no map needs is left out of the shader, for a GL may run every
/// branch for every map. So a program is of one collider alone.
/// \param world  of bodies with poses.
[[nodiscard]] std::string colliderDefines(bool world, std::span<const PlacedMap> maps,
                                          const MapLayout& layout);

}  // namespace relief
