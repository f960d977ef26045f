// Height maps in closed form, and the exact surface of any.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bake/ground/ground_tree.h"

namespace relief::test {

/// \param height  of (column, row).
template <class Height>
HeightGrid gridOf(std::uint32_t columns, std::uint32_t rows, const Height& height) {
    HeightGrid grid{columns, rows, {}};
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            grid.heights.push_back(static_cast<float>(height(double(column), double(row))));
        }
    }
    return grid;
}

/// Hills of some tens of squares, up to 1.2 steep.
inline double hills(double x, double z) {
    return 8.0 * std::sin(x / 11.0) + 5.0 * std::cos(z / 7.0) + 0.7 * std::sin(x / 2.3 + z / 3.1);
}

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

/// The bilinear surface. \param x, z  squares from the first sample. \return nullopt beyond the grid and above holes.
inline std::optional<double> surfaceAt(const HeightGrid& grid, double x, double z) {
    if (!(x >= 0.0 && z >= 0.0 && x <= grid.columns - 1 && z <= grid.rows - 1)) {
        return std::nullopt;
    }
    const auto column = static_cast<std::size_t>(std::min(std::floor(x), grid.columns - 2.0));
    const auto row = static_cast<std::size_t>(std::min(std::floor(z), grid.rows - 2.0));
    const double s = x - double(column);
    const double t = z - double(row);
    const double lower = (1.0 - s) * grid.at(column, row) + s * grid.at(column + 1, row);
    const double upper = (1.0 - s) * grid.at(column, row + 1) + s * grid.at(column + 1, row + 1);
    const double height = (1.0 - t) * lower + t * upper;
    return std::isnan(height) ? std::nullopt : std::optional(height);
}

}  // namespace relief::test
