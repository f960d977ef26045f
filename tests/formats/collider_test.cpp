// SPDX-License-Identifier: Apache-2.0
#include "formats/collider.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

#include "tests/formats/analytic_shapes.h"

namespace relief {
namespace {

/// A 3×3 float map over [−2, 2]³ that votes `distance` at the origin, or abstains.
DepthMap voter(std::optional<float> distance) {
    // z_scale 4 and z' = ½ at the origin: distance = 4 · (depth − ½).
    DepthMap map = test::emptyMap(test::centeredFrame({0, 0, 0}, glm::dmat3(1.0), {4, 4, 4}),
                                  MapFormat::kFloat32, Compare::kLess, 3, 3);
    if (distance == kFarOutside) {
        return map;
    }
    if (!distance) {
        map.empty_is_outside = false;
        return map;
    }
    // The normal identifies the voter.
    const glm::dvec3 normal = test::rotation({0, 0, 1}, *distance * 40.0)[0];
    encodeTexel(map.format, {Surface{*distance / 4.0F + 0.5F, glm::vec3(normal)}, std::nullopt},
                map.texelAt(0, 1, 1));
    return map;
}

using Votes = std::vector<std::optional<float>>;

Collider colliderOf(const Votes& votes) {
    Collider collider;
    for (const std::optional<float>& v : votes) {
        collider.maps.push_back(voter(v));
    }
    return collider;
}

const glm::vec3 kOrigin(0.0F);
constexpr float kFar = kFarOutside;

TEST(Rule2, OutsideWinsThenTheVoteNearestToZero) {
    const auto distance = [](const Votes& votes) { return evaluate(colliderOf(votes), kOrigin).distance; };
    EXPECT_EQ(distance({-1.0F, -0.25F, -0.5F}), -0.25F);
    EXPECT_EQ(distance({-1.0F, 1.5F, -0.5F}), 1.5F);
    EXPECT_EQ(distance({1.0F, 0.25F, -0.5F, 0.5F}), 0.25F);
    EXPECT_EQ(distance({-0.25F, kFar}), kFar);
    EXPECT_EQ(distance({kFar, 1.0F}), 1.0F);
    EXPECT_EQ(distance({std::nullopt, -1.0F}), -1.0F);
    EXPECT_EQ(distance({-1.0F, 0.0F}), 0.0F);
}

TEST(InsideBox, IsTheIntersectionOfEnclosingVolumes) {
    Collider collider = colliderOf({-1.0F, -1.0F, -1.0F});
    const auto place = [&](std::size_t map, const glm::dvec3& center, bool encloses) {
        const DepthMap placed = test::emptyMap(test::centeredFrame(center, glm::dmat3(1.0), {4, 4, 4}),
                                               MapFormat::kFloat32, Compare::kLess, 3, 3);
        collider.maps[map].object_to_map = placed.object_to_map;
        collider.maps[map].encloses = encloses;
        collider.maps[map].empty_is_outside = true;
    };
    place(0, {0, 0, 0}, true);
    place(1, {1, -1, 0}, true);
    place(2, {9, 9, 9}, false);
    const std::optional<Bounds> box = insideBox(collider);
    ASSERT_TRUE(box);
    EXPECT_EQ(box->min, glm::vec3(-1, -2, -2));
    EXPECT_EQ(box->max, glm::vec3(2, 1, 2));
    // The squares of these rows underflow in floats.
    for (DepthMap& map : collider.maps) {
        for (glm::vec4& row : map.object_to_map.row) {
            row = glm::vec4(1e-24F * glm::vec3(row), row.w);
        }
    }
    EXPECT_NEAR(insideBox(collider).value().max.x, 2e24, 1e19);
}

TEST(Rule2, OrderDoesNotMatter) {
    const Votes sets[] = {
        {-1.0F, -0.5F, -0.25F, -1.5F, std::nullopt, -0.75F},
        {-1.0F, 0.5F, -0.25F, 1.5F, std::nullopt, kFar},
        {0.0F, 0.5F, -0.25F, kFar, -1.0F, std::nullopt},
        {0.0F, -0.5F, -0.25F, -1.0F, std::nullopt, -1.5F},
        {kFar, -0.5F, std::nullopt, -0.25F, -1.0F, -1.5F},
        {0.25F, 0.5F, 0.75F, 1.0F, 1.5F, kFar},
    };
    for (const Votes& votes : sets) {
        const Collider first = colliderOf(votes);
        const FieldSample expected = evaluate(first, kOrigin);
        std::vector<std::size_t> order(votes.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        do {
            Collider shuffled;
            for (const std::size_t i : order) {
                shuffled.maps.push_back(first.maps[i]);
            }
            const FieldSample sample = evaluate(shuffled, kOrigin);
            ASSERT_EQ(sample.distance, expected.distance);
            ASSERT_EQ(sample.normal, expected.normal);
            ASSERT_EQ(order[static_cast<std::size_t>(sample.map)], static_cast<std::size_t>(expected.map));
        } while (std::next_permutation(order.begin(), order.end()));
    }
}

TEST(Rule2, NoVoteIsMapMinusOneAndOutside) {
    for (const Votes& votes : {Votes{}, Votes{std::nullopt}, Votes{std::nullopt, std::nullopt}}) {
        const FieldSample sample = evaluate(colliderOf(votes), kOrigin);
        EXPECT_EQ(sample.map, -1);
        EXPECT_FALSE(sample.inside());
        EXPECT_EQ(sample.normal, kOrigin);
    }
}

TEST(Rule2, FirstOfEqualVotesWins) {
    EXPECT_EQ(evaluate(colliderOf({std::nullopt, -0.5F, -0.5F}), kOrigin).map, 1);
    EXPECT_EQ(evaluate(colliderOf({-1.0F, 0.5F, 0.5F, kFar}), kOrigin).map, 1);
    EXPECT_EQ(evaluate(colliderOf({-1.0F, kFar, kFar}), kOrigin).map, 1);
    EXPECT_EQ(evaluate(colliderOf({0.0F, 0.0F}), kOrigin).map, 0);
}

TEST(Rule2, NormalComesFromTheDecidingMapAndIsZeroFarOutside) {
    EXPECT_EQ(evaluate(colliderOf({-0.5F, kFar}), kOrigin).normal, kOrigin);
    const Collider collider = colliderOf({-0.5F, 0.25F, kFar});
    const FieldSample sample = evaluate(collider, kOrigin);
    EXPECT_EQ(sample.map, 1);
    EXPECT_EQ(sample.normal, vote(collider.maps[1], kOrigin)->normal);
    EXPECT_FALSE(sample.inside());
    EXPECT_TRUE(evaluate(colliderOf({-0.5F}), kOrigin).inside());
}

/// `inside` agrees with evaluate(). Inside, so do normal and map. Outside, the map is the first that votes outside.
void expectInsideAgrees(const Collider& collider, const glm::vec3& p) {
    const FieldSample full = evaluate(collider, p);
    const InsideSample early = evaluateInside(collider, p);
    ASSERT_EQ(early.inside, full.inside());
    if (early.inside) {
        ASSERT_EQ(early.normal, full.normal);
        ASSERT_EQ(early.map, full.map);
        return;
    }
    ASSERT_EQ(early.normal, glm::vec3(0.0F));
    int first = -1;
    for (std::size_t i = collider.maps.size(); i-- > 0;) {
        const std::optional<Vote> v = vote(collider.maps[i], p);
        first = v && v->distance >= 0.0F ? static_cast<int>(i) : first;
    }
    ASSERT_EQ(early.map, first);
}

TEST(Inside, IsTheSignOfEvaluateForAnyVoteOrder) {
    Votes votes = {std::nullopt, -1.0F, -0.25F, 0.0F, 0.5F, kFar, std::nullopt, -0.25F};
    std::sort(votes.begin(), votes.end());
    do {
        expectInsideAgrees(colliderOf({votes.begin(), votes.begin() + 4}), kOrigin);
    } while (std::next_permutation(votes.begin(), votes.end()));
    expectInsideAgrees({}, kOrigin);
}

TEST(Inside, StopsAtTheFirstOutsideVote) {
    // The second map has no texels, so it must not be read.
    Collider collider = colliderOf({-0.5F, 0.25F, -0.5F});
    collider.maps[2].texels.clear();
    EXPECT_FALSE(evaluateInside(collider, kOrigin).inside);
}

}  // namespace
}  // namespace relief
