// SPDX-License-Identifier: Apache-2.0
// Stores the samples for building a ground tree, and a quadtree of height ranges over the squares between samples.
// A cell of the quadtree is called a column: it has the outline of a stack of cells of the ground tree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace relief {

/// Equally spaced rows of samples in ascending z, each in ascending x.
struct HeightGrid {
    std::uint32_t columns = 0;   ///< 2 or more
    std::uint32_t rows = 0;      ///< 2 or more
    std::vector<float> heights;  ///< columns · rows heights, object units; NaN is a hole

    [[nodiscard]] float at(std::size_t column, std::size_t row) const {
        return heights[row * columns + column];
    }
};

/// Squares along the side of a leaf.
inline constexpr std::uint32_t kLeafSquares = 4;

/// The height range of the squares with ground in a column.
struct ColumnRange {
    float low = 0.0F;  ///< heights, object units
    float high = 0.0F;
    bool ground = false;  ///< at least one square has ground
    bool hole = false;    ///< at least one square has no ground, or lies outside the grid
};

void add(ColumnRange& to, const ColumnRange& from);

class ColumnRanges {
  public:
    /// Computes the ranges of all levels.
    /// \param levels  number of levels. A column of level i is kLeafSquares · 2^i squares wide.
    /// \param grid    must outlive this object.
    ColumnRanges(const HeightGrid& grid, unsigned levels);

    /// Number of columns of a level: width() along x, depth() along z.
    [[nodiscard]] std::uint32_t width(unsigned level) const { return levels_[level].width; }
    [[nodiscard]] std::uint32_t depth(unsigned level) const { return levels_[level].depth; }
    /// Returns the range of a column; outside the grid, all squares are holes.
    [[nodiscard]] ColumnRange at(unsigned level, std::uint32_t x, std::uint32_t z) const;
    /// Returns the range of side² squares, starting at (x, z). \param side  at most kLeafSquares.
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
