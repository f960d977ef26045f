// SPDX-License-Identifier: Apache-2.0
// shaders/air/air.glsl in OpenGL 3.3 and OpenGL ES 3.0, against closed forms and the guarantees of curl noise.
// Tolerance of sums and pinned numbers: a GL may fuse operations, and its division and square root may be off by a few
// ulp. The largest error is in the noise's phase: up to 1024 in the fourth octave, where a fused multiply-add changes
// the fraction by up to 2^-15. That shifts an octave of speed 0.1 by up to 1e-5. All other errors are smaller, for
// numbers below 4 and forces below 10.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "runtime/air/air_block.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/particles/random.h"
#include "runtime/particles/step_pass.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/runtime/gl/query_program.h"

namespace relief {
namespace {

constexpr double kTolerance = 2e-5;
constexpr GLsizei kTexelsAcross = 256;

struct Sample {
    glm::vec3 air;
    glm::vec3 field;
};

/// Evaluates air.glsl at the points of a texture, one per texel.
constexpr const char* kAirQuery = R"(
uniform highp sampler2D u_points;  // xyz: object space; w: time

layout(location = 0) out vec4 o_air;    // xyz: airVelocity
layout(location = 1) out vec4 o_field;  // xyz: fieldAcceleration of a particle with velocity (1, 2, 3)

void main() {
    vec4 point = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0);
    o_air = vec4(airVelocity(point.xyz, point.w), 0.0);
    o_field = vec4(fieldAcceleration(point.xyz, vec3(1.0, 2.0, 3.0), point.w), 0.0);
}
)";

class AirGlTest : public GlTest {
  protected:
    static std::vector<Sample> evaluate(const AirBlock& air, const std::vector<glm::vec4>& points) {
        const PassState state;
        const GlProgram program = required(makeQueryProgram("air/air.glsl", kAirQuery, air.defines()));
        const auto height = static_cast<GLsizei>((points.size() + kTexelsAcross - 1) / kTexelsAcross);
        std::vector<glm::vec4> padded(points);
        padded.resize(static_cast<std::size_t>(kTexelsAcross * height), glm::vec4(0.0F));
        const auto texture = [&](const void* data) {
            return makeTexture2D(GL_RGBA32F, kTexelsAcross, height, GL_RGBA, GL_FLOAT, data);
        };
        const GlTexture input = texture(padded.data());
        const GlTexture out_air = texture(nullptr);
        const GlTexture out_field = texture(nullptr);
        const GlFramebuffer framebuffer = required(makeFramebuffer({out_air.name(), out_field.name()}));
        air.attach(program, {});
        program.use();  // without air attach() does nothing
        program.set("u_points", 0);
        useTexture(0, input);
        air.bind({});
        program.drawScreen(framebuffer.name(), kTexelsAcross, height);
        const std::vector<float> airs = required(readTextureFloats(out_air, kTexelsAcross, height));
        const std::vector<float> fields = required(readTextureFloats(out_field, kTexelsAcross, height));
        std::vector<Sample> samples;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const float* a = &airs[4 * i];
            const float* f = &fields[4 * i];
            samples.push_back({{a[0], a[1], a[2]}, {f[0], f[1], f[2]}});
        }
        return samples;
    }
    static std::vector<Sample> evaluate(const AirSettings& settings, const std::vector<glm::vec4>& points) {
        return evaluate(required(AirBlock::create(settings)), points);
    }
    /// The noise velocity at points and times.
    static std::vector<glm::dvec3> blown(const CurlNoise& noise, const std::vector<glm::vec4>& points) {
        AirSettings air;
        air.curl_noise = noise;
        std::vector<glm::dvec3> velocities;
        for (const Sample& sample : evaluate(air, points)) {
            velocities.emplace_back(sample.air);
        }
        return velocities;
    }
    /// Half the velocity differences between +h and −h along x, y and z.
    static std::vector<std::array<glm::dvec3, 3>> differences(const CurlNoise& noise,
                                                              const std::vector<glm::vec4>& points, float h) {
        std::vector<glm::vec4> around;
        for (const glm::vec4& p : points) {
            for (int axis = 0; axis < 3; ++axis) {
                glm::vec4 e(0.0F);
                e[axis] = h;
                around.push_back(p + e);
                around.push_back(p - e);
            }
        }
        const std::vector<glm::dvec3> v = blown(noise, around);
        std::vector<std::array<glm::dvec3, 3>> halves;
        for (std::size_t i = 0; i < v.size(); i += 6) {
            halves.push_back(
                {0.5 * (v[i] - v[i + 1]), 0.5 * (v[i + 2] - v[i + 3]), 0.5 * (v[i + 4] - v[i + 5])});
        }
        return halves;
    }
};

