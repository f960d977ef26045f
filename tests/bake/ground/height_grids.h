// SPDX-License-Identifier: Apache-2.0
// Height maps in closed form, and the exact surface of any height map.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bake/ground/ground_bake.h"
#include "bake/ground/ground_tree.h"
#include "formats/base/file_io.h"
#include "formats/container.h"
#include "formats/world/world_field.h"
#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief::test {

/// \param height  function of (column, row)
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

/// Hills tens of squares long, with slopes up to 1.2.
inline double hills(double x, double z) {
    return 8.0 * std::sin(x / 11.0) + 5.0 * std::cos(z / 7.0) + 0.7 * std::sin(x / 2.3 + z / 3.1);
}

/// Heights of the lowest and the highest 16-bit sample.
constexpr double kLow = -20.0;
constexpr double kHigh = 44.0;

/// A folder of 16-bit raw height maps.
class RawHeights : public testing::Test {
  protected:
    /// \param height  function of (column, row); NaN marks a hole, written as sample 0. \return the heights after
    /// quantization
    template <class Height>
    HeightGrid write(const char* name, std::uint32_t columns, std::uint32_t rows,
                     const Height& height) const {
        std::vector<std::uint16_t> samples;
        HeightGrid grid = gridOf(columns, rows, [&](double x, double z) {
            const double h = height(x, z);
            samples.push_back(std::isnan(h) ? std::uint16_t{0}
                                            : static_cast<std::uint16_t>(
                                                  std::lround((h - kLow) / (kHigh - kLow) * 65535.0)));
            return kLow + (kHigh - kLow) / 65535.0 * samples.back();
        });
        EXPECT_TRUE(writeFile(folder_.path() / name, std::as_bytes(std::span(samples))));
        return grid;
    }
    static HeightsSpec spec(const std::string& more) {
        return parseHeightsSpec("low=-20,high=44" + (more.empty() ? "" : "," + more)).value();
    }
    [[nodiscard]] Result<GroundResult> tryBake(const char* name, const HeightsSpec& heights,
                                               const std::filesystem::path& into) const {
        HeightMap map = required(HeightMap::open(folder_.path() / name, heights));
        GroundOptions options;
        options.heights = heights;
        options.folder = into;
        return bakeHeightMap(map, options);
    }
    /// \param into  folder of a world; if empty, bakes one container
    [[nodiscard]] GroundResult bake(const char* name, const HeightsSpec& heights,
                                    const std::filesystem::path& into = {}) const {
        return required(tryBake(name, heights, into));
    }
    [[nodiscard]] std::filesystem::path world() const {
        std::filesystem::create_directories(folder_.path() / "world");
        return folder_.path() / "world";
    }
    [[nodiscard]] WorldField load(WorldDetail detail = WorldDetail::kFine) const {
        return WorldField(required(loadWorld(world() / kWorldFileName, {}, detail)));
    }

    TemporaryFolder folder_;
};

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

/// The bilinear surface. \param x, z  in squares from the first sample. \return nullopt outside the grid and at holes
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
