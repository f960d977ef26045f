// SPDX-License-Identifier: Apache-2.0
// The error that one more byte saves, as a function of the bytes of a mesh.
#pragma once

#include <limits>
#include <vector>

#include "bake/patches/patch_planner.h"

namespace relief {

/// The slope of the convex hull of an error curve, interpolated linearly between logarithms. The power law at the end
/// of the curve extends it.
class WorthCurve {
  public:
    /// \param curve  not empty. \param weight  factor on its errors, 0 or more.
    WorthCurve(const ErrorCurve& curve, double weight);

    /// Returns the bytes up to which each byte saves at least this much; they grow as the worth falls.
    /// \param log_worth  natural logarithm of the worth.
    [[nodiscard]] double bytesAt(double log_worth) const;

  private:
    struct Knot {
        double bytes = 0.0;  // natural logarithms
        double worth = 0.0;
    };
    void add(double bytes, double worth);

    std::vector<Knot> knots_;  // in descending order of worth
    double power_;             // errors are proportional to bytes^-power beyond the last knot
    double most_ = std::numeric_limits<double>::infinity();  // bytes; more bytes save nothing
};

}  // namespace relief
