// SPDX-License-Identifier: Apache-2.0
// Colliders animated by clips: vertices and fields against the CPU's poses, and the velocity of surfaces that hit
// particles. Also the wobble by transform feedback against its formula.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/glm.hpp>
#include <iostream>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "formats/container.h"
#include "runtime/bodies/world_textures.h"
#include "runtime/gl/buffer_read.h"
#include "runtime/live/animated_collider.h"
#include "runtime/live/wobble_pass.h"
#include "runtime/particles/random.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/runtime/collider/field_query.h"
#include "tests/runtime/gl/caller_state.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/runtime/particles/collision_test.h"

namespace relief::test {
namespace {

using SharedMesh = std::shared_ptr<const AnimatedMesh>;

SharedMesh shared(AnimatedMesh mesh) {
    return std::make_shared<const AnimatedMesh>(std::move(mesh));
}

MeshPose clipPose(const AnimatedMesh& mesh, const char* clip, double seconds) {
    return poseAt(mesh, mesh.clips.at(*findClip(mesh, clip)), seconds);
}

std::vector<glm::vec3> readVertices(const SkinPass& pass) {
    std::vector<glm::vec3> vertices(pass.bytes() / sizeof(glm::vec3));
    EXPECT_TRUE(readBuffer(pass.buffer(), 0, std::as_writable_bytes(std::span(vertices))));
    return vertices;
}

class AnimatedColliderGlTest : public CollisionTest {
  protected:
    void makeAnimated(const SharedMesh& mesh, const Pose& pose = {},
                      const AnimatedColliderOptions& options = {}) {
        animated_.emplace(required(AnimatedCollider::create(mesh, options)));
        pose_ = pose;
        const ColliderBody body{
            .collider = &animated_->frames(), .pose = animated_->placed(pose), .live = true};
        auto textures = required(WorldTextures::create(std::span(&body, 1)));
        textures_ = std::make_unique<WorldTextures>(std::move(textures));
        show();
    }
    void show() {
        setPose(animated_->placed(pose_));
        const Result<void> done = animated_->update(*textures_, 0);
        ASSERT_TRUE(done) << done.error().message;
    }
    void showPose(const MeshPose& pose) {
        const Result<void> set = animated_->setPose(pose);
        ASSERT_TRUE(set) << set.error().message;
        show();
    }
    /// Shows a pose.
    /// \return the fraction of wrong points near its mesh.
    double wrongFraction(const MeshPose& pose, std::size_t count) {
        showPose(pose);
        const std::vector<glm::uvec3>& triangles = animated_->mesh().triangles;
        const std::vector<glm::vec3> positions = posed(animated_->mesh(), pose);
        Bounds box;
        for (const glm::vec3& p : positions) {
            box.add(p);
        }
        const std::vector<glm::vec3> points = pointsNear(positions, triangles, count, box.longestSide(), 7);
        std::vector<glm::vec3> world;
        for (const glm::vec3& p : points) {
            world.push_back(toWorld(pose_, p));
        }
        const std::vector<FieldSample> samples = fieldOf(*textures_, world);
        std::size_t wrong = 0;
        std::size_t inside = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const bool truth = windingNumber(positions, triangles, points[i]) > 0.5;
            wrong += samples[i].inside() == truth ? 0 : 1;
            inside += truth ? 1 : 0;
        }
        EXPECT_GT(inside, count / 4);
        EXPECT_LT(inside, count * 3 / 4);
        return static_cast<double>(wrong) / static_cast<double>(count);
    }
    /// A particle, initially at rest, after a box animated by a clip has hit it.
    ParticleState hitBy(const char* clip, const glm::vec3& half, const glm::vec3& position,
                        const ParticleType& type) {
        makeAnimated(shared(movingBox(half)));
        make({.capacity = 16});
        setType(type);
        EXPECT_TRUE(particles_->setCollider(textures_.get()));
        spawnOne({position, glm::vec3(0.0F), 100.0F, 0});
        for (int step = 1; step <= 12 && (step == 1 || state().at(0).collisions == 0); ++step) {
            showPose(clipPose(animated_->mesh(), clip, static_cast<double>(static_cast<float>(step) * kDt)));
            particles_->step(kDt);
        }
        EXPECT_EQ(state().at(0).contact, Contact::kCollided);
        return state().at(0);
    }
    std::optional<AnimatedCollider> animated_;
    Pose pose_;
};
RELIEF_INSTANTIATE_STEP_TESTS(AnimatedColliderGlTest);

TEST_P(AnimatedColliderGlTest, VerticesMatchTheCpu) {
    const AnimatedMesh mesh = bendingTube(24, 200);
    std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0F, 1.0F, 0.0F));
    auto pass = SkinPass::create(mesh);
    auto with_normals = SkinPass::create(mesh, normals);
    ASSERT_TRUE(pass && with_normals);
    const glm::vec3 origin(0.25F, -1.0F, 2.0F);
    for (const MeshClip& clip : mesh.clips) {
        for (const double time : {0.0, 0.37, 0.9}) {
            const MeshPose pose = poseAt(mesh, clip, time);
            const std::vector<glm::vec3> cpu = posed(mesh, pose);
            pass->run(pose, origin);
            with_normals->run(pose);
            const std::vector<glm::vec3> gpu = readVertices(*pass);
            const std::vector<glm::vec3> pairs = readVertices(*with_normals);
            ASSERT_EQ(gpu.size(), cpu.size());
            ASSERT_EQ(pairs.size(), 2 * cpu.size());
            for (std::size_t i = 0; i < cpu.size(); ++i) {
                ASSERT_LE(glm::length(gpu[i] + origin - cpu[i]), 2e-6F)
                    << clip.name << " " << time << " " << i;
                ASSERT_LE(glm::length(pairs[2 * i] - cpu[i]), 2e-6F) << i;
            }
            // The ends of the tube rotate with their joints.
            const auto angle = static_cast<float>(clip.name == "bend" ? time * std::acos(0.0) : 0.0);
            EXPECT_LE(glm::length(pairs.back() - glm::vec3(-std::sin(angle), std::cos(angle), 0.0F)), 1e-5F);
            EXPECT_LE(glm::length(pairs[1] - glm::vec3(0, 1, 0)), 1e-5F);
        }
    }
}