std::vector<glm::vec4> randomPoints(std::size_t count, float reach, float seconds, std::uint64_t seed) {
    Pcg32 random(seed);
    std::vector<glm::vec4> points(count);
    for (glm::vec4& p : points) {
        for (int i = 0; i < 3; ++i) {
            p[i] = random.between(-reach, reach);
        }
        p.w = random.between(0.0F, seconds);
    }
    return points;
}

std::shared_ptr<FlowField> randomFlow(std::array<std::uint32_t, 3> size, FlowOutside outside) {
    auto flow = std::make_shared<FlowField>();
    flow->size = size;
    flow->box_min = {-1.0F, -0.7F, -1.2F};
    flow->box_max = {1.1F, 0.9F, 0.8F};
    flow->outside = outside;
    flow->gain = 1.5F;
    Pcg32 random(3);
    for (std::uint32_t i = 0; i < size[0] * size[1] * size[2]; ++i) {
        flow->nodes.emplace_back(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    }
    return flow;
}

AirSettings everything() {
    AirSettings air;
    air.wind = {0.3F, -0.1F, 0.2F};
    air.flow = randomFlow({7, 5, 6}, FlowOutside::kZero);
    air.curl_noise = CurlNoise{0.8F, 0.6F, 4, 0.9F, 4'000'000'000U};
    for (int i = 0; i < 8; ++i) {
        const auto f = static_cast<float>(i);
        air.attractors.push_back({{0.3F * f - 1.0F, std::sin(f), std::cos(f)},
                                  (i % 2 == 0 ? 1.0F : -0.5F),
                                  0.1F + 0.05F * f,
                                  i % 3,
                                  i < 4 ? 1.3F : Attractor{}.reach});
        air.vortices.push_back({{std::cos(f), 0.2F * f, std::sin(f)},
                                {f - 3.0F, 2.0F, 0.5F * f},
                                0.4F * f - 1.0F,
                                0.15F + 0.1F * f,
                                i % 3});
    }
    return air;
}

// No kind, only one kind, all but one, and all: each combination compiles, and its result is the sum of its parts.
// With several attractors or vortices, each adds its own contribution.
TEST_P(AirGlTest, EveryCombinationCompilesAndAddsUp) {
    const AirSettings all = everything();
    const std::vector<glm::vec4> points = randomPoints(2000, 2.0F, 128.0F * 0.6F / 0.9F, 2);
    const auto some = [&](unsigned kinds) {
        AirSettings air = all;
        air.wind = (kinds & 1U) != 0 ? all.wind : glm::vec3(0.0F);
        if ((kinds & 2U) == 0) {
            air.flow = nullptr;
        }
        if ((kinds & 4U) == 0) {
            air.curl_noise.reset();
        }
        air.attractors.resize((kinds & 8U) != 0 ? all.attractors.size() : 0);
        air.vortices.resize((kinds & 16U) != 0 ? all.vortices.size() : 0);
        return air;
    };
    const auto expectSum = [&](const std::vector<Sample>& together,
                               const std::vector<std::vector<Sample>>& parts) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            Sample sum{};
            for (const std::vector<Sample>& part : parts) {
                sum = {sum.air + part[i].air, sum.field + part[i].field};
            }
            ASSERT_NEAR(glm::length(together[i].air - sum.air), 0.0, kTolerance) << i;
            ASSERT_NEAR(glm::length(together[i].field - sum.field), 0.0, kTolerance) << i;
        }
    };
    for (const unsigned kinds : {0U, 30U, 29U, 27U, 23U, 15U, 31U}) {
        SCOPED_TRACE(kinds);
        const AirBlock block = required(AirBlock::create(some(kinds)));
        EXPECT_EQ(block.defines().empty(), kinds == 0) << "a scene without air must not compile air code";
        EXPECT_EQ(block.defines().find("_CURL") != std::string::npos, (kinds & 4U) != 0);
        std::vector<std::vector<Sample>> parts;
        for (unsigned kind = 1; kind < 32; kind *= 2) {
            parts.push_back(evaluate(some(kinds & kind), points));
        }
        expectSum(evaluate(block, points), parts);
    }
    std::vector<std::vector<Sample>> parts;
    for (std::size_t i = 0; i < all.attractors.size(); ++i) {
        AirSettings one;
        one.attractors = {all.attractors[i]};
        one.vortices = {all.vortices[i]};
        parts.push_back(evaluate(one, points));
    }
    expectSum(evaluate(some(24), points), parts);
}

