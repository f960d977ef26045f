// SPDX-License-Identifier: Apache-2.0
// Elementary functions whose results are bit-identical on every processor and compiler. Results of libm vary: glibc
// selects one of several variants of each function for the processor. The functions below use only operations that
// IEEE 754 rounds exactly: sums, products, quotients and square roots.
#pragma once

namespace relief::portable {

/// Computes the natural logarithm within 2 ULP. \param x  positive, finite and normal
[[nodiscard]] double log(double x);

/// Computes e^x within 2 ULP; 0 below −745, infinity above 710.
[[nodiscard]] double exp(double x);

/// Computes x^y to 13 digits if |y · log x| is at most 100. \param x  as for log()
[[nodiscard]] double pow(double x, double y);

/// Accurate to 1e-15. \param radians  at most 100,000 in magnitude
[[nodiscard]] double sin(double radians);
[[nodiscard]] double cos(double radians);

/// Accurate to 1e-15; returns radians in [−π, π]. atan2(0, 0) is 0, and negative zeros count as positive.
[[nodiscard]] double atan2(double y, double x);

/// Accurate to 1e-15; returns radians in [0, π]. \param x  in [−1, 1]
[[nodiscard]] double acos(double x);

}  // namespace relief::portable
