// SPDX-License-Identifier: Apache-2.0
// Air and fields on the CPU: the noise's clock, Stokes drag, and every invalid setting.
#include "runtime/air/air.h"
#include "runtime/particles/step_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "tests/results.h"

namespace relief {
namespace {

TEST(CurlNoise, TimeWrapsAfterThePeriod) {
    CurlNoise noise{1.0F, 0.5F, 3, 0.25F, 5};  // 128 patterns of 2 s
    EXPECT_EQ(curlTime(noise, 256.0 + 0.5), 0.5F);
    noise.drift = 0.0F;
    EXPECT_EQ(curlTime(noise, 1e6), 0.0F);
}

// A drop 0.1 mm in diameter in air: k = 9 viscosity / (2 density radius²).
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

TEST(Air, InvalidSettingsAreNamed) {
    AirSettings good;
    good.attractors.resize(8);
    good.vortices.resize(8);
    good.curl_noise = CurlNoise{};
    good.flow = std::make_shared<FlowField>(FlowField{.nodes = {glm::vec3(1.0F)}});
    ASSERT_TRUE(checkAir(good)) << checkAir(good).error().message;
    struct Case {
        const char* part;
        std::function<void(AirSettings&)> change;
    };
    const float nan = std::nanf("");
    const auto expectNamed = [&](const Case& one, ErrorCode code) {
        AirSettings air = good;
        one.change(air);
        expectError(checkAir(air), code, one.part);
    };
    for (const Case& one : {Case{"wind", [&](auto& a) { a.wind.y = nan; }},
                            Case{"viscosity", [](auto& a) { a.viscosity = -1.0F; }},
                            Case{"9 attractors", [](auto& a) { a.attractors.resize(9); }},
                            Case{"9 vortices", [](auto& a) { a.vortices.resize(9); }},
                            Case{"attractor 2", [](auto& a) { a.attractors[2].radius = 0.0F; }},
                            Case{"attractor 3", [](auto& a) { a.attractors[3].falloff = 3; }},
                            Case{"attractor 4", [&](auto& a) { a.attractors[4].strength = nan; }},
                            Case{"vortex 1", [](auto& a) { a.vortices[1].axis = glm::vec3(0.0F); }},
                            Case{"vortex 7", [](auto& a) { a.vortices[7].falloff = -1; }},
                            Case{"octaves", [](auto& a) { a.curl_noise->octaves = 5; }},
                            Case{"scale", [](auto& a) { a.curl_noise->scale = 0.0F; }},
                            Case{"drift", [](auto& a) { a.curl_noise->drift = 1001.0F; }}}) {
        expectNamed(one, ErrorCode::kUsage);
    }
    const auto expectFlowNamed = [&](const char* part, const FlowField& flow, ErrorCode code) {
        expectNamed({part, [&](auto& a) { a.flow = std::make_shared<FlowField>(flow); }}, code);
    };
    const std::vector<glm::vec3> still(4, glm::vec3(0.0F));
    FlowField hole{.size = {2, 1, 2}, .nodes = still};
    hole.nodes[3].z = nan;
    expectFlowNamed("4 velocities", {.size = {2, 2, 2}, .nodes = still}, ErrorCode::kInvalidInput);
    expectFlowNamed("empty", {.size = {2, 0, 1}, .nodes = {}}, ErrorCode::kInvalidInput);
    expectFlowNamed("empty on the y axis", {.size = {2, 2, 1}, .box_max = {1.0F, 0.0F, 1.0F}, .nodes = still},
                    ErrorCode::kInvalidInput);
    expectFlowNamed("at node 1, 0, 1 is not finite", hole, ErrorCode::kInvalidInput);
    expectFlowNamed("bytes", {.size = {512, 512, 65}, .nodes = {}}, ErrorCode::kLimit);
}

}  // namespace
}  // namespace relief
