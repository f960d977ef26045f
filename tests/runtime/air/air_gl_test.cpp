// shaders/air/air.glsl in OpenGL 3.3 and OpenGL ES 3.0: against its C++ twin at random points, and against closed
// forms.
//
// Tolerance: both sides chain the same float operations, but a GL may fuse them, and takes a few ulp for
// division and square root. What counts is the noise's place in its patterns: up to 1024 of the fourth
// octave, whose fraction a fused multiply-add takes with 2^-15 less error; that shifts an octave of speed 0.1
// by up to 1e-5. All else, of numbers below 4 and forces below 10, stays below that.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/air/air_block.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/particles/emitter.h"
#include "tests/runtime/air/air_reference.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/runtime/gl/query_program.h"

namespace relief {
namespace {

constexpr double kTolerance = 2e-5;
constexpr GLsizei kWidth = 256;
constexpr float kViscosity = 1.8e-5F;
constexpr float kMass = 5e-10F;

struct Sample {
    glm::vec3 air;
    glm::vec3 field;
    float stokes;
};

/// Evaluates air.glsl at the points of a texture, one a texel.
constexpr const char* kQuery = R"(
uniform highp sampler2D u_points;    // xyz: object space; w: time
uniform highp sampler2D u_velocity;  // xyz: the particle's velocity; w: its radius
uniform float u_viscosity;
uniform float u_mass;

layout(location = 0) out vec4 o_air;    // xyz: airVelocity
layout(location = 1) out vec4 o_field;  // xyz: fieldAcceleration; w: stokesRate

void main() {
    vec4 point = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0);
    vec4 particle = texelFetch(u_velocity, ivec2(gl_FragCoord.xy), 0);
    o_air = vec4(airVelocity(point.xyz, point.w), 0.0);
    o_field = vec4(fieldAcceleration(point.xyz, particle.xyz, point.w),
                   stokesRate(u_viscosity, particle.w, u_mass));
}
)";

class AirGlTest : public GlTest {
  protected:
    /// What the GPU says at points and times; `stokes` for radii of 1e-5 and up, by index.
    static std::vector<Sample> evaluate(const AirBlock& air, const std::vector<glm::vec4>& points) {
        const PassState state;
        const auto program = makeQueryProgram("air/air.glsl", kQuery, air.defines());
        EXPECT_TRUE(program) << program.error().message;
        if (!program) {
            return {};
        }
        const auto height = static_cast<GLsizei>((points.size() + kWidth - 1) / kWidth);
        std::vector<glm::vec4> padded(points);
        padded.resize(static_cast<std::size_t>(kWidth * height), glm::vec4(0.0F));
        std::vector<glm::vec4> particles(padded.size());
        for (std::size_t i = 0; i < particles.size(); ++i) {
            particles[i] = glm::vec4(1.0F, 2.0F, 3.0F, radius(i));
        }
        const auto texture = [&](const void* data) {
            return makeTexture2D(GL_RGBA32F, kWidth, height, GL_RGBA, GL_FLOAT, data);
        };
        const GlTexture input = texture(padded.data());
        const GlTexture velocity = texture(particles.data());
        const GlTexture out_air = texture(nullptr);
        const GlTexture out_field = texture(nullptr);
        const std::array<GLuint, 2> targets{out_air.name(), out_field.name()};
        const auto framebuffer = makeFramebuffer(targets);
        EXPECT_TRUE(framebuffer);
        const GlVertexArray no_attributes = makeVertexArray();
        air.attach(*program, {});
        glUseProgram(program->name());
        program->set("u_points", 0);
        program->set("u_velocity", 1);
        program->set("u_viscosity", kViscosity);
        program->set("u_mass", kMass);
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, input.name());
        glActiveTexture(GL_TEXTURE1);
        glBindTexture(GL_TEXTURE_2D, velocity.name());
        air.bind({});
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer->name());
        glViewport(0, 0, kWidth, height);
        glBindVertexArray(no_attributes.name());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        const auto airs = readTextureFloats(out_air, kWidth, height);
        const auto fields = readTextureFloats(out_field, kWidth, height);
        EXPECT_TRUE(airs && fields);
        std::vector<Sample> samples;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const float* a = &(*airs)[4 * i];
            const float* f = &(*fields)[4 * i];
            samples.push_back({{a[0], a[1], a[2]}, {f[0], f[1], f[2]}, f[3]});
        }
        return samples;
    }
    static std::vector<Sample> evaluate(const AirSettings& settings, const std::vector<glm::vec4>& points) {
        const auto air = AirBlock::create(settings);
        EXPECT_TRUE(air) << air.error().message;
        return air ? evaluate(*air, points) : std::vector<Sample>{};
    }
    static float radius(std::size_t i) { return 1e-5F + 1e-7F * static_cast<float>(i % 1000); }
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

