// SPDX-License-Identifier: Apache-2.0
// Random draws against closed forms; the death queue and the index allocator against slow, simple containers.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "runtime/particles/death_queue.h"
#include "runtime/particles/emitter.h"
#include "runtime/particles/index_allocator.h"
#include "runtime/particles/random.h"
#include "tests/runtime/particles/statistics.h"

namespace relief::test {
namespace {

std::vector<std::uint32_t> pop(DeathQueue& queue, float now) {
    std::vector<std::uint32_t> dead;
    queue.popUntil(now, dead);
    std::sort(dead.begin(), dead.end());
    return dead;
}

struct Pace {
    const char* name;
    float dt_min, dt_max;  // seconds between steps
    float life_max;
};

class DeathQueueRun : public testing::TestWithParam<Pace> {};

// Fails if a day is skipped or opened a turn too early, or a block is lost or used twice.
TEST_P(DeathQueueRun, AgreesWithASortedReference) {
    const Pace& run = GetParam();
    DeathQueue queue;
    std::multimap<float, std::uint32_t> reference;
    Pcg32 random(5);
    float now = 0.0F;
    std::uint32_t next = 0;
    std::size_t died = 0;
    for (int step = 0; step < 4000; ++step) {
        // In waves, so that blocks are returned to the pool and reused.
        const std::uint32_t births = step / 500 % 2 == 0 ? random.below(40) : 0;
        for (std::uint32_t i = 0; i < births; ++i) {
            // Some are overdue, and many coincide.
            const float life = random.below(8) == 0 ? -1.0F : random.between(0.0F, run.life_max);
            const float time = random.below(3) == 0 ? now + 0.25F * run.life_max : now + life;
            queue.push(time, next);
            reference.emplace(time, next++);
        }
        now += random.between(run.dt_min, run.dt_max);
        std::vector<std::uint32_t> expected;
        while (!reference.empty() && reference.begin()->first <= now) {
            expected.push_back(reference.begin()->second);
            reference.erase(reference.begin());
        }
        std::sort(expected.begin(), expected.end());
        died += expected.size();
        ASSERT_EQ(pop(queue, now), expected) << "step " << step << " at " << now;
        ASSERT_EQ(queue.size(), reference.size());
        if (step % 700 == 699) {
            const float shift = 0.9F * now;
            std::multimap<float, std::uint32_t> shifted;
            for (const auto& [time, index] : reference) {
                shifted.emplace(time - shift, index);
            }
            reference = std::move(shifted);
            queue.rebase(shift);
            now -= shift;
        }
    }
    EXPECT_GT(died, 10'000U);
}

// Steps far shorter than a day, as long as several days, and longer than a whole turn of 64 s. Lifetimes within a day,
// a turn and several turns.
INSTANTIATE_TEST_SUITE_P(Paces, DeathQueueRun,
                         testing::Values(Pace{"Fine", 1e-5F, 2e-3F, 0.01F},
                                         Pace{"Usual", 1 / 60.0F, 1 / 60.0F, 3.0F},
                                         Pace{"Turns", 0.01F, 0.5F, 400.0F},
                                         Pace{"Coarse", 0.0F, 200.0F, 1000.0F}),
                         [](const auto& run) { return std::string(run.param.name); });

TEST(DeathQueue, DueTimesAreExact) {
    DeathQueue queue;
    const float due = 1.7F;
    queue.push(due, 7);
    EXPECT_TRUE(pop(queue, std::nextafter(due, 0.0F)).empty());
    EXPECT_EQ(pop(queue, due), std::vector<std::uint32_t>{7});
    EXPECT_TRUE(pop(queue, due).empty());
}

TEST(DeathQueue, EntriesThatAreNeverDueHideNoOthers) {
    DeathQueue queue;
    queue.push(std::numeric_limits<float>::quiet_NaN(), 1);
    queue.push(std::numeric_limits<float>::infinity(), 2);
    queue.push(3e38F, 3);
    queue.push(64.0F, 4);  // on the same day as the others
    queue.push(-5.0F, 5);
    queue.push(-std::numeric_limits<float>::infinity(), 6);
    EXPECT_EQ(pop(queue, 0.0F), (std::vector<std::uint32_t>{5, 6}));
    EXPECT_EQ(pop(queue, 70.0F), std::vector<std::uint32_t>{4});
    EXPECT_TRUE(pop(queue, 1e30F).empty());
    EXPECT_EQ(queue.size(), 3U);
}

class IndexAllocatorCapacity : public testing::TestWithParam<std::uint32_t> {};

// Fails on any wrong summary bit at any level: the capacities are just below, at and above a full word of each level of
// the tree.
TEST_P(IndexAllocatorCapacity, AgreesWithASet) {
    const std::uint32_t capacity = GetParam();
    IndexAllocator allocator(capacity);
    std::set<std::uint32_t> free;
    std::set<std::uint32_t> live;
    std::vector<std::uint32_t> live_list;
    for (std::uint32_t i = 0; i < capacity; ++i) {
        free.insert(i);
    }
    EXPECT_FALSE(allocator.release(0));
    Pcg32 random(capacity);
    for (int call = 0; call < 100'000; ++call) {
        // Fills and empties in waves, so that both extremes are reached.
        const bool fill = (call / 20'000) % 2 == 0;
        if (random.uniform() < (fill ? 0.7F : 0.3F)) {
            const auto index = allocator.acquire();
            ASSERT_EQ(index.has_value(), !free.empty());
            if (index) {
                ASSERT_EQ(*index, *free.begin());
                free.erase(free.begin());
                live.insert(*index);
                live_list.push_back(*index);
            }
        } else if (!live_list.empty()) {
            const std::size_t at = random.next() % live_list.size();
            const std::uint32_t index = live_list[at];
            live_list[at] = live_list.back();
            live_list.pop_back();
            ASSERT_TRUE(allocator.release(index));
            ASSERT_FALSE(allocator.release(index)) << "released twice";
            live.erase(index);
            free.insert(index);
        }
        ASSERT_EQ(allocator.liveCount(), live.size());
        ASSERT_EQ(allocator.extent(), live.empty() ? 0 : *live.rbegin() + 1);
    }
    for (std::uint32_t i = 0; i < capacity; ++i) {
        ASSERT_EQ(allocator.isLive(i), live.contains(i));
    }
}

INSTANTIATE_TEST_SUITE_P(Capacities, IndexAllocatorCapacity,
                         testing::Values(1U, 2U, 63U, 64U, 65U, 1000U, 4095U, 4096U, 4097U, 20'000U));

TEST(IndexAllocator, RejectsIndicesBeyondItsCapacity) {
    IndexAllocator allocator(64);
    EXPECT_FALSE(allocator.isLive(64));
    EXPECT_FALSE(allocator.release(64));
    EXPECT_FALSE(allocator.release(0xffffffffU));
    IndexAllocator none(0);
    EXPECT_EQ(none.acquire(), std::nullopt);
    EXPECT_EQ(none.extent(), 0U);
}

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
}  // namespace relief::test
