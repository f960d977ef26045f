// SPDX-License-Identifier: Apache-2.0
// The scene's colliders, their pose keys, and particle types. pose_keys_test.cpp tests poses between keys.
#include "runtime/scene/scene_collider.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "runtime/scene/scene_live.h"
#include "tests/results.h"
#include "tests/runtime/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

void expectNear(const glm::vec3& a, const glm::vec3& b, float bound) {
    EXPECT_NEAR(a.x, b.x, bound);
    EXPECT_NEAR(a.y, b.y, bound);
    EXPECT_NEAR(a.z, b.z, bound);
}

/// Rotates by 120 degrees about z and moves from x = 1 to x = 5, from 2 s to 4 s.
SceneCollider turning() {
    SceneCollider collider;
    collider.posed = true;
    collider.pose.scale = 2.0F;
    const float angle = 2.0F / 3.0F * std::numbers::pi_v<float>;
    collider.keys = {{2.0, {{1.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F, 0.0F}, 2.0F}},
                     {4.0, {{5.0F, 0.0F, 0.0F}, glm::angleAxis(angle, glm::vec3(0.0F, 0.0F, 1.0F)), 2.0F}}};
    return collider;
}

TEST(SceneCollider, ReadsEveryKey) {
    const Scene scene = goodScene(
        "[[collider]]\nfile = \"a.relief\"\nposition = [1, 2, 3]\naxis = [0, 0, 5]\nangle = 90\nscale = 0.5\n"
        "restitution = 0.25\nfriction = 0.75\n"
        "[[collider.key]]\ntime = 1\n"
        "[[collider.key]]\ntime = 2.5\nposition = [4, 5, 6]\nangle = -180\n"
        "[[collider]]\nfile = \"b/b.relief\"\nangle = 180\n");
    ASSERT_EQ(scene.colliders.size(), 2U);
    const SceneCollider& first = scene.colliders[0];
    EXPECT_EQ(first.restitution, 0.25F);
    EXPECT_EQ(first.friction, 0.75F);
    // A quarter turn about z maps x to y.
    expectNear(toWorld(first.pose, {2.0F, 0.0F, 0.0F}), {1.0F, 3.0F, 3.0F}, 1e-6F);
    ASSERT_EQ(first.keys.size(), 2U);
    EXPECT_EQ(first.keys[0].time, 1.0);
    EXPECT_EQ(first.keys[0].pose, first.pose) << "missing values of a key are the collider's";
    EXPECT_EQ(poseAt(first, 9.0), first.keys[1].pose);
    // Half a turn about y, the default axis of an angle; the collider's scale.
    expectNear(toWorld(first.keys[1].pose, {2.0F, 0.0F, 0.0F}), {3.0F, 5.0F, 6.0F}, 1e-6F);
    const SceneCollider& second = scene.colliders[1];
    expectNear(toWorld(poseAt(second, 9.0), {1.0F, 2.0F, 3.0F}), {-1.0F, 2.0F, -3.0F}, 1e-6F);
    EXPECT_EQ(second.path, std::filesystem::path("dir/b/b.relief"));
    EXPECT_EQ(second.origin, "dir/scene.toml:16:8");
    const Scene tiny = sceneWith("axis = [0, 0, 1e-30]\nangle = 90\n");
    expectNear(toWorld(tiny.colliders.front().pose, {1.0F, 0.0F, 0.0F}), {0.0F, 1.0F, 0.0F}, 1e-6F);
}

TEST(SceneCollider, AnyPoseKeyPosesIt) {
    EXPECT_FALSE(sceneWith("").colliders.front().posed);
    for (const char* key : {"position = [0, 0, 0]", "angle = 0", "scale = 1", "restitution = 1",
                            "friction = 0", "[[collider.key]]\ntime = 0\n[[collider.key]]\ntime = 1"}) {
        EXPECT_TRUE(sceneWith(std::string(key) + "\n").colliders.front().posed) << key;
    }
}