// Against the winding number of the posed triangles, including points far outside the rest box. RELIEF_ANIMATED names a
// container to test instead: every frame of every clip, at 30 frames per second.
TEST_P(AnimatedColliderGlTest, InsideMatchesThePosedMesh) {
    const Pose body{{3.0F, -1.0F, 0.5F}, glm::angleAxis(0.7F, glm::normalize(glm::vec3(1, 2, 3))), 1.5F};
    // The tube is 1/25 of the box thick, and half a texel is lost at its silhouettes.
    makeAnimated(shared(bendingTube()), body, {.resolution = 768, .box_size = {}});
    EXPECT_LE(wrongFraction(clipPose(animated_->mesh(), "bend", 0.31), 3000), 0.02);
    EXPECT_LE(wrongFraction(clipPose(animated_->mesh(), "grow", 1.0), 3000), 0.02);
    const char* const file = std::getenv("RELIEF_ANIMATED");
    if (file == nullptr) {
        return;
    }
    makeAnimated(shared(required(readAnimatedMesh(required(loadCollider(file)).animation))), body);
    for (const MeshClip& clip : animated_->mesh().clips) {
        double worst = 0.0;
        for (int frame = 0; frame <= static_cast<int>(30.0F * clip.seconds); ++frame) {
            worst = std::max(worst, wrongFraction(poseAt(animated_->mesh(), clip, frame / 30.0), 1000));
        }
        std::cout << clip.name << ": the worst frame has " << 100.0 * worst << " % wrong points\n";
        EXPECT_LE(worst, 0.02) << clip.name;
    }
}

