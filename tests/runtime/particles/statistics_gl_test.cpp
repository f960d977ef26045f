// Sums on the GPU against sums of the state read back, and stages timed.
#include "runtime/particles/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <thread>

#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gpu_timer.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/particles/step_gl_test.h"

namespace relief {
namespace {

constexpr float kDt = 1.0F / 60.0F;

class StatisticsGlTest : public StepGlTest {
  protected:
    static ParticleSystem makeParticles(std::uint32_t capacity) {
        auto particles = ParticleSystem::create(onPath({.capacity = capacity}));
        EXPECT_TRUE(particles) << particles.error().message;
        return std::move(*particles);
    }
    static Statistics makeStatistics(std::uint32_t capacity) {
        auto statistics = Statistics::create(capacity);
        EXPECT_TRUE(statistics) << statistics.error().message;
        return std::move(*statistics);
    }
    static StatisticsSample sample(Statistics& statistics, const ParticleSystem& particles,
                                   std::uint64_t tag = 0) {
        EXPECT_TRUE(statistics.request(particles, tag));
        const auto one = statistics.wait();
        EXPECT_TRUE(one && *one);
        return one && *one ? **one : StatisticsSample{};
    }
    /// Writes a number into the state of a particle, as an overflow on the GPU would.
    static void loseTexel(const GlTexture& state, const ParticleSystem& particles, std::uint32_t index,
                          int axis, float value) {
        std::array<float, 4> texel{};
        texel[static_cast<std::size_t>(axis)] = value;
        glBindTexture(GL_TEXTURE_2D, state.name());
        glTexSubImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(index % particles.textureWidth()),
                        static_cast<GLint>(index / particles.textureWidth()), 1, 1, GL_RGBA, GL_FLOAT,
                        texel.data());
        glBindTexture(GL_TEXTURE_2D, 0);
    }
    /// Counts are exact. The energy: at most six roundings a pass of seven, and three of a particle's own,
    /// each of 2^-24, all terms positive.
    static void expectEqualsState(const StatisticsSample& gpu, const ParticleSystem& particles) {
        const auto state = particles.readState();
        ASSERT_TRUE(state);
        std::uint32_t in_contact = 0;
        std::uint32_t caught = 0;
        std::uint64_t collisions = 0;
        double energy = 0.0;
        float fastest = 0.0F;
        for (const ParticleState& particle : *state) {
            in_contact += particle.contact != Contact::kNone ? 1 : 0;
            caught += particle.contact == Contact::kCaught ? 1 : 0;
            collisions += particle.collisions;
            const analytic::Vec v(particle.velocity);
            energy += 0.5 * glm::dot(v, v);
            fastest = std::max(fastest, glm::length(particle.velocity));
        }
        EXPECT_EQ(gpu.alive, state->size());
        EXPECT_EQ(gpu.in_contact, in_contact);
        EXPECT_EQ(gpu.caught, caught);
        EXPECT_EQ(gpu.collisions, collisions);
        EXPECT_NEAR(gpu.energy, energy, 45 * std::pow(2.0, -24) * energy);
        EXPECT_NEAR(gpu.max_speed, fastest, 1e-6F * fastest);
    }
    static std::vector<Birth> randomBirths(std::uint32_t count, Pcg32& random) {
        std::vector<Birth> births(count);
        for (Birth& birth : births) {
            for (int i = 0; i < 3; ++i) {
                birth.position[i] = random.between(-1.0F, 1.0F);
                birth.velocity[i] = random.between(-2.0F, 2.0F);
            }
            birth.lifetime = random.between(0.05F, 2.0F);
        }
        return births;
    }
};

// Every shape that the ladder can have, and particles that bounce, are caught, die and are born.
TEST_P(StatisticsGlTest, SumsEqualThoseOfTheStateReadBack) {
    Collider collider = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 64);
    const auto textures = ColliderTextures::create(collider);
    ASSERT_TRUE(textures);
    for (const std::uint32_t capacity : {1U, 3U, 4U, 17U, 1000U, 1024U, 1025U, 5000U, 70'000U}) {
        SCOPED_TRACE(capacity);
        ParticleSystem particles = makeParticles(capacity);
        ASSERT_TRUE(particles.setCollider(&*textures));
        EXPECT_TRUE(particles.setForces({{0.0F, -3.0F, 0.0F}, {}, 0.1F}));
        EXPECT_TRUE(particles.setCollision({0.6F, 0.1F, 0.0F}));
        EXPECT_TRUE(particles.setGround(-0.9F));
        Statistics statistics = makeStatistics(capacity);
        Pcg32 random(capacity);
        bool someone_in_contact = false;
        for (int step = 0; step < 40; ++step) {
            particles.spawn(randomBirths(capacity / 16 + 1, random));
            particles.step(kDt);
            if (step % 8 == 7 || step == 0) {
                const StatisticsSample gpu = sample(statistics, particles, static_cast<std::uint64_t>(step));
                EXPECT_EQ(gpu.tag, static_cast<std::uint64_t>(step));
                expectEqualsState(gpu, particles);
                someone_in_contact = someone_in_contact || gpu.in_contact > gpu.caught;
            }
        }
        EXPECT_TRUE(someone_in_contact || capacity < 100);
    }
}

// Free flight in closed form: n particles at speed s have ½ n s² and nothing else.
TEST_P(StatisticsGlTest, FreeFlightInClosedForm) {
    ParticleSystem particles = makeParticles(3000);
    Statistics statistics = makeStatistics(3000);
    const std::vector<Birth> births(2500, {glm::vec3(0.0F), {0.0F, 3.0F, 4.0F}, 10.0F, 0});
    particles.spawn(births);
    const StatisticsSample before = sample(statistics, particles);
    EXPECT_EQ(before.alive, 0U) << "they are born with the next step";
    particles.step(kDt);
    const StatisticsSample after = sample(statistics, particles);
    EXPECT_EQ(after.alive, 2500U);
    EXPECT_EQ(after.energy, 2500 * 12.5) << "small whole numbers and halves add up exactly";
    EXPECT_EQ(after.max_speed, 5.0F);
    EXPECT_EQ(after.collisions, 0U);
    EXPECT_EQ(after.in_contact, 0U);
}

// Every way to be lost, alone among thousands that are not, in every component, at either end of the rows and with either
// integrator: the type is found, and no sum is spoilt.
TEST_P(StatisticsGlTest, LostParticlesNameTheirTypeAndSpoilNoSum) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const std::vector<ParticleType> types(kParticleTypesMax);
    for (const Integrator integrator : {Integrator::kEuler, Integrator::kVerlet}) {
        for (const float value : {kNan, -kNan, kInfinity, -kInfinity, 3e38F, 2e15F}) {
            for (const std::uint32_t lost : {0U, 1U, 2047U, 2499U}) {
                SCOPED_TRACE(std::to_string(value) + " of particle " + std::to_string(lost));
                auto particles = ParticleSystem::create(onPath({.capacity = 3000, .integrator = integrator}));
                ASSERT_TRUE(particles);
                ASSERT_TRUE(particles->setTypes(types));
                Statistics statistics = makeStatistics(3000);
                std::vector<Birth> births(2500, {glm::vec3(0.0F), {0.0F, 3.0F, 4.0F}, 1.0F, 9});
                Birth& birth = births[lost];
                const int axis = static_cast<int>(lost % 3);
                if (std::isfinite(value)) {
                    birth.velocity[axis] = value;
                }
                birth.type = lost % 2 == 0 ? 0 : 15;
                particles->spawn(births);
                particles->step(kDt);
                if (!std::isfinite(value)) {
                    // A place may be as far off as floats go; a speed may not.
                    loseTexel(lost % 2 == 0 ? particles->positions() : particles->velocities(), *particles,
                              lost, axis, value);
                }
                const StatisticsSample gpu = sample(statistics, *particles);
                EXPECT_EQ(gpu.alive, 2500U);
                // A lost type behind one that is not, and the other way round.
                EXPECT_EQ(gpu.lost_type, std::optional<std::uint32_t>(birth.type));
                EXPECT_NEAR(gpu.energy, 2499 * 12.5, integrator == Integrator::kEuler ? 0.0 : 0.5);
                EXPECT_NEAR(gpu.max_speed, 5.0F, 1e-4F);
                for (int step = 0; step < 80; ++step) {
                    particles->step(kDt);
                }
                EXPECT_FALSE(sample(statistics, *particles).lost_type) << "the dead are not looked at";
            }
        }
    }
}

