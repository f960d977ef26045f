// The heights of one patch, fitted to the inside of its cell.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "bake/patches/cell_columns.h"
#include "formats/patch_tree.h"

namespace relief {

struct FittedPatch {
    PatchHeights heights;
    double wrong = 0.0;  ///< volume on the wrong side, in cells, times its costs
};

/// Fits patches of several sizes to the same columns.
class PatchFitter {
  public:
    /// \param columns  borrowed.
    /// \param outside_below  by the columns where it is not given.
    PatchFitter(const CellColumns& columns, const MistakeCosts& costs,
                std::optional<bool> outside_below = {});

    [[nodiscard]] bool outsideBelow() const { return outside_below_; }
    /// \param side  2, 3 or 5 heights.
    /// \param rounds  of least squares, each with weights from the one before that turn it into least absolute error.
    [[nodiscard]] FittedPatch fit(std::uint32_t side, int rounds) const;
    /// The volume that is inside, and all, in cells.
    [[nodiscard]] double insideVolume() const { return inside_volume_; }
    [[nodiscard]] double volume() const { return volume_; }

  private:
    /// The best height of a line.
    struct Target {
        double height = 0.0;
        /// Costs of errors above and below it: none where a line has no surface, and any height at least, or at most, as high
        /// will do. None for lines that miss the cube.
        double above = 0.0;
        double below = 0.0;
        /// The length on the wrong side is the error, as far as that is in the cube.
        bool by_error = true;
    };
    [[nodiscard]] Target targetOf(const CellColumn& column) const;
    template <std::size_t kSide>
    [[nodiscard]] FittedPatch fitOf(int rounds) const;
    /// The volume on the wrong side among some heights.
    template <std::size_t kSide>
    [[nodiscard]] double wrongOf(const std::array<double, kSide * kSide>& heights) const;

    const CellColumns& columns_;
    MistakeCosts costs_;
    bool outside_below_ = false;
    std::vector<Target> targets_;
    double inside_volume_ = 0.0;
    double volume_ = 0.0;
};

}  // namespace relief
