// SPDX-License-Identifier: Apache-2.0
// A scene's world: its bodies among the colliders, their order, and changes by tables.
#include "runtime/scene/scene_world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <memory>

#include "runtime/bodies/world_bodies.h"
#include "runtime/picture/camera.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/scene/scene_pictures.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"
#include "tests/runtime/bodies/three_bodies.h"
#include "tests/runtime/scene/scene_text.h"

namespace relief {
namespace {

Scene placed(const std::string& text) {
    Scene scene = goodScene("world = \"level/world.json\"\n" + text);
    const auto done = placeBodies(scene, test::threeBodies());
    EXPECT_TRUE(done) << done.error().message;
    return scene;
}

TEST(SceneWorld, BodiesBecomeCollidersWithTheirPoses) {
    const Scene scene = placed("");
    ASSERT_EQ(scene.colliders.size(), 3U);
    const SceneCollider& door = scene.colliders[1];
    EXPECT_EQ(door.path, std::filesystem::path("dir/level/door.relief"));
    EXPECT_EQ(door.node, "door");
    EXPECT_TRUE(door.posed);
    EXPECT_EQ(door.pose, poseOf(test::threeBodies().bodies[1])) << "bit-identical";
    EXPECT_EQ(door.restitution, 0.25F);
    EXPECT_EQ(door.friction, 0.75F);
    EXPECT_EQ(scene.colliders[2].node, "gate");
}

TEST(SceneWorld, NodeTablesComeFirstAndKeepUnsetValues) {
    const Scene scene = placed(
        "[[collider]]\nfile = \"own.relief\"\n"
        "[[collider]]\nnode = \"door\"\n[[collider.key]]\ntime = 1\n[[collider.key]]\ntime = 2\nposition = "
        "[4, 0.5, 1]\n"
        "[[collider]]\nnode = \"floor\"\nposition = [0, 1, 0]\n");
    ASSERT_EQ(scene.colliders.size(), 4U);
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

// Also detected if every second body is elsewhere.
TEST(SceneWorld, TooManyCoincidentBodiesAreErrors) {
    const auto collider = std::make_shared<const Collider>(test::readmeExample());
    const auto scene = [&](std::size_t bodies, std::size_t every, float apart) {
        LoadedScene loaded;
        loaded.colliders.assign(bodies, collider);
        loaded.scene.colliders.resize(bodies);
        for (std::size_t i = 0; i < bodies; ++i) {
            if (i % every != 0) {
                loaded.scene.colliders[i].pose.position.x = apart * static_cast<float>(i + 1);
            }
        }
        return loaded;
    };
    EXPECT_TRUE(checkOverlap(scene(kOverlapMax, 1, 0.0F)));
    EXPECT_TRUE(checkOverlap(scene(8192, kOverlapMax, 10.0F))) << "apart";
    for (const auto& [refused, words] :
         {std::pair(scene(kOverlapMax + 1, 1, 0.0F), "1025 bodies overlap at "),
          {scene(4096, 2, 10.0F), "2048 bodies overlap at "}}) {
        const auto result = checkOverlap(refused);
        ASSERT_FALSE(result) << words;
        EXPECT_EQ(result.error().code, ErrorCode::kLimit);
        EXPECT_TRUE(result.error().message.starts_with(words)) << result.error().message;
    }
}

// A level is wide and low. Seen from above, it fills nine tenths of the picture's width or height.
TEST(SceneWorld, DefaultCameraFramesALevel) {
    for (const glm::vec3& half :
         {glm::vec3(90.0F, 12.0F, 90.0F), glm::vec3(4.0F, 30.0F, 2.0F), glm::vec3(300.0F, 0.0F, 5.0F)}) {
        const Bounds bounds{-half, half};
        const auto scene = required(withDefaults(placed("[render]\nsize = [640, 360]\n"), bounds));
        const Camera camera = sceneCamera(scene, bounds, 0.0);
        glm::vec2 most(0.0F);
        for (int i = 0; i < 8; ++i) {
            const glm::bvec3 high((i & 1) != 0, (i & 2) != 0, (i & 4) != 0);
            const glm::vec4 clip = camera.projection(640.0F / 360.0F) * camera.view() *
                                   glm::vec4(glm::mix(bounds.min, bounds.max, high), 1.0F);
            ASSERT_GT(clip.w, 0.0F);
            most = glm::max(most, glm::abs(glm::vec2(clip)) / clip.w);
        }
        EXPECT_NEAR(std::max(most.x, most.y), 0.9F, 1e-3F) << half.x;
    }
}

/// Adds another tile of the door, in the same place, before the gate.
World threeBodiesAndATile() {
    World world = test::threeBodies();
    test::addTile(world, 1, "door-1.relief", 2);
    return world;
}

TEST(SceneWorld, NodeTablesMoveAllTiles) {
    const auto scene = [](const std::string& text) {
        Scene read = goodScene("world = \"w.json\"\n" + text);
        EXPECT_TRUE(placeBodies(read, threeBodiesAndATile()));
        return read;
    };
    const Scene moved = scene(
        "[[collider]]\nnode = \"door\"\nangle = 30\n[[collider.key]]\ntime = 1\n[[collider.key]]\ntime = 2\n"
        "position = [4, 0.5, 1]\n");
    ASSERT_EQ(moved.colliders.size(), 4U);
    EXPECT_EQ(moved.colliders[1].node, "floor");
    EXPECT_EQ(moved.colliders[2].node, "gate") << "has the same index as without the tile";
    const SceneCollider& door = moved.colliders[0];
    const SceneCollider& tile = moved.colliders[3];
    EXPECT_EQ(tile.path, std::filesystem::path("dir/door-1.relief"));
    EXPECT_EQ(tile.tile_of, 0U);
    EXPECT_FALSE(door.tile_of);
    EXPECT_NE(door.pose, poseOf(test::threeBodies().bodies[1]));
    for (const double time : {0.0, 1.25, 1.5, 3.0}) {
        EXPECT_EQ(poseAt(tile, time), poseAt(door, time));
    }
    EXPECT_EQ(tile.restitution, 0.25F);
    const Scene still = scene("");
    ASSERT_EQ(still.colliders.size(), 4U);
    EXPECT_EQ(still.colliders[2].path, std::filesystem::path("dir/door-1.relief")) << "in the world's order";
    EXPECT_FALSE(still.colliders[2].tile_of);
}

TEST(SceneWorld, NodesHaveOnePlaceInTheWorld) {
    World elsewhere = threeBodiesAndATile();
    elsewhere.bodies[2].position.x += 1.0F;
    for (const auto& [node, world] : {std::pair("door", elsewhere), {"window", test::threeBodies()}}) {
        Scene scene = goodScene("world = \"w.json\"\n[[collider]]\nnode = \"" + std::string(node) + "\"\n");
        const auto done = placeBodies(scene, world);
        ASSERT_FALSE(done) << node;
        EXPECT_TRUE(done.error().message.starts_with("dir/scene.toml:1:9: collider[0].node = '"))
            << done.error().message;
    }
}

}  // namespace
}  // namespace relief