TEST_P(AirGlTest, FlowIsExactOnTrilinearFieldsAndConstantOutside) {
    const auto linear = [](const glm::vec3& p) {
        return glm::vec3(1.0F + p.x - 2.0F * p.y + 0.5F * p.z, 3.0F * p.y + p.x * p.z,
                         p.z - p.x + p.x * p.y * p.z);
    };
    for (const glm::uvec3& size : {glm::uvec3(9, 4, 5), {2, 2, 2}, {6, 3, 1}, {1, 1, 1}, {1, 7, 1}}) {
        auto flow = randomFlow({size.x, size.y, size.z}, FlowOutside::kEdge);
        for (std::uint32_t i = 0; i < flow->nodes.size(); ++i) {
            const glm::vec3 at(i % size.x, i / size.x % size.y, i / (size.x * size.y));
            const glm::vec3 steps = glm::max(glm::vec3(size) - 1.0F, 1.0F);
            flow->nodes[i] = linear(flow->box_min + (flow->box_max - flow->box_min) * at / steps);
        }
        AirSettings air;
        air.flow = flow;
        std::vector<glm::vec4> points = randomPoints(1000, 1.6F, 0.0F, 5);
        points.emplace_back(flow->box_min, 0.0F);
        points.emplace_back(flow->box_max, 0.0F);
        points.emplace_back(0.0F, -1e30F, 0.0F, 0.0F);  // the position of dead particles
        const std::vector<Sample> edge = evaluate(air, points);
        flow->outside = FlowOutside::kZero;
        const std::vector<Sample> zero = evaluate(air, points);
        std::size_t outside = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const glm::vec3 p(points[i]);
            glm::vec3 node = glm::clamp(p, flow->box_min, flow->box_max);
            const bool within = node == p;
            for (int a = 0; a < 3; ++a) {
                node[a] = size[a] == 1 ? flow->box_min[a] : node[a];
            }
            ASSERT_NEAR(glm::length(edge[i].air - flow->gain * linear(node)), 0.0, 8e-6) << i;
            outside += within ? 0 : 1;
            ASSERT_EQ(zero[i].air, within ? edge[i].air : glm::vec3(0.0F)) << i;
        }
        EXPECT_GT(outside, 300U);
        EXPECT_LT(outside, 930U);
    }
}

