// SPDX-License-Identifier: Apache-2.0
// Stores the samples from which a ground tree is built.
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

}  // namespace relief
