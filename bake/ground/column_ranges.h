// SPDX-License-Identifier: Apache-2.0
// The range of heights below each cell of a quadtree over the squares of a height map.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/ground/height_grid.h"

namespace relief {

/// Of the squares of a column that have ground.
struct ColumnRange {
    float low = 0.0F;  ///< heights, object units
    float high = 0.0F;
    bool ground = false;  ///< some square has any
    bool hole = false;    ///< some square has none, or lies beyond the grid
};

class ColumnRanges {
  public:
    /// \param levels  from columns of kLeafSquares on, each twice as wide as those before. The grid must outlive this.
    ColumnRanges(const HeightGrid& grid, unsigned levels);

    /// Columns along x or z of a level.
    [[nodiscard]] std::uint32_t width(unsigned level) const { return levels_[level].width; }
    [[nodiscard]] std::uint32_t depth(unsigned level) const { return levels_[level].depth; }
    /// \param x, z  any; beyond the grid there are holes.
    [[nodiscard]] ColumnRange at(unsigned level, std::uint32_t x, std::uint32_t z) const;
    /// Of side² squares from one on. \param side  below kLeafSquares.
    [[nodiscard]] ColumnRange ofSquares(std::size_t x, std::size_t z, std::uint32_t side) const;

  private:
    struct Level {
        std::uint32_t width = 0;
        std::uint32_t depth = 0;
        std::vector<ColumnRange> columns;
    };
    const HeightGrid& grid_;
    std::vector<Level> levels_;
};

}  // namespace relief
