// Where, which way, how fast and when an emitter gives birth: against closed forms, for fixed seeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "runtime/particles/emitter.h"

namespace relief {
namespace {

constexpr int kCount = 100'000;

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

/// Kolmogorov's distance between the births and a distribution, in units of 1/√n; above 2.7 by chance once in
/// a million.
double off(const std::vector<Birth>& births, const std::function<double(const Birth&)>& value,
           const std::function<double(double)>& cdf) {
    std::vector<double> draws;
    for (const Birth& birth : births) {
        draws.push_back(value(birth));
    }
    std::sort(draws.begin(), draws.end());
    const auto n = static_cast<double>(draws.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < draws.size(); ++i) {
        const double f = cdf(draws[i]);
        worst = std::max({worst, f - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - f});
    }
    return worst * std::sqrt(n);
}
constexpr double kCritical = 2.7;

double lengthOf(const glm::vec3& v) {
    return std::hypot(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
}
double dotOf(const glm::vec3& a, const glm::vec3& b) {
    return static_cast<double>(a.x * b.x + a.y * b.y + a.z * b.z);
}

EmitterSettings round(EmitterShape shape) {
    EmitterSettings settings;
    settings.shape = shape;
    settings.center = {3.0F, -1.0F, 2.0F};
    settings.radius = 0.5F;
    return settings;
}

TEST(EmitterShapes, SphereIsUniformInVolume) {
    const EmitterSettings settings = round(EmitterShape::kSphere);
    const auto births = burstOf(settings, kCount);
    const auto radius = [&](const Birth& b) { return lengthOf(b.position - settings.center) / 0.5; };
    EXPECT_LT(off(births, radius, [](double r) { return r * r * r; }), kCritical);
}

TEST(EmitterShapes, ShellIsUniformInArea) {
    const EmitterSettings settings = round(EmitterShape::kShell);
    const auto births = burstOf(settings, kCount);
    for (int axis = 0; axis < 3; ++axis) {
        const auto height = [&](const Birth& b) {
            return static_cast<double>(b.position[axis] - settings.center[axis]) / 0.5;
        };
        EXPECT_LT(off(births, height, [](double h) { return 0.5 * (h + 1.0); }), kCritical);
    }
    for (const Birth& birth : births) {
        ASSERT_NEAR(lengthOf(birth.position - settings.center), 0.5, 1e-6);
    }
}

TEST(EmitterShapes, DiscIsUniformInAreaAndFlat) {
    EmitterSettings settings = round(EmitterShape::kDisc);
    settings.normal = {0.0F, 6.0F, 8.0F};
    const auto births = burstOf(settings, kCount);
    const auto radius = [&](const Birth& b) { return lengthOf(b.position - settings.center) / 0.5; };
    EXPECT_LT(off(births, radius, [](double r) { return r * r; }), kCritical);
    double sum = 0.0;
    for (const Birth& birth : births) {
        ASSERT_NEAR(dotOf(birth.position - settings.center, {0.0F, 0.6F, 0.8F}), 0.0, 1e-6);
        sum += static_cast<double>(birth.position.x - settings.center.x);
    }
    // A coordinate has mean 0 and variance r²/4.
    EXPECT_NEAR(sum / kCount, 0.0, 5.0 * 0.25 / std::sqrt(kCount));
}

TEST(EmitterShapes, PointsAreChosenEvenlyAndTheirNormalsFollowed) {
    EmitterSettings settings;
    settings.shape = EmitterShape::kPoints;
    constexpr int kPoints = 50;
    for (int i = 0; i < kPoints; ++i) {
        settings.points.positions.emplace_back(static_cast<float>(i), 0.0F, 1.0F);
        settings.points.normals.push_back(i % 2 == 0 ? glm::vec3(0.0F, 1.0F, 0.0F)
                                                     : glm::vec3(0.0F, 0.0F, -1.0F));
    }
    settings.aim = EmitterAim{std::nullopt, 0.0F, 2.0F, 2.0F, 0.0F};
    std::map<float, int> hits;
    for (const Birth& birth : burstOf(settings, kCount)) {
        ++hits[birth.position.x];
        const auto i = static_cast<std::size_t>(birth.position.x);
        ASSERT_EQ(birth.position, settings.points.positions[i]);
        ASSERT_EQ(birth.velocity, 2.0F * settings.points.normals[i]);
    }
    ASSERT_EQ(hits.size(), static_cast<std::size_t>(kPoints));
    double square = 0.0;
    const double mean = static_cast<double>(kCount) / kPoints;
    for (const auto& [x, n] : hits) {
        square += (n - mean) * (n - mean) / mean;
    }
    EXPECT_NEAR(square, kPoints - 1.0, 5.0 * std::sqrt(2.0 * (kPoints - 1.0)));
}

TEST(EmitterAim, ConeIsUniformInSolidAngleAboutItsDirection) {
    EmitterSettings settings;
    settings.velocity = {0.0F, 0.0F, 0.0F};
    settings.aim = EmitterAim{glm::vec3(3.0F, 0.0F, -4.0F), 25.0F, 2.0F, 2.0F, 0.0F};
    const auto births = burstOf(settings, kCount);
    const double opening = 1.0 - std::cos(25.0 * 3.14159265358979323846 / 180.0);
    const auto down = [](const Birth& b) { return 1.0 - dotOf(b.velocity, {0.6F, 0.0F, -0.8F}) / 2.0; };
    EXPECT_LT(off(births, down, [&](double d) { return d / opening; }), kCritical);
    for (const Birth& birth : births) {
        ASSERT_NEAR(lengthOf(birth.velocity), 2.0, 1e-5);
    }
}

// Without a direction the cone stands on the surface.
TEST(EmitterAim, FollowsTheNormalOfItsShape) {
    for (const EmitterShape shape : {EmitterShape::kSphere, EmitterShape::kShell, EmitterShape::kDisc}) {
        EmitterSettings settings = round(shape);
        settings.normal = {0.0F, 0.0F, -2.0F};
        settings.aim = EmitterAim{std::nullopt, 10.0F, 1.0F, 1.0F, 0.0F};
        const double least = std::cos(10.0 * 3.14159265358979323846 / 180.0) - 1e-5;
        double mean = 0.0;
        for (const Birth& birth : burstOf(settings, 1000)) {
            const glm::vec3 normal = shape == EmitterShape::kDisc
                                         ? glm::vec3(0.0F, 0.0F, -1.0F)
                                         : unitVector(birth.position - settings.center);
            ASSERT_GE(dotOf(birth.velocity, normal), least);
            mean += dotOf(birth.velocity, normal) / 1000.0;
        }
        EXPECT_LT(mean, 0.5 * (1.0 + least) + 0.002);  // and fills it
    }
}

TEST(EmitterAim, SpeedsAreUniformOrTruncatedNormal) {
    EmitterSettings settings;
    settings.aim = EmitterAim{glm::vec3(0.0F, 1.0F, 0.0F), 0.0F, 1.0F, 3.0F, 0.0F};
    const auto speed = [](const Birth& b) { return static_cast<double>(b.velocity.y); };
    EXPECT_LT(off(burstOf(settings, kCount), speed, [](double v) { return 0.5 * (v - 1.0); }), kCritical);
    settings.aim = EmitterAim{glm::vec3(0.0F, 1.0F, 0.0F), 0.0F, 1.0F, 1.0F, 2.0F};
    const auto phi = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
    const double cut = phi(-0.5);  // what lies below 0
    EXPECT_LT(off(burstOf(settings, kCount), speed,
                  [&](double v) { return v < 0.0 ? 0.0 : (phi((v - 1.0) / 2.0) - cut) / (1.0 - cut); }),
              kCritical);
}

TEST(EmitterStreams, OneSeedGivesIndependentEmitters) {
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

/// A fountain with all there is: bursts that fall between and onto births by rate.
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

TEST(EmitterMoments, CountsAreThoseOfTheClosedForm) {
    Emitter emitter(fountain(), 1);
    std::vector<Birth> births;
    for (int step = 1; step <= 64; ++step) {
        emitter.emit(1.0 / 16.0, 1'000'000, births);
        const double s = std::min(step / 16.0 - 0.5, 2.25);
        // Six bursts, at 0 … 1.875; the one at 2.25 would begin as the duration ends.
        const double bursts = s < 0.0 ? 0.0 : std::min(std::floor(s / 0.375) + 1.0, 6.0);
        ASSERT_EQ(births.size(),
                  static_cast<std::size_t>(70.0 * bursts + std::floor(1000.0 * std::max(s, 0.0))))
            << step;
    }
}

TEST(EmitterMoments, BirthsAreTheSameHoweverTimeIsCut) {
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
            ASSERT_EQ(births[i].position, runs[0][i].position) << i;
            ASSERT_EQ(births[i].velocity, runs[0][i].velocity) << i;
            ASSERT_EQ(births[i].lifetime, runs[0][i].lifetime) << i;
        }
    }
}

// Birth n lives from n / rate on: at the end of its step that is its age, bursts are born at once.
TEST(EmitterMoments, AgesSpreadBirthsOverTheStep) {
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
            ASSERT_GE(births[i].age, 0.0F);
            ASSERT_LE(births[i].age, 1.0F / 16.0F);
        }
        before = births.size();
    }
    EXPECT_GT(before, 1900U);
    settings.spread = false;
    Emitter at_once(settings, 1);
    births.clear();
    at_once.emit(1.0, 1'000'000, births);
    for (const Birth& birth : births) {
        ASSERT_EQ(birth.age, 0.0F);
    }
    settings.spread = true;
    settings.start = 0.0;
    for (const Birth& birth : burstOf(settings, 10)) {
        ASSERT_EQ(birth.age, 0.0F);
    }
}

