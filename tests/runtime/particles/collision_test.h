// SPDX-License-Identifier: Apache-2.0
// A particle system with colliders, for collision tests.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <span>
#include <vector>

#include "runtime/bodies/world_textures.h"
#include "runtime/events/event_recorder.h"
#include "runtime/particles/particle_system.h"
#include "runtime/particles/random.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/particles/step_gl_test.h"

namespace relief {

inline constexpr float kDt = 1.0F / 60.0F;

inline glm::vec3 randomIn(Pcg32& random, const glm::vec3& low, const glm::vec3& high) {
    const float x = random.between(low.x, high.x);
    const float y = random.between(low.y, high.y);
    return {x, y, random.between(low.z, high.z)};
}
inline glm::vec3 randomIn(Pcg32& random, float half) {
    return randomIn(random, glm::vec3(-half), glm::vec3(half));
}

inline glm::quat turn(const glm::vec3& axis, float angle) {
    return glm::angleAxis(angle, glm::normalize(axis));
}

class CollisionTest : public StepGlTest {
  protected:
    void make(const ParticleSystemOptions& options) {
        particles_ = std::make_unique<ParticleSystem>(required(ParticleSystem::create(onPath(options))));
    }
    void collideWith(Result<WorldTextures> textures) {
        textures_ = std::make_unique<WorldTextures>(required(std::move(textures)));
        ASSERT_TRUE(particles_->setCollider(textures_.get()));
    }
    void collideWith(const Collider& collider) { collideWith(WorldTextures::create(collider)); }
    void collideWith(const ColliderBody& body) { collideWith(WorldTextures::create(std::span(&body, 1))); }
    void setType(const ParticleType& type) { ASSERT_TRUE(particles_->setTypes(std::span(&type, 1))); }
    void setPose(const Pose& pose) { textures_->setPoses(std::span(&pose, 1)); }
    [[nodiscard]] std::vector<ParticleState> state() const { return required(particles_->readState()); }
    /// Spawns particles created by `birth`.
    void spawnMany(std::uint32_t count, const std::function<Birth(std::uint32_t)>& birth) {
        std::vector<Birth> births;
        for (std::uint32_t i = 0; i < count; ++i) {
            births.push_back(birth(i));
        }
        ASSERT_EQ(particles_->spawn(births), count);
    }
    void spawnOne(const Birth& birth) { ASSERT_EQ(particles_->spawn(std::span(&birth, 1)), 1U); }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            ASSERT_TRUE(particles_->step(kDt));
        }
    }
    /// Requests and returns the events of the last step.
    StepEvents takeEvents(std::uint64_t tag = 0) {
        EXPECT_TRUE(requestEvents(*particles_, tag));
        return required(waitEvents(*particles_)).value();
    }

    std::unique_ptr<WorldTextures> textures_;
    std::unique_ptr<ParticleSystem> particles_;
};

inline Collider boxCollider() {
    return analytic::frontBackCollider(analytic::box({-0.4, -0.2, -0.3}, {0.4, 0.2, 0.3}), 96);
}

}  // namespace relief
