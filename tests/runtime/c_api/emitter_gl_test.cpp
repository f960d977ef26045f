// SPDX-License-Identifier: Apache-2.0
// Births on the surfaces of an animated collider and a static collider through the C API; and the handle table.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>
#include <string>
#include <vector>

#include "formats/container.h"
#include "runtime/c_api/call.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/runtime/c_api/stage.h"

namespace relief::c_api {
namespace {

class CApiEmitter : public testing::Test {
  protected:
    void TearDown() override { EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)); }

    /// Particles without gravity. The options are those of an emitter that emits `burst` particles once, which inherit
    /// the velocity of the surface.
    relief_particles* particlesOf(std::uint32_t burst) {
        stage_.options.capacity = 2 * burst;
        stage_.options.gravity[1] = 0.0F;
        options_.rate = 0.0F;
        options_.burst = burst;
        options_.inherit = 1.0F;
        options_.lifetime_min = options_.lifetime_max = 100.0F;
        return relief_particles_create(nullptr, &stage_.options);
    }

    static constexpr float kDt = 0.02F;
    Stage stage_;
    relief_emitter_options& options_ = stage_.emitter_options;
};

// Sparks from the group of the upper joint of a character that bends and moves.
TEST_F(CApiEmitter, BirthsLieOnAnAnimatedCollider) {
    relief_particles* particles = particlesOf(1000);
    options_.type = 7;
    options_.seed = 3;
    relief_emitter* emitter = relief_emitter_create(stage_.animation, "middle", "cloth", &options_);
    ASSERT_NE(emitter, nullptr) << relief_error();
    const std::uint32_t body = 0;
    for (int step = 0; step <= 5; ++step) {
        const double time = double{kDt} * step;
        const relief_pose place{{static_cast<float>(2.0 * time), 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F, 1.0F}};
        ASSERT_EQ(relief_textures_set_clip(stage_.animated_textures, body, "bend", time), 0)
            << relief_error();
        ASSERT_EQ(relief_textures_set_poses(stage_.animated_textures, &body, &place, 1), 0);
    }
    ASSERT_EQ(relief_particles_emit(particles, emitter, stage_.animated_textures, body, kDt), 1000)
        << relief_error();
    EXPECT_EQ(relief_particles_emit(particles, emitter, stage_.animated_textures, body, kDt), 0)
        << "one burst";
    ASSERT_EQ(relief_particles_step(particles, kDt), 0);
    std::vector<relief_particle> sparks(1000);
    ASSERT_EQ(relief_particles_read(particles, sparks.data(), sparks.size()), 1000);
    for (const relief_particle& spark : sparks) {
        EXPECT_EQ(spark.type, 7U);
        // The upper half rotates towards -x about height 1: ω × r at its end, plus the body's velocity.
        const double up = spark.position[1] - kDt * spark.velocity[1] - 1.0;
        EXPECT_GT(up, -1.0 / 3.0 - 0.05) << "outside the triangles of the group";
        EXPECT_NEAR(spark.velocity[0], 2.0 - std::acos(0.0) * up, up < 0.34 ? 1.0 : 0.01);
    }
    relief_emitter_free(emitter);
    relief_particles_free(particles);
}

// Dust from a rotated box that moves: on its faces, with the body's velocity.
TEST_F(CApiEmitter, BirthsLieOnACollider) {
    constexpr int kCount = 4000;
    relief_particles* particles = particlesOf(kCount);
    relief_emitter* emitter = relief_emitter_create_on(stage_.collider, "cloth", &options_);
    ASSERT_NE(emitter, nullptr) << relief_error();
    EXPECT_EQ(relief_particles_emit(particles, emitter, stage_.textures, 1, kDt), -1);
    expectError("body is 1");
    const std::uint32_t body = 1;
    relief_pose place{{1.0F, 2.0F, 3.0F}, {0.0F, 0.6F, 0.0F, 0.8F}};
    ASSERT_EQ(relief_textures_set_poses(stage_.world_textures, &body, &place, 1), 0);
    place.position[0] += 0.5F * kDt;
    ASSERT_EQ(relief_textures_set_poses(stage_.world_textures, &body, &place, 1), 0);
    ASSERT_EQ(relief_particles_emit(particles, emitter, stage_.world_textures, body, kDt), kCount)
        << relief_error();
    ASSERT_EQ(relief_particles_step(particles, kDt), 0);
    std::vector<relief_particle> dust(kCount);
    ASSERT_EQ(relief_particles_read(particles, dust.data(), dust.size()), kCount);
    const glm::dvec3 half(0.4, 0.2, 0.3);
    const glm::dquat turned(0.8, 0.0, 0.6, 0.0);
    for (const relief_particle& one : dust) {
        EXPECT_NEAR(one.velocity[0], 0.5, 1e-4);
        EXPECT_LT(std::hypot(one.velocity[1], one.velocity[2]), 1e-4);
        const glm::dvec3 moved(place.position[0] + 0.5 * double{kDt}, place.position[1], place.position[2]);
        const glm::dvec3 p = glm::conjugate(turned) *
                             (glm::dvec3(one.position[0], one.position[1], one.position[2]) - moved) /
                             2.0;  // the scale of the body
        double off = 1.0;
        for (int i = 0; i < 3; ++i) {
            off = std::min(off, std::abs(std::abs(p[i]) - half[i]));
        }
        EXPECT_LT(off, 1e-3);
    }
    // In textures of a single collider, the surface lies in object space.
    relief_emitter* again = relief_emitter_create_on(stage_.collider, nullptr, &options_);
    EXPECT_EQ(relief_particles_emit(particles, again, stage_.textures, 0, kDt), kCount);
    relief_emitter_free(again);
    relief_emitter_free(emitter);
    relief_particles_free(particles);
    EXPECT_EQ(relief_emitter_create_on(stage_.collider, "oak", &options_), nullptr);
    expectError("material: ");
}

