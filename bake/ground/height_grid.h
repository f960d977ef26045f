// SPDX-License-Identifier: Apache-2.0
// The samples that a tree of ground is made from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace relief {

/// Rows of samples at equal distances, the first at the lowest z, each from the lowest x on.
struct HeightGrid {
    std::uint32_t columns = 0;   ///< 2 or more
    std::uint32_t rows = 0;      ///< 2 or more
    std::vector<float> heights;  ///< columns · rows, object units; NaN is a hole

    [[nodiscard]] float at(std::size_t column, std::size_t row) const {
        return heights[row * columns + column];
    }
};

/// Squares along the side of a leaf.
inline constexpr std::uint32_t kLeafSquares = 4;

}  // namespace relief
