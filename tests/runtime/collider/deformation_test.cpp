// Deformations on the CPU against closed forms, and the box of a whole motion; how maps are laid out to be
// drawn to.
#include "runtime/collider/deformation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "runtime/collider/map_layout.h"

namespace relief {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

void expectNear(const glm::vec3& a, const glm::vec3& b, float bound) {
    EXPECT_LE(glm::length(a - b), bound)
        << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

glm::vec3 at(const Deformation& deformation, double time, const glm::vec3& p, const glm::vec3& normal = {}) {
    return deform(deformation, momentOf(deformation, time), p, normal);
}

TEST(Deformation, ATwistTurnsMoreAndMore) {
    // A quarter turn at the top, at the time of the greatest amplitude.
    const Deformation twist{.kind = DeformKind::kTwist,
                            .amplitude = 0.5F * kPi,
                            .frequency = 2.0F,
                            .center = {1.0F, 0.0F, 0.0F},
                            .range_low = -1.0F,
                            .range_high = 1.0F};
    const double quarter = 0.125;
    expectNear(at(twist, quarter, {2.0F, 1.0F, 0.0F}), {1.0F, 1.0F, -1.0F}, 1e-6F);
    expectNear(at(twist, quarter, {2.0F, 5.0F, 0.0F}), {1.0F, 5.0F, -1.0F}, 1e-6F);  // beyond: no more
    expectNear(at(twist, quarter, {2.0F, -1.0F, 0.0F}), {2.0F, -1.0F, 0.0F}, 1e-6F);
    const float half = std::sqrt(0.5F);
    expectNear(at(twist, quarter, {2.0F, 0.0F, 0.0F}), {1.0F + half, 0.0F, -half}, 1e-6F);
    expectNear(at(twist, 0.0, {2.0F, 1.0F, 0.0F}), {2.0F, 1.0F, 0.0F}, 1e-6F);
    // The other way half a period later; the same after any number of them.
    expectNear(at(twist, quarter + 0.25, {2.0F, 1.0F, 0.0F}), {1.0F, 1.0F, 1.0F}, 1e-6F);
    expectNear(at(twist, quarter + 1e6, {2.0F, 1.0F, 0.0F}), {1.0F, 1.0F, -1.0F}, 1e-5F);
}

TEST(Deformation, ABendWindsABeamOnACircle) {
    // A beam along x, of length 1 from x = 0, on a quarter of a circle of radius 2/pi about an axis along z.
    const Deformation bend{.kind = DeformKind::kBend,
                           .amplitude = 0.5F * kPi,
                           .frequency = 1.0F,
                           .phase = 0.5F * kPi,
                           .axis = {0.0F, 0.0F, 1.0F},
                           .along = {1.0F, 0.0F, 0.0F}};
    const float radius = 2.0F / kPi;
    for (const float s : {0.0F, 0.25F, 0.5F, 1.0F}) {
        for (const float h : {0.0F, 0.1F, -0.2F}) {
            const float a = 0.5F * kPi * s;
            const glm::vec3 wanted((radius - h) * std::sin(a), radius - (radius - h) * std::cos(a), 0.7F);
            expectNear(at(bend, 0.0, {s, h, 0.7F}), wanted, 2e-6F);
        }
    }
    // Straight on both sides of the range.
    expectNear(at(bend, 0.0, {-3.0F, 0.1F, 0.0F}), {-3.0F, 0.1F, 0.0F}, 1e-6F);
    expectNear(at(bend, 0.0, {3.0F, 0.0F, 0.0F}), {radius, radius + 2.0F, 0.0F}, 2e-6F);
    // Lengths on the middle line stay, and hardly bent it is still exact.
    Deformation slight = bend;
    slight.amplitude = 1e-4F;
    expectNear(at(slight, 0.0, {1.0F, 0.0F, 0.0F}), {1.0F, 0.5e-4F, 0.0F}, 1e-7F);
}

TEST(Deformation, AWobbleGoesAlongTheNormal) {
    const Deformation wobble{
        .kind = DeformKind::kWobble, .amplitude = 0.3F, .frequency = 0.5F, .wavelength = 2.0F};
    const glm::vec3 p(0.3F, -0.7F, 1.9F);
    const glm::vec3 n = glm::normalize(glm::vec3(1.0F, 2.0F, -2.0F));
    for (const double t : {0.0, 0.37, 12.5}) {
        double sum = 0.0;
        const double rates[3] = {1.0, 1.25, 0.8};
        for (int k = 0; k < 3; ++k) {
            sum +=
                std::sin(2.0 * std::numbers::pi * (static_cast<double>(p[k]) / 2.0 - rates[k] * 0.5 * t) + k);
        }
        expectNear(at(wobble, t, p, n), p + static_cast<float>(0.1 * sum) * n, 1e-5F);
    }
}

TEST(Deformation, TheBoxHoldsTheWholeMotionAndIsNotMuchLarger) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> in(-1.0F, 1.0F);
    for (int i = 0; i < 40; ++i) {
        Deformation d;
        d.kind = static_cast<DeformKind>(i % 3);
        d.amplitude = d.kind == DeformKind::kWobble ? 0.3F : 6.0F * in(random);
        d.frequency = 1.7F;
        d.phase = in(random);
        d.center = {in(random), in(random), in(random)};
        d.axis = glm::normalize(glm::vec3(in(random), in(random), in(random)));
        d.along = glm::normalize(glm::cross(d.axis, glm::vec3(0.3F, -0.5F, 0.8F)));
        d.range_low = -0.6F;
        d.range_high = 0.8F;
        ASSERT_TRUE(checkDeformation(d));
        std::vector<glm::vec3> points;
        for (int k = 0; k < 200; ++k) {
            points.emplace_back(in(random), in(random), in(random));
        }
        const Bounds box = deformedBounds(d, points);
        Bounds seen;
        for (int step = 0; step < 600; ++step) {
            const DeformMoment moment = momentOf(d, step / 987.0);
            for (const glm::vec3& p : points) {
                const glm::vec3 n = glm::normalize(p);
                seen.add(deform(d, moment, p, n));
            }
        }
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(box.min[k], seen.min[k]) << i;
            EXPECT_GE(box.max[k], seen.max[k]) << i;
            // The wobble's worst case is that all three waves meet.
            EXPECT_GE(box.min[k], seen.min[k] - 0.15F * seen.longestSide()) << i;
            EXPECT_LE(box.max[k], seen.max[k] + 0.15F * seen.longestSide()) << i;
        }
    }
}