bool hangsByAHair(const AirSettings& air, const glm::vec3& p) {
    for (const Attractor& one : air.attractors) {
        if (std::abs(glm::length(p - one.position) - one.reach) < 1e-6F * one.reach) {
            return true;  // at the very end of an attractor's reach
        }
    }
    return false;
}

void expectTwins(const AirSettings& air, const std::vector<glm::vec4>& points,
                 const std::vector<Sample>& gpu) {
    ASSERT_EQ(gpu.size(), points.size());
    std::size_t excused = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::vec3 p(points[i]);
        const glm::vec3 velocity = airVelocity(air, p, points[i].w);
        const glm::vec3 field = fieldAcceleration(air, p, glm::vec3(0.0F), points[i].w);
        ASSERT_NEAR(glm::length(gpu[i].air - velocity), 0.0, kTolerance) << i;
        if (hangsByAHair(air, p)) {
            ++excused;
            continue;
        }
        ASSERT_NEAR(glm::length(gpu[i].field - field), 0.0, kTolerance) << i;
    }
    EXPECT_LT(excused, points.size() / 1000 + 1);
}

TEST_P(AirGlTest, EqualsTheCpuAtRandomPointsAndTimes) {
    const AirSettings air = everything();
    const float period = 128.0F * 0.6F / 0.9F;
    const std::vector<glm::vec4> points = randomPoints(30'000, 2.5F, period, 1);
    expectTwins(air, points, evaluate(air, points));
}

// Far away floats are coarser than the noise's cells, and a fused multiply-add lands in another one; but no speed
// is greater there.
TEST_P(AirGlTest, NoiseIsBoundedFarAway) {
    AirSettings air;
    air.curl_noise = CurlNoise{1.0F, 1e-3F, 4, 1e-4F, 5};
    std::vector<glm::vec4> points = randomPoints(20'000, 1.0F, 100.0F, 4);
    Pcg32 random(14);
    for (glm::vec4& p : points) {
        for (int axis = 0; axis < 3; ++axis) {
            p[axis] = std::ldexp(p[axis], static_cast<int>(random.between(-10.0F, 24.0F)));
            p[axis] = random.between(0.0F, 1.0F) < 0.02F ? std::copysign(3e38F, p[axis]) : p[axis];
        }
    }
    const std::vector<Sample> gpu = evaluate(air, points);
    ASSERT_EQ(gpu.size(), points.size());
    for (std::size_t i = 0; i < gpu.size(); ++i) {
        ASSERT_LT(static_cast<double>(glm::length(gpu[i].air)), 4.4 * std::sqrt(2.0) * 15.0 / std::sqrt(85.0))
            << i;
    }
}

TEST_P(AirGlTest, EveryKindOfAirCompilesAloneAndWithTheOthers) {
    const AirSettings all = everything();
    const std::vector<glm::vec4> points = randomPoints(500, 1.5F, 10.0F, 2);
    for (unsigned kinds = 0; kinds < 32; ++kinds) {
        SCOPED_TRACE(kinds);
        AirSettings air = all;
        air.wind = (kinds & 1U) != 0 ? all.wind : glm::vec3(0.0F);
        if ((kinds & 2U) == 0) {
            air.flow = nullptr;
        }
        if ((kinds & 4U) == 0) {
            air.curl_noise.reset();
        }
        air.attractors.resize((kinds & 8U) != 0 ? 3 : 0);
        air.vortices.resize((kinds & 16U) != 0 ? 2 : 0);
        const auto block = AirBlock::create(air);
        ASSERT_TRUE(block) << block.error().message;
        EXPECT_EQ(block->defines().empty(), kinds == 0) << "a scene without air must compile none of it";
        EXPECT_EQ(block->defines().find("_CURL") != std::string::npos, (kinds & 4U) != 0);
        expectTwins(air, points, evaluate(*block, points));
    }
}

TEST_P(AirGlTest, FlowIsExactOnLinearFieldsAndConstantOutside) {
    for (const std::array<std::uint32_t, 3> size :
         {std::array<std::uint32_t, 3>{9, 4, 5}, {2, 2, 2}, {6, 3, 1}, {1, 1, 1}, {1, 7, 1}}) {
        auto flow = randomFlow(size, FlowOutside::kEdge);
        const auto linear = [](const glm::vec3& p) {
            return glm::vec3(1.0F + p.x - 2.0F * p.y + 0.5F * p.z, 3.0F * p.y, p.z - p.x);
        };
        const auto nodeAt = [&](glm::vec3 p, bool clamp_only) {
            for (int a = 0; a < 3; ++a) {
                const auto side = size[static_cast<std::size_t>(a)];
                p[a] = std::clamp(p[a], flow->box_min[a], flow->box_max[a]);
                p[a] = side == 1 && !clamp_only ? flow->box_min[a] : p[a];
            }
            return p;
        };
        flow->gain = 1.0F;
        for (std::uint32_t i = 0; i < flow->nodes.size(); ++i) {
            const std::uint32_t at[3] = {i % size[0], i / size[0] % size[1], i / (size[0] * size[1])};
            glm::vec3 p = flow->box_min;
            for (int a = 0; a < 3; ++a) {
                const auto side = size[static_cast<std::size_t>(a)];
                p[a] += side == 1 ? 0.0F
                                  : (flow->box_max[a] - flow->box_min[a]) * static_cast<float>(at[a]) /
                                        static_cast<float>(side - 1);
            }
            flow->nodes[i] = linear(p);
        }
        AirSettings air;
        air.flow = flow;
        std::vector<glm::vec4> points = randomPoints(3000, 1.6F, 0.0F, 5);
        points.emplace_back(flow->box_min, 0.0F);
        points.emplace_back(flow->box_max, 0.0F);
        points.emplace_back(0.0F, -1e30F, 0.0F, 0.0F);  // where the dead are
        const std::vector<Sample> edge = evaluate(air, points);
        flow->outside = FlowOutside::kZero;
        const std::vector<Sample> zero = evaluate(air, points);
        ASSERT_EQ(edge.size(), points.size());
        std::size_t outside = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const glm::vec3 p(points[i]);
            const glm::vec3 expected = linear(nodeAt(p, false));
            ASSERT_NEAR(glm::length(edge[i].air - expected), 0.0, 4e-6) << i;
            const bool within = nodeAt(p, true) == p;
            outside += within ? 0 : 1;
            ASSERT_EQ(zero[i].air, within ? edge[i].air : glm::vec3(0.0F)) << i;
        }
        EXPECT_GT(outside, 1000U);
        EXPECT_LT(outside, 2800U);
    }
}

TEST_P(AirGlTest, AttractorsFallOffAsTheySay) {
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
            ASSERT_EQ(gpu.size(), points.size());
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
            EXPECT_EQ(gpu.back().field, glm::vec3(0.0F)) << "no direction at its very place";
        }
    }
}

