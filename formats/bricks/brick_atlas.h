// SPDX-License-Identifier: Apache-2.0
// Distances near a surface as a GPU filters them: what `relief-accuracy --atlas` writes of the rivals that it measures, for
// `relief-bench step --bricks` to read. A dense volume is one brick.
//
// A file is the bytes of a Header, then those of `index`, then of `codes`; little-endian; another version of the tools may refuse it.
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
    static constexpr std::uint32_t kOutside = 0;  ///< in `index`: a cube without a brick
    static constexpr std::uint32_t kInside = 1;
    static constexpr std::uint32_t kFirstBrick = 2;

    Bounds box;              ///< of the mesh, object space: all beyond is outside
    glm::vec3 origin{0.0F};  ///< the lowest corner of cube (0, 0, 0)
    glm::vec3 cube_size{1.0F};
    glm::uvec3 cubes{1};
    glm::uvec3 cells{1};      ///< voxels of a brick, which has a node more along each axis
    float range = 1.0F;       ///< object units: the distance of the largest code
    std::uint32_t bits = 8;   ///< of a code: 8 or 16
    std::uint64_t bytes = 0;  ///< those that relief-accuracy counts, with the index that it counts
    std::vector<std::uint32_t>
        index;  ///< of each cube, x fastest: kOutside, kInside, or kFirstBrick and its brick
    std::vector<std::int16_t> codes;  ///< brick after brick, nodes x fastest: ±codeMax() for ±range

    [[nodiscard]] std::size_t nodesOfBrick() const {
        return std::size_t{cells.x + 1} * (cells.y + 1) * (cells.z + 1);
    }
    [[nodiscard]] std::size_t bricks() const { return codes.size() / nodesOfBrick(); }
    [[nodiscard]] float codeMax() const { return bits == 8 ? 127.0F : 32767.0F; }
};

/// Errors: kIo, kLimit, kInvalidInput (not such a file, or an index of bricks that are not there).
[[nodiscard]] Result<BrickAtlas> loadBrickAtlas(const std::filesystem::path& path);
/// Errors: kIo.
[[nodiscard]] Result<void> saveBrickAtlas(const BrickAtlas& atlas, const std::filesystem::path& path);

}  // namespace relief