// Closed forms. A box moves along +x with 1 unit per second: all its motion is that of the box of its maps. Another box
// rotates by 90° per second about y around its fixed centre: the motion is that of its texels, ω × p at p, which
// carries the end at +x towards −z.
TEST_P(AnimatedColliderGlTest, ClipsPushParticles) {
    const ParticleState pushed = hitBy("go", {0.2F, 0.3F, 0.3F}, {0.3F, 0.05F, 0.1F}, {.restitution = 0.5F});
    EXPECT_NEAR(pushed.velocity.x, 1.5F, 0.02F);
    EXPECT_NEAR(pushed.velocity.y, 0.0F, 1e-3F);
    const ParticleState swung = hitBy("turn", {0.5F, 0.3F, 0.05F}, {0.4F, 0.05F, -0.083F}, {});
    const float speed = 0.4F * static_cast<float>(std::acos(0.0));
    EXPECT_NEAR(swung.velocity.z, -speed, 0.08F * speed);
}

using AnimatedArgumentsGlTest = AnimatedColliderGlTest;
RELIEF_INSTANTIATE_STEP_TESTS_ONCE(AnimatedArgumentsGlTest);

TEST_P(AnimatedArgumentsGlTest, InvalidArgumentsAreRejected) {
    const SharedMesh mesh = shared(movingBox({0.2F, 0.3F, 0.3F}));
    makeAnimated(mesh);
    const auto refused = [&](const std::function<void(MeshPose&)>& change) {
        MeshPose pose = restPose(*mesh);
        change(pose);
        const Result<void> set = animated_->setPose(pose);
        return !set && set.error().code == ErrorCode::kUsage;
    };
    EXPECT_TRUE(refused([](MeshPose& pose) { pose.joints.emplace_back(); }));
    EXPECT_TRUE(refused([](MeshPose& pose) { pose.weights.push_back(1.0F); }));
    EXPECT_TRUE(refused([](MeshPose& pose) { pose.joints[0].row[1].x = std::nanf(""); }));
    EXPECT_TRUE(refused([](MeshPose& pose) { pose.joints[0].row[0].x = 5.0F; })) << "outside the room";
    ASSERT_TRUE(animated_->setPose(clipPose(*mesh, "go", 0.5)));
    EXPECT_TRUE(refused([](MeshPose&) {})) << "twice";
    EXPECT_FALSE(SkinPass::create(*mesh, std::vector<glm::vec3>(3)));
}

struct Points {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
};

Points somePoints(std::size_t count) {
    Pcg32 random(11);
    Points points;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = random.signedUniform();
        const float y = random.signedUniform();
        points.positions.emplace_back(x, y, random.signedUniform());
        points.normals.push_back(onUnitSphere(random));
    }
    return points;
}

constexpr Wobble kSome{.amplitude = 0.2F, .frequency = 0.9F, .phase = 0.4F, .wavelength = 0.8F};

/// The sine's phase along an axis, by the formula of wobble_pass.h.
double phaseAt(int axis, double time, float coordinate) {
    const double rates[3] = {1.0, 1.25, 0.8};
    return 2.0 * std::numbers::pi *
               (double{coordinate} / double{kSome.wavelength} -
                rates[axis] * double{kSome.frequency} * time) +
           double{kSome.phase} + axis;
}
glm::vec3 wobbled(double time, const glm::vec3& p, const glm::vec3& normal) {
    const double sum =
        std::sin(phaseAt(0, time, p.x)) + std::sin(phaseAt(1, time, p.y)) + std::sin(phaseAt(2, time, p.z));
    return p + kSome.amplitude / 3.0F * static_cast<float>(sum) * normal;
}

