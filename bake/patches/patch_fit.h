// The heights of one patch, fitted to the inside of its cell.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/patches/cell_columns.h"
#include "formats/patch_tree.h"

namespace relief {

struct FittedPatch {
    PatchHeights heights;
    double wrong = 0.0;  ///< volume on the wrong side, in cells
};

/// Fits patches of several sizes to the same columns.
class PatchFitter {
  public:
    /// \param columns  borrowed.
    explicit PatchFitter(const CellColumns& columns);

    [[nodiscard]] bool outsideBelow() const { return outside_below_; }
    /// \param side  2, 3 or 5 heights.
    /// \param rounds  of least squares, each with weights from the one before that turn it into least absolute error.
    [[nodiscard]] FittedPatch fit(std::uint32_t side, int rounds) const;
    /// The volume that is inside, and all, in cells.
    [[nodiscard]] double insideVolume() const { return inside_volume_; }
    [[nodiscard]] double volume() const { return volume_; }

  private:
    /// The best height of a column: any at least, or at most, as high will do where a column has no surface.
    enum class Bound : std::uint8_t { kExact, kAtLeast, kAtMost };
    struct Target {
        double height;
        Bound bound;
    };
    [[nodiscard]] Target targetOf(const CellColumn& column) const;

    const CellColumns& columns_;
    bool outside_below_ = false;
    std::vector<Target> targets_;
    double inside_volume_ = 0.0;
    double volume_ = 0.0;
};

}  // namespace relief
