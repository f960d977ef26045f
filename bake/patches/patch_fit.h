// SPDX-License-Identifier: Apache-2.0
// Fits the heights of a patch or pair to the inside of the mesh in one cell.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "bake/patches/cell_columns.h"
#include "formats/patch_tree.h"

namespace relief {

/// The best height on one line of a LineGrid.
struct HeightTarget {
    double height = 0.0;
    /// Costs of errors above and below the height. If the line enters or leaves the cell at this height, one cost is
    /// zero, because all greater or all smaller heights are equally good. Both are zero if the line misses the cell.
    double above = 0.0;
    double below = 0.0;
};

/// A HeightTarget for each line, stored as one array per member.
class HeightTargets {
  public:
    /// Sets all costs to zero, as for lines that miss the cell.
    explicit HeightTargets(std::size_t lines) : lines_(lines), numbers_(3 * lines) {}
    void set(std::size_t line, const HeightTarget& target) {
        *height(line) = static_cast<float>(target.height);
        *above(line) = static_cast<float>(target.above);
        *below(line) = static_cast<float>(target.below);
    }
    [[nodiscard]] float* height(std::size_t line) { return &numbers_[line]; }
    [[nodiscard]] float* above(std::size_t line) { return &numbers_[lines_ + line]; }
    [[nodiscard]] float* below(std::size_t line) { return &numbers_[2 * lines_ + line]; }
    [[nodiscard]] const float* height(std::size_t line) const { return &numbers_[line]; }
    [[nodiscard]] const float* above(std::size_t line) const { return &numbers_[lines_ + line]; }
    [[nodiscard]] const float* below(std::size_t line) const { return &numbers_[2 * lines_ + line]; }

  private:
    std::size_t lines_;
    std::vector<float> numbers_;
};

struct FittedPatch {
    PatchHeights heights;
    double wrong = 0.0;  ///< misclassified volume, in cells, weighted by ErrorCosts
};

/// Two surfaces, the lower one first.
struct FittedPair {
    std::array<PatchHeights, 2> heights;
    double wrong = 0.0;  ///< as FittedPatch::wrong
};

/// Fits two surfaces to columns: a wall, with the inside between them, or a gap, with the outside between them.
class PairFitter {
  public:
    /// \param columns  borrowed.
    /// \param normal  of the planes that provide heights where no line meets the surface.
    /// \param walls  true: fits a wall; false: a gap; nullopt: the one with the lower least().
    PairFitter(const CellColumns& columns, const ErrorCosts& costs, const glm::dvec3& normal,
               std::optional<bool> walls = {});

    [[nodiscard]] bool walls() const { return walls_; }
    /// A lower bound of FittedPair::wrong for any pair.
    [[nodiscard]] double least() const { return least_; }
    /// Like PatchFitter::fit.
    [[nodiscard]] FittedPair fit(std::uint32_t side, int rounds) const;

  private:
    template <std::size_t kSide>
    [[nodiscard]] std::array<double, kSide * kSide> anchorsOf(std::size_t surface) const;
    template <std::size_t kSide>
    [[nodiscard]] FittedPair fitOf(int rounds) const;

    const CellColumns& columns_;
    ErrorCosts costs_;  // false_inside applies to volume that is wrongly between the surfaces
    glm::dvec3 normal_;
    bool walls_ = true;
    double least_ = 0.0;
    std::array<HeightTargets, 2> targets_;
    std::vector<std::uint32_t> without_;  // lines with nothing between the surfaces
};

/// Fits patches of several sizes to the same columns.
class PatchFitter {
  public:
    /// \param columns  borrowed.
    /// \param mean  the plane that provides heights where no line meets the surface.
    /// \param outside_below  whether the outside is below the patch; nullopt: derived from the columns.
    PatchFitter(const CellColumns& columns, const ErrorCosts& costs, const CellPlane& mean,
                std::optional<bool> outside_below = {});

    [[nodiscard]] bool outsideBelow() const { return outside_below_; }
    /// \param side  2, 3 or 5 heights.
    /// \param rounds  of iteratively reweighted least squares, which approximates the least absolute error.
    [[nodiscard]] FittedPatch fit(std::uint32_t side, int rounds) const;
    /// The volume that is inside, in cells.
    [[nodiscard]] double insideVolume() const { return inside_volume_; }

  private:
    /// \param by_error  set to false if the misclassified length may differ from |height − target| within the cell.
    [[nodiscard]] HeightTarget targetOf(const CellColumn& column, bool& by_error) const;
    template <std::size_t kSide>
    [[nodiscard]] FittedPatch fitOf(int rounds) const;
    /// The misclassified volume for given heights.
    template <std::size_t kSide>
    [[nodiscard]] double wrongOf(const std::array<double, kSide * kSide>& heights) const;
    /// Sets the targets of lines whose CellColumn::turns is empty.
    void setTargetsWithoutTurns();

    const CellColumns& columns_;
    ErrorCosts costs_;
    CellPlane mean_;
    bool outside_below_ = false;
    HeightTargets targets_;
    std::vector<float> by_error_;  // per line: 0 if in not_by_error_, else 1; empty if not_by_error_ is empty
    std::vector<std::uint32_t> not_by_error_;  // lines for which targetOf() clears by_error
    double inside_volume_ = 0.0;
};

}  // namespace relief
