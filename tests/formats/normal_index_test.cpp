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

/// Equation 3 of the paper, in double and in its own words.
glm::dvec3 equation3(double s, double t) {
    const double z = 1.0 - std::abs(s) - std::abs(t);
    if (std::abs(s) + std::abs(t) <= 1.0) {
        return glm::normalize(glm::dvec3(s, t, z));
    }
    return glm::normalize(glm::dvec3((s >= 0 ? 1.0 : -1.0) * (1.0 - std::abs(t)),
                                     (t >= 0 ? 1.0 : -1.0) * (1.0 - std::abs(s)), z));
}

glm::dvec3 equation3(NormalIndex index) {
    return equation3((std::min<int>(index.s, 254) - 127) / 127.0,
                     (std::min<int>(index.t, 254) - 127) / 127.0);
}

/// What an encoder that rounds each coordinate gives.
NormalIndex roundedIndex(const glm::dvec3& n) {
    const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    double s = n.x / sum;
    double t = n.y / sum;
    if (n.z < 0.0) {
        const double s0 = s;
        s = (s0 >= 0 ? 1.0 : -1.0) * (1.0 - std::abs(t));
        t = (t >= 0 ? 1.0 : -1.0) * (1.0 - std::abs(s0));
    }
    const auto code = [](double v) { return static_cast<std::uint8_t>(std::lround(v * 127.0 + 127.0)); };
    return {code(s), code(t)};
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

TEST(NormalIndex, KnownIndices) {
    EXPECT_EQ(decodeNormal({127, 127}), glm::vec3(0, 0, 1));
    EXPECT_EQ(decodeNormal({254, 127}), glm::vec3(1, 0, 0));
    EXPECT_EQ(decodeNormal({127, 0}), glm::vec3(0, -1, 0));
    for (const NormalIndex corner : {NormalIndex{0, 0}, {254, 0}, {0, 254}, {254, 254}}) {
        EXPECT_EQ(decodeNormal(corner), glm::vec3(0, 0, -1));
    }
    EXPECT_EQ(decodeNormal({255, 255}), decodeNormal({254, 254}));
    EXPECT_EQ(decodeNormal({255, 12}), decodeNormal({254, 12}));
}

TEST(NormalIndex, EveryIndexIsEquation3) {
    for (unsigned packed = 0; packed < 65536; ++packed) {
        const NormalIndex index = indexOf(packed);
        const glm::dvec3 decoded(decodeNormal(index));
        ASSERT_NEAR(glm::length(decoded), 1.0, 2e-7) << packed;
        ASSERT_LT(glm::length(decoded - equation3(index)), 4e-7) << packed;
    }
}

TEST(NormalIndex, EveryIndexEncodesToItsOwnVector) {
    for (unsigned packed = 0; packed < 65536; ++packed) {
        const glm::vec3 decoded = decodeNormal(indexOf(packed));
        ASSERT_EQ(decodeNormal(encodeNormal(decoded)), decoded) << packed;
    }
}

TEST(NormalIndex, LengthDoesNotMatter) {
    std::mt19937 random(3);
    std::normal_distribution<float> gauss;
    for (int i = 0; i < 10000; ++i) {
        const glm::vec3 n(gauss(random), gauss(random), gauss(random));
        const NormalIndex index = encodeNormal(n);
        // Powers of two: the same direction to the last bit.
        ASSERT_EQ(encodeNormal(n * 0x1p-60F), index);
        ASSERT_EQ(encodeNormal(n * 0x1p+60F), index);
    }
}

TEST(NormalIndex, PackingKeepsBothBytes) {
    EXPECT_EQ(packNormal({0x12, 0x34}), 0x1234);
    EXPECT_EQ(unpackNormal(0x1234), (NormalIndex{0x12, 0x34}));
}

TEST(NormalIndex, BestOfFourStaysBelow065DegreesWhereRoundingDoesNot) {
    std::mt19937_64 random(20240701);
    std::normal_distribution<double> gauss;
    double worst = 0.0;
    double worst_rounded = 0.0;
    for (int i = 0; i < 1'200'000; ++i) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(gauss(random), gauss(random), gauss(random)));
        const glm::vec3 single(n);
        worst = std::max(worst,
                         angleInDegrees(glm::dvec3(decodeNormal(encodeNormal(single))), glm::dvec3(single)));
        worst_rounded = std::max(worst_rounded, angleInDegrees(equation3(roundedIndex(n)), n));
    }
    EXPECT_LE(worst, 0.65);
    EXPECT_GT(worst, 0.55) << "suspiciously good: does the test still look at 8+8-bit indices?";
    EXPECT_GT(worst_rounded, 0.85);
    EXPECT_LT(worst_rounded, 0.96);
}

}  // namespace
}  // namespace relief
