// A particle system among colliders, for the tests of collision.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <vector>

#include "runtime/particles/particle_system.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/particles/step_gl_test.h"

namespace relief {

inline constexpr float kDt = 1.0F / 60.0F;

class CollisionTest : public StepGlTest {
  protected:
    void make(const ParticleSystemOptions& options) {
        auto made = ParticleSystem::create(onPath(options));
        ASSERT_TRUE(made) << made.error().message;
        particles_ = std::make_unique<ParticleSystem>(std::move(*made));
    }
    void collideWith(Result<ColliderTextures> textures) {
        ASSERT_TRUE(textures) << textures.error().message;
        textures_ = std::make_unique<ColliderTextures>(std::move(*textures));
        ASSERT_TRUE(particles_->setCollider(textures_.get()));
    }
    void setType(const ParticleType& type) { ASSERT_TRUE(particles_->setTypes(std::span(&type, 1))); }
    [[nodiscard]] std::vector<ParticleState> state() const {
        auto read = particles_->readState();
        EXPECT_TRUE(read);
        return read.value_or(std::vector<ParticleState>{});
    }
    void spawnOne(const Birth& birth) { ASSERT_EQ(particles_->spawn(std::span(&birth, 1)), 1U); }

    std::unique_ptr<ColliderTextures> textures_;
    std::unique_ptr<ParticleSystem> particles_;
};

inline Collider boxCollider() {
    return analytic::frontBackCollider(analytic::box({-0.4, -0.2, -0.3}, {0.4, 0.2, 0.3}), 96);
}

}  // namespace relief
