// The paths of a step: the same particles, whichever is taken, and the caller's image units as they were.
#include <gtest/gtest.h>

#include <vector>

#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/particle_system.h"
#include "runtime/particles/random.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/particles/collision_test.h"

namespace relief {
namespace {

constexpr std::uint32_t kParticles = 3000;

/// What a step is compiled for.
struct Features {
    const char* name;
    Integrator integrator = Integrator::kEuler;
    bool collider = true;
    float radius = 0.0F;
    float sweep = 0.0F;
    bool air = false;
};

class StepPathGlTest : public GlTest {
  protected:
    /// Particles that are born in two goes, collide and die.
    static std::vector<ParticleState> played(const Features& features, StepPath path, int steps) {
        auto textures = ColliderTextures::create(boxCollider());
        EXPECT_TRUE(textures);
        auto made = ParticleSystem::create({.capacity = kParticles + 100,
                                            .integrator = features.integrator,
                                            .epoch_seconds = 0.3,
                                            .path = path});
        EXPECT_TRUE(made) << made.error().message;
        ParticleSystem& particles = *made;
        EXPECT_EQ(particles.path(), path);
        particles.setForces({{0.1F, -3.0F, 0.0F}, {0.4F, 0.0F, -0.3F}, 0.5F});
        particles.setGround(-0.19F);  // above some: they touch it in the first step
        ParticleType type;
        type.restitution = 0.5F;
        type.friction = 0.2F;
        type.radius = features.radius;
        EXPECT_TRUE(particles.setTypes(std::span(&type, 1)));
        EXPECT_TRUE(particles.setSweep(features.sweep));
        if (features.air) {
            AirSettings air;
            air.curl_noise = CurlNoise{.amplitude = 0.5F, .scale = 0.4F, .octaves = 2, .drift = 0.1F};
            EXPECT_TRUE(particles.setAir(air));
        }
        if (features.collider) {
            EXPECT_TRUE(particles.setCollider(&*textures));
        }
        Pcg32 random(5);
        std::vector<Birth> births;
        for (std::uint32_t i = 0; i < kParticles; ++i) {
            births.push_back(
                {{random.between(-0.8F, 0.8F), random.between(-0.2F, 0.8F), random.between(-0.8F, 0.8F)},
                 {random.between(-1.0F, 1.0F), random.between(-3.0F, 0.0F), random.between(-1.0F, 1.0F)},
                 random.between(0.2F, 2.0F),
                 0});
        }
        const auto half = static_cast<std::ptrdiff_t>(kParticles / 2);
        particles.spawn({births.begin(), births.begin() + half});
        for (int i = 0; i < steps; ++i) {
            if (i == steps / 2) {
                particles.spawn({births.begin() + half, births.end()});
            }
            particles.step(kDt);
        }
        auto state = particles.readState();
        EXPECT_TRUE(state);
        return state.value_or(std::vector<ParticleState>{});
    }
};

constexpr Features kAll[] = {
    {"nothing solid", Integrator::kEuler, false},
    {"a collider"},
    {"Verlet", Integrator::kVerlet},
    {"a radius", Integrator::kEuler, true, 0.03F},
    {"swept", Integrator::kEuler, true, 0.0F, 0.02F},
    {"swept Verlet with a radius, in moving air", Integrator::kVerlet, true, 0.02F, 0.05F, true},
};

// One processor runs both paths of a software renderer with the same arithmetic: bit by bit. A GPU may fuse other
// operations in a compute shader: a step from the same births is within the CPU reference's tolerance
// (particle_system_gl_test.cpp), but for one in a thousand, where a decision hangs by a hair.
TEST_P(StepPathGlTest, BothPathsGiveTheSameParticles) {
    const bool bits = context_->software();
    const int steps = bits ? 40 : 2;
    for (const Features& features : kAll) {
        SCOPED_TRACE(features.name);
        const std::vector<ParticleState> fragment = played(features, StepPath::kFragment, steps);
        const std::vector<ParticleState> compute = played(features, StepPath::kCompute, steps);
        ASSERT_EQ(fragment.size(), compute.size());
        ASSERT_GT(fragment.size(), kParticles / 4);
        std::size_t others = 0;
        std::size_t touched = 0;
        for (std::size_t i = 0; i < fragment.size(); ++i) {
            const ParticleState& a = fragment[i];
            const ParticleState& b = compute[i];
            ASSERT_EQ(a.id, b.id);
            touched += a.collisions > 0 ? 1 : 0;
            const float far =
                std::max(glm::length(a.position - b.position), glm::length(a.velocity - b.velocity));
            const bool same = bits ? far == 0.0F && a.collisions == b.collisions && a.contact == b.contact &&
                                         a.age == b.age && a.lifetime == b.lifetime
                                   : far < 4e-6F;
            others += same ? 0 : 1;
        }
        EXPECT_LE(others, bits ? 0 : fragment.size() / 1000);
        EXPECT_GT(touched, 0U);
    }
}

TEST_P(StepPathGlTest, AutoTakesComputeWhereAGpuDraws) {
    const auto particles = ParticleSystem::create({.capacity = 10});
    ASSERT_TRUE(particles);
    EXPECT_EQ(particles->path(), context_->software() ? StepPath::kFragment : StepPath::kCompute);
}

// More than a dispatch of births takes, on texels in disorder: the short lives of the first go are over.
TEST_P(StepPathGlTest, ManyBirthsAtOnceAreTheSame) {
    constexpr std::uint32_t kMany = 300'000;
    std::vector<std::vector<ParticleState>> states;
    for (const StepPath path : {StepPath::kFragment, StepPath::kCompute}) {
        auto particles = ParticleSystem::create({.capacity = kMany, .path = path});
        ASSERT_TRUE(particles) << particles.error().message;
        Pcg32 random(7);
        for (const bool lasting : {false, true}) {
            std::vector<Birth> births(kMany);
            for (Birth& birth : births) {
                birth.position = {random.uniform(), random.uniform(), random.uniform()};
                birth.velocity = {random.uniform(), 0.0F, random.uniform()};
                birth.lifetime = lasting || random.next() % 2 == 0 ? 10.0F : kDt;
                birth.type = random.next() % 3;
            }
            EXPECT_EQ(particles->spawn(births) == kMany, !lasting);
            particles->step(2.0F * kDt);
        }
        auto state = particles->readState();
        ASSERT_TRUE(state);
        states.push_back(std::move(*state));
    }
    ASSERT_EQ(states[0].size(), kMany);
    ASSERT_EQ(states[1].size(), kMany);
    for (std::uint32_t i = 0; i < kMany; ++i) {
        const ParticleState& a = states[0][i];
        const ParticleState& b = states[1][i];
        ASSERT_EQ(a.id, b.id);
        ASSERT_EQ(a.type, b.type);
        ASSERT_EQ(a.age, b.age);
        ASSERT_EQ(a.lifetime, b.lifetime);
        ASSERT_LT(glm::length(a.position - b.position), context_->software() ? 1e-30F : 1e-6F);
        ASSERT_LT(glm::length(a.velocity - b.velocity), context_->software() ? 1e-30F : 1e-6F);
    }
}

TEST_P(StepPathGlTest, TheCallersImageAndStorageUnitsAreKept) {
    const GlTexture mine = makeImageTexture2D(GL_R32F, 4, 4);
    glBindImageTexture(0, mine.name(), 0, GL_FALSE, 0, GL_READ_ONLY, GL_R32F);
    glBindImageTexture(2, mine.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32F);
    const GlBuffer storage = makeBuffer();
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, storage.name());
    glBufferData(GL_SHADER_STORAGE_BUFFER, 1024, nullptr, GL_STATIC_DRAW);
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 0, storage.name(), 256, 512);
    auto particles = ParticleSystem::create({.capacity = 10, .path = StepPath::kCompute});
    ASSERT_TRUE(particles);
    const Birth birth{{0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 0.0F}, 10.0F, 0};
    particles->spawn(std::span(&birth, 1));
    particles->step(kDt);
    const auto unit = [](GLenum what, GLuint index) {
        GLint value = -1;
        glGetIntegeri_v(what, index, &value);
        return value;
    };
    EXPECT_EQ(unit(GL_IMAGE_BINDING_NAME, 0), static_cast<GLint>(mine.name()));
    EXPECT_EQ(unit(GL_IMAGE_BINDING_ACCESS, 0), GL_READ_ONLY);
    EXPECT_EQ(unit(GL_IMAGE_BINDING_FORMAT, 0), GL_R32F);
    EXPECT_EQ(unit(GL_IMAGE_BINDING_NAME, 1), 0);
    EXPECT_EQ(unit(GL_IMAGE_BINDING_NAME, 2), static_cast<GLint>(mine.name()));
    EXPECT_EQ(unit(GL_IMAGE_BINDING_ACCESS, 2), GL_READ_WRITE);
    EXPECT_EQ(unit(GL_SHADER_STORAGE_BUFFER_BINDING, 0), static_cast<GLint>(storage.name()));
    EXPECT_EQ(unit(GL_SHADER_STORAGE_BUFFER_START, 0), 256);
    EXPECT_EQ(unit(GL_SHADER_STORAGE_BUFFER_SIZE, 0), 512);
}

RELIEF_INSTANTIATE_GL_TESTS(StepPathGlTest);

}  // namespace
}  // namespace relief
