#include "runtime/collider/body_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <tuple>

namespace relief {
namespace {

/// Cells of a level, at most, along each axis from the origin: what an int holds after rounding.
constexpr float kCellsMax = 1e9F;
/// Levels of fewer bodies than this share of all join the next coarser one.
constexpr std::size_t kFew = 16;
/// Lists of a level for each of its entries, at least.
constexpr std::size_t kListsPerEntry = 1;
constexpr int kUnbounded = std::numeric_limits<int>::max();

/// The exponent of 2 of the cells for a box.
int exponentOf(const BodyBox& box, float cell_size) {
    if (box.unbounded) {
        return kUnbounded;
    }
    const glm::vec3 size = box.high - box.low;
    const glm::vec3 most = glm::max(glm::abs(box.low), glm::abs(box.high));
    const float far = std::max({most.x, most.y, most.z});
    const float least =
        std::max({cell_size * size.x, cell_size * size.y, cell_size * size.z, far / kCellsMax, 1e-30F});
    return static_cast<int>(std::ceil(std::log2(least)));
}

/// The boxes of each level, by exponent; ascending.
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

std::uint32_t packed(const glm::uvec3& place) {
    return place.x | place.y << 8U | place.z << 16U;
}

struct Placed {
    std::uint32_t list;
    BodyGrid::Entry entry;
};

}  // namespace

std::uint32_t cellHash(const glm::ivec3& cell) {
    std::uint32_t h = static_cast<std::uint32_t>(cell.x) * 0x8da6b343U +
                      static_cast<std::uint32_t>(cell.y) * 0xd8163841U +
                      static_cast<std::uint32_t>(cell.z) * 0xcb1ab31fU;
    h ^= h >> 15U;
    h *= 0x2c1b3c6dU;
    return h ^ (h >> 13U);
}

glm::uvec3 placeInCell(const glm::vec3& p, float cells_per_unit, const glm::ivec3& cell) {
    // Each step rises with p, and a power of 2 scales without rounding: what lies between two points stays between them.
    return glm::uvec3(glm::clamp(256.0F * (p * cells_per_unit - glm::vec3(cell)), 0.0F, 255.0F));
}

BodyGrid BodyGrid::of(std::span<const BodyBox> boxes, float cell_size) {
    BodyGrid grid;
    for (const auto& [exponent, indices] : levelsOf(boxes, cell_size)) {
        Level level;
        level.first = static_cast<std::uint32_t>(grid.lists.size());
        const bool bounded = exponent != kUnbounded;
        level.cells_per_unit = bounded ? std::ldexp(1.0F, -exponent) : 0.0F;
        std::vector<Placed> placed;
        for (const std::uint32_t index : indices) {
            const BodyBox& box = boxes[index];
            const auto cellOf = [&](const glm::vec3& p) {
                return bounded ? glm::ivec3(glm::floor(p * level.cells_per_unit)) : glm::ivec3(0);
            };
            const glm::ivec3 low = cellOf(box.low);
            const glm::ivec3 high = cellOf(box.high);
            for (int z = low.z; z <= high.z; ++z) {
                for (int y = low.y; y <= high.y; ++y) {
                    for (int x = low.x; x <= high.x; ++x) {
                        const glm::ivec3 cell(x, y, z);
                        const auto place = [&](const glm::vec3& p) {
                            return packed(placeInCell(p, level.cells_per_unit, cell));
                        };
                        placed.push_back({0,
                                          {box.body, bounded ? place(box.low) : 0,
                                           bounded ? place(box.high) : 0xffffffU, cellHash(cell)}});
                    }
                }
            }
        }
        while (bounded && level.mask + 1 < kListsPerEntry * placed.size()) {
            level.mask = 2 * level.mask + 1;
        }
        for (Placed& one : placed) {
            one.list = one.entry.hash & level.mask;
        }
        std::stable_sort(placed.begin(), placed.end(),
                         [](const Placed& a, const Placed& b) { return a.list < b.list; });
        grid.lists.resize(level.first + level.mask + 1);
        for (std::size_t k = 0; k < placed.size();) {
            const std::uint32_t list = placed[k].list;
            List& range = grid.lists[level.first + list];
            range.first = static_cast<std::uint32_t>(grid.entries.size());
            for (; k < placed.size() && placed[k].list == list; ++k) {
                grid.entries.push_back(placed[k].entry);
            }
            range.end = static_cast<std::uint32_t>(grid.entries.size());
        }
        grid.levels.push_back(level);
    }
    return grid;
}

}  // namespace relief
