// SPDX-License-Identifier: Apache-2.0
// The broad phase of a world: finds the bodies that a point may be in. Independent of GL.
//
// Each body is assigned to a level by the size of its box; cell sizes are powers of 2. The body is inserted into
// those cells of its level that its oriented box intersects. The cells of a level are hashed into a power-of-two table
// of lists:
//
//     floor(p / cell size)  ──hash──▶  list [first, end)  ──▶  entries: body, hash of its cell
//
// A point queries one list per level. Levels with few bodies are merged into the next coarser one, because each level
// adds a query per point.
#pragma once

#include <cstdint>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace relief {

/// The oriented box of a body in the world.
struct BodyBox {
    glm::vec3 center{0.0F};
    glm::mat3 half{0.0F};  ///< columns: from the centre to three faces, mutually perpendicular
    float margin = 0.0F;   ///< added around the box
    std::uint32_t body = 0;
    bool unbounded = false;  ///< contains every point; stored in a separate level

    /// Returns half the sides of the enclosing axis-aligned box.
    [[nodiscard]] glm::vec3 extent() const {
        return glm::abs(half[0]) + glm::abs(half[1]) + glm::abs(half[2]) + margin;
    }
};

/// Maximum levels of a grid.
inline constexpr std::size_t kGridLevelsMax = 8;

struct BodyGrid {
    struct Level {
        float cells_per_unit = 0.0F;  ///< a power of 2; 0: all points are in cell 0
        std::uint32_t first = 0;      ///< index of its first list
        std::uint32_t mask = 0;       ///< mask applied to the hash
    };
    struct List {
        std::uint32_t first = 0;  ///< index into `entries`
        std::uint32_t end = 0;
    };
    struct Entry {
        std::uint32_t body = 0;
        std::uint32_t hash = 0;  ///< cellHash
    };
    std::vector<Level> levels;
    std::vector<List> lists;
    std::vector<Entry> entries;  ///< each list is sorted by body

    /// Builds a grid.
    /// \param boxes  finite unless unbounded.
    /// \param cell_size  in units of a body's longest side. Cells are rounded up to a power of 2; they are larger if a
    /// coordinate would exceed 1e9 cells, or if the body's level is merged into a coarser one. Smaller cells give
    /// shorter lists but more entries.
    [[nodiscard]] static BodyGrid of(std::span<const BodyBox> boxes, float cell_size);
};

/// Returns the hash of a cell; must match bodies/bodies.glsl.
[[nodiscard]] std::uint32_t cellHash(const glm::ivec3& cell);

}  // namespace relief