TEST_F(CApiEmitter, EmitterErrorsAreNamed) {
    const auto refused = [&](const char* group, const char* material, const std::string& what) {
        EXPECT_EQ(relief_emitter_create(stage_.animation, group, material, &options_), nullptr) << what;
        expectError("relief_emitter_create(): " + what);
        stage_.fill();
    };
    refused("Head", nullptr, "group: ");
    refused("", nullptr, "group: ");
    refused(nullptr, "skin", "material: ");
    options_.speed_min = 2.0F;
    refused(nullptr, nullptr, "options->speed_min");
    options_.lifetime_max = 0.5F;
    refused(nullptr, nullptr, "options->lifetime_min");
    options_.rate = 0.0F;
    refused(nullptr, nullptr, "options->rate");
    options_.rate = 1.0F;

    Collider other = loadCollider(stage_.good<const char*>("path")).value();
    other.animation = writeAnimatedMesh(bendingTube(9, 6));
    const std::vector<std::byte> bytes = writeContainer(other).value();
    relief_collider* collider = relief_collider_read(bytes.data(), bytes.size());
    relief_animation* animation = relief_animation_create(collider);
    relief_emitter* emitter = relief_emitter_create(animation, nullptr, nullptr, &options_);
    ASSERT_NE(emitter, nullptr) << relief_error();
    EXPECT_EQ(relief_particles_emit(stage_.particles, emitter, stage_.animated_textures, 0, 1.0F), -1);
    expectError("emitter has ");
    relief_emitter* own = relief_emitter_create(stage_.animation, nullptr, nullptr, &options_);
    EXPECT_EQ(relief_particles_emit(stage_.particles, own, stage_.world_textures, 0, 1.0F), -1);
    expectError("body is 0");
    // A step with a tiny dt is valid, and gives no infinite numbers.
    EXPECT_GE(relief_particles_emit(stage_.particles, own, stage_.animated_textures, 0, 1e-40F), 0)
        << relief_error();
    relief_emitter_free(own);
    relief_emitter_free(emitter);
    relief_animation_free(animation);
    relief_collider_free(collider);
}

TEST(Handles, AreUniqueAndStayFreed) {
    HandleTable table;
    std::set<std::uintptr_t> all;
    std::vector<std::uintptr_t> live;
    // More than a few blocks at once, then thousands of handles that reuse a few slots.
    for (int i = 0; i < 1000; ++i) {
        live.push_back(table.add(HandleKind::kCollider, std::make_shared<int>(i)));
    }
    all.insert(live.begin(), live.end());
    for (int i = 0; i < 20'000; ++i) {
        const auto at = static_cast<std::size_t>(i % 7);
        const std::uintptr_t old = live[at];
        EXPECT_NE(table.remove(HandleKind::kCollider, old), nullptr);
        EXPECT_EQ(table.remove(HandleKind::kCollider, old), nullptr);
        live[at] =
            table.add(i % 2 == 0 ? HandleKind::kParticles : HandleKind::kCollider, std::make_shared<int>(i));
        EXPECT_TRUE(all.insert(live[at]).second) << "handle was reused";
        if (i % 2 == 0) {
            EXPECT_EQ(table.find(HandleKind::kCollider, live[at]), nullptr);
            EXPECT_NE(table.remove(HandleKind::kParticles, live[at]), nullptr);
            live[at] = table.add(HandleKind::kCollider, std::make_shared<int>(i));
            all.insert(live[at]);
        }
        EXPECT_EQ(table.find(HandleKind::kCollider, old), nullptr);
    }
    for (std::size_t i = 7; i < live.size(); ++i) {
        ASSERT_NE(table.find(HandleKind::kCollider, live[i]), nullptr);
        EXPECT_EQ(*static_cast<int*>(table.find(HandleKind::kCollider, live[i])->get()), static_cast<int>(i));
    }
    for (const std::uintptr_t one : all) {
        EXPECT_NE(one & 7U, 0U) << "could be confused with an aligned pointer";
    }
}

TEST(Call, CatchesExceptions) {
    const std::uint64_t before = callErrors().count();
    EXPECT_EQ(answer("f", -1, [](const Call&) -> Result<int> { throw std::bad_alloc(); }), -1);
    EXPECT_STREQ(callErrors().last(), "out of memory");
    EXPECT_EQ(answer("f", -1, [](const Call&) -> Result<int> { throw std::runtime_error("two\nlines"); }),
              -1);
    EXPECT_STREQ(callErrors().last(), "two lines");
    EXPECT_EQ(answer("f", -1, [](const Call&) -> Result<int> { throw 7; }), -1);
    EXPECT_STREQ(callErrors().last(), "an unknown error");
    EXPECT_EQ(callErrors().count(), before + 3);
}

}  // namespace
}  // namespace relief::c_api
