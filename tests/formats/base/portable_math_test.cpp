// SPDX-License-Identifier: Apache-2.0
// Compares with libm in long double, and pins the exact bits, which must not depend on compiler or processor.
#include "formats/base/portable_math.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

namespace relief {
namespace {

constexpr int kSamples = 20'000;

/// Values between low and high that are not multiples of a round number.
double sample(double low, double high, int i) {
    return low + (high - low) * ((i + 0.318309886183790672) / kSamples);
}

void expectNear(const std::function<double(double)>& ours,
                const std::function<long double(long double)>& truth, double low, double high,
                double relative, double absolute) {
    double worst = 0.0;
    double worst_at = low;
    for (int i = 0; i < kSamples; ++i) {
        const double x = sample(low, high, i);
        const long double expected = truth(x);
        const double error = static_cast<double>(std::abs(static_cast<long double>(ours(x)) - expected));
        const double share = error / (absolute + relative * static_cast<double>(std::abs(expected)));
        if (!(share <= worst)) {
            worst = share;
            worst_at = x;
        }
    }
    EXPECT_LE(worst, 1.0) << "at " << worst_at;
}

constexpr double kTwoUlp = 2.0 * std::numeric_limits<double>::epsilon();

TEST(PortableMath, KeepsItsErrorBounds) {
    const auto log = [](long double x) { return std::log(x); };
    const auto exp = [](long double x) { return std::exp(x); };
    const auto sin = [](long double x) { return std::sin(x); };
    const auto cos = [](long double x) { return std::cos(x); };
    const auto acos = [](long double x) { return std::acos(x); };
    expectNear(portable::log, log, 1e-9, 2.0, kTwoUlp, 1e-18);
    expectNear(portable::log, log, 0.5, 1e6, kTwoUlp, 1e-18);
    expectNear(portable::log, log, 1e-300, 1e300, kTwoUlp, 1e-18);
    expectNear(portable::exp, exp, -1.0, 1.0, kTwoUlp, 0.0);
    expectNear(portable::exp, exp, -700.0, 700.0, kTwoUlp, 0.0);
    for (const double reach : {1.0, 10.0, 1e5}) {
        expectNear(portable::sin, sin, -reach, reach, 0.0, 1e-15);
        expectNear(portable::cos, cos, -reach, reach, 0.0, 1e-15);
    }
    expectNear(portable::acos, acos, -1.0, 1.0, 0.0, 1e-15);
    for (const double y : {-3.0, -1e-9, 1e-300, 0.5, 1e9}) {
        expectNear([&](double x) { return portable::atan2(y, x); },
                   [&](long double x) { return std::atan2(static_cast<long double>(y), x); }, -2.0, 2.0, 0.0,
                   1e-15);
    }
    expectNear([](double x) { return portable::pow(x, 1.0 / 2.4); },
               [](long double x) { return std::pow(x, static_cast<long double>(1.0 / 2.4)); }, 0.0031308, 1.0,
               1e-13, 0.0);
}

TEST(PortableMath, EndsAndCorners) {
    EXPECT_EQ(portable::log(1.0), 0.0);
    EXPECT_EQ(portable::exp(0.0), 1.0);
    EXPECT_EQ(portable::exp(-1e6), 0.0);
    EXPECT_EQ(portable::exp(1e6), std::numeric_limits<double>::infinity());
    EXPECT_EQ(portable::sin(0.0), 0.0);
    EXPECT_EQ(portable::cos(0.0), 1.0);
    EXPECT_EQ(portable::acos(1.0), 0.0);
    EXPECT_EQ(portable::atan2(0.0, 0.0), 0.0);
    EXPECT_EQ(portable::atan2(0.0, -1.0), 0x1.921fb54442d18p+1);
    EXPECT_EQ(portable::atan2(-1.0, 0.0), -0x1.921fb54442d18p+0);
    EXPECT_TRUE(std::isnan(portable::sin(std::numeric_limits<double>::quiet_NaN())));
    EXPECT_TRUE(std::isnan(portable::cos(std::numeric_limits<double>::infinity())));
}

/// A hash of the bits of many results.
std::uint64_t bitsOf(const std::function<double(double)>& f, double low, double high) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (int i = 0; i < kSamples; ++i) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(f(sample(low, high, i)))) * 0x100000001b3U;
    }
    return hash;
}

// Taken from GCC 12 on x86-64 with -O2. A difference means that a compiler or processor rounds differently:
// look for contraction, x87 or -ffast-math before changing a number here.
TEST(PortableMath, BitsArePortable) {
    EXPECT_EQ(bitsOf(portable::log, 1e-6, 1e6), 0xc2c47b6f2235efc6U);
    EXPECT_EQ(bitsOf(portable::exp, -700.0, 700.0), 0x988ac3a66f2401ccU);
    EXPECT_EQ(bitsOf(portable::sin, -1e5, 1e5), 0x1c92c31377f1482cU);
    EXPECT_EQ(bitsOf(portable::cos, -1e5, 1e5), 0xc20115627a45004fU);
    EXPECT_EQ(bitsOf(portable::acos, -1.0, 1.0), 0x7cde6f4da17904ffU);
}

}  // namespace
}  // namespace relief