TEST_P(AirGlTest, VorticesTurnRightHandedRoundTheirAxis) {
    const glm::vec3 center(0.1F, -0.2F, 0.3F);
    const glm::vec3 axis(1.0F, 2.0F, -2.0F);  // of length 3
    std::vector<glm::vec4> points = randomPoints(5000, 2.0F, 0.0F, 9);
    points.emplace_back(center + axis, 0.0F);
    for (const int falloff : {0, 1, 2}) {
        AirSettings air;
        air.vortices = {{center, axis, 4.0F, 0.6F, falloff}};
        const std::vector<Sample> gpu = evaluate(air, points);
        ASSERT_EQ(gpu.size(), points.size());
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            const glm::dvec3 a = glm::dvec3(axis) / 3.0;
            const glm::dvec3 d = glm::dvec3(points[i]) - glm::dvec3(center);
            const glm::dvec3 across = d - glm::dot(d, a) * a;
            const double r = glm::length(across);
            const double size = r < 0.6 ? r / 0.6 : std::pow(0.6 / r, falloff);
            const glm::dvec3 got(gpu[i].field);
            ASSERT_NEAR(glm::length(got), 4.0 * size, 1e-5) << r;
            ASSERT_NEAR(glm::dot(got, a), 0.0, 5e-6) << "pushes along its axis";
            ASSERT_NEAR(glm::dot(got, across) / r, 0.0, 5e-6) << "pushes outwards";
            ASSERT_GT(glm::dot(glm::cross(a, across), got), 0.0) << "turns the wrong way";
        }
        EXPECT_NEAR(glm::length(gpu.back().field), 0.0, 1e-5);
    }
}

