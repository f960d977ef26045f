// SPDX-License-Identifier: Apache-2.0
// Distances near a surface: a grid of cubes, where each cube near the surface has a brick, a block of distances that a
// GPU can filter. A dense volume is one brick. `relief-accuracy --atlas` writes the distance volumes that it measures,
// and `relief-bench step --bricks` reads them.
//
// File layout: a Header, `index`, `codes`; little-endian. The layout may change with every version of the tools.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

struct BrickAtlas {
    static constexpr std::uint32_t kOutside = 0;  ///< in `index`: no brick, outside
    static constexpr std::uint32_t kInside = 1;
    static constexpr std::uint32_t kFirstBrick = 2;

    Bounds box;              ///< bounds of the mesh, object space; everything beyond is outside
    glm::vec3 origin{0.0F};  ///< the lowest corner of cube (0, 0, 0)
    glm::vec3 cube_size{1.0F};
    glm::uvec3 cubes{1};
    glm::uvec3 cells{1};      ///< voxels per brick; a brick has one more node along each axis
    float range = 1.0F;       ///< distance of the largest code, in object units
    std::uint32_t bits = 8;   ///< per code: 8 or 16
    std::uint64_t bytes = 0;  ///< size that relief-accuracy reports, with a smaller index or none
    std::vector<std::uint32_t>
        index;  ///< per cube, x fastest: kOutside, kInside, or kFirstBrick + brick number
    std::vector<std::int16_t> codes;  ///< brick by brick, nodes x fastest: ±codeMax() encodes ±range

    [[nodiscard]] std::size_t nodesOfBrick() const {
        return std::size_t{cells.x + 1} * (cells.y + 1) * (cells.z + 1);
    }
    [[nodiscard]] std::size_t bricks() const { return codes.size() / nodesOfBrick(); }
    [[nodiscard]] float codeMax() const { return bits == 8 ? 127.0F : 32767.0F; }
};

/// Reads an atlas. Errors: kIo, kLimit, kInvalidInput (not an atlas, or an index to a missing brick).
[[nodiscard]] Result<BrickAtlas> loadBrickAtlas(const std::filesystem::path& path);
/// Writes an atlas. Errors: kIo.
[[nodiscard]] Result<void> saveBrickAtlas(const BrickAtlas& atlas, const std::filesystem::path& path);

}  // namespace relief
