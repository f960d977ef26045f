// SPDX-License-Identifier: Apache-2.0
// Compares the death queue with a sorted multimap, which is slow but simple.
#include "runtime/particles/death_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "runtime/particles/random.h"

namespace relief {
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

}  // namespace
}  // namespace relief
