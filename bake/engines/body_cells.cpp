// SPDX-License-Identifier: Apache-2.0
#include "bake/engines/body_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "formats/base/portable_math.h"

namespace relief {
namespace {

constexpr std::uint32_t kCellsMax = 256;        // along an axis
constexpr std::size_t kEntriesPerBodyMax = 16;  // on average

struct Grid {
    std::array<double, 3> corner{};
    double edge = 1.0;
    std::array<std::uint32_t, 3> cells{1, 1, 1};

    [[nodiscard]] std::size_t count() const { return std::size_t{cells[0]} * cells[1] * cells[2]; }
    [[nodiscard]] std::uint32_t at(double x, std::size_t axis) const {
        const double cell = std::floor((x - corner[axis]) / edge);
        return static_cast<std::uint32_t>(std::clamp(cell, 0.0, static_cast<double>(cells[axis] - 1)));
    }
    /// Calls visit(index of the cell) for each cell within half an edge of a body's box. The margin also covers the
    /// rounding of shaders.
    template <class Visit>
    void cellsOf(const EngineBody& body, const Visit& visit) const {
        std::array<std::uint32_t, 3> first{};
        std::array<std::uint32_t, 3> last{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double margin = 0.50001 * edge + 4e-7 * std::abs(double{body.max_friction[i]});
            first[i] = at(double{body.min_restitution[i]} - margin, i);
            last[i] = at(double{body.max_friction[i]} + margin, i);
        }
        for (std::uint32_t z = first[2]; z <= last[2]; ++z) {
            for (std::uint32_t y = first[1]; y <= last[1]; ++y) {
                for (std::uint32_t x = first[0]; x <= last[0]; ++x) {
                    visit((std::size_t{z} * cells[1] + y) * cells[0] + x);
                }
            }
        }
    }
};

/// Returns the number of entries of all cells.
std::size_t entriesOf(const Grid& grid, std::span<const EngineBody> bodies) {
    std::size_t entries = 0;
    for (const EngineBody& body : bodies) {
        grid.cellsOf(body, [&](std::size_t) { ++entries; });
    }
    return entries;
}

/// Returns a grid with about one cell per body, or a coarser grid if it would have too many entries.
Grid gridOf(std::span<const EngineBody> bodies) {
    std::array<double, 3> low{};
    std::array<double, 3> high{};
    for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::numeric_limits<double>::infinity();
        high[i] = -low[i];
        for (const EngineBody& body : bodies) {
            low[i] = std::min(low[i], double{body.min_restitution[i]});
            high[i] = std::max(high[i], double{body.max_friction[i]});
        }
    }
    Grid grid;
    if (bodies.empty()) {
        return grid;
    }
    const double longest = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2], 1e-30});
    double volume = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        volume *= std::max(high[i] - low[i], longest / kCellsMax);
    }
    double edge = std::max(portable::pow(volume / static_cast<double>(bodies.size()), 1.0 / 3.0),
                           longest / (kCellsMax - 2));
    for (;; edge *= 2.0) {
        grid.edge = double{static_cast<float>(edge)};
        for (std::size_t i = 0; i < 3; ++i) {
            grid.cells[i] = static_cast<std::uint32_t>(
                std::clamp(std::ceil((high[i] - low[i]) / grid.edge + 1.0), 1.0, double{kCellsMax}));
            grid.corner[i] = double{static_cast<float>(low[i] - 0.5 * grid.edge)};
        }
        if (grid.count() <= 8 || entriesOf(grid, bodies) <= kEntriesPerBodyMax * bodies.size()) {
            return grid;
        }
    }
}

}  // namespace

std::vector<std::uint32_t> bodyCells(std::span<const EngineBody> bodies) {
    const Grid grid = gridOf(bodies);
    std::vector<std::vector<std::uint32_t>> lists(grid.count());
    for (std::uint32_t body = 0; body < bodies.size(); ++body) {
        grid.cellsOf(bodies[body], [&](std::size_t cell) { lists[cell].push_back(body); });
    }
    std::vector<std::uint32_t> words(grid.cells.begin(), grid.cells.end());
    words.push_back(0);
    for (const double corner : grid.corner) {
        words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(corner)));
    }
    words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(grid.edge)));
    std::uint32_t entries = 0;
    for (const auto& list : lists) {
        words.push_back(entries);
        entries += static_cast<std::uint32_t>(list.size());
    }
    words.push_back(entries);
    words[3] = entries;
    for (const auto& list : lists) {
        words.insert(words.end(), list.begin(), list.end());
    }
    return words;
}

}  // namespace relief