TEST(EmitterMoments, ADayOfStepsEndsWithOneLongStep) {
    EmitterSettings settings;
    settings.rate = 1.0;
    Emitter emitter(settings, 1);
    std::vector<Birth> births;
    for (int step = 0; step < 86400 * 10; ++step) {
        emitter.emit(0.1, 1'000'000, births);
    }
    EXPECT_EQ(births.size(), 86400U);
}

TEST(EmitterMoments, RefusedBirthsAreSkippedAcrossBursts) {
    Emitter emitter(fountain(), 1);
    std::vector<Birth> births;
    EXPECT_EQ(emitter.emit(2.0, 100, births), 5U * 70U + 1500U - 100U);
    EXPECT_EQ(emitter.emit(2.0, 1'000'000, births), 0U);
    EXPECT_EQ(births.size(), 100U + 70U + 750U);
}

TEST(EmitterMoments, AbsurdNumbersEndQuickly) {
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

TEST(EmitAll, EarlierEmittersTakeTheRoom) {
    EmitterSettings settings;
    settings.burst = 60;
    std::vector<Emitter> emitters;
    settings.type = 1;
    emitters.emplace_back(settings, 1, 0);
    settings.type = 2;
    emitters.emplace_back(settings, 1, 1);
    std::vector<Birth> births;
    EXPECT_EQ(emitAll(emitters, 0.1, 100, births), 20U);
    ASSERT_EQ(births.size(), 100U);
    EXPECT_EQ(births[59].type, 1U);
    EXPECT_EQ(births[60].type, 2U);
}

TEST(EmitterCheck, NamesWhatIsWrong) {
    const auto problem = [](const std::function<void(EmitterSettings&)>& change) {
        EmitterSettings settings = fountain();
        change(settings);
        const auto checked = Emitter::check(settings);
        EXPECT_TRUE(checked || checked.error().code == ErrorCode::kUsage);
        return checked ? std::string() : checked.error().message;
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(problem([](auto&) {}), "");
    const std::pair<const char*, std::function<void(EmitterSettings&)>> wrong[] = {
        {"radius", [](auto& s) { s.radius = -1.0F; }},
        {"center", [](auto& s) { s.center.x = kNan; }},
        {"normal", [](auto& s) { s.shape = EmitterShape::kDisc, s.normal = glm::vec3(0.0F); }},
        {"box_min", [](auto& s) { s.shape = EmitterShape::kBox, s.box_min.z = 1.0F; }},
        {"points", [](auto& s) { s.shape = EmitterShape::kPoints; }},
        {"normals",
         [](auto& s) {
             s.shape = EmitterShape::kPoints;
             s.points.positions.resize(2);
             s.points.normals.resize(1);
         }},
        {"aim.direction",
         [](auto& s) {
             s.shape = EmitterShape::kPoints;
             s.points.positions.resize(2);
             s.aim->direction.reset();
         }},
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
    for (const auto& [word, change] : wrong) {
        EXPECT_NE(problem(change).find(word), std::string::npos) << word << ": " << problem(change);
    }
}

}  // namespace
}  // namespace relief
