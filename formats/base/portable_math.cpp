// SPDX-License-Identifier: Apache-2.0
#include "formats/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace relief::portable {
namespace {

// Constants split into parts. The first parts have so few bits that their products with a small integer are exact.
constexpr double kLog2High = 0x1.62e42fee00000p-1;
constexpr double kLog2Low = 0x1.a39ef35793c76p-33;
constexpr double kHalfPi1 = 0x1.921fb54400000p+0;
constexpr double kHalfPi2 = 0x1.0b4611a600000p-34;
constexpr double kHalfPi3 = 0x1.3198a2e037073p-69;
constexpr double kPi = 0x1.921fb54442d18p+1;

/// Splits an angle into quarter turns and a remainder in [−π/4, π/4].
std::pair<std::int64_t, double> quarterTurns(double radians) {
    if (!(std::abs(radians) <= 1e15)) {
        return {0, std::numeric_limits<double>::quiet_NaN()};
    }
    const double turns = std::floor(radians * (2.0 / kPi) + 0.5);
    return {static_cast<std::int64_t>(turns),
            ((radians - turns * kHalfPi1) - turns * kHalfPi2) - turns * kHalfPi3};
}

/// Returns the sum of the Taylor terms after that of x^first, divided by that term, by Horner's scheme. The term of x^n
/// is −x²/(n(n − 1)) times the previous one.
double alternating(double x_squared, int first) {
    double sum = 0.0;
    for (int n = first + 18; n > first; n -= 2) {
        sum = -x_squared / static_cast<double>(n * (n - 1)) * (1.0 + sum);
    }
    return sum;
}

double sinNearZero(double x) {
    return x + x * alternating(x * x, 1);
}

double cosNearZero(double x) {
    return 1.0 + alternating(x * x, 0);
}

/// \param t  in [0, 1]
double atanOfRatio(double t) {
    // Halve the angle twice: tan(a/2) = tan a / (1 + √(1 + tan² a)).
    double tangent = t;
    for (int i = 0; i < 2; ++i) {
        tangent /= 1.0 + std::sqrt(1.0 + tangent * tangent);
    }
    const double square = tangent * tangent;
    double sum = 0.0;
    for (int n = 27; n >= 3; n -= 2) {
        sum = square * ((n % 4 == 3 ? -1.0 : 1.0) / static_cast<double>(n) + sum);
    }
    return 4.0 * (tangent + tangent * sum);
}

}  // namespace

double log(double x) {
    int exponent = 0;
    double m = std::frexp(x, &exponent);  // in [1/2, 1)
    if (m < 0x1.6a09e667f3bcdp-1) {
        m *= 2.0;
        --exponent;
    }
    // log m = 2 artanh s, |s| < 0.172
    const double s = (m - 1.0) / (m + 1.0);
    const double square = s * s;
    double sum = 0.0;
    for (int n = 23; n >= 3; n -= 2) {
        sum = square * (1.0 / static_cast<double>(n) + sum);
    }
    const double whole = static_cast<double>(exponent);
    return whole * kLog2High + (2.0 * s + (2.0 * s * sum + whole * kLog2Low));
}

double exp(double x) {
    const double bounded = std::clamp(x, -800.0, 800.0);
    const double whole = std::floor(bounded / (kLog2High + kLog2Low) + 0.5);
    const double rest = (bounded - whole * kLog2High) - whole * kLog2Low;
    double sum = 0.0;
    for (int n = 15; n >= 2; --n) {
        sum = rest / static_cast<double>(n) * (1.0 + sum);
    }
    return std::ldexp(1.0 + (rest + rest * sum), static_cast<int>(whole));
}

double pow(double x, double y) {
    return exp(y * log(x));
}

double sin(double radians) {
    const auto [quarters, rest] = quarterTurns(radians);
    const double value = quarters % 2 == 0 ? sinNearZero(rest) : cosNearZero(rest);
    return (quarters & 2) == 0 ? value : -value;
}

double cos(double radians) {
    const auto [quarters, rest] = quarterTurns(radians);
    const double value = quarters % 2 == 0 ? cosNearZero(rest) : sinNearZero(rest);
    return ((quarters + 1) & 2) == 0 ? value : -value;
}

double atan2(double y, double x) {
    const double height = std::abs(y);
    const double width = std::abs(x);
    if (height == 0.0 && width == 0.0) {
        return 0.0;
    }
    double angle = height <= width ? atanOfRatio(height / width) : 0.5 * kPi - atanOfRatio(width / height);
    if (x < 0.0) {
        angle = kPi - angle;
    }
    return y < 0.0 ? -angle : angle;
}

double acos(double x) {
    return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

}  // namespace relief::portable
