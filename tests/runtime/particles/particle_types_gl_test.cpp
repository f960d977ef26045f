// What a type alone decides: how gravity acts on it, and which bodies it meets.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "tests/runtime/particles/collision_test.h"

namespace relief {
namespace {

class ParticleTypesGlTest : public CollisionTest {
  protected:
    /// One particle of each type at a place, at rest.
    void spawnEach(std::size_t types, const glm::vec3& place, float age = 0.0F) {
        std::vector<Birth> births;
        for (std::size_t i = 0; i < types; ++i) {
            births.push_back({place, glm::vec3(0.0F), 1000.0F, static_cast<std::uint32_t>(i), age});
        }
        ASSERT_EQ(particles_->spawn(births), types);
    }
    [[nodiscard]] std::vector<float> heights() const {
        std::vector<float> y;
        for (const ParticleState& particle : state()) {
            y.push_back(particle.position.y);
        }
        return y;
    }
};

// Euler from rest: dt² g n (n + 1) / 2 after n steps, times the type's factor; so in the free flight before the first.
TEST_P(ParticleTypesGlTest, GravityIsScaled) {
    const std::array<float, 5> factors{1.0F, 0.0F, -0.5F, 2.0F, 1000.0F};
    std::vector<ParticleType> types(factors.size());
    for (std::size_t i = 0; i < types.size(); ++i) {
        types[i].gravity = factors[i];
    }
    struct Case {
        Integrator integrator;
        float age;
        int steps;
    };
    for (const auto& [integrator, age, steps] :
         {Case{Integrator::kEuler, 0.0F, 30}, Case{Integrator::kVerlet, 0.0F, 30},
          Case{Integrator::kEuler, 0.5F, 1}}) {
        make({.capacity = 16, .integrator = integrator});
        ASSERT_TRUE(particles_->setTypes(types));
        EXPECT_TRUE(particles_->setForces({{0.0F, -8.0F, 0.0F}, {}, 0.0F, 0.0F}));
        spawnEach(types.size(), glm::vec3(0.0F), age);
        step(steps);
        const std::vector<ParticleState> all = state();
        ASSERT_EQ(all.size(), types.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            const float acceleration = -8.0F * factors[i];
            const auto n = static_cast<float>(steps);
            EXPECT_NEAR(all[i].velocity.y, acceleration * (age + n * kDt),
                        2e-3F * std::abs(factors[i]) + 1e-6F);
            const float way = acceleration * kDt * kDt * n * (n + 1.0F) / 2.0F;
            if (age == 0.0F) {
                EXPECT_NEAR(all[i].position.y, way, 1e-4F * std::max(1.0F, std::abs(way))) << factors[i];
            }
        }
    }
}

// One collider in its own space, and the floor: each type stops at what it collides with.
TEST_P(ParticleTypesGlTest, ATypeGoesThroughWhatItDoesNotCollideWith) {
    std::vector<ParticleType> types(4);
    types[1].collides = kCollidesWithGround;
    types[2].collides = 1;
    types[3].collides = 0;
    const Collider box = boxCollider();
    for (const float radius : {0.0F, 0.05F}) {
        for (const float sweep : {0.0F, 0.02F}) {
            make({.capacity = 16});
            collideWith(box);
            for (ParticleType& type : types) {
                type.radius = radius;
                type.friction = 1.0F;
            }
            ASSERT_TRUE(particles_->setTypes(types));
            ASSERT_TRUE(particles_->setSweep(sweep));
            EXPECT_TRUE(particles_->setForces({{0.0F, -9.81F, 0.0F}, {}, 0.0F}));
            EXPECT_TRUE(particles_->setGround(-1.0F));
            spawnEach(4, {0.1F, 0.5F, 0.0F});   // above the box
            spawnEach(4, {2.0F, 0.5F, 0.0F});   // beside it
            spawnEach(4, {0.1F, 0.0F, 0.05F});  // in it
            step(120);
            const float top = 0.2F + radius;
            const float ground = -1.0F + radius;
            constexpr float kFalls = -5.0F;
            constexpr float kAny = 0.0F;
            // What is inside of a body that it does not meet is not caught.
            const std::array<float, 12> wanted{top,    ground, top,  kFalls, ground, ground,
                                               kFalls, kFalls, kAny, ground, kAny,   kFalls};
            const std::vector<float> y = heights();
            ASSERT_EQ(y.size(), wanted.size());
            for (std::size_t i = 0; i < y.size(); ++i) {
                const float off =
                    wanted[i] == kFalls ? std::max(y[i] - kFalls, 0.0F) : std::abs(y[i] - wanted[i]);
                EXPECT_TRUE(off < 0.1F || wanted[i] == kAny) << i << " at " << y[i];
            }
        }
    }
}

// Three shelves above each other, and a mask for each of their sets: what falls stops at the highest of its own.
TEST_P(ParticleTypesGlTest, MasksOfSeveralBodies) {
    const Collider box = boxCollider();
    std::vector<ColliderBody> bodies;
    for (const float height : {2.0F, 1.0F, 0.0F}) {
        bodies.push_back({&box, {{0.0F, height, 0.0F}}});
    }
    std::vector<ParticleType> types(8);
    for (std::uint32_t i = 0; i < 8; ++i) {
        types[i].collides = i;
        types[i].friction = 1.0F;
        types[i].on_collision = i % 2 == 0 ? OnCollision::kStop : OnCollision::kBounce;
    }
    make({.capacity = 16});
    collideWith(ColliderTextures::create(bodies));
    ASSERT_TRUE(particles_->setTypes(types));
    EXPECT_TRUE(particles_->setForces({{0.0F, -9.81F, 0.0F}, {}, 0.0F}));
    EXPECT_TRUE(particles_->setGround(-1.0F));  // nobody's
    spawnEach(8, {0.1F, 2.5F, 0.0F});
    step(150);
    const std::vector<float> y = heights();
    ASSERT_EQ(y.size(), 8U);
    EXPECT_LT(y[0], -5.0F);
    for (std::uint32_t i = 1; i < 8; ++i) {
        const float top = (i & 1U) != 0 ? 2.0F : (i & 2U) != 0 ? 1.0F : 0.0F;
        EXPECT_NEAR(y[i], top + 0.2F, 0.12F) << i;
    }
}

// A run that begins before time 0: its clock shows it, and no particle notices.
TEST_P(ParticleTypesGlTest, ARunMayBeginBeforeTimeZero) {
    std::vector<ParticleState> of[2];
    for (const double start : {0.0, -2.0}) {
        make({.capacity = 16, .epoch_seconds = 0.5, .start_time = start});
        EXPECT_EQ(particles_->time(), start);
        EXPECT_TRUE(particles_->setForces({{0.0F, -9.81F, 0.0F}, {}, 0.5F}));
        spawnOne({{}, {1.0F, 0.0F, 0.0F}, 1.5F, 0});
        step(60);
        EXPECT_NEAR(particles_->time(), start + 1.0, 1e-6);
        of[start < 0.0 ? 1 : 0] = state();
        step(31);
        EXPECT_TRUE(state().empty()) << "it lives for a second and a half";
    }
    ASSERT_EQ(of[0].size(), 1U);
    EXPECT_EQ(of[0][0].position, of[1][0].position);
    EXPECT_NEAR(of[0][0].age, of[1][0].age, 1e-6F);
}

}  // namespace

RELIEF_INSTANTIATE_STEP_TESTS(ParticleTypesGlTest);

}  // namespace relief
