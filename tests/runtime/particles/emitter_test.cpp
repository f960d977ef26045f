// SPDX-License-Identifier: Apache-2.0
// Position, direction, speed and time of births, against closed forms for fixed seeds.
#include "runtime/particles/emitter.h"
#include "runtime/births/emitter_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>
#include <optional>

#include "tests/results.h"
#include "tests/runtime/particles/statistics.h"

namespace relief {
namespace {

constexpr int kCount = 30'000;
constexpr double kDegree = 3.14159265358979323846 / 180.0;

std::vector<Birth> burstOf(EmitterSettings settings, std::uint64_t count, std::uint64_t seed = 1,
                           std::uint64_t stream = 0) {
    settings.burst = count;
    settings.rate = 0.0;
    EXPECT_TRUE(Emitter::check(settings));
    Emitter emitter(settings, seed, stream);
    std::vector<Birth> births;
    EXPECT_EQ(emitter.emit(0.01, count, births), 0U);
    EXPECT_EQ(births.size(), count);
    return births;
}

double lengthOf(const glm::vec3& v) {
    return glm::length(glm::dvec3(v));
}
double dotOf(const glm::vec3& a, const glm::vec3& b) {
    return static_cast<double>(glm::dot(a, b));
}

EmitterSettings snow() {
    EmitterSettings settings;
    settings.box_min = {-1.0F, 2.0F, 5.0F};
    settings.box_max = {3.0F, 2.5F, 5.0F};  // flat along z
    settings.velocity = {0.0F, -2.0F, 1.0F};
    settings.velocity_spread = {0.5F, 0.0F, 2.0F};
    settings.lifetime_min = 3.0F;
    settings.lifetime_max = 7.0F;
    settings.type = 5;
    return settings;
}

EmitterSettings round(EmitterShape shape) {
    EmitterSettings settings;
    settings.shape = shape;
    settings.center = {3.0F, -1.0F, 2.0F};
    settings.radius = 0.5F;
    settings.normal = {0.0F, 6.0F, 8.0F};
    return settings;
}

EmitterSettings aimed(const EmitterAim& aim) {
    EmitterSettings settings;
    settings.velocity = glm::vec3(0.0F);
    settings.aim = aim;
    return settings;
}

TEST(Emitter, DrawsMatchTheirDistributions) {
    using Value = std::function<double(const Birth&)>;
    using Cdf = std::function<double(double)>;
    const auto uniform = [](double low, double high) -> Cdf {
        return [=](double x) { return std::clamp((x - low) / (high - low), 0.0, 1.0); };
    };
    const glm::vec3 center = round(EmitterShape::kSphere).center;
    const Value radius = [=](const Birth& b) { return lengthOf(b.position - center) / 0.5; };
    const auto place = [=](int axis) -> Value {
        return [=](const Birth& b) { return static_cast<double>(b.position[axis]); };
    };
    const auto velocity = [](int axis) -> Value {
        return [=](const Birth& b) { return static_cast<double>(b.velocity[axis]); };
    };
    const auto phi = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
    const glm::vec3 up(0.0F, 1.0F, 0.0F);
    const EmitterAim cone{glm::vec3(3.0F, 0.0F, -4.0F), 25.0F, 2.0F, 2.0F, 0.0F};
    struct Case {
        const char* name;
        EmitterSettings settings;
        Value value;
        Cdf cdf;
    };
    const Case cases[] = {
        {"box x", snow(), place(0), uniform(-1.0, 3.0)},
        {"box y", snow(), place(1), uniform(2.0, 2.5)},
        {"velocity x", snow(), velocity(0), uniform(-0.5, 0.5)},
        {"velocity z", snow(), velocity(2), uniform(-1.0, 3.0)},
        {"lifetime", snow(), [](const Birth& b) { return static_cast<double>(b.lifetime); },
         uniform(3.0, 7.0)},
        {"sphere", round(EmitterShape::kSphere), radius, [](double r) { return r * r * r; }},
        // The fraction of the ball below a plane.
        {"sphere y", round(EmitterShape::kSphere), place(1),
         [](double y) {
             const double h = 2.0 * (y + 1.0);
             return (2.0 + 3.0 * h - h * h * h) / 4.0;
         }},
        {"shell", round(EmitterShape::kShell), place(1), uniform(-1.5, -0.5)},
        {"disc", round(EmitterShape::kDisc), radius, [](double r) { return r * r; }},
        {"cone", aimed(cone),
         [](const Birth& b) {
             return dotOf(b.velocity, {0.6F, 0.0F, -0.8F}) / 2.0;
         },
         uniform(std::cos(25.0 * kDegree), 1.0)},
        {"speed", aimed({up, 0.0F, 1.0F, 3.0F, 0.0F}), velocity(1), uniform(1.0, 3.0)},
        {"normal speed, cut at 0", aimed({up, 0.0F, 1.0F, 1.0F, 2.0F}), velocity(1),
         [=](double v) { return std::max(phi((v - 1.0) / 2.0) - phi(-0.5), 0.0) / (1.0 - phi(-0.5)); }}};
    for (const auto& [name, settings, value, cdf] : cases) {
        std::vector<double> draws;
        for (const Birth& birth : burstOf(settings, kCount)) {
            draws.push_back(value(birth));
        }
        EXPECT_LT(test::kolmogorov(std::move(draws), cdf), test::kKolmogorovMax) << name;
    }
    for (const Birth& birth : burstOf(snow(), 100)) {
        EXPECT_EQ(birth.position.z, 5.0F);
        EXPECT_EQ(birth.velocity.y, -2.0F);
        EXPECT_EQ(birth.type, 5U);
    }
    for (const Birth& birth : burstOf(round(EmitterShape::kShell), 100)) {
        EXPECT_NEAR(radius(birth), 1.0, 2e-6);
    }
    double sum = 0.0;
    for (const Birth& birth : burstOf(round(EmitterShape::kDisc), kCount)) {
        ASSERT_NEAR(dotOf(birth.position - center, {0.0F, 0.6F, 0.8F}), 0.0, 1e-6);
        sum += static_cast<double>(birth.position.x - center.x);
    }
    // A coordinate has mean 0 and variance r²/4.
    EXPECT_NEAR(sum / kCount, 0.0, 5.0 * 0.25 / std::sqrt(kCount));
    for (const Birth& birth : burstOf(aimed(cone), 100)) {
        EXPECT_NEAR(lengthOf(birth.velocity), 2.0, 1e-5);
    }
}

TEST(Emitter, PointsAreChosenUniformlyWithTheirNormals) {
    EmitterSettings settings = aimed({std::nullopt, 0.0F, 2.0F, 2.0F, 0.0F});
    settings.shape = EmitterShape::kPoints;
    constexpr std::size_t kPoints = 50;
    for (std::size_t i = 0; i < kPoints; ++i) {
        settings.points.positions.emplace_back(static_cast<float>(i), 0.0F, 1.0F);
        settings.points.normals.push_back(i % 2 == 0 ? glm::vec3(0.0F, 1.0F, 0.0F)
                                                     : glm::vec3(0.0F, 0.0F, -1.0F));
    }
    std::vector<std::size_t> hits(kPoints);
    for (const Birth& birth : burstOf(settings, kCount)) {
        const auto i = static_cast<std::size_t>(birth.position.x);
        ++hits.at(i);
        ASSERT_EQ(birth.position, settings.points.positions[i]);
        ASSERT_EQ(birth.velocity, 2.0F * settings.points.normals[i]);
    }
    EXPECT_LT(test::chiSquare(hits, std::vector<double>(kPoints, 1.0)), test::kChiSquareMax);
}

// Without a direction the cone's axis is the surface normal.
TEST(Emitter, AimDefaultsToTheNormal) {
    for (const EmitterShape shape : {EmitterShape::kSphere, EmitterShape::kShell, EmitterShape::kDisc}) {
        EmitterSettings settings = round(shape);
        settings.normal = {0.0F, 0.0F, -2.0F};
        settings.aim = EmitterAim{std::nullopt, 10.0F, 1.0F, 1.0F, 0.0F};
        const double least = std::cos(10.0 * kDegree) - 1e-5;
        double mean = 0.0;
        for (const Birth& birth : burstOf(settings, 1000)) {
            const glm::vec3 normal = shape == EmitterShape::kDisc
                                         ? glm::vec3(0.0F, 0.0F, -1.0F)
                                         : unitVector(birth.position - settings.center);
            ASSERT_GE(dotOf(birth.velocity, normal), least);
            mean += dotOf(birth.velocity, normal) / 1000.0;
        }
        EXPECT_LT(mean, 0.5 * (1.0 + least) + 0.002);  // and fills the cone
    }
}

TEST(Emitter, OneSeedGivesIndependentEmitters) {
    EmitterSettings settings;
    settings.box_max = glm::vec3(1.0F);
    const auto a = burstOf(settings, kCount, 1, 0);
    const auto b = burstOf(settings, kCount, 1, 1);
    double product = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        product += static_cast<double>((a[i].position.x - 0.5F) * (b[i].position.x - 0.5F));
    }
    EXPECT_NEAR(product / kCount, 0.0, 5.0 / 12.0 / std::sqrt(kCount));
}

// Pins the bits: a change of generator, order or arithmetic would change every seeded run.
TEST(Emitter, FirstBirthIsPinned) {
    Pcg32 random(1);
    const float x = static_cast<float>(random.next() >> 8) * 0x1p-24F;
    EXPECT_EQ(burstOf(snow(), 1).at(0).position.x, (1.0F - x) * -1.0F + x * 3.0F);
}

/// A fountain with all settings: bursts between and at births by rate.
EmitterSettings fountain() {
    EmitterSettings settings = round(EmitterShape::kSphere);
    settings.start = 0.5;
    settings.rate = 1000.0;
    settings.duration = 2.25;
    settings.burst = 70;
    settings.burst_every = 0.375;
    settings.aim = EmitterAim{glm::vec3(0.0F, 1.0F, 0.0F), 30.0F, 1.0F, 2.0F, 0.3F};
    settings.lifetime_max = 2.0F;
    return settings;
}

TEST(Emitter, CountsMatchTheClosedForm) {
    for (const int rate : {16, 60}) {  // steps per second; sixty also give exactly one second's births
        Emitter emitter(fountain(), 1);
        std::vector<Birth> births;
        for (int step = 1; step <= 4 * rate; ++step) {
            emitter.emit(1.0 / rate, 1'000'000, births);
            const double s = std::min(static_cast<double>(step) / rate - 0.5, 2.25);
            if (rate == 60 && step % 30 != 0) {
                continue;
            }
            // Six bursts, at 0 … 1.875; the one at 2.25 would start at the end of the duration.
            const double bursts = s < 0.0 ? 0.0 : std::min(std::floor(s / 0.375) + 1.0, 6.0);
            ASSERT_EQ(births.size(),
                      static_cast<std::size_t>(70.0 * bursts + std::floor(1000.0 * std::max(s, 0.0))))
                << rate << " " << step;
        }
    }
}

TEST(Emitter, BirthsDoNotDependOnTheStep) {
    std::vector<std::vector<Birth>> runs;
    for (const int cuts : {1, 2, 7, 60, 1000}) {
        Emitter emitter(fountain(), 3);
        std::vector<Birth>& births = runs.emplace_back();
        for (int i = 0; i < 4 * cuts; ++i) {
            ASSERT_EQ(emitter.emit(1.0 / cuts, 1'000'000, births), 0U);
        }
    }
    for (const std::vector<Birth>& births : runs) {
        ASSERT_EQ(births.size(), 6U * 70U + 2250U);
        for (std::size_t i = 0; i < births.size(); ++i) {
            const Birth& first = runs[0][i];
            ASSERT_TRUE(births[i].position == first.position && births[i].velocity == first.velocity &&
                        births[i].lifetime == first.lifetime)
                << i;
        }
    }
    EXPECT_NE(burstOf(snow(), 1, 4).at(0).position, burstOf(snow(), 1, 3).at(0).position);
}

// Birth n happens at n / rate; its age is the time since then at the end of its step. Bursts happen at once.
TEST(Emitter, AgesSpreadBirthsOverTheStep) {
    EmitterSettings settings = fountain();
    settings.burst = 0;
    Emitter emitter(settings, 1);
    std::size_t before = 0;
    std::vector<Birth> births;
    for (int step = 1; step <= 40; ++step) {
        emitter.emit(1.0 / 16.0, 1'000'000, births);
        for (std::size_t i = before; i < births.size(); ++i) {
            const double moment = 0.5 + static_cast<double>(i + 1) / 1000.0;
            ASSERT_NEAR(births[i].age, step / 16.0 - moment, 1e-6);
            ASSERT_TRUE(births[i].age >= 0.0F && births[i].age <= 1.0F / 16.0F);
        }
        before = births.size();
    }
    EXPECT_GT(before, 1900U);
    settings.start = 0.0;
    births = burstOf(settings, 10);
    settings.interpolate = false;
    Emitter(settings, 1).emit(1.0, 1'000'000, births);
    EXPECT_EQ(births.size(), 1010U);
    for (const Birth& birth : births) {
        ASSERT_EQ(birth.age, 0.0F);
    }
}

TEST(Emitter, ADayOfStepsHasTheExactCount) {
    EmitterSettings settings;
    settings.rate = 1.0;
    Emitter emitter(settings, 1);
    std::vector<Birth> births;
    for (int step = 0; step < 86400 * 10; ++step) {
        emitter.emit(0.1, 1'000'000, births);
    }
    EXPECT_EQ(births.size(), 86400U);
}

TEST(Emitter, RefusedBirthsAreSkipped) {
    Emitter emitter(fountain(), 1);
    std::vector<Birth> births;
    EXPECT_EQ(emitter.emit(2.0, 100, births), 5U * 70U + 1500U - 100U);
    EXPECT_EQ(emitter.emit(2.0, 1'000'000, births), 0U);
    EXPECT_EQ(births.size(), 100U + 70U + 750U);
}

TEST(Emitter, HugeNumbersAreFast) {
    EmitterSettings settings = fountain();
    settings.rate = 1e300;
    settings.burst = ~std::uint64_t{0};
    settings.burst_every = 1e-300;
    settings.duration = std::numeric_limits<double>::infinity();
    Emitter emitter(settings, 1);
    std::vector<Birth> births;
    for (const double dt : {1e-300, 1.0, 1e300, 1e308, 1e308, std::numeric_limits<double>::infinity(), 1.0}) {
        emitter.emit(dt, 10, births);
    }
    EXPECT_LE(births.size(), 70U);
}

TEST(Emitter, EarlierEmittersHavePriority) {
    EmitterSettings settings;
    settings.burst = 60;
    std::vector<Emitter> emitters;
    for (const std::uint32_t type : {1U, 2U}) {
        settings.type = type;
        emitters.emplace_back(settings, 1, type);
    }
    std::vector<Birth> births;
    EXPECT_EQ(emitAll(emitters, 0.1, 100, births), 20U);
    ASSERT_EQ(births.size(), 100U);
    EXPECT_EQ(births[59].type, 1U);
    EXPECT_EQ(births[60].type, 2U);
}

TEST(Emitter, CheckNamesTheInvalidSetting) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(Emitter::check(fountain()));
    EmitterSettings points = fountain();
    points.shape = EmitterShape::kPoints;
    points.points.positions.resize(2);
    const std::pair<std::string, std::function<void(EmitterSettings&)>> wrong[] = {
        {"radius", [](auto& s) { s.radius = -1.0F; }},
        {"center", [](auto& s) { s.center.x = kNan; }},
        {"normal", [](auto& s) { s.shape = EmitterShape::kDisc, s.normal = glm::vec3(0.0F); }},
        {"box_min", [](auto& s) { s.shape = EmitterShape::kBox, s.box_min.z = 1.0F; }},
        {"1 to " + std::to_string(kPointsMax) + " points", [](auto& s) { s.shape = EmitterShape::kPoints; }},
        {"normals", [&](auto& s) { s = points, s.points.normals.resize(1); }},
        {"aim.direction", [&](auto& s) { s = points, s.aim->direction.reset(); }},
        {"aim.direction", [](auto& s) { s.shape = EmitterShape::kBox, s.aim->direction.reset(); }},
        {"aim.direction", [](auto& s) { s.aim->direction = glm::vec3(0.0F); }},
        {"cone", [](auto& s) { s.aim->cone_degrees = 180.1F; }},
        {"cone", [](auto& s) { s.aim->cone_degrees = kNan; }},
        {"speeds", [](auto& s) { s.aim->speed_min = 5.0F; }},
        {"speeds", [](auto& s) { s.aim->speed_min = -1.0F; }},
        {"speeds", [](auto& s) { s.aim->speed_deviation = kNan; }},
        {"rate", [](auto& s) { s.rate = -1.0; }},
        {"start", [](auto& s) { s.start = static_cast<double>(kNan); }},
        {"duration", [](auto& s) { s.duration = 0.0; }},
        {"burst_every", [](auto& s) { s.burst_every = -1.0; }},
        {"velocity_spread", [](auto& s) { s.velocity_spread.y = -1.0F; }},
        {"lifetime_min", [](auto& s) { s.lifetime_min = 0.0F; }},
        {"lifetime_max", [](auto& s) { s.lifetime_min = 3.0F; }},
    };
    for (const auto& [field, change] : wrong) {
        EmitterSettings settings = fountain();
        change(settings);
        expectError(Emitter::check(settings), ErrorCode::kUsage, field);
    }
}

