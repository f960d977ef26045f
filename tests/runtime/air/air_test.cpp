// Air and fields on the CPU: the noise's clock, Stokes drag, and every wrong setting.
#include "runtime/air/air.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace relief {
namespace {

TEST(CurlNoise, ItsTimeRepeatsAfterItsPeriod) {
    CurlNoise noise{1.0F, 0.5F, 3, 0.25F, 5};  // 128 patterns of 2 s
    EXPECT_EQ(curlTime(noise, 256.0 + 0.5), 0.5F);
    noise.drift = 0.0F;
    EXPECT_EQ(curlTime(noise, 1e6), 0.0F);
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