TEST_P(StatisticsGlTest, OfSeveralLostTypesTheFirstIsNamed) {
    ParticleSystem particles = makeParticles(3000);
    ASSERT_TRUE(particles.setTypes(std::vector<ParticleType>(kParticleTypesMax)));
    Statistics statistics = makeStatistics(3000);
    std::vector<Birth> births(3000, {glm::vec3(0.0F), glm::vec3(0.0F), 1.0F, 0});
    for (const std::uint32_t type : {14U, 7U, 3U, 11U}) {
        births[100 * type].type = type;
        births[100 * type].velocity.y = 3e38F;
    }
    particles.spawn(births);
    particles.step(kDt);
    EXPECT_EQ(sample(statistics, particles).lost_type, std::optional<std::uint32_t>(3));
}

// The fastest that are not lost: their squares still add up.
TEST_P(StatisticsGlTest, TheFastestAddUp) {
    ParticleSystem particles = makeParticles(3000);
    Statistics statistics = makeStatistics(3000);
    particles.spawn(std::vector<Birth>(3000, {glm::vec3(0.0F), {9e14F, 0.0F, 0.0F}, 10.0F, 0}));
    particles.step(kDt);
    const StatisticsSample gpu = sample(statistics, particles);
    EXPECT_FALSE(gpu.lost_type);
    EXPECT_NEAR(gpu.energy, 3000 * 0.5 * 8.1e29, 1e28);
}