// Moving emitters: births are placed with the emitter's pose at their own time, and inherit a fraction of its velocity.
const glm::vec3 kUp(0.0F, 1.0F, 0.0F);

/// Rotates by 180° about y and moves by 8 along x, in 4 s.
std::vector<PoseKey> spin() {
    return {{0.0, {}},
            {2.0, {{4.0F, 0.0F, 0.0F}, glm::angleAxis(0.5F * std::numbers::pi_v<float>, kUp), 1.0F}},
            {4.0, {{8.0F, 0.0F, 0.0F}, glm::angleAxis(std::numbers::pi_v<float>, kUp), 1.0F}}};
}

void expectNear(const glm::vec3& a, const glm::vec3& b, float bound, const char* what) {
    EXPECT_LT(glm::length(a - b), bound) << what << ": " << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(EmitterMotion, BirthsUseThePoseAtTheirOwnTime) {
    EmitterMotion motion;
    motion.keys = spin();
    std::vector<Birth> births(2, Birth{{1.0F, 0.5F, 0.0F}, {0.0F, 0.0F, 3.0F}});
    births[1].age = 1.0F;
    carry(motion, 2.0, births);
    // At 2 s: a quarter turn about y maps x to -z, and z to x.
    expectNear(births[0].position, {4.0F, 0.5F, -1.0F}, 1e-5F, "place");
    expectNear(births[0].velocity, {3.0F, 0.0F, 0.0F}, 1e-5F, "velocity");
    const float h = std::sqrt(0.5F);
    expectNear(births[1].position, {2.0F + h, 0.5F, -h}, 1e-5F, "place a second before");
    expectNear(births[1].velocity, {3.0F * h, 0.0F, 3.0F * h}, 1e-5F, "velocity a second before");
}

// Composes both motions: positions by hand, velocities by their differences.
TEST(EmitterMotion, AttachedEmittersFollowTheirBody) {
    EmitterMotion motion;
    motion.keys = spin();
    motion.body = {
        {1.0, {{0.0F, 1.0F, 0.0F}, glm::angleAxis(0.3F, glm::normalize(glm::vec3(1.0F, 0.0F, 1.0F))), 3.0F}},
        {3.0, {{1.0F, 5.0F, -2.0F}, glm::angleAxis(1.9F, glm::vec3(1.0F, 0.0F, 0.0F)), 3.0F}}};
    motion.inherit = 1.0F;
    const auto at = [&](double time) {
        Birth birth{{0.3F, -0.2F, 0.6F}, {0.0F, 0.0F, 0.0F}};
        carry(motion, time, std::span(&birth, 1));
        return birth;
    };
    for (const double time : {1.2, 1.7, 2.5}) {
        const glm::vec3 by_hand =
            toWorld(poseAt(motion.body, time), toWorld(poseAt(motion.keys, time), {0.3F, -0.2F, 0.6F}));
        expectNear(at(time).position, by_hand, 1e-5F, "place");
        const glm::vec3 measured = (at(time + 1e-3).position - at(time - 1e-3).position) / 2e-3F;
        expectNear(at(time).velocity, measured, 0.05F, "velocity");
    }
    // The body's scale applies to positions, not to velocities.
    motion.inherit = 0.0F;
    Birth birth{{}, {0.0F, 7.0F, 0.0F}};
    carry(motion, 2.0, std::span(&birth, 1));
    EXPECT_NEAR(glm::length(birth.velocity), 7.0F, 1e-5F);
}

}  // namespace
}  // namespace relief
