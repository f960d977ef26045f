// SPDX-License-Identifier: Apache-2.0
// The points that a check of ground measures, and the sums of their errors.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bake/measure/accuracy.h"

namespace relief {

enum class GroundSample : std::uint8_t { kNear, kSeam, kAnywhere };

/// Draws squares in ascending order, one from each of `samples` equal strata.
class GroundStrata {
  public:
    GroundStrata(std::uint64_t squares, std::uint64_t samples, std::uint64_t seed, GroundSample kind);
    /// Returns true if draws remain and the current draw lies in a square before `square`.
    [[nodiscard]] bool before(std::uint64_t square) const { return next_ < samples_ && square_ < square; }
    [[nodiscard]] std::uint64_t square() const { return square_; }
    /// The position of the current draw: x and z as fractions of the square, and height as a fraction of its range,
    /// each in [0, 1).
    [[nodiscard]] const std::array<double, 3>& place() const { return place_; }
    void advance();

  private:
    void draw();

    std::uint64_t squares_;
    std::uint64_t samples_;
    std::uint64_t seed_;
    GroundSample kind_;
    std::uint64_t next_ = 0;
    std::uint64_t square_ = 0;
    std::array<double, 3> place_{};
};

/// Points near the surface. Distances are along y, in metres, from the height map's surface to the collider's.
struct GroundNear {
    std::uint64_t points = 0;
    WrongPercent wrong;
    double mean = 0.0;  ///< positive upwards
    double mean_abs = 0.0;
    double p99 = 0.0;           ///< 99 % of the points have a smaller absolute distance
    double most = 0.0;          ///< largest absolute distance
    std::uint64_t missing = 0;  ///< points without a surface within range; excluded from distances
};

struct GroundOutcome {
    bool truth = false;
    bool inside = false;
    std::optional<double> error;
};

/// Sums over the points near the surface.
class GroundNearSums {
  public:
    void add(const GroundOutcome& outcome);
    [[nodiscard]] GroundNear result();

  private:
    GroundNear near_;
    std::uint64_t false_inside_ = 0;
    std::uint64_t false_outside_ = 0;
    double sum_ = 0.0;
    double sum_abs_ = 0.0;
    std::vector<float> distances_;
};

}  // namespace relief