// Beyond what one float counts: 20000 particles on the floor for 1000 steps, 2·10^7 steps in contact and an
// odd number of them.
TEST_P(StatisticsGlTest, CollisionsAreExactBeyondAFloat) {
    ParticleSystem particles = makeParticles(20'000);
    Statistics statistics = makeStatistics(20'000);
    EXPECT_TRUE(particles.setGround(0.0F));
    EXPECT_TRUE(particles.setForces({{0.0F, -1.0F, 0.0F}, {}, 0.0F}));
    EXPECT_TRUE(particles.setCollision({0.0F, 1.0F, 0.0F}));
    const std::vector<Birth> births(19'999, {{0.0F, 1e-7F, 0.0F}, glm::vec3(0.0F), 1000.0F, 0});
    particles.spawn(births);
    for (int step = 0; step < 1001; ++step) {
        particles.step(kDt);
    }
    const StatisticsSample gpu = sample(statistics, particles);
    EXPECT_EQ(gpu.collisions, 19'999ULL * 1001ULL);
    EXPECT_EQ(gpu.in_contact, 19'999U);
    EXPECT_EQ(gpu.energy, 0.0);
}

// Texels beyond the extent hold leftovers of the dead, and the ladder's those of times when more rows were in
// use: neither must count.
TEST_P(StatisticsGlTest, LeftoversDoNotCount) {
    ParticleSystem particles = makeParticles(40'000);
    Statistics statistics = makeStatistics(40'000);
    std::vector<Birth> births(10, {glm::vec3(0.0F), {1.0F, 0.0F, 0.0F}, 100.0F, 0});
    births.resize(30'000, {glm::vec3(0.0F), {1.0F, 0.0F, 0.0F}, 0.02F, 0});
    particles.spawn(births);
    for (int step = 0; step < 5; ++step) {
        particles.step(kDt);
        expectEqualsState(sample(statistics, particles), particles);
    }
    EXPECT_EQ(particles.extent(), 10U);
    EXPECT_EQ(sample(statistics, particles).energy, 5.0);
}

TEST_P(StatisticsGlTest, SamplesComeBackInOrderAndLate) {
    ParticleSystem particles = makeParticles(100);
    Statistics statistics = makeStatistics(100);
    EXPECT_FALSE(statistics.poll());
    EXPECT_TRUE(statistics.wait() && !*statistics.wait());
    const std::vector<Birth> births(1, {glm::vec3(0.0F), {2.0F, 0.0F, 0.0F}, 100.0F, 0});
    for (std::uint64_t tag = 0; tag < Statistics::kInFlightMax; ++tag) {
        ASSERT_TRUE(statistics.request(particles, tag));  // the first of nobody
        particles.spawn(births);
        particles.step(kDt);
    }
    EXPECT_FALSE(statistics.request(particles, 99)) << "the ring is full";
    EXPECT_EQ(statistics.inFlight(), Statistics::kInFlightMax);
    glFinish();
    for (std::uint64_t tag = 0; tag < Statistics::kInFlightMax; ++tag) {
        const auto one = statistics.poll();
        ASSERT_TRUE(one) << "the GPU has finished";
        EXPECT_EQ(one->tag, tag);
        EXPECT_EQ(one->alive, tag);
        EXPECT_EQ(one->energy, 2.0 * static_cast<double>(tag));
    }
    EXPECT_FALSE(statistics.poll());
}

TEST_P(StatisticsGlTest, WhatDoesNotFitIsRefused) {
    for (const std::uint32_t capacity : {0U, ParticleSystem::kCapacityMax + 1}) {
        const auto made = Statistics::create(capacity);
        ASSERT_FALSE(made);
        EXPECT_EQ(made.error().code, ErrorCode::kUsage);
    }
    Statistics statistics = makeStatistics(100);
    EXPECT_FALSE(statistics.request(makeParticles(101), 0));
    EXPECT_EQ(statistics.inFlight(), 0);
}

// The caller's framebuffer, program, buffers and switches; a switch that would keep a pass from drawing.
TEST_P(StatisticsGlTest, TheCallersStateIsKeptAndDoesNoHarm) {
    ParticleSystem particles = makeParticles(3000);
    Pcg32 random(3);
    particles.spawn(randomBirths(2000, random));
    particles.step(kDt);
    const GlBuffer buffer = makeBuffer();
    const GlVertexArray array = makeVertexArray();
    const GlTexture texture = makeTexture2D(GL_RGBA8, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer.name());
    glBindVertexArray(array.name());
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glEnable(GL_SCISSOR_TEST);
    glEnable(GL_RASTERIZER_DISCARD);
    glEnable(GL_BLEND);
    glScissor(0, 0, 0, 0);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glViewport(1, 2, 3, 4);
    glPixelStorei(GL_PACK_SKIP_ROWS, 5);
    const auto state = [] {
        std::vector<GLint> values;
        for (const GLenum what : {GL_CURRENT_PROGRAM, GL_VERTEX_ARRAY_BINDING, GL_PIXEL_PACK_BUFFER_BINDING,
                                  GL_VIEWPORT, GL_DRAW_FRAMEBUFFER_BINDING, GL_READ_FRAMEBUFFER_BINDING,
                                  GL_TEXTURE_BINDING_2D, GL_SCISSOR_TEST, GL_ACTIVE_TEXTURE,
                                  GL_RASTERIZER_DISCARD, GL_BLEND, GL_COLOR_WRITEMASK, GL_PACK_SKIP_ROWS}) {
            std::array<GLint, 4> some{};
            glGetIntegerv(what, some.data());
            values.insert(values.end(), some.begin(), some.end());
        }
        return values;
    };
    const auto before = state();
    Statistics statistics = makeStatistics(3000);
    EXPECT_EQ(state(), before) << "create";
    EXPECT_TRUE(statistics.request(particles, 7));
    EXPECT_EQ(state(), before) << "request";
    const auto one = statistics.wait();
    ASSERT_TRUE(one && *one);
    EXPECT_EQ(state(), before) << "wait";
    expectEqualsState(**one, particles);
}

TEST_P(StatisticsGlTest, StagesAreTimed) {
    ParticleSystem particles = makeParticles(100'000);
    Pcg32 random(5);
    particles.spawn(randomBirths(100'000, random));
    GpuTimer timer;
    constexpr int kSteps = 3 * GpuTimer::kQueries;  // more than the ring holds
    double outside = 0.0;
    for (int step = 0; step < kSteps; ++step) {
        const auto begun = std::chrono::steady_clock::now();
        {
            const StageScope scope(&timer, Stage::kStep);
            particles.step(1e-4F);
            if (step == 0) {
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
        }
        if (step % 16 == 0) {
            glFinish();
            static_cast<void>(timer.times());
        }
        outside +=
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
    }
    glFinish();
    const StageTime& step = timer.times()[static_cast<std::size_t>(Stage::kStep)];
    EXPECT_EQ(step.runs, static_cast<std::uint64_t>(kSteps));
    EXPECT_GE(step.cpu_ms, 5.0);
    EXPECT_LE(step.cpu_ms, outside);
    if (timer.measuresGpu()) {
        EXPECT_GT(step.gpu_runs, 0U);
        EXPECT_LE(step.gpu_runs, step.runs);
        EXPECT_GT(step.gpu_ms, 0.0);
    } else {
        EXPECT_EQ(step.gpu_runs, 0U);
    }
    EXPECT_EQ(timer.times()[static_cast<std::size_t>(Stage::kSort)].runs, 0U);
    RecordProperty("measures_gpu", timer.measuresGpu() ? "yes" : "no");
    RecordProperty("gpu_runs", std::to_string(step.gpu_runs));
    RecordProperty("gpu_ms", std::to_string(step.gpu_ms));
    RecordProperty("cpu_ms", std::to_string(step.cpu_ms));
    const StageScope nothing(nullptr, Stage::kDraw);  // no timer: no harm
}

// A query of the caller's own goes on, and the stage inside it is timed on the CPU.
TEST_P(StatisticsGlTest, TheCallersQueryIsLeftAlone) {
    GpuTimer timer;
    if (!timer.measuresGpu() || GetParam().api == GlApi::kGles30) {
        return;  // there is no such query to be in the way
    }
    GLuint query = 0;
    glGenQueries(1, &query);
    glBeginQuery(GL_TIME_ELAPSED, query);
    timer.begin(Stage::kDraw);
    timer.end();
    GLint current = 0;
    glGetQueryiv(GL_TIME_ELAPSED, GL_CURRENT_QUERY, &current);
    EXPECT_EQ(static_cast<GLuint>(current), query);
    glEndQuery(GL_TIME_ELAPSED);
    glDeleteQueries(1, &query);
    glFinish();
    const StageTime& draw = timer.times()[static_cast<std::size_t>(Stage::kDraw)];
    EXPECT_EQ(draw.runs, 1U);
    EXPECT_EQ(draw.gpu_runs, 0U);
}

}  // namespace

RELIEF_INSTANTIATE_STEP_TESTS(StatisticsGlTest);

}  // namespace relief
