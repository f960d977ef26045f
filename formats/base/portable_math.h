// SPDX-License-Identifier: Apache-2.0
// Elementary functions with the same bits on every processor and by every compiler. Those of libm vary: glibc
// has several of each, and takes the one that suits the processor. Here are sums, products, quotients and
// roots alone, which IEEE 754 rounds exactly.
#pragma once

namespace relief::portable {

/// Natural logarithm, within 2 units in the last place. \param x  positive, finite and normal
[[nodiscard]] double log(double x);

/// Within 2 units in the last place; 0 below −745, infinity above 710.
[[nodiscard]] double exp(double x);

/// x to the power of y, to 13 digits where y · log x is at most 100. \param x  as of log()
[[nodiscard]] double pow(double x, double y);

/// To 1e-15. \param radians  at most 100,000 in size
[[nodiscard]] double sin(double radians);
[[nodiscard]] double cos(double radians);

/// To 1e-15, radians in [−π, π]; atan2(0, 0) is 0. Zeros count as positive.
[[nodiscard]] double atan2(double y, double x);

/// To 1e-15, radians in [0, π]. \param x  in [−1, 1]
[[nodiscard]] double acos(double x);

}  // namespace relief::portable
