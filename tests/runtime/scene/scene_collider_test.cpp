// The scene's colliders, their ways through the world, and what types of particles do: what is read, and where
// bodies are between two keys.
#include "runtime/scene/scene_collider.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/runtime/scene/scene_text.h"

namespace relief {
namespace {

Scene good(const std::string& more) {
    return goodScene(kSceneHead + more);
}

void expectNear(const glm::vec3& a, const glm::vec3& b, float bound) {
    EXPECT_NEAR(a.x, b.x, bound);
    EXPECT_NEAR(a.y, b.y, bound);
    EXPECT_NEAR(a.z, b.z, bound);
}

/// Turns by 120 degrees about z while it goes from x = 1 to x = 5, from 2 s to 4 s.
SceneCollider turning() {
    SceneCollider collider;
    collider.posed = true;
    collider.pose.scale = 2.0F;
    PoseKey key;
    key.pose.scale = 2.0F;
    key.time = 2.0;
    key.pose.position = {1.0F, 0.0F, 0.0F};
    collider.keys.push_back(key);
    key.time = 4.0;
    key.pose.position = {5.0F, 0.0F, 0.0F};
    key.pose.rotation = glm::angleAxis(2.0F / 3.0F * std::numbers::pi_v<float>, glm::vec3(0.0F, 0.0F, 1.0F));
    collider.keys.push_back(key);
    return collider;
}

TEST(SceneCollider, ATableAloneIsNotPosed) {
    for (const char* text :
         {"[collider]\nfile = \"b/a.relief\"\n", "[[collider]]\nfile = \"b/a.relief\"\n"}) {
        const Scene scene = goodScene(text);
        ASSERT_EQ(scene.colliders.size(), 1U);
        const SceneCollider& collider = scene.colliders.front();
        EXPECT_EQ(collider.path, std::filesystem::path("dir/b/a.relief"));
        EXPECT_EQ(collider.origin, "dir/scene.toml:2:8");
        EXPECT_FALSE(collider.posed);
        EXPECT_EQ(collider.pose, Pose{});
        EXPECT_EQ(collider.restitution, 1.0F);
        EXPECT_EQ(collider.friction, 0.0F);
        EXPECT_TRUE(collider.keys.empty());
    }
}

TEST(SceneCollider, EveryKey) {
    const Scene scene = goodScene(
        "[[collider]]\nfile = \"a.relief\"\nposition = [1, 2, 3]\naxis = [0, 0, 5]\nangle = 90\nscale = 0.5\n"
        "restitution = 0.25\nfriction = 0.75\n"
        "[[collider.key]]\ntime = 1\n"
        "[[collider.key]]\ntime = 2.5\nposition = [4, 5, 6]\nangle = -180\n"
        "[[collider]]\nfile = \"b.relief\"\nangle = 180\n");
    ASSERT_EQ(scene.colliders.size(), 2U);
    const SceneCollider& first = scene.colliders[0];
    EXPECT_TRUE(first.posed);
    EXPECT_EQ(first.restitution, 0.25F);
    EXPECT_EQ(first.friction, 0.75F);
    // A quarter about z: x goes to y.
    expectNear(toWorld(first.pose, {2.0F, 0.0F, 0.0F}), {1.0F, 3.0F, 3.0F}, 1e-6F);
    ASSERT_EQ(first.keys.size(), 2U);
    EXPECT_EQ(first.keys[0].time, 1.0);
    EXPECT_EQ(first.keys[0].pose, first.pose) << "what a key leaves open is the collider's";
    EXPECT_EQ(first.keys[1].time, 2.5);
    // Half a turn about y, which is the axis of an angle alone; the collider's scale.
    expectNear(toWorld(first.keys[1].pose, {2.0F, 0.0F, 0.0F}), {3.0F, 5.0F, 6.0F}, 1e-6F);
    expectNear(toWorld(scene.colliders[1].pose, {1.0F, 2.0F, 3.0F}), {-1.0F, 2.0F, -3.0F}, 1e-6F);
    EXPECT_EQ(scene.colliders[1].origin, "dir/scene.toml:16:8");
}

TEST(SceneCollider, AnyKeyOfItsPlacePosesIt) {
    for (const char* key : {"position = [0, 0, 0]", "angle = 0", "scale = 1", "restitution = 1",
                            "friction = 0", "[[collider.key]]\ntime = 0\n[[collider.key]]\ntime = 1"}) {
        EXPECT_TRUE(good(std::string(key) + "\n").colliders.front().posed) << key;
    }
}

TEST(SceneCollider, ATinyAxisIsADirectionToo) {
    const Scene scene = good("axis = [0, 0, 1e-30]\nangle = 90\n");
    expectNear(toWorld(scene.colliders.front().pose, {1.0F, 0.0F, 0.0F}), {0.0F, 1.0F, 0.0F}, 1e-6F);
    const Scene large = good("axis = [0, 0, 1e9]\nangle = 90\n");
    expectNear(toWorld(large.colliders.front().pose, {1.0F, 0.0F, 0.0F}), {0.0F, 1.0F, 0.0F}, 1e-6F);
}

TEST(PoseAt, RestsOutsideItsKeysAndIsExactAtThem) {
    const SceneCollider collider = turning();
    EXPECT_EQ(poseAt(collider, 0.0), collider.keys[0].pose);
    EXPECT_EQ(poseAt(collider, 2.0), collider.keys[0].pose);
    EXPECT_EQ(poseAt(collider, 4.0), collider.keys[1].pose);
    EXPECT_EQ(poseAt(collider, 1e9), collider.keys[1].pose);
    SceneCollider still;
    still.pose.position = {7.0F, 8.0F, 9.0F};
    EXPECT_EQ(poseAt(still, 3.0), still.pose);
}

TEST(PoseAt, GoesStraightAndTurnsEvenly) {
    const SceneCollider collider = turning();
    // A quarter of 120 degrees is 30: quaternions mixed without slerp would be off by half a degree there.
    const float c = std::sqrt(0.75F);
    const Pose half = poseAt(collider, 3.0);
    expectNear(half.position, {3.0F, 0.0F, 0.0F}, 1e-6F);
    expectNear(half.rotation * glm::vec3(1.0F, 0.0F, 0.0F), {0.5F, c, 0.0F}, 1e-6F);
    const Pose quarter = poseAt(collider, 2.5);
    expectNear(quarter.position, {2.0F, 0.0F, 0.0F}, 1e-6F);
    expectNear(quarter.rotation * glm::vec3(1.0F, 0.0F, 0.0F), {c, 0.5F, 0.0F}, 1e-6F);
    EXPECT_NEAR(glm::length(quarter.rotation), 1.0F, 1e-6F);
    EXPECT_EQ(quarter.scale, 2.0F);
}

TEST(WorldBounds, HoldEveryPlaceOfATurningBox) {
    Bounds object;
    object.add({-1.0F, -1.0F, -1.0F});
    object.add({1.0F, 1.0F, 1.0F});
    SceneCollider collider = turning();
    // At one place: the corners of a square of half side 2 come by at ±2√2 on x and y; z stays.
    collider.keys[1].pose.position = collider.keys[0].pose.position;
    const Bounds turned = worldBounds(collider, object);
    const float reach = 2.0F * std::sqrt(2.0F);
    expectNear(turned.min, {1.0F - reach, -reach, -2.0F}, 0.003F);
    expectNear(turned.max, {1.0F + reach, reach, 2.0F}, 0.003F);
    // On its way: from x = 1 − 2 (as the turn begins) to 5 + 2.
    const Bounds moved = worldBounds(turning(), object);
    EXPECT_LE(moved.min.x, -1.0F);
    EXPECT_GE(moved.max.x, 7.0F);
    EXPECT_NEAR(moved.max.y, reach, 0.003F);
    // At rest: the pose alone.
    SceneCollider still;
    still.pose = {{1.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F, 0.0F}, 3.0F};
    EXPECT_EQ(worldBounds(still, object).min, glm::vec3(-2.0F, -3.0F, -3.0F));
    EXPECT_EQ(worldBounds(still, object).max, glm::vec3(4.0F, 3.0F, 3.0F));
}

TEST(SceneTypes, EveryPhysicalKey) {
    const Scene scene = good(
        "[collision]\nrestitution = 0.2\nfriction = 0.3\nfriction_threshold = 0.4\n"
        "[[type]]\n"
        "[[type]]\nname = \"rain\"\nmass = 2\nradius = 0.25\nrestitution = 0.5\nfriction = 0.75\n"
        "friction_threshold = 0\non_collision = \"die\"\nlifetime_loss = 1.5\n"
        "[[type]]\nname = \"snow\"\non_collision = \"stop\"\n[[type]]\non_collision = \"slide\"\n"
        "[[type]]\non_collision = \"bounce\"\n");
    ASSERT_EQ(scene.types.size(), 5U);
    EXPECT_EQ(scene.types[0].name, "");
    EXPECT_EQ(scene.types[1].name, "rain");
    EXPECT_EQ(scene.types[1].place, "dir/scene.toml:8:1");
    const ParticleType& first = scene.types[0];
    EXPECT_EQ(first.mass, 1.0F);
    EXPECT_EQ(first.radius, 0.0F);
    EXPECT_EQ(first.restitution, 0.2F) << "of [collision]";
    EXPECT_EQ(first.friction, 0.3F);
    EXPECT_EQ(first.friction_threshold, 0.4F);
    EXPECT_EQ(first.on_collision, OnCollision::kBounce);
    EXPECT_EQ(first.lifetime_loss, 0.0F);
    const ParticleType& rain = scene.types[1];
    EXPECT_EQ(rain.mass, 2.0F);
    EXPECT_EQ(rain.radius, 0.25F);
    EXPECT_EQ(rain.restitution, 0.5F);
    EXPECT_EQ(rain.friction, 0.75F);
    EXPECT_EQ(rain.friction_threshold, 0.0F);
    EXPECT_EQ(rain.on_collision, OnCollision::kDie);
    EXPECT_EQ(rain.lifetime_loss, 1.5F);
    EXPECT_EQ(scene.types[2].on_collision, OnCollision::kStop);
    EXPECT_EQ(scene.types[3].on_collision, OnCollision::kSlide);
    EXPECT_EQ(scene.types[4].on_collision, OnCollision::kBounce);
    EXPECT_TRUE(good("").types.empty()) << "[collision] describes the only one";
}

TEST(SceneStep, IntegratorAndSweep) {
    EXPECT_EQ(good("").time.integrator, Integrator::kEuler);
    EXPECT_EQ(good("[time]\nintegrator = \"verlet\"\n").time.integrator, Integrator::kVerlet);
    EXPECT_EQ(good("").collision.sweep, 0.0F);
    EXPECT_EQ(good("[collision]\nsweep = 0.25\n").collision.sweep, 0.25F);
}

}  // namespace
}  // namespace relief
