// A scene's world: its bodies among the colliders, in which order, and what tables change of them.
#include "runtime/scene/scene_world.h"

#include <gtest/gtest.h>

#include "runtime/collider/world_bodies.h"
#include "tests/runtime/collider/three_bodies.h"
#include "tests/runtime/scene/scene_error.h"

namespace relief {
namespace {

Scene placed(const std::string& text) {
    auto scene = parseScene("world = \"level/world.json\"\n" + text, "dir/scene.toml");
    EXPECT_TRUE(scene) << scene.error().message;
    const auto done = placeBodies(*scene, test::threeBodies());
    EXPECT_TRUE(done) << done.error().message;
    return *scene;
}

TEST(SceneWorld, BodiesAreCollidersAsTheWorldPlacesThem) {
    const Scene scene = placed("");
    EXPECT_EQ(scene.world, std::filesystem::path("dir/level/world.json"));
    ASSERT_EQ(scene.colliders.size(), 3U);
    EXPECT_EQ(scene.colliders[0].path, std::filesystem::path("dir/level/floor.relief"));
    const SceneCollider& door = scene.colliders[1];
    EXPECT_EQ(door.path, std::filesystem::path("dir/level/door.relief"));
    EXPECT_EQ(door.node, "door");
    EXPECT_TRUE(door.posed);
    EXPECT_EQ(door.pose, poseOf(test::threeBodies().bodies[1])) << "to the bit";
    EXPECT_EQ(door.restitution, 0.25F);
    EXPECT_EQ(door.friction, 0.75F);
    EXPECT_EQ(scene.colliders[2].node, "gate");
}

TEST(SceneWorld, ATableOfANodeComesFirstAndKeepsWhatItLeavesOpen) {
    const Scene scene = placed(
        "[[collider]]\nfile = \"own.relief\"\n"
        "[[collider]]\nnode = \"door\"\n[[collider.key]]\ntime = 1\n[[collider.key]]\ntime = 2\nposition = "
        "[4, 0.5, 1]\n"
        "[[collider]]\nnode = \"floor\"\nposition = [0, 1, 0]\n");
    ASSERT_EQ(scene.colliders.size(), 4U);
    EXPECT_EQ(scene.colliders[0].path, std::filesystem::path("dir/own.relief"));
    const SceneCollider& door = scene.colliders[1];
    const Pose rest = poseOf(test::threeBodies().bodies[1]);
    EXPECT_EQ(door.pose, rest);
    ASSERT_EQ(door.keys.size(), 2U);
    EXPECT_EQ(door.keys[0].pose, rest);
    EXPECT_EQ(door.keys[1].pose.position, glm::vec3(4.0F, 0.5F, 1.0F));
    EXPECT_EQ(door.keys[1].pose.rotation, rest.rotation);
    EXPECT_EQ(door.keys[1].pose.scale, 2.0F);
    EXPECT_EQ(scene.colliders[2].node, "floor");
    EXPECT_EQ(scene.colliders[2].pose.position, glm::vec3(0.0F, 1.0F, 0.0F));
    EXPECT_EQ(scene.colliders[3].node, "gate");
}

TEST(SceneWorld, MistakesAreNamed) {
    const std::string world = "world = \"w.json\"\n";
    expectSceneError("[[collider]]\nnode = \"door\"\n", "dir/scene.toml:2:8: ", "needs world");
    expectSceneError(world + "[collider]\nnode = \"door\"\nfriction = 0\n",
                     "dir/scene.toml:4:12: ", "the world's");
    expectSceneError(world + "[collider]\nnode = \"\"\n", "dir/scene.toml:3:8: ", "is empty");
    expectSceneError(world + "[collider]\nnode = \"door\"\n[[collider.key]]\ntime = 1\n",
                     "dir/scene.toml:4:1: ", "moves nothing");
    expectSceneError("world = 3\n", "dir/scene.toml:1:9: ", "world");
    expectSceneError("world = \"/etc/world.json\"\n", "dir/scene.toml:1:9: ", "world");
    auto scene = parseScene(world + "[collider]\nnode = \"window\"\n", "dir/scene.toml");
    ASSERT_TRUE(scene);
    const auto none = placeBodies(*scene, test::threeBodies());
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().message,
              "dir/scene.toml:1:9: collider[0].node = 'window' is the name of no body of 'dir/w.json'; take "
              "one that its "
              "\"bodies\" list as \"node\"");
}

}  // namespace
}  // namespace relief
