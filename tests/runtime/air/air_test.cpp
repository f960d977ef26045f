// Air and fields on the CPU: what curl noise promises, Stokes drag, and every wrong setting.
#include "runtime/air/air.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "runtime/particles/emitter.h"

namespace relief {
namespace {

glm::vec3 randomPoint(Pcg32& random, float reach) {
    const float x = random.between(-reach, reach);
    const float y = random.between(-reach, reach);
    return {x, y, random.between(-reach, reach)};
}

// Central differences over 0.02 of the finest cell are off by h²/6 of a third derivative, some 1e-3 of the
// gradient, and by roundings of some 1e-4 of it. A field with divergence, or with one term of the curl wrong,
// has as much of it as of anything else.
TEST(CurlNoise, HasNoDivergence) {
    for (const int octaves : {1, 2, 4}) {
        const CurlNoise noise{1.5F, 0.8F, octaves, 0.4F, 7};
        const float h = 0.02F * noise.scale / static_cast<float>(1 << (octaves - 1));
        Pcg32 random(1);
        double divergence = 0.0;
        double gradient = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const glm::vec3 p = randomPoint(random, 4.0F);
            const float t = random.between(0.0F, 20.0F);
            double sum = 0.0;
            for (int axis = 0; axis < 3; ++axis) {
                glm::vec3 e(0.0F);
                e[axis] = h;
                const glm::dvec3 d =
                    (glm::dvec3(curlVelocity(noise, p + e, t)) - glm::dvec3(curlVelocity(noise, p - e, t))) /
                    (2.0 * static_cast<double>(h));
                sum += d[axis];
                gradient += glm::dot(d, d);
            }
            divergence += sum * sum;
        }
        EXPECT_LT(std::sqrt(divergence / gradient), 2e-3) << octaves;
        EXPECT_GT(gradient, 1.0);
    }
}

// The amplitude is the root mean square of the speed, whatever the octaves, the seed and the time, and no
// direction is preferred.
TEST(CurlNoise, HasTheAmplitudeItSaysAndNoPreferredDirection) {
    for (const int octaves : {1, 2, 3, 4}) {
        for (const float t : {0.0F, 0.75F}) {  // a pattern, and half way to the next
            const CurlNoise noise{2.0F, 0.5F, octaves, 1.0F / 3.0F, static_cast<std::uint32_t>(octaves)};
            Pcg32 random(2);
            glm::dvec3 mean(0.0);
            glm::dvec3 squares(0.0);
            double fastest = 0.0;
            constexpr int kPoints = 60'000;
            for (int i = 0; i < kPoints; ++i) {
                const glm::dvec3 v(curlVelocity(noise, randomPoint(random, 100.0F), t));
                mean += v / static_cast<double>(kPoints);
                squares += v * v / static_cast<double>(kPoints);
                fastest = std::max(fastest, glm::length(v));
            }
            EXPECT_NEAR(std::sqrt(squares.x + squares.y + squares.z), 2.0, 0.02) << octaves << " " << t;
            EXPECT_LT(fastest, 4.0 * 2.0) << "the header says so";
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(mean[axis], 0.0, 0.025) << octaves << " " << t;
                EXPECT_NEAR(squares[axis], 4.0 / 3.0, 0.05) << octaves << " " << t;
            }
        }
    }
}

TEST(CurlNoise, IsTheSameForTheSameSeedAndAnotherForAnother) {
    CurlNoise noise{1.0F, 1.0F, 3, 0.5F, 42};
    const CurlNoise same = noise;
    CurlNoise other = noise;
    other.seed = 43;
    Pcg32 random(3);
    double product = 0.0;
    double square = 0.0;
    for (int i = 0; i < 5000; ++i) {
        const glm::vec3 p = randomPoint(random, 50.0F);
        const glm::vec3 v = curlVelocity(noise, p, 3.0F);
        ASSERT_EQ(v, curlVelocity(same, p, 3.0F));
        product += static_cast<double>(glm::dot(v, curlVelocity(other, p, 3.0F)));
        square += static_cast<double>(glm::dot(v, v));
    }
    EXPECT_NEAR(product / square, 0.0, 0.05);
    // Pinned: the noise of a seed is part of a scene's result.
    const glm::vec3 pinned = curlVelocity({1.0F, 1.0F, 1, 0.0F, 1}, glm::vec3(0.0F), 0.0F);
    // At a lattice point the velocity is the curl of its gradients alone, even numbers times 1/rms.
    for (int axis = 0; axis < 3; ++axis) {
        const double steps = static_cast<double>(pinned[axis]) / (2.0 * 0.103262385);
        EXPECT_NEAR(steps, std::round(steps), 1e-5);
        EXPECT_LE(std::abs(steps), 7.0);
    }
}

TEST(CurlNoise, ChangesSmoothlyInTimeAndRepeatsAfterItsPeriod) {
    const CurlNoise noise{1.0F, 0.5F, 3, 0.25F, 5};  // a pattern lasts 2 s
    Pcg32 random(4);
    double correlation = 0.0;
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 p = randomPoint(random, 10.0F);
        for (const float t : {0.5F, 1.0F, 2.0F, 6.0F}) {  // where patterns of some octave follow each other
            const glm::vec3 step = curlVelocity(noise, p, t + 1e-3F) - curlVelocity(noise, p, t - 1e-3F);
            ASSERT_LT(glm::length(step), 0.05F);
        }
        correlation +=
            static_cast<double>(glm::dot(curlVelocity(noise, p, 0.0F), curlVelocity(noise, p, 2.0F)));
        ASSERT_EQ(curlTime(noise, 256.0 + 0.5), 0.5F);
        ASSERT_LT(glm::length(curlVelocity(noise, p, 255.9999F) - curlVelocity(noise, p, 0.0F)), 0.01F)
            << "a jump where time is taken back";
    }
    EXPECT_NEAR(correlation / 300.0, 0.0, 0.15) << "after a pattern's time another should blow";
    CurlNoise still = noise;
    still.drift = 0.0F;
    EXPECT_EQ(curlTime(still, 1e6), 0.0F);
}

