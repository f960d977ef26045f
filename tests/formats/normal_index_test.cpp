// SPDX-License-Identifier: Apache-2.0
#include "formats/normal_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "tests/formats/analytic_shapes.h"

namespace relief {
namespace {

using test::angleInDegrees;

/// Equation 3 of the paper, written independently in double precision.
glm::dvec3 equation3(NormalIndex index) {
    const double s = (std::min<int>(index.s, 254) - 127) / 127.0;
    const double t = (std::min<int>(index.t, 254) - 127) / 127.0;
    const double z = 1.0 - std::abs(s) - std::abs(t);
    if (std::abs(s) + std::abs(t) <= 1.0) {
        return glm::normalize(glm::dvec3(s, t, z));
    }
    return glm::normalize(glm::dvec3((s >= 0 ? 1.0 : -1.0) * (1.0 - std::abs(t)),
                                     (t >= 0 ? 1.0 : -1.0) * (1.0 - std::abs(s)), z));
}

NormalIndex indexOf(unsigned packed) {
    return unpackNormal(static_cast<std::uint16_t>(packed));
}

TEST(NormalIndex, SixAxesAreExact) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : {1.0F, -1.0F}) {
            glm::vec3 n(0.0F);
            n[axis] = sign;
            EXPECT_EQ(decodeNormal(encodeNormal(n)), n) << "axis " << axis << " sign " << sign;
        }
    }
}

TEST(NormalIndex, EveryIndexMatchesEquation3AndRoundTrips) {
    for (unsigned packed = 0; packed < 65536; ++packed) {
        const glm::vec3 decoded = decodeNormal(indexOf(packed));
        ASSERT_NEAR(glm::length(glm::dvec3(decoded)), 1.0, 2e-7) << packed;
        ASSERT_LT(glm::length(glm::dvec3(decoded) - equation3(indexOf(packed))), 4e-7) << packed;
        ASSERT_EQ(decodeNormal(encodeNormal(decoded)), decoded) << packed;
    }
}

TEST(NormalIndex, LengthDoesNotMatter) {
    std::mt19937 random(3);
    std::normal_distribution<float> gauss;
    for (int i = 0; i < 10000; ++i) {
        const glm::vec3 n(gauss(random), gauss(random), gauss(random));
        const NormalIndex index = encodeNormal(n);
        // Scaling by a power of two preserves the direction exactly.
        ASSERT_EQ(encodeNormal(n * 0x1p-60F), index);
        ASSERT_EQ(encodeNormal(n * 0x1p+60F), index);
    }
}

TEST(NormalIndex, PackingKeepsBothBytes) {
    EXPECT_EQ(packNormal({0x12, 0x34}), 0x1234);
    EXPECT_EQ(unpackNormal(0x1234), (NormalIndex{0x12, 0x34}));
}

// Rounding each coordinate independently would be up to 0.95 degrees off.
TEST(NormalIndex, BestOfFourErrorIsBelow065Degrees) {
    std::mt19937_64 random(20240701);
    std::normal_distribution<double> gauss;
    double worst = 0.0;
    for (int i = 0; i < 400'000; ++i) {
        const glm::vec3 n(glm::normalize(glm::dvec3(gauss(random), gauss(random), gauss(random))));
        worst = std::max(worst, angleInDegrees(glm::dvec3(decodeNormal(encodeNormal(n))), glm::dvec3(n)));
    }
    EXPECT_LE(worst, 0.65);
    EXPECT_GT(worst, 0.55) << "too accurate: does this still test 8+8-bit indices?";
}

}  // namespace
}  // namespace relief
