// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <algorithm>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "runtime/stream/stream_plan.h"
#include "runtime/stream/texel_ranges.h"

namespace relief::test {
namespace {

constexpr std::size_t kColliders = 40;

std::vector<StreamBody> randomBodies(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    const auto vec = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    std::vector<StreamBody> bodies;
    for (std::uint32_t i = 0; i < 300; ++i) {
        Bounds box;
        box.add(vec());
        box.add(vec());
        bodies.push_back(
            {static_cast<std::uint32_t>(random() % kColliders),
             box,
             {50.0F * vec(), glm::normalize(glm::quat(unit(random), vec())), 1.5F + unit(random)}});
    }
    return bodies;
}

/// The distance to a body from samples on all sides of its box: between the true distance and `step` more.
float sampledDistance(const StreamBody& body, const glm::vec3& point, int count) {
    float least = std::numeric_limits<float>::max();
    for (int x = 0; x <= count; ++x) {
        for (int y = 0; y <= count; ++y) {
            for (int z = 0; z <= count; ++z) {
                const glm::vec3 at =
                    body.box.min + glm::vec3(x, y, z) / static_cast<float>(count) * body.box.size();
                least = std::min(least, glm::distance(point, toWorld(body.pose, at)));
            }
        }
    }
    return least;
}

TEST(StreamPlan, RequestsBodiesInRangeNearestFirst) {
    std::mt19937 random(3);
    const std::vector<StreamBody> bodies = randomBodies(random);
    StreamPlan plan(bodies, kColliders);
    const std::vector<PointOfInterest> points = {{{10.0F, -5.0F, 0.0F}, 12.0F},
                                                 {{-30.0F, 0.0F, 20.0F}, 25.0F}};
    plan.measureAll(points);
    std::vector<float> nearest(kColliders, 1e9F);
    for (const StreamBody& body : bodies) {
        for (const PointOfInterest& point : points) {
            nearest[body.collider] =
                std::min(nearest[body.collider], sampledDistance(body, point.position, 12) / point.radius);
        }
    }
    constexpr float kSampled = 0.05F;  // above the sample step divided by a radius
    std::vector<bool> found(kColliders, false);
    float before = 0.0F;
    for (const std::uint32_t collider : plan.wanted()) {
        found[collider] = true;
        EXPECT_LT(nearest[collider], 1.0F + kSampled);
        EXPECT_GT(nearest[collider], before - kSampled);
        before = std::max(before, nearest[collider] - kSampled);
    }
    for (std::size_t i = 0; i < kColliders; ++i) {
        EXPECT_TRUE(found[i] || nearest[i] > 1.0F) << i;
    }
    EXPECT_GT(plan.wanted().size(), 5U);
    EXPECT_LT(plan.wanted().size(), kColliders);
}

TEST(StreamPlan, PartialUpdatesMatchAFullUpdate) {
    std::mt19937 random(4);
    const std::vector<StreamBody> bodies = randomBodies(random);
    StreamPlan whole(bodies, kColliders);
    StreamPlan parts(bodies, kColliders);
    const std::vector<PointOfInterest> points = {{{0.0F, 0.0F, 0.0F}, 20.0F}, {{-30.0F, 0.0F, 20.0F}, 5.0F}};
    const std::vector<PointOfInterest> later = {{{90.0F, 0.0F, 0.0F}, 20.0F}};
    whole.measureAll(points);
    ASSERT_FALSE(whole.wanted().empty());
    int looks = 1;
    bool fresh = parts.measureSome(points, 100);
    while (!fresh) {
        EXPECT_TRUE(parts.wanted().empty());
        fresh = parts.measureSome(later, 100);
        ++looks;
    }
    EXPECT_EQ(looks, 6) << "300 bodies, 50 at a time";
    EXPECT_TRUE(std::ranges::equal(parts.wanted(), whole.wanted()));
    while (!parts.measureSome(later, 100)) {
    }
    whole.measureAll(later);
    EXPECT_TRUE(std::ranges::equal(parts.wanted(), whole.wanted()));
    EXPECT_TRUE(parts.measureSome({}, 1'000'000));
    EXPECT_TRUE(parts.wanted().empty()) << "nothing is wanted without points";
}

/// Compared with an array of flags.
TEST(TexelRanges, AllocatesTheFirstFitAndMergesFreedRanges) {
    constexpr std::size_t kFirst = 1000;
    constexpr std::size_t kCount = 400;
    TexelRanges ranges(kFirst, kCount);
    std::vector<char> taken(kCount, 0);
    std::vector<std::pair<std::size_t, std::size_t>> held;
    std::mt19937 random(5);
    int refused = 0;
    for (int i = 0; i < 20'000; ++i) {
        if (random() % 2 == 0 && !held.empty()) {
            std::swap(held[random() % held.size()], held.back());
            const auto [first, count] = held.back();
            held.pop_back();
            ranges.give(first, count);
            std::fill_n(taken.begin() + static_cast<std::ptrdiff_t>(first - kFirst), count, 0);
        } else {
            const std::size_t count = 1 + random() % 80;
            const auto place = ranges.take(count);
            const auto gap =
                std::search_n(taken.begin(), taken.end(), static_cast<std::ptrdiff_t>(count), char{0});
            ASSERT_EQ(place.has_value(), gap != taken.end());
            if (place) {
                ASSERT_EQ(*place, kFirst + static_cast<std::size_t>(gap - taken.begin()));
                std::fill_n(gap, count, char{1});
                held.emplace_back(*place, count);
            }
            refused += place ? 0 : 1;
        }
        ASSERT_EQ(ranges.free(), static_cast<std::size_t>(std::count(taken.begin(), taken.end(), 0)));
    }
    EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace relief::test
