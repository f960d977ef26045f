// SPDX-License-Identifier: Apache-2.0
// The core of the runtime, linked without its layers: load, upload, step, births and one emitter need no layer.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "formats/container.h"
#include "runtime/relief.hpp"
#include "tests/formats/analytic_shapes.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief::test {
namespace {

constexpr double kRadius = 1.0;

/// A container as read from a file.
std::vector<std::byte> ballFile() {
    Collider ball = threeMaps(*makeSphere(glm::dvec3(0.0), kRadius), glm::dvec3(0.0), glm::dmat3(1.0), 1.05,
                              64, MapFormat::kFrontBackFixed, Decode::kPlane);
    ball.bounds = {glm::vec3(-1.0F), glm::vec3(1.0F)};
    return required(writeContainer(ball));
}

class CoreGlTest : public GlTest {};

// Snow falls on a ball. None of it ends inside, and all resting snow is on the surface.
TEST_P(CoreGlTest, SnowSettlesOnABall) {
    const Collider ball = required(readContainer(ballFile()));
    const auto textures = required(ColliderTextures::create(ball));
    auto particles = required(ParticleSystem::create({.capacity = 4096}));
    ASSERT_TRUE(particles.setCollider(&textures));
    ASSERT_TRUE(particles.setForces({.gravity = {0.0F, -9.8F, 0.0F}}));
    ASSERT_TRUE(particles.setSweep(0.1F));
    ASSERT_TRUE(particles.setType({.on_collision = OnCollision::kStop}));
    EmitterSettings sky;
    sky.box_min = {-0.7F, 1.5F, -0.7F};
    sky.box_max = {0.7F, 2.0F, 0.7F};
    sky.burst = 4096;
    sky.lifetime_min = sky.lifetime_max = 100.0F;
    Emitter emitter(sky, 1);
    std::vector<Birth> births;
    EXPECT_EQ(emitter.emit(1.0 / 60.0, particles.room(), births), 0U);
    EXPECT_EQ(required(particles.spawn(births)), 4096U);
    for (int i = 0; i < 90; ++i) {
        ASSERT_TRUE(particles.step(1.0F / 60.0F));
    }
    const std::vector<ParticleState> states = required(particles.readState());
    ASSERT_EQ(states.size(), 4096U);
    for (const ParticleState& state : states) {
        const double height = glm::length(glm::dvec3(state.position)) - kRadius;
        ASSERT_EQ(state.contact, Contact::kStopped);
        ASSERT_GT(state.position.y, 0.0F);
        // Outside by the CPU's vote, except for rounding. Texels at the ball's outline are empty if their centre misses
        // the ball; half their diagonal is 0.026. A sweep stops less than its length above the surface.
        ASSERT_GT(evaluate(ball, state.position).distance, -1e-5F);
        ASSERT_GT(height, -0.026);
        ASSERT_LT(height, 0.1);
    }
}

INSTANTIATE_TEST_SUITE_P(Apis, CoreGlTest, testing::Values(GlApi::kGl33Core, GlApi::kGles30), glApiTestName);

}  // namespace
}  // namespace relief::test
