// SPDX-License-Identifier: Apache-2.0
// The broad phase of a world: which bodies a point may be in. Plain arithmetic, no GL.
//
// A body's box goes to the level whose cells are some times smaller, a power of 2, and there into the cells that it meets, turned
// as it is. The cells of a level lie in a hash table of lists, a power of two of them:
//
//     floor(p / cell size)  ──hash──▶  list [first, end)  ──▶  entries: body, hash of its cell
//
// A point asks one list of each level. Levels of few bodies join the next coarser one: each costs every point a look.
#pragma once

#include <cstdint>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace relief {

/// The box of a body in the world.
struct BodyBox {
    glm::vec3 center{0.0F};
    glm::mat3 half{0.0F};  ///< columns: from the centre to its sides, at right angles to each other
    float margin = 0.0F;   ///< around it
    std::uint32_t body = 0;
    bool unbounded = false;  ///< met by every point: a list of its own holds these

    /// From the centre to the sides of the box around it whose edges are along the axes.
    [[nodiscard]] glm::vec3 extent() const {
        return glm::abs(half[0]) + glm::abs(half[1]) + glm::abs(half[2]) + margin;
    }
};

/// Levels of one grid, at most.
inline constexpr std::size_t kGridLevelsMax = 8;

struct BodyGrid {
    struct Level {
        float cells_per_unit = 0.0F;  ///< a power of 2; 0: all points are in cell 0
        std::uint32_t first = 0;      ///< of its lists
        std::uint32_t mask = 0;       ///< of the hash
    };
    struct List {
        std::uint32_t first = 0;  ///< of `entries`
        std::uint32_t end = 0;
    };
    struct Entry {
        std::uint32_t body = 0;
        std::uint32_t hash = 0;  ///< cellHash
    };
    std::vector<Level> levels;
    std::vector<List> lists;
    std::vector<Entry> entries;  ///< of a list by rising body

    /// \param boxes  finite where they are bounded, and no coordinate above 1e9 cells.
    /// \param cell_size  of the longest side of a body, at least; at most twice that. Small cells have short lists, and more
    ///     entries.
    [[nodiscard]] static BodyGrid of(std::span<const BodyBox> boxes, float cell_size);
};

/// The hash of a cell, as bodies/bodies.glsl finds it.
[[nodiscard]] std::uint32_t cellHash(const glm::ivec3& cell);

}  // namespace relief