TEST_P(AirGlTest, AttractorsMatchTheirFalloff) {
    const glm::vec3 position(0.2F, 0.4F, -0.3F);
    std::vector<glm::vec4> points = randomPoints(5000, 3.0F, 0.0F, 7);
    points.emplace_back(position, 0.0F);
    for (const int falloff : {0, 1, 2}) {
        for (const float strength : {2.0F, -3.0F}) {
            constexpr float kRadius = 0.5F;
            constexpr float kReach = 2.5F;
            AirSettings air;
            air.attractors = {{position, strength, kRadius, falloff, kReach}};
            const std::vector<Sample> gpu = evaluate(air, points);
            std::array<int, 3> zones{};
            for (std::size_t i = 0; i + 1 < points.size(); ++i) {
                const glm::dvec3 d = glm::dvec3(position) - glm::dvec3(points[i]);
                const double r = glm::length(d);
                if (std::abs(r - 2.5) < 1e-6) {
                    continue;
                }
                const double size = r < 0.5 ? r / 0.5 : (r > 2.5 ? 0.0 : std::pow(0.5 / r, falloff));
                ++zones[r < 0.5 ? 0U : (r > 2.5 ? 2U : 1U)];
                const glm::dvec3 expected = static_cast<double>(strength) * size * d / r;
                ASSERT_NEAR(glm::length(glm::dvec3(gpu[i].field) - expected), 0.0, 5e-6) << r;
            }
            EXPECT_GT(*std::min_element(zones.begin(), zones.end()), 5);
            EXPECT_EQ(gpu.back().field, glm::vec3(0.0F)) << "no force at the attractor itself";
        }
    }
}

TEST_P(AirGlTest, VorticesRotateRightHandedAboutTheirAxis) {
    const glm::vec3 center(0.1F, -0.2F, 0.3F);
    const glm::vec3 axis(1.0F, 2.0F, -2.0F);  // length 3
    std::vector<glm::vec4> points = randomPoints(5000, 2.0F, 0.0F, 9);
    points.emplace_back(center + axis, 0.0F);
    for (const int falloff : {0, 1, 2}) {
        AirSettings air;
        air.vortices = {{center, axis, 4.0F, 0.6F, falloff}};
        const std::vector<Sample> gpu = evaluate(air, points);
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            const glm::dvec3 a = glm::dvec3(axis) / 3.0;
            const glm::dvec3 d = glm::dvec3(points[i]) - glm::dvec3(center);
            const glm::dvec3 across = d - glm::dot(d, a) * a;
            const double r = glm::length(across);
            const double size = r < 0.6 ? r / 0.6 : std::pow(0.6 / r, falloff);
            const glm::dvec3 got(gpu[i].field);
            ASSERT_NEAR(glm::length(got), 4.0 * size, 1e-5) << r;
            ASSERT_NEAR(glm::dot(got, a), 0.0, 5e-6) << "force along the axis";
            ASSERT_NEAR(glm::dot(got, across) / r, 0.0, 5e-6) << "radial force";
            ASSERT_GT(glm::dot(glm::cross(a, across), got), 0.0) << "rotates in the wrong direction";
        }
        EXPECT_NEAR(glm::length(gpu.back().field), 0.0, 1e-5);
    }
}

TEST_P(AirGlTest, UpdateChangesValuesWithoutRecompiling) {
    AirSettings air = everything();
    AirBlock block = required(AirBlock::create(air));
    const std::string defines = block.defines();
    const std::vector<glm::vec4> points = randomPoints(1000, 1.5F, 10.0F, 11);
    air.wind = {-2.0F, 0.0F, 1.0F};
    air.attractors.resize(1);
    air.vortices.clear();
    air.curl_noise->octaves = 1;
    AirSettings without_flow = air;
    without_flow.flow = nullptr;  // an update does not change the flow
    ASSERT_TRUE(block.update(without_flow));
    EXPECT_EQ(block.defines(), defines);
    const std::vector<Sample> updated = evaluate(block, points);
    const std::vector<Sample> made = evaluate(air, points);
    ASSERT_EQ(updated.size(), made.size());
    for (std::size_t i = 0; i < made.size(); ++i) {
        ASSERT_NEAR(glm::length(updated[i].air - made[i].air), 0.0, kTolerance) << i;
        ASSERT_NEAR(glm::length(updated[i].field - made[i].field), 0.0, kTolerance) << i;
    }

    AirBlock less = required(AirBlock::create(without_flow));
    EXPECT_EQ(less.update(everything()).error().code, ErrorCode::kUsage) << "compiled without vortices";
    air.attractors.resize(9);
    EXPECT_EQ(AirBlock::create(air).error().code, ErrorCode::kUsage);
}

