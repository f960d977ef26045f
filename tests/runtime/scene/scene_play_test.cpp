// SPDX-License-Identifier: Apache-2.0
// The scene's colliders that play clips: defaults and colours.
#include "runtime/scene/scene_play.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "formats/container.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/scene/scene_meshes.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/results.h"
#include "tests/runtime/live/animated_container.h"
#include "tests/runtime/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

const std::string kTubeCollider = "[[collider]]\nfile = \"tube.relief\"\n";

TEST(ScenePlay, IsLoadedWithItsClip) {
    const std::string keys =
        "clip = \"bend\", start = 0.5, speed = -2, loop = false, bounds_scale = 1.5, resolution = 64";
    EXPECT_EQ(goodScene(kTubeCollider + "play = { " + keys + " }\n").colliders.front().play,
              (ScenePlay{"bend", 0.5F, -2.0F, false, 1.5F, 64}));
    const test::TemporaryFolder folder;
    ASSERT_TRUE(saveCollider(folder.path() / "tube.relief", animatedContainer(bendingTube(12, 8))));
    const std::string two = kTubeCollider + "position = [3, 0, 0]\nplay = { clip = \"bend\" }\n" +
                            kTubeCollider + "play = { clip = \"grow\", start = 0.25, loop = false }\n" +
                            kTubeCollider;
    const auto loaded = required(loadAll(folder.write("scene.toml", two), {}));
    ASSERT_TRUE(loaded.played[0] && loaded.played[1]);
    EXPECT_FALSE(loaded.played[2]) << "at rest";
    EXPECT_EQ(loaded.played[0]->mesh, loaded.played[1]->mesh) << "read once";
    const AnimatedMesh& mesh = *loaded.played[0]->mesh;
    EXPECT_EQ(loaded.played[0]->poseAt(2.5), poseAt(mesh, mesh.clips[0], 0.5)) << "repeats from the start";
    EXPECT_EQ(loaded.played[1]->poseAt(0.5), poseAt(mesh, mesh.clips[1], 0.75));
    EXPECT_EQ(loaded.played[1]->poseAt(7.0), poseAt(mesh, mesh.clips[1], 1.0));
    // The tube bends to -x by slightly more than 1.
    EXPECT_LE(loaded.bounds.min.x, 3.0F - 1.05F);
    EXPECT_GE(loaded.bounds.max.x, 3.09F);
}

TEST(ScenePlay, MissingClipsAndMeshesAreNamed) {
    const test::TemporaryFolder folder;
    Collider collider = animatedContainer(bendingTube(12, 8));
    ASSERT_TRUE(saveCollider(folder.path() / "tube.relief", collider));
    const auto expectRefused = [&](const std::string& words) {
        expectErrorOf(loadAll(folder.write("scene.toml", kTubeCollider + "play = { clip = \"run\" }\n"), {}),
                      "scene.toml:2:8", words);
    };
    expectRefused("'bend', 'grow'");
    collider.animation.resize(100);
    ASSERT_TRUE(saveCollider(folder.path() / "tube.relief", collider));
    expectRefused("FlatBuffers");
    collider.animation.clear();
    ASSERT_TRUE(saveCollider(folder.path() / "tube.relief", collider));
    expectRefused("--animated");
}

TEST(ScenePlay, MaterialsHaveColours) {
    const test::TemporaryFolder folder;
    const AnimatedMesh mesh = tubeWithMaterials("arm", "sleeve");
    ASSERT_TRUE(saveCollider(folder.path() / "tube.relief", animatedContainer(mesh)));
    const auto load = [&](const std::string& keys) {
        return loadAll(
            folder.write("scene.toml", kTubeCollider + "play = {}\n" + keys +
                                           "[ground]\nenabled = false\n[render]\nmeshes = \".\"\n"),
            {});
    };
    using Color = std::array<std::uint8_t, 4>;
    for (const auto& [keys, rest] :
         {std::pair<std::string, Color>("color = [0, 1, 0.2]\n", {0, 255, 51, 255}),
          std::pair<std::string, Color>("", {189, 153, 133, 255})}) {  // clay
        const auto loaded =
            required(load(keys + "[[collider.material]]\nname = \"sleeve\"\ncolor = [1, 0.4, 0]\n"));
        const auto drawn = required(loadDrawnMeshes(loaded));
        const std::vector<Color>& colors = drawn.meshes.front().colors;
        ASSERT_EQ(colors.size(), mesh.positions.size());
        std::vector<Color> expected(colors.size(), rest);
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            for (int k = 0; k < 3 && mesh.triangle_materials[i] == 1; ++k) {
                expected[mesh.triangles[i][k]] = {255, 102, 0, 255};
            }
        }
        EXPECT_EQ(colors, expected);
        EXPECT_NE(std::count(colors.begin(), colors.end(), rest), 0);
    }
    EXPECT_TRUE(loadDrawnMeshes(*load(""))->meshes.front().colors.empty());
    expectErrorOf(load("[[collider.material]]\nname = \"hat\"\ncolor = [1, 1, 1]\n"),
                  "scene.toml:2:8: collider.material: ", "hat");
}

}  // namespace
}  // namespace relief