TEST(WorldBounds, ContainARotatingBoxAtEveryTime) {
    Bounds object;
    object.add({-1.0F, -1.0F, -1.0F});
    object.add({1.0F, 1.0F, 1.0F});
    SceneCollider collider = turning();
    // Without translation: the corners of a square of half side 2 pass ±2√2 on x and y; z does not change.
    collider.keys[1].pose.position = collider.keys[0].pose.position;
    const Bounds turned = worldBounds(collider, object);
    const float reach = 2.0F * std::sqrt(2.0F);
    expectNear(turned.min, {1.0F - reach, -reach, -2.0F}, 0.003F);
    expectNear(turned.max, {1.0F + reach, reach, 2.0F}, 0.003F);
    // With translation: from x = 1 − 2 (at the start of the rotation) to 5 + 2.
    const Bounds moved = worldBounds(turning(), object);
    EXPECT_LE(moved.min.x, -1.0F);
    EXPECT_GE(moved.max.x, 7.0F);
    EXPECT_NEAR(moved.max.y, reach, 0.003F);
    // At rest: only the pose.
    SceneCollider still;
    still.pose = {{1.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F, 0.0F}, 3.0F};
    EXPECT_EQ(worldBounds(still, object).min, glm::vec3(-2.0F, -3.0F, -3.0F));
    EXPECT_EQ(worldBounds(still, object).max, glm::vec3(4.0F, 3.0F, 3.0F));
}

TEST(SceneTypes, DefaultsAreThoseOfCollisions) {
    const Scene scene = sceneWith(
        "[collision]\nrestitution = 0.2\nfriction = 0.3\nfriction_threshold = 0.4\n[[type]]\n"
        "[[type]]\nname = \"rain\"\nmass = 2\nradius = 0.25\nrestitution = 0.5\nfriction = 0.75\n"
        "friction_threshold = 0\non_collision = \"die\"\nlifetime_loss = 1.5\n");
    ASSERT_EQ(scene.types.size(), 2U);
    const ParticleType& first = scene.types[0];
    EXPECT_EQ(first.restitution, 0.2F);
    EXPECT_EQ(first.friction, 0.3F);
    EXPECT_EQ(first.friction_threshold, 0.4F);
    const ParticleType& rain = scene.types[1];
    EXPECT_EQ(rain.mass, 2.0F);
    EXPECT_EQ(rain.radius, 0.25F);
    EXPECT_EQ(rain.restitution, 0.5F);
    EXPECT_EQ(rain.friction, 0.75F);
    EXPECT_EQ(rain.friction_threshold, 0.0F);
    EXPECT_EQ(rain.on_collision, OnCollision::kDie);
    EXPECT_EQ(rain.lifetime_loss, 1.5F);
}

TEST(SceneLive, ReadsKeys) {
    const SceneCollider collider =
        goodScene(
            "[collider]\nmesh = \"a.obj\"\nresolution = 100\n"
            "deform = { amplitude = 0.2, frequency = 0.5, phase = 180, wavelength = 3 }\n")
            .colliders.front();
    ASSERT_TRUE(collider.live);
    EXPECT_EQ(collider.path, "dir/a.obj");
    EXPECT_EQ(collider.resolution, 100U);
    EXPECT_FLOAT_EQ(collider.live->amplitude, 0.2F);
    EXPECT_FLOAT_EQ(collider.live->frequency, 0.5F);
    EXPECT_EQ(collider.live->wavelength, 3.0F);
}

TEST(SceneLive, MapsContainTheMotionOfTheMesh) {
    const test::TemporaryFolder folder;
    SceneCollider collider;
    collider.path = folder.write("bar.obj",
                                 "v 0 0 0\nv 4 0 0\nv 4 1 0\nv 0 1 0\nv 2 0.5 1\n"
                                 "f 1 3 2\nf 1 4 3\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
    collider.origin = "scene.toml:2:8";
    collider.live.emplace();
    collider.live->amplitude = 0.25F;
    collider.live->phase = 180.0F;
    const auto live = required(loadLiveMesh(collider));
    EXPECT_EQ(live.mesh.positions.size(), 5U) << "no vertex is duplicated";
    EXPECT_EQ(live.mesh.normals.size(), 5U);
    EXPECT_FLOAT_EQ(live.wobble.phase, std::numbers::pi_v<float>);
    EXPECT_EQ(live.wobble.wavelength, 2.0F) << "half of the longest side";
    ASSERT_EQ(live.frames.maps.size(), 3U);
    EXPECT_LE(live.frames.bounds.min.z, -0.25F);
    EXPECT_GE(live.frames.bounds.max.x, 4.25F);
    EXPECT_LE(live.frames.bounds.max.x, 4.5F);

    collider.path = folder.path() / "none.obj";
    EXPECT_TRUE(loadLiveMesh(collider).error().message.starts_with("scene.toml:2:8: collider.mesh: "));
    collider.path = folder.write("point.obj", "v 1 1 1\nf 1 1 1\n");
    expectErrorOf(loadLiveMesh(collider), "scene.toml:2:8", "");
}

}  // namespace
}  // namespace relief
