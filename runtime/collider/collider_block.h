// The uniform block of shaders/collider/collider.glsl as bytes, and what that shader is compiled for.
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

/// The shader's ReliefBody, std140.
struct BlockBody {
    glm::vec4 row[3];
    glm::vec4 before[3];
    glm::vec4 response;
    std::int32_t maps[4];
};
static_assert(sizeof(BlockBody) == 128);

/// Bytes before the first body.
inline constexpr std::size_t kBlockHead = 16;

/// The maps that a block of so many bytes has room for beside so many bodies.
[[nodiscard]] std::size_t mapsInBlock(std::size_t block_bytes, std::size_t bodies);

/// Writes the rows that take a point of the world to the body's object space.
void writeRows(const Pose& pose, glm::vec4 (&rows)[3]);

/// The whole block.
[[nodiscard]] std::vector<std::byte> colliderBlock(std::span<const BlockBody> bodies,
                                                   std::span<const PlacedMap> maps, const MapLayout& layout);

/// Lines for makeProgram: RELIEF_MAP_CAPACITY, and what no map needs is left out of the shader, for a GL may run every
/// branch for every map. So a program is of one collider alone.
[[nodiscard]] std::string colliderDefines(std::size_t bodies, std::span<const PlacedMap> maps,
                                          const MapLayout& layout);

}  // namespace relief
