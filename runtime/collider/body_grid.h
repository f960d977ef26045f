// The broad phase of a world: which bodies a point may be in. Plain arithmetic, no GL.
//
// A body's box goes to the level whose cells are about as large, a power of 2, and so into a few cells there. The cells of a
// level lie in a hash table of lists, a power of two of them:
//
//     floor(p / cell size)  ──hash──▶  list [first, end)  ──▶  entries: body, hash of its cell, its box in 256ths of the cell
//
// A point asks one list of each level. Levels of few bodies join the next coarser one: each costs every point a look.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace relief {

/// The box of a body in the world.
struct BodyBox {
    glm::vec3 low{0.0F};
    glm::vec3 high{0.0F};
    std::uint32_t body = 0;
    bool unbounded = false;  ///< met by every point: a list of its own holds these
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
    /// The part of a box in a cell, rounded outwards.
    struct Entry {
        std::uint32_t body = 0;
        std::uint32_t low = 0;   ///< x, y and z of a byte each, x lowest
        std::uint32_t high = 0;  ///< the same
        std::uint32_t hash = 0;  ///< cellHash
    };
    std::vector<Level> levels;
    std::vector<List> lists;
    std::vector<Entry> entries;  ///< of a list by rising body

    /// \param boxes  finite where they are bounded, and no coordinate above 1e9 cells.
    /// \param cell_size  of the longest side of a body, at least; at most twice that. Small cells have short lists, and more
    ///     entries.
    [[nodiscard]] static BodyGrid of(std::span<const BodyBox> boxes, float cell_size = 0.7F);
};

/// The hash of a cell, and a place in it as an entry has places: as collider/bodies.glsl finds them.
[[nodiscard]] std::uint32_t cellHash(const glm::ivec3& cell);
[[nodiscard]] glm::uvec3 placeInCell(const glm::vec3& p, float cells_per_unit, const glm::ivec3& cell);

}  // namespace relief
