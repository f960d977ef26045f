// SPDX-License-Identifier: Apache-2.0
#include "runtime/bodies/body_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

namespace relief {
namespace {

/// Maximum cells of a level along each axis from the origin: fits into an int after rounding.
constexpr float kCellsMax = 1e9F;
/// Levels with fewer than 1/kFew of all bodies are merged into the next coarser one.
constexpr std::size_t kFew = 16;
/// Minimum lists per entry of a level.
constexpr std::size_t kListsPerEntry = 1;
constexpr int kUnbounded = std::numeric_limits<int>::max();

/// Returns the power of 2 of the cell size for a box.
int exponentOf(const BodyBox& box, float cell_size) {
    if (box.unbounded) {
        return kUnbounded;
    }
    const glm::vec3 extent = box.extent();
    const glm::vec3 most = glm::abs(box.center) + extent;
    const float side = 2.0F * std::max({extent.x, extent.y, extent.z});
    const float far = std::max({most.x, most.y, most.z});
    const float least = std::max({cell_size * side, far / kCellsMax, 1e-30F});
    return static_cast<int>(std::ceil(std::log2(least)));
}

/// Returns the boxes of each level, by ascending exponent.
std::map<int, std::vector<std::uint32_t>> levelsOf(std::span<const BodyBox> boxes, float cell_size) {
    std::map<int, std::vector<std::uint32_t>> levels;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        levels[exponentOf(boxes[i], cell_size)].push_back(i);
    }
    const auto join = [&](auto level) {
        const auto next = std::next(level);
        next->second.insert(next->second.end(), level->second.begin(), level->second.end());
        return levels.erase(level);
    };
    const auto last = [&](auto level) {
        return std::next(level) == levels.end() || std::next(level)->first == kUnbounded;
    };
    for (auto level = levels.begin(); level != levels.end();) {
        const bool few = level->second.size() < boxes.size() / kFew;
        level = level->first != kUnbounded && !last(level) && few ? join(level) : std::next(level);
    }
    while (levels.size() > kGridLevelsMax) {
        join(levels.begin());
    }
    for (auto& [exponent, indices] : levels) {
        std::sort(indices.begin(), indices.end());
    }
    return levels;
}

/// Enumerates the cells of a level that an oriented box intersects.
class IntersectedCells {
  public:
    IntersectedCells(const BodyBox& box, float cell_size) : box_(box), cell_size_(cell_size) {
        for (int i = 0; i < 3; ++i) {
            const float length = glm::length(box.half[i]);
            axis_[i] = length > 0.0F ? box.half[i] / length : glm::vec3(0.0F);
            const float of_cell = glm::dot(glm::abs(axis_[i]), glm::vec3(0.5F * cell_size));
            reach_[i] = length + box.margin + of_cell;
        }
    }
    /// Returns false if a side of the box separates it from the cell.
    [[nodiscard]] bool intersects(const glm::ivec3& cell) const {
        const glm::vec3 from = (glm::vec3(cell) + 0.5F) * cell_size_ - box_.center;
        return std::abs(glm::dot(from, axis_[0])) <= reach_[0] &&
               std::abs(glm::dot(from, axis_[1])) <= reach_[1] &&
               std::abs(glm::dot(from, axis_[2])) <= reach_[2];
    }
    template <class Visit>
    void forEach(const Visit& visit) const {
        const glm::ivec3 low(glm::floor((box_.center - box_.extent()) / cell_size_));
        const glm::ivec3 high(glm::floor((box_.center + box_.extent()) / cell_size_));
        for (int z = low.z; z <= high.z; ++z) {
            for (int y = low.y; y <= high.y; ++y) {
                for (int x = low.x; x <= high.x; ++x) {
                    if (const glm::ivec3 cell(x, y, z); intersects(cell)) {
                        visit(cell);
                    }
                }
            }
        }
    }

  private:
    const BodyBox& box_;
    float cell_size_;
    glm::vec3 axis_[3];
    float reach_[3] = {};
};

/// Adds a level with these entries. \param lists  number of lists, a power of two.
void addLevel(BodyGrid& grid, float cells_per_unit, std::uint32_t lists,
              std::span<const BodyGrid::Entry> entries) {
    const BodyGrid::Level level{cells_per_unit, static_cast<std::uint32_t>(grid.lists.size()), lists - 1};
    const auto listOf = [&](const BodyGrid::Entry& entry) -> BodyGrid::List& {
        return grid.lists[level.first + (entry.hash & level.mask)];
    };
    grid.lists.resize(grid.lists.size() + lists);
    for (const BodyGrid::Entry& entry : entries) {
        ++listOf(entry).end;
    }
    auto end = static_cast<std::uint32_t>(grid.entries.size());
    for (std::size_t i = level.first; i < grid.lists.size(); ++i) {
        const std::uint32_t count = grid.lists[i].end;
        grid.lists[i] = {end, end};
        end += count;
    }
    grid.entries.resize(end);
    for (const BodyGrid::Entry& entry : entries) {
        grid.entries[listOf(entry).end++] = entry;
    }
    grid.levels.push_back(level);
}

}  // namespace

std::uint32_t cellHash(const glm::ivec3& cell) {
    std::uint32_t h = static_cast<std::uint32_t>(cell.x) * 0x8da6b343U +
                      static_cast<std::uint32_t>(cell.y) * 0xd8163841U +
                      static_cast<std::uint32_t>(cell.z) * 0xcb1ab31fU;
    h ^= h >> 15U;
    h *= 0x2c1b3c6dU;
    return h ^ (h >> 13U);
}

BodyGrid BodyGrid::of(std::span<const BodyBox> boxes, float cell_size) {
    BodyGrid grid;
    std::vector<Entry> entries;
    for (const auto& [exponent, indices] : levelsOf(boxes, cell_size)) {
        entries.clear();
        const bool bounded = exponent != kUnbounded;
        for (const std::uint32_t index : indices) {
            const std::uint32_t body = boxes[index].body;
            if (bounded) {
                const IntersectedCells cells(boxes[index], std::ldexp(1.0F, exponent));
                cells.forEach([&](const glm::ivec3& cell) { entries.push_back({body, cellHash(cell)}); });
            } else {
                entries.push_back({body, cellHash(glm::ivec3(0))});
            }
        }
        std::uint32_t lists = 1;
        while (bounded && lists < kListsPerEntry * entries.size()) {
            lists *= 2;
        }
        addLevel(grid, bounded ? std::ldexp(1.0F, -exponent) : 0.0F, lists, entries);
    }
    return grid;
}

}  // namespace relief
