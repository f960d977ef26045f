// SPDX-License-Identifier: Apache-2.0
// Random draws against closed forms.
#include "runtime/particles/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/runtime/particles/statistics.h"

namespace relief {
namespace {

constexpr int kDraws = 100'000;

std::vector<double> values(std::uint64_t seed, const std::function<float(Pcg32&)>& draw) {
    Pcg32 random(seed);
    std::vector<double> out;
    for (int i = 0; i < kDraws; ++i) {
        out.push_back(static_cast<double>(draw(random)));
    }
    return out;
}

// The first outputs of O'Neill's pcg32_random_r demo program (seed 42, sequence 54).
TEST(Random, IsThePublishedGenerator) {
    Pcg32 random(42, 54);
    for (const std::uint32_t expected :
         {0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU, 0xcbed606eU}) {
        EXPECT_EQ(random.next(), expected);
    }
}

TEST(Random, BelowIsUniformAndInRange) {
    for (const std::uint32_t count : {1U, 2U, 7U, 1000U}) {
        Pcg32 random(count);
        std::vector<std::size_t> hits(count);
        for (int i = 0; i < kDraws; ++i) {
            const std::uint32_t at = random.below(count);
            ASSERT_LT(at, count);
            ++hits[at];
        }
        if (count > 1) {
            EXPECT_LT(test::chiSquare(hits, std::vector<double>(count, 1.0)), test::kChiSquareMax);
        }
    }
    // For a bound of 3/4 · 2^32, a product without rejection would draw every third number twice as often.
    Pcg32 random(9);
    int thirds = 0;
    for (int i = 0; i < kDraws; ++i) {
        thirds += random.below(0xC0000000U) % 3 == 0 ? 1 : 0;
    }
    EXPECT_NEAR(thirds, kDraws / 3.0, 5.0 * std::sqrt(kDraws * 2.0 / 9.0));
}

TEST(Random, SignedUniformIsOddAndNeverZero) {
    const auto draws = values(1, [](Pcg32& r) { return r.signedUniform(); });
    for (const double x : draws) {
        ASSERT_LT(std::abs(x), 1.0);
        ASSERT_NE(x, 0.0);
        ASSERT_EQ(std::fmod(std::abs(x) * 0x1p24, 2.0), 1.0);
    }
    EXPECT_LT(test::kolmogorov(draws, [](double x) { return 0.5 * (x + 1.0); }), test::kKolmogorovMax);
}

TEST(Random, ConeIsUniformInSolidAngle) {
    for (const double degrees : {0.5, 20.0, 90.0, 135.0, 180.0}) {
        SCOPED_TRACE(degrees);
        const double opening = oneMinusCosine(degrees);
        Pcg32 random(5);
        std::vector<double> down;
        std::vector<double> turns;
        for (int i = 0; i < kDraws; ++i) {
            const glm::dvec3 d(inCone(random, static_cast<float>(opening)));
            ASSERT_NEAR(glm::length(d), 1.0, 3e-7);
            // Computed from the radius if that is better conditioned.
            const double aside = std::hypot(d.x, d.y);
            down.push_back(degrees < 1.0 ? aside * aside / (1.0 + std::sqrt(1.0 - aside * aside))
                                         : 1.0 - d.z);
            turns.push_back(std::atan2(d.y, d.x));
        }
        EXPECT_LT(test::kolmogorov(down, [&](double x) { return x / opening; }), test::kKolmogorovMax);
        EXPECT_LT(test::kolmogorov(
                      turns, [](double a) { return (a + std::numbers::pi) / (2.0 * std::numbers::pi); }),
                  test::kKolmogorovMax);
    }
}

TEST(Random, OneMinusCosineMatchesLibm) {
    EXPECT_EQ(oneMinusCosine(0.0), 0.0);
    EXPECT_DOUBLE_EQ(oneMinusCosine(90.0), 1.0);
    EXPECT_DOUBLE_EQ(oneMinusCosine(180.0), 2.0);
    for (double degrees = 1e-6; degrees <= 180.0; degrees *= 1.7) {
        const double sine = std::sin(degrees * std::numbers::pi / 360.0);
        EXPECT_NEAR(oneMinusCosine(degrees) / (2.0 * sine * sine), 1.0, 1e-14) << degrees;
    }
}

TEST(Random, BasesAreRightHandedAndOrthonormal) {
    Pcg32 random(7);
    for (int i = 0; i < 1000; ++i) {
        glm::vec3 z = onUnitSphere(random);
        if (i < 6) {
            z = glm::vec3(0.0F);
            z[i / 2] = i % 2 == 0 ? 1.0F : -1.0F;
        }
        const Basis basis = basisAbout(z);
        ASSERT_LT(glm::length(glm::cross(basis.x, basis.y) - z), 1e-6F);
        ASSERT_EQ(basis.toWorld({0.0F, 0.0F, 1.0F}), z);
        ASSERT_NEAR(glm::length(basis.x), 1.0F, 1e-6F);
    }
}

TEST(Random, NormalizesVectorsOfAnyLength) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(unitVector({0.0F, -1e-40F, 0.0F}), glm::vec3(0.0F, -1.0F, 0.0F));
    EXPECT_EQ(unitVector({3e38F, 0.0F, 0.0F}), glm::vec3(1.0F, 0.0F, 0.0F));
    EXPECT_NEAR(unitVector({3e20F, 0.0F, -4e20F}).z, -0.8F, 1e-7F);
    for (const glm::vec3& none : {glm::vec3(0.0F), {1.0F, kInfinity, 0.0F}, {std::nanf(""), 1.0F, 0.0F}}) {
        EXPECT_EQ(unitVector(none), glm::vec3(0.0F));
    }
}

// Pins the bits: they must be the same on every machine, because seeded runs depend on them.
TEST(Random, BitsOfEveryDrawArePinned) {
    Pcg32 random(42, 54);
    float sum = 0.0F;
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 ball = inUnitBall(random);
        const glm::vec3 cone = inCone(random, static_cast<float>(oneMinusCosine(33.0)));
        sum += ball.x + 2.0F * ball.y + 4.0F * cone.x + 8.0F * cone.z + standardNormal(random);
        sum += static_cast<float>(random.below(1000)) * 0x1p-10F;
    }
    EXPECT_EQ(sum, 0x1.e5864ep+12F);
}

}  // namespace
}  // namespace relief