RELIEF_INSTANTIATE_GL_TESTS(AirGlTest);

constexpr double kUnitRms = 1.45944383;  // as in curl_noise.cpp
/// Bound of the speed, in amplitudes. With all numbers at ±15, blended with another such pattern, a corner contributes
/// at most √2 · 15 √3 · t² (|driving| + |turning|) in any direction. The largest sum over the corners is 4.314
/// kUnitRms.
const double kNoiseSpeedMax = 4.4 * std::sqrt(2.0) * 15.0 / std::sqrt(85.0);

/// One octave of amplitude 1 at rest, whose lattice has the object's unit.
CurlNoise unitLattice(std::uint32_t seed) {
    return {1.0F, curlUnits({.scale = 1.0F}), 1, 0.0F, seed};
}

/// The position with the skewed coordinates q.
glm::vec4 unskewed(const glm::dvec3& q) {
    return {glm::vec3(q - (q.x + q.y + q.z) / 6.0), 0.0F};
}

class CurlNoiseGlTest : public AirGlTest {
  protected:
    using Numbers = std::vector<std::array<double, 6>>;

    /// The two vectors of each lattice point. Near a lattice point the velocity is t² ((4t/3 - 1/2) b + (b·d) d + a ×
    /// d) with t = 1/2 - |d|². So the velocity at the point is b / 24, and its curl is a / 2. Central differences over
    /// h have an error of 4 h².
    static Numbers cornerNumbers(const CurlNoise& noise, const std::vector<glm::ivec3>& lattice) {
        constexpr float kStep = 0.02F;
        std::vector<glm::vec4> points;
        for (const glm::ivec3& point : lattice) {
            points.push_back(unskewed(point));
        }
        const std::vector<glm::dvec3> velocity = blown(noise, points);
        const auto d = differences(noise, points, kStep);
        Numbers numbers;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const glm::dvec3 b = velocity[i] * (24.0 / kUnitRms);
            const glm::dvec3 a =
                glm::dvec3(d[i][1].z - d[i][2].y, d[i][2].x - d[i][0].z, d[i][0].y - d[i][1].x) *
                (2.0 / (static_cast<double>(kStep) * kUnitRms));
            numbers.push_back({a.x, a.y, a.z, b.x, b.y, b.z});
        }
        return numbers;
    }
    static double odd(double number) { return 2.0 * std::floor(0.5 * number) + 1.0; }
};

// Central differences over 0.02 of the finest cell have an error of h²/6 of a third derivative, about 1e-3 of the
// gradient, and rounding errors of about 1e-4. A field with divergence, or with a wrong term in the curl, would have a
// divergence as large as the other derivatives.
TEST_P(CurlNoiseGlTest, IsDivergenceFree) {
    for (const int octaves : {1, 2, 4}) {
        const CurlNoise noise{1.5F, 0.8F, octaves, 0.4F, 7};
        const float h = 0.02F * noise.scale / static_cast<float>(1 << (octaves - 1));
        double divergence = 0.0;
        double gradient = 0.0;
        for (const auto& d : differences(noise, randomPoints(2000, 4.0F, 20.0F, 1), h)) {
            divergence += std::pow(d[0].x + d[1].y + d[2].z, 2.0);
            gradient += glm::dot(d[0], d[0]) + glm::dot(d[1], d[1]) + glm::dot(d[2], d[2]);
        }
        EXPECT_LT(std::sqrt(divergence / gradient), 2e-3) << octaves;
        EXPECT_GT(gradient, 0.01);
    }
}

