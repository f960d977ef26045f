// SPDX-License-Identifier: Apache-2.0
// The scene's colliders that deform: what is read, and what is filled in.
#include "runtime/scene/scene_live.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/results.h"
#include "tests/runtime/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

TEST(SceneLive, Keys) {
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

TEST(SceneLive, TheMeshIsReadAndItsMapsHoldTheMotion) {
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
    EXPECT_EQ(live.mesh.positions.size(), 5U) << "no vertex is doubled";
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