class WobblePassGlTest : public GlTest {
  protected:
    static std::vector<glm::vec3> read(const WobblePass& pass) {
        std::vector<glm::vec3> values(pass.bytes() / sizeof(glm::vec3));
        EXPECT_TRUE(readBuffer(pass.buffer(), 0, std::as_writable_bytes(std::span(values))));
        return values;
    }
};
RELIEF_INSTANTIATE_GL_TESTS(WobblePassGlTest);

TEST_P(WobblePassGlTest, MatchesItsFormulaAndKeepsCallerState) {
    const Points points = somePoints(5000);
    const CallerState caller;
    auto pass = required(WobblePass::create(kSome, points.positions, points.normals));
    caller.expectKept("create");
    float moved = 0.0F;
    for (const double time : {0.0, 0.3, 777.7}) {
        pass.run(time);
        caller.expectKept("run");
        {
            const PassState sequence(PassState::Scope::kSequence);
            pass.run(0.1);
            pass.run(time);
        }
        caller.expectKept("a sequence of passes");
        const std::vector<glm::vec3> gpu = read(pass);
        const std::vector<glm::vec3> all = relief::wobbled(kSome, points.positions, points.normals, time);
        ASSERT_EQ(gpu.size(), points.positions.size());
        ASSERT_EQ(all.size(), points.positions.size());
        for (std::size_t i = 0; i < gpu.size(); ++i) {
            const glm::vec3 cpu = wobbled(time, points.positions[i], points.normals[i]);
            ASSERT_LE(glm::length(all[i] - cpu), 1e-6F) << time << " " << i;
            ASSERT_LE(glm::length(gpu[i] - cpu), 2e-5F) << time << " " << i;
            moved = std::max(moved, glm::length(gpu[i] - points.positions[i]));
        }
    }
    EXPECT_GT(moved, 0.05F);  // the vertices do move
}

TEST_P(WobblePassGlTest, NormalsMatchTheMovedSurface) {
    // The plane z = 0 becomes z = f(x, y) = amplitude/3 · Σ sin(…), with normal (-df/dx, -df/dy, 1).
    Points points;
    std::vector<glm::vec3> wanted;
    const double time = 0.3;
    const double slope = -2.0 * std::numbers::pi / 3.0 * double{kSome.amplitude} / double{kSome.wavelength};
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 p(0.03F * static_cast<float>(i), 0.7F - 0.05F * static_cast<float>(i), 0.0F);
        points.positions.push_back(p);
        points.normals.emplace_back(0.0F, 0.0F, 1.0F);
        wanted.push_back(glm::normalize(glm::vec3(slope * std::cos(phaseAt(0, time, p.x)),
                                                  slope * std::cos(phaseAt(1, time, p.y)), 1.0)));
    }
    auto pass = required(
        WobblePass::create(kSome, points.positions, points.normals, VertexOutput::kPositionsAndNormals));
    pass.run(time);
    const std::vector<glm::vec3> gpu = read(pass);
    ASSERT_EQ(gpu.size(), 2 * wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_LE(glm::length(gpu[2 * i + 1] - wanted[i]), 2e-3F) << i;
    }
}

TEST_P(WobblePassGlTest, InvalidArgumentsAreRejected) {
    const Points points = somePoints(3);
    const auto refused = [&](const Wobble& wobble, std::span<const glm::vec3> positions,
                             std::span<const glm::vec3> normals) {
        expectError(WobblePass::create(wobble, positions, normals), ErrorCode::kUsage);
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    refused(kSome, {}, {});
    refused(kSome, points.positions, {});
    refused(kSome, points.positions, std::span(points.normals).first(2));
    refused({.amplitude = nan}, points.positions, points.normals);
    refused({.phase = nan}, points.positions, points.normals);
    refused({.frequency = -1.0F}, points.positions, points.normals);
    refused({.wavelength = 0.0F}, points.positions, points.normals);
}

}  // namespace
}  // namespace relief::test
