// SPDX-License-Identifier: Apache-2.0
#include "bake/ground/column_ranges.h"

#include <algorithm>
#include <cmath>

#include "bake/mesh/loops.h"

namespace relief {
namespace {

ColumnRange ofSquare(const HeightGrid& grid, std::size_t x, std::size_t z) {
    if (x + 1 >= grid.columns || z + 1 >= grid.rows) {
        return {.hole = true};
    }
    const float a = grid.at(x, z);
    const float b = grid.at(x + 1, z);
    const float c = grid.at(x, z + 1);
    const float d = grid.at(x + 1, z + 1);
    if (std::isnan(a) || std::isnan(b) || std::isnan(c) || std::isnan(d)) {
        return {.hole = true};
    }
    return {std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d)), true, false};
}

std::uint32_t columnsFor(std::uint32_t samples, std::uint32_t squares) {
    return (samples - 1 + squares - 1) / squares;
}

}  // namespace

void add(ColumnRange& to, const ColumnRange& from) {
    if (from.ground) {
        to.low = to.ground ? std::min(to.low, from.low) : from.low;
        to.high = to.ground ? std::max(to.high, from.high) : from.high;
    }
    to.ground = to.ground || from.ground;
    to.hole = to.hole || from.hole;
}

ColumnRanges::ColumnRanges(const HeightGrid& grid, unsigned levels) : grid_(grid), levels_(levels) {
    for (unsigned i = 0; i < levels; ++i) {
        Level& level = levels_[i];
        level.width = columnsFor(grid.columns, kLeafSquares << i);
        level.depth = columnsFor(grid.rows, kLeafSquares << i);
        level.columns.resize(std::size_t{level.width} * level.depth);
        forEachIndex(0, level.depth, 1, [&](std::size_t z) {
            for (std::size_t x = 0; x < level.width; ++x) {
                ColumnRange& column = level.columns[z * level.width + x];
                for (std::uint32_t k = 0; i > 0 && k < 4; ++k) {
                    add(column, at(i - 1, static_cast<std::uint32_t>(2 * x + (k & 1U)),
                                   static_cast<std::uint32_t>(2 * z + (k >> 1U))));
                }
                if (i == 0) {
                    column = ofSquares(kLeafSquares * x, kLeafSquares * z, kLeafSquares);
                }
            }
        });
    }
}

ColumnRange ColumnRanges::at(unsigned level, std::uint32_t x, std::uint32_t z) const {
    const Level& from = levels_[level];
    return x < from.width && z < from.depth ? from.columns[std::size_t{z} * from.width + x]
                                            : ColumnRange{.hole = true};
}

ColumnRange ColumnRanges::ofSquares(std::size_t x, std::size_t z, std::uint32_t side) const {
    ColumnRange range;
    for (std::uint32_t j = 0; j < side; ++j) {
        for (std::uint32_t i = 0; i < side; ++i) {
            add(range, ofSquare(grid_, x + i, z + j));
        }
    }
    return range;
}

}  // namespace relief
