// Births on the GPU: those within a step lie where they would be had they been born one by one, and four
// million places fill, empty and fill again without a loss.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/particles/emitter.h"
#include "runtime/particles/particle_system.h"
#include "tests/runtime/particles/step_gl_test.h"

namespace relief {
namespace {

class BirthsGlTest : public StepGlTest {
  protected:
    static ParticleSystem makeSystem(std::uint32_t capacity) {
        auto made = ParticleSystem::create(onPath({.capacity = capacity}));
        EXPECT_TRUE(made) << made.error().message;
        return std::move(*made);
    }
    static std::vector<ParticleState> stateOf(const ParticleSystem& particles) {
        auto state = particles.readState();
        EXPECT_TRUE(state) << state.error().message;
        return state.value_or(std::vector<ParticleState>{});
    }
};

// A jet of one velocity without forces: n births a second lie v / n apart, across the ends of steps, too.
TEST_P(BirthsGlTest, AFastJetShowsNoBands) {
    for (const bool spread : {true, false}) {
        ParticleSystem particles = makeSystem(1000);
        EmitterSettings settings;
        settings.rate = 960.0;
        settings.velocity = {64.0F, 0.0F, 0.0F};
        settings.lifetime_min = settings.lifetime_max = 100.0F;
        settings.spread = spread;
        Emitter emitter(settings, 1);
        std::vector<Birth> births;
        for (int step = 0; step < 32; ++step) {
            births.clear();
            emitter.emit(1.0 / 32.0, particles.room(), births);
            particles.spawn(births);
            particles.step(1.0F / 32.0F);
        }
        const auto state = stateOf(particles);
        ASSERT_EQ(state.size(), 960U);
        std::vector<float> gaps;
        for (std::size_t i = 1; i < state.size(); ++i) {
            ASSERT_EQ(state[i].id, state[i - 1].id + 1);
            gaps.push_back(state[i - 1].position.x - state[i].position.x);
        }
        const auto [least, most] = std::minmax_element(gaps.begin(), gaps.end());
        const float even = 64.0F / 960.0F;
        if (spread) {
            EXPECT_NEAR(*least, even, 2e-4F);
            EXPECT_NEAR(*most, even, 2e-4F);
            // The last was born as the last step began, by its own clock.
            EXPECT_NEAR(state.back().age, 1.0F / 32.0F, 1e-5F);
            EXPECT_NEAR(state.front().age, 1.0F + 1.0F / 32.0F - 1.0F / 960.0F, 1e-5F);
        } else {
            EXPECT_EQ(*least, 0.0F);  // all of a step in one place, and then a gap
            EXPECT_NEAR(*most, 2.0F, 1e-4F);
        }
    }
}

// An age of a whole step is a whole step: under gravity, wind and drag it ends where one that was born a step
// earlier does, so that nothing shows where two steps meet. It dies by its age, too.
TEST_P(BirthsGlTest, AnAgeOfOneStepIsOneStep) {
    constexpr float kDt = 1.0F / 64.0F;
    ParticleSystem particles = makeSystem(4);
    EXPECT_TRUE(particles.setForces({{0.0F, -9.0F, 0.0F}, {5.0F, 0.0F, 1.0F}, 3.0F}));
    const std::vector<Birth> earlier{{{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}, 1.0F, 0, 0.0F}};
    const std::vector<Birth> aged{{{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}, 1.0F, 0, kDt}};
    particles.spawn(earlier);
    particles.step(kDt);
    particles.spawn(aged);
    for (int step = 1; step < 63; ++step) {
        particles.step(kDt);
    }
    const auto state = stateOf(particles);
    ASSERT_EQ(state.size(), 2U);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(state[0].position[axis], state[1].position[axis], 1e-5F);
        EXPECT_NEAR(state[0].velocity[axis], state[1].velocity[axis], 1e-5F);
    }
    EXPECT_GT(std::abs(state[0].position.y - 2.0F), 0.2F);  // it has moved
    EXPECT_EQ(state[0].age, state[1].age);
    EXPECT_EQ(state[1].lifetime, 1.0F);
    particles.step(kDt);
    EXPECT_EQ(particles.counts().alive, 0U);
    EXPECT_EQ(particles.counts().died, 2U);
}

// Every third particle dies in the first step. The next births take exactly the places of the dead, in
// ascending order, and everything else stays who it is.
TEST_P(BirthsGlTest, FourMillionPlacesFillEmptyAndFillAgain) {
    constexpr std::uint32_t kCapacity = 1U << 22;
    ParticleSystem particles = makeSystem(kCapacity);
    const auto dies = [](std::uint32_t index) { return index % 3 == 1; };
    std::uint32_t dead = 0;
    {
        std::vector<Birth> births(kCapacity + 10);
        for (std::uint32_t i = 0; i < kCapacity; ++i) {
            births[i].position.x = static_cast<float>(i);
            births[i].lifetime = dies(i) ? 0.01F : 1000.0F;
            dead += dies(i) ? 1 : 0;
        }
        ASSERT_EQ(particles.spawn(births), kCapacity);
    }
    EXPECT_EQ(particles.room(), 0U);
    particles.step(0.0625F);
    EXPECT_EQ(particles.counts().died, dead);
    EXPECT_EQ(particles.room(), dead);
    {
        const std::vector<Birth> births(dead, Birth{{-1.0F, 0.0F, 0.0F}, glm::vec3(0.0F), 1000.0F, 0, 0.0F});
        ASSERT_EQ(particles.spawn(births), dead);
    }
    particles.step(0.0625F);
    const ParticleCounts counts = particles.counts();
    EXPECT_EQ(counts.alive, kCapacity);
    EXPECT_EQ(counts.extent, kCapacity);
    EXPECT_EQ(counts.born, std::uint64_t{kCapacity} + dead);
    EXPECT_EQ(counts.refused, 10U);

    const auto raw = particles.readRaw();
    ASSERT_TRUE(raw) << raw.error().message;
    std::uint32_t next_id = kCapacity;
    for (std::uint32_t i = 0; i < kCapacity; ++i) {
        const std::uint32_t id = dies(i) ? next_id++ : i;
        ASSERT_EQ(raw->birth[4 * std::size_t{i} + 3], static_cast<float>(id)) << i;
        ASSERT_EQ(raw->position[4 * std::size_t{i}], dies(i) ? -1.0F : static_cast<float>(i)) << i;
        ASSERT_EQ(raw->position[4 * std::size_t{i} + 3], 0.0F) << i;
    }
}

RELIEF_INSTANTIATE_STEP_TESTS(BirthsGlTest);

}  // namespace
}  // namespace relief
