// SPDX-License-Identifier: Apache-2.0
// The errors of a mesh that a byte more mends, against the bytes that it has.
#pragma once

#include <limits>
#include <vector>

#include "bake/patches/patch_planner.h"

namespace relief {

/// The slope of the convex hull of a curve of errors, on straight lines of logarithms, and beyond its end of the power law
/// that it ends with.
class WorthCurve {
  public:
    /// \param curve  not empty. \param weight  of its errors, 0 or more.
    WorthCurve(const ErrorCurve& curve, double weight);

    /// The bytes up to which each mends at least so much; they grow where the worth falls.
    /// \param log_worth  natural logarithm.
    [[nodiscard]] double bytesAt(double log_worth) const;

  private:
    struct Knot {
        double bytes = 0.0;  // natural logarithms
        double worth = 0.0;
    };
    void add(double bytes, double worth);

    std::vector<Knot> knots_;                                // worth falls
    double power_;                                           // errors go by bytes^-power beyond the last
    double most_ = std::numeric_limits<double>::infinity();  // bytes; more mend nothing
};

}  // namespace relief
