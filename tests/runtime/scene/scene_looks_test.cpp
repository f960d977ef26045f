// SPDX-License-Identifier: Apache-2.0
// The scene's looks, sprites and camera path.
#include <gtest/gtest.h>

#include "runtime/scene/scene_pictures.h"
#include "tests/results.h"
#include "tests/runtime/scene/scene_text.h"

namespace relief {
namespace {

Scene good(const std::string& more) {
    return goodScene(kSceneHead + more);
}

TEST(SceneLooks, EveryKey) {
    const Scene scene = good(
        "[render]\nsprite = \"quad\"\nblend = \"additive\"\nsoft = 0.5\natlas = \"a.png\"\natlas_cells = [4, "
        "2]\n"
        "mesh = \"m.obj\"\n[[type]]\nsize = 0.25\ncolor = [1, 0, 0.5]\n"
        "[[type]]\nsize = [[0, 1], [0.5, 2]]\ncolor = [[0, 1, 0, 0], [1, 0, 1, 0]]\nopacity = [[0, 0], [1, "
        "1]]\n"
        "rotation = [[0.25, -3]]\nturn = 1\nspin = 2\ncell = [3, 7]\nlit = false\n[[type]]\ncell = 6\nfade = "
        "[1, 2]\nstretch = 0.25\n");
    EXPECT_EQ(scene.render.atlas, std::filesystem::path("dir/a.png"));
    EXPECT_EQ(scene.render.atlas_columns, 4U);
    EXPECT_EQ(scene.render.atlas_rows, 2U);
    EXPECT_EQ(scene.render.mesh, std::filesystem::path("dir/m.obj"));
    ASSERT_EQ(scene.types.size(), 3U);
    EXPECT_EQ(scene.types[0].look,
              (ParticleLook{.size = {{0.0F, 0.25F}}, .color = {{0.0F, {1.0F, 0.0F, 0.5F}}}}));
    EXPECT_EQ(scene.types[1].look,
              (ParticleLook{.size = {{0.0F, 1.0F}, {0.5F, 2.0F}},
                            .color = {{0.0F, {1.0F, 0.0F, 0.0F}}, {1.0F, {0.0F, 1.0F, 0.0F}}},
                            .opacity = {{0.0F, 0.0F}, {1.0F, 1.0F}},
                            .rotation = {{0.25F, -3.0F}},
                            .turn = 1.0F,
                            .spin = 2.0F,
                            .cell_first = 3,
                            .cell_last = 7,
                            .lit = false,
                            .fade_in = 0.0F,  // opacity says itself how it comes and goes
                            .fade_out = 0.0F}));
    EXPECT_EQ(scene.types[2].look.cell_last, 6U);
    EXPECT_EQ(scene.types[2].look.fade_out, 2.0F);
}

TEST(SceneCamera, KeysAreFollowedAndFilledFromTheCamera) {
    const auto scene = required(
        withDefaults(good("[camera]\ntarget = [0, 1, 0]\nfov = 40\n"
                          "[[camera.key]]\ntime = 0\neye = [4, 1, 0]\n"
                          "[[camera.key]]\ntime = 2\neye = [8, 1, 0]\ntarget = [0, 3, 0]\nfov = 20\n"),
                     unitBounds()));
    const Camera camera = sceneCamera(scene, unitBounds(), 1.0);
    EXPECT_EQ(camera.eye, glm::vec3(6.0F, 1.0F, 0.0F));
    EXPECT_EQ(camera.target, glm::vec3(0.0F, 2.0F, 0.0F));
    EXPECT_EQ(camera.fov, 30.0F);
    EXPECT_GT(camera.far_plane, 6.0F);
    EXPECT_EQ(sceneCamera(scene, unitBounds(), 0.0).target, glm::vec3(0.0F, 1.0F, 0.0F));
}

}  // namespace
}  // namespace relief
