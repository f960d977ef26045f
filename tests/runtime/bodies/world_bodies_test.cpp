// SPDX-License-Identifier: Apache-2.0
// Converts a world file into bodies for the GPU.
#include "runtime/bodies/world_bodies.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/runtime/bodies/three_bodies.h"

namespace relief {
namespace {

TEST(WorldBodies, BodiesPosesAndBoxMatchTheWorld) {
    const LoadedWorld loaded = {test::threeBodies(), std::vector<Collider>(2)};
    const std::vector<ColliderBody> bodies = worldBodies(loaded);
    ASSERT_EQ(bodies.size(), 3U);
    EXPECT_EQ(bodies[1].collider, &loaded.colliders[1]);
    EXPECT_EQ(bodies[2].collider, bodies[1].collider) << "uploaded once";
    EXPECT_EQ(bodies[1].friction, 0.75F);
    const std::vector<Pose> poses = worldPoses(loaded.world);
    ASSERT_EQ(poses.size(), 3U);
    EXPECT_EQ(poses[1], bodies[1].pose);
    EXPECT_EQ(findBodies(loaded.world, "door"), std::vector<std::size_t>{1});
    EXPECT_TRUE(findBodies(loaded.world, "doo").empty());
    const Bounds box = worldBounds(loaded.world);
    EXPECT_EQ(box.min, glm::vec3(-9.0F));
    EXPECT_EQ(box.max, glm::vec3(9.0F));
    // Rotated by slightly more than 90° about y, and scaled by 2: a corner of the door.
    const glm::vec3 corner = toWorld(poses[1], glm::vec3(1.0F, 2.0F, 0.0F));
    EXPECT_NEAR(corner.x, 3.0F + 2.0F * 0.28F, 1e-6F);
    EXPECT_NEAR(corner.y, 4.5F, 1e-6F);
    EXPECT_NEAR(corner.z, 1.0F - 2.0F * 0.96F, 1e-6F);
}

}  // namespace
}  // namespace relief