TEST(CurlNoise, AnswersAtExtremePoints) {
    const CurlNoise noise{1.0F, 1e-3F, 4, 0.0F, 5};
    for (const float far : {1e6F, 1e30F, 3e38F, -3e38F, std::nanf("")}) {
        const glm::vec3 v = curlVelocity(noise, {0.0F, far, far}, 0.0F);
        EXPECT_TRUE(std::isfinite(glm::length(v))) << far;
    }
}

// A drop of 0.1 mm across in air: k = 9 viscosity / (2 density radius²).
TEST(Air, StokesRateOfADrop) {
    const double radius = 5e-5;
    const double mass = 1000.0 * 4.0 / 3.0 * 3.14159265358979 * radius * radius * radius;
    const double expected = 9.0 * 1.8e-5 / (2.0 * 1000.0 * radius * radius);
    EXPECT_NEAR(expected, 32.4, 1e-9);
    EXPECT_NEAR(
        static_cast<double>(stokesRate(1.8e-5F, static_cast<float>(radius), static_cast<float>(mass))),
        expected, 1e-5 * expected);
    EXPECT_EQ(stokesRate(0.0F, 1.0F, 1.0F), 0.0F);
}

TEST(Air, WrongSettingsAreNamed) {
    AirSettings good;
    good.attractors.resize(8);
    good.vortices.resize(8);
    good.curl_noise = CurlNoise{};
    good.flow = std::make_shared<FlowField>(FlowField{.nodes = {glm::vec3(1.0F)}});
    ASSERT_TRUE(checkAir(good)) << checkAir(good).error().message;
    struct Case {
        const char* part;
        ErrorCode code;
        std::function<void(AirSettings&)> spoil;
    };
    const float nan = std::nanf("");
    const auto flowOf = [](FlowField flow) { return std::make_shared<FlowField>(std::move(flow)); };
    const Case cases[] = {
        {"wind", ErrorCode::kUsage, [&](AirSettings& a) { a.wind.y = nan; }},
        {"viscosity", ErrorCode::kUsage, [](AirSettings& a) { a.viscosity = -1.0F; }},
        {"9 attractors", ErrorCode::kUsage, [](AirSettings& a) { a.attractors.resize(9); }},
        {"9 vortices", ErrorCode::kUsage, [](AirSettings& a) { a.vortices.resize(9); }},
        {"attractor 2", ErrorCode::kUsage, [](AirSettings& a) { a.attractors[2].radius = 0.0F; }},
        {"attractor 3", ErrorCode::kUsage, [](AirSettings& a) { a.attractors[3].falloff = 3; }},
        {"attractor 4", ErrorCode::kUsage, [&](AirSettings& a) { a.attractors[4].strength = nan; }},
        {"vortex 1", ErrorCode::kUsage, [](AirSettings& a) { a.vortices[1].axis = glm::vec3(0.0F); }},
        {"vortex 7", ErrorCode::kUsage, [](AirSettings& a) { a.vortices[7].falloff = -1; }},
        {"octaves", ErrorCode::kUsage, [](AirSettings& a) { a.curl_noise->octaves = 5; }},
        {"scale", ErrorCode::kUsage, [](AirSettings& a) { a.curl_noise->scale = 0.0F; }},
        {"drift", ErrorCode::kUsage, [](AirSettings& a) { a.curl_noise->drift = 1001.0F; }},
        {"3 velocities", ErrorCode::kInvalidInput,
         [&](AirSettings& a) {
             a.flow = flowOf({.size = {2, 2, 1}, .nodes = std::vector<glm::vec3>(3)});
         }},
        {"empty", ErrorCode::kInvalidInput,
         [&](AirSettings& a) {
             a.flow = flowOf({.size = {2, 0, 1}, .nodes = {}});
         }},
        {"empty on the y axis", ErrorCode::kInvalidInput,
         [&](AirSettings& a) {
             a.flow = flowOf({.box_max = {1.0F, 0.0F, 1.0F}, .nodes = {glm::vec3(0.0F)}});
         }},
        {"at node 1, 0, 1 is not finite", ErrorCode::kInvalidInput,
         [&](AirSettings& a) {
             FlowField flow{.size = {2, 1, 2}, .nodes = std::vector<glm::vec3>(4, glm::vec3(0.0F))};
             flow.nodes[3].z = nan;
             a.flow = flowOf(std::move(flow));
         }},
        {"bytes", ErrorCode::kLimit,
         [&](AirSettings& a) {
             a.flow = flowOf({.size = {512, 512, 65}, .nodes = {}});
         }},
    };
    for (const Case& one : cases) {
        AirSettings air = good;
        one.spoil(air);
        const auto checked = checkAir(air);
        ASSERT_FALSE(checked) << one.part;
        EXPECT_EQ(checked.error().code, one.code) << one.part;
        EXPECT_NE(checked.error().message.find(one.part), std::string::npos) << checked.error().message;
    }
}

}  // namespace
}  // namespace relief