// The amplitude is the root mean square of the speed for any octaves, seed and time, and no direction is preferred.
TEST_P(CurlNoiseGlTest, HasItsAmplitudeAndIsIsotropic) {
    for (const int octaves : {1, 2, 3, 4}) {
        for (const float t : {0.0F, 0.75F}) {  // a pattern, and halfway to the next
            const CurlNoise noise{2.0F, 0.5F, octaves, 1.0F / 3.0F, static_cast<std::uint32_t>(octaves)};
            std::vector<glm::vec4> points = randomPoints(60'000, 100.0F, 0.0F, 2);
            for (glm::vec4& p : points) {
                p.w = t;
            }
            glm::dvec3 mean(0.0);
            glm::dvec3 squares(0.0);
            double fastest = 0.0;
            for (const glm::dvec3& v : blown(noise, points)) {
                mean += v / static_cast<double>(points.size());
                squares += v * v / static_cast<double>(points.size());
                fastest = std::max(fastest, glm::length(v));
            }
            EXPECT_NEAR(std::sqrt(squares.x + squares.y + squares.z), 2.0, 0.02) << octaves << " " << t;
            EXPECT_LT(fastest, 4.0 * 2.0) << "bound stated in the header";
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(mean[axis], 0.0, 0.025) << octaves << " " << t;
                EXPECT_NEAR(squares[axis], 4.0 / 3.0, 0.05) << octaves << " " << t;
            }
        }
    }
}