TEST(Deformation, WhatMakesNoSenseIsRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto refused = [](auto&& change, DeformKind kind) {
        Deformation d;
        d.kind = kind;
        EXPECT_TRUE(checkDeformation(d));
        change(d);
        const auto checked = checkDeformation(d);
        ASSERT_FALSE(checked);
        EXPECT_EQ(checked.error().code, ErrorCode::kUsage);
    };
    refused([&](Deformation& d) { d.amplitude = nan; }, DeformKind::kTwist);
    refused([&](Deformation& d) { d.amplitude = 7.0F; }, DeformKind::kTwist);
    refused([&](Deformation& d) { d.frequency = -1.0F; }, DeformKind::kWobble);
    refused([&](Deformation& d) { d.wavelength = 0.0F; }, DeformKind::kWobble);
    refused([&](Deformation& d) { d.axis = glm::vec3(0.0F); }, DeformKind::kTwist);
    refused([&](Deformation& d) { d.along = d.axis; }, DeformKind::kBend);
    refused([&](Deformation& d) { d.range_high = d.range_low; }, DeformKind::kBend);
}

TEST(TexelLayout, RectanglesLieApartBelowWhatIsPacked) {
    TexelLayout layout;
    layout.addPacked(1000);
    const int sizes[][2] = {{256, 256}, {100, 7}, {3, 512}, {256, 512}, {200, 30}, {64, 384}};
    for (const auto& size : sizes) {
        layout.addRectangle(size[0], size[1]);
    }
    ASSERT_TRUE(layout.finish(4096));
    EXPECT_EQ(layout.width(), 1024);  // 512 wide it would be higher
    EXPECT_LE(layout.height(), layout.width());
    std::vector<int> used(static_cast<std::size_t>(layout.width()) *
                          static_cast<std::size_t>(layout.height()));
    std::fill_n(used.begin(), 1000, 1);
    for (std::size_t i = 0; i < std::size(sizes); ++i) {
        const TexelRectangle r = layout.rectangle(i);
        EXPECT_EQ(r.width, sizes[i][0]);
        EXPECT_EQ(r.height, sizes[i][1]);
        ASSERT_LE(r.x + r.width, layout.width());
        ASSERT_LE(r.y + r.height, layout.height());
        for (int y = 0; y < r.height; ++y) {
            for (int x = 0; x < r.width; ++x) {
                const std::size_t at_texel =
                    layout.index(r) + static_cast<std::size_t>(y) * static_cast<std::size_t>(layout.width()) +
                    static_cast<std::size_t>(x);
                EXPECT_EQ(used[at_texel]++, 0);
            }
        }
    }
    EXPECT_FALSE(layout.finish(512));  // the narrowest that holds it is wider
    TexelLayout none;
    ASSERT_TRUE(none.finish(64));
    EXPECT_EQ(none.height(), 0);
}

}  // namespace
}  // namespace relief