TEST_P(AirGlTest, StokesRateIsSixPiOnTheGpuToo) {
    const std::vector<glm::vec4> points(1000, glm::vec4(0.0F));
    const std::vector<Sample> gpu = evaluate(AirSettings{}, points);
    ASSERT_EQ(gpu.size(), points.size());
    for (std::size_t i = 0; i < gpu.size(); ++i) {
        const double expected = 6.0 * 3.14159265358979 * static_cast<double>(kViscosity) *
                                static_cast<double>(radius(i)) / static_cast<double>(kMass);
        ASSERT_NEAR(static_cast<double>(gpu[i].stokes), expected, 1e-6 * expected);
        ASSERT_EQ(gpu[i].air, glm::vec3(0.0F));
        ASSERT_EQ(gpu[i].field, glm::vec3(0.0F));
    }
}

TEST_P(AirGlTest, UpdateChangesWhatTheSameProgramsSay) {
    AirSettings air = everything();
    auto block = AirBlock::create(air);
    ASSERT_TRUE(block) << block.error().message;
    const std::string defines = block->defines();
    const std::vector<glm::vec4> points = randomPoints(1000, 1.5F, 10.0F, 11);
    air.wind = {-2.0F, 0.0F, 1.0F};
    air.attractors.resize(1);
    air.vortices.clear();
    air.curl_noise->octaves = 1;
    AirSettings without_flow = air;
    without_flow.flow = nullptr;  // an update leaves the flow as it is
    ASSERT_TRUE(block->update(without_flow));
    EXPECT_EQ(block->defines(), defines);
    expectTwins(air, points, evaluate(*block, points));

    auto less = AirBlock::create(without_flow);
    ASSERT_TRUE(less);
    const auto refused = less->update(everything());
    ASSERT_FALSE(refused) << "its programs know no vortices";
    EXPECT_EQ(refused.error().code, ErrorCode::kUsage);
}

TEST_P(AirGlTest, WrongSettingsAndTooLargeFlowsAreRefused) {
    AirSettings air;
    air.attractors.resize(9);
    auto refused = AirBlock::create(air);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kUsage);
    air.attractors.clear();
    auto flow = std::make_shared<FlowField>();
    flow->size = {513, 1, 1};
    flow->nodes.resize(513);
    air.flow = flow;
    refused = AirBlock::create(air);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kLimit);
    EXPECT_NE(refused.error().message.find("513x1x1"), std::string::npos) << refused.error().message;
}

TEST_P(AirGlTest, TheCallersStateIsKeptAndDoesNoHarm) {
    const AirSettings air = everything();
    const std::vector<glm::vec4> points = randomPoints(500, 1.0F, 1.0F, 13);
    const std::vector<Sample> plain = evaluate(air, points);
    GLuint texture = 0;
    glGenTextures(1, &texture);
    const GlTexture owner(texture);
    glActiveTexture(GL_TEXTURE6);
    glBindTexture(GL_TEXTURE_3D, texture);
    const GlBuffer buffer = makeBuffer();
    glBindBuffer(GL_UNIFORM_BUFFER, buffer.name());
    glBufferData(GL_UNIFORM_BUFFER, 4096, nullptr, GL_STATIC_DRAW);
    glBindBufferRange(GL_UNIFORM_BUFFER, 1, buffer.name(), 256, 512);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer.name());
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 3);
    glPixelStorei(GL_UNPACK_SKIP_IMAGES, 2);
    glActiveTexture(GL_TEXTURE2);
    const std::vector<Sample> odd = evaluate(air, points);
    ASSERT_EQ(odd.size(), plain.size());
    for (std::size_t i = 0; i < odd.size(); ++i) {
        ASSERT_EQ(odd[i].air, plain[i].air);
    }
    GLint value = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &value);
    EXPECT_EQ(value, GL_TEXTURE2);
    glActiveTexture(GL_TEXTURE6);
    glGetIntegerv(GL_TEXTURE_BINDING_3D, &value);
    EXPECT_EQ(static_cast<GLuint>(value), texture);
    glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, 1, &value);
    EXPECT_EQ(static_cast<GLuint>(value), buffer.name());
    GLint64 start = 0;
    glGetInteger64i_v(GL_UNIFORM_BUFFER_START, 1, &start);
    EXPECT_EQ(start, 256);
    glGetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &value);
    EXPECT_EQ(static_cast<GLuint>(value), buffer.name());
}

RELIEF_INSTANTIATE_GL_TESTS(AirGlTest);

}  // namespace
}  // namespace relief