// Pinned, because the noise of a seed is part of a scene's result.
TEST_P(CurlNoiseGlTest, DependsOnlyOnTheSeed) {
    Pcg32 random(6);
    std::vector<glm::ivec3> lattice;
    for (int i = 0; i < 200; ++i) {
        const float x = random.between(-40.0F, 40.0F);
        const float y = random.between(-40.0F, 40.0F);
        lattice.emplace_back(glm::vec3(x, y, random.between(-40.0F, 40.0F)));
    }
    for (const std::uint32_t seed : {1U, 2U, 4'000'000'000U}) {
        for (const auto& numbers : cornerNumbers(unitLattice(seed), lattice)) {
            for (const double number : numbers) {
                ASSERT_NEAR(number, odd(number), 0.06) << seed;
                ASSERT_LE(std::abs(odd(number)), 15.0) << seed;
            }
        }
    }
    constexpr double kNumbers[2][6] = {{7, 3, -3, -5, -11, -1}, {1, -9, 9, 5, 13, -1}};
    const Numbers at = cornerNumbers(unitLattice(1), {glm::ivec3(0), glm::ivec3(3, -2, 5)});
    for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t m = 0; m < 6; ++m) {
            EXPECT_NEAR(at[i][m], kNumbers[i][m], m < 3 ? 0.06 : 1e-3) << i << " " << m;
        }
    }
    // All octaves, late in their patterns.
    const std::vector<glm::vec4> points = {
        {0.3F, -0.7F, 1.9F, 0.4F}, {-5.1F, 2.2F, 0.6F, 33.3F}, {1.5F, 8.25F, -3.5F, 77.7F}};
    const glm::dvec3 pinned[3] = {
        {0.093286, -0.440639, -1.087173}, {0.000630, -0.218924, 0.443611}, {0.174797, 0.082640, -0.205891}};
    const std::vector<glm::dvec3> v = blown({0.8F, 0.6F, 4, 0.9F, 4'000'000'000U}, points);
    for (std::size_t i = 0; i < v.size(); ++i) {
        EXPECT_NEAR(glm::length(v[i] - pinned[i]), 0.0, kTolerance)
            << v[i].x << ", " << v[i].y << ", " << v[i].z;
    }
}

// At the faces between simplices, other corners start to contribute: at faces within a cell's cube, where two fractions
// are equal, and at those between cubes. The velocity jumps if the order of corners is wrong or a contribution does not
// end at the face opposite its corner. It has a kink if a contribution ends too abruptly.
TEST_P(CurlNoiseGlTest, IsSmoothAcrossFacesOfSimplices) {
    Pcg32 random(8);
    constexpr std::size_t kPoints = 4000;
    for (int face = 0; face < 7; ++face) {  // the last kind is anywhere
        std::vector<glm::vec4> points;
        for (std::size_t i = 0; i < kPoints; ++i) {
            glm::dvec3 q;
            for (int axis = 0; axis < 3; ++axis) {
                q[axis] = static_cast<double>(random.between(-20.0F, 20.0F));
            }
            if (face < 3) {
                const int next = (face + 1) % 3;
                q[next] = std::floor(q[next]) + q[face] - std::floor(q[face]);
            } else if (face < 6) {
                q[face - 3] = std::round(q[face - 3]);
            }
            const glm::vec4 p = unskewed(q);
            const glm::vec4 n(onUnitSphere(random), 0.0F);
            points.insert(points.end(), {p, p + 1e-4F * n, p - 1e-4F * n, p + 0.01F * n, p - 0.01F * n});
        }
        const std::vector<glm::dvec3> v = blown(unitLattice(3), points);
        double bend = 0.0;
        for (std::size_t i = 0; i < v.size(); i += 5) {
            ASSERT_LT(glm::length(v[i + 1] - v[i + 2]), 0.01) << face;  // derivatives stay below about 30
            const glm::dvec3 second = v[i + 3] - 2.0 * v[i] + v[i + 4];
            bend += glm::dot(second, second) / static_cast<double>(kPoints);
        }
        // A kink would be about 0.01 times a derivative, whose root mean square is 7.
        EXPECT_LT(std::sqrt(bend), 0.01) << face;
    }
}

TEST_P(CurlNoiseGlTest, ChangesSmoothlyInTimeAndRepeatsAfterItsPeriod) {
    const CurlNoise noise{1.0F, 0.5F, 3, 0.25F, 5};  // a pattern lasts 2 s
    std::vector<glm::vec4> points;
    for (const glm::vec4& random : randomPoints(300, 10.0F, 0.0F, 4)) {
        // Before and after the times at which patterns of some octave change; then two pattern lengths, and the ends of
        // the period.
        for (const float t :
             {0.499F, 0.501F, 0.999F, 1.001F, 1.999F, 2.001F, 5.999F, 6.001F, 0.0F, 2.0F, 255.9999F}) {
            points.emplace_back(glm::vec3(random), t);
        }
    }
    const std::vector<glm::dvec3> v = blown(noise, points);
    ASSERT_EQ(v.size(), points.size());
    double correlation = 0.0;
    for (std::size_t i = 0; i < v.size(); i += 11) {
        for (std::size_t k = 0; k < 8; k += 2) {
            ASSERT_LT(glm::length(v[i + k] - v[i + k + 1]), 0.05);
        }
        correlation += glm::dot(v[i + 8], v[i + 9]) / 300.0;
        ASSERT_LT(glm::length(v[i + 10] - v[i + 8]), 0.01) << "a jump where the time wraps";
    }
    EXPECT_NEAR(correlation, 0.0, 0.15) << "successive patterns must not correlate";
}

// Far away, floats are coarser than the noise's cells, and a fused multiply-add may select another cell; but the speed
// stays bounded.
TEST_P(CurlNoiseGlTest, IsBoundedFarAway) {
    std::vector<glm::vec4> points = randomPoints(20'000, 1.0F, 100.0F, 4);
    Pcg32 random(14);
    for (glm::vec4& p : points) {
        // From 1 to 2^33 lattice units along each axis, some beyond the integer range.
        for (int axis = 0; axis < 3; ++axis) {
            p[axis] = std::ldexp(p[axis], static_cast<int>(random.between(-10.0F, 24.0F)));
            p[axis] = random.between(0.0F, 1.0F) < 0.02F ? std::copysign(3e38F, p[axis]) : p[axis];
        }
    }
    for (const glm::dvec3& v : blown({1.0F, 1e-3F, 4, 1e-4F, 5}, points)) {
        ASSERT_LT(glm::length(v), kNoiseSpeedMax);
    }
}

RELIEF_INSTANTIATE_GL_TESTS(CurlNoiseGlTest);

}  // namespace
}  // namespace relief
