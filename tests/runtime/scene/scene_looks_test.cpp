// The scene's looks, sprites and camera path: what is read, and every mistake with its place.
#include <gtest/gtest.h>

#include <string>

#include "runtime/scene/scene.h"
#include "runtime/scene/scene_parser.h"
#include "runtime/scene/scene_pictures.h"
#include "tests/runtime/scene/scene_error.h"

namespace relief {
namespace {

const std::string kHead = "[collider]\nfile = \"a.relief\"\n";

Scene good(const std::string& more) {
    const auto scene = parseScene(kHead + more, "dir/scene.toml");
    EXPECT_TRUE(scene) << more << "\n" << scene.error().message;
    return scene.value_or(Scene{});
}

/// The lines after the head start at line 3.
void expectError(const std::string& more, const std::string& place, const std::string& part) {
    expectSceneError(kHead + more, "dir/scene.toml:" + place + ": ", part);
}

TEST(SceneLooks, NothingGivenIsAsBefore) {
    const Scene scene = good("");
    EXPECT_EQ(scene.render.sprite, Sprite::kPoint);
    EXPECT_EQ(scene.render.blend, Blend::kAlpha);
    EXPECT_EQ(scene.render.soft, 0.0F);
    EXPECT_TRUE(scene.render.atlas.empty() && scene.render.mesh.empty() && scene.types.empty());
    EXPECT_TRUE(scene.camera.keys.empty());
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
    EXPECT_EQ(scene.render.sprite, Sprite::kQuad);
    EXPECT_EQ(scene.render.blend, Blend::kAdditive);
    EXPECT_EQ(scene.render.soft, 0.5F);
    EXPECT_EQ(scene.render.atlas, std::filesystem::path("dir/a.png"));
    EXPECT_EQ(scene.render.atlas_columns, 4U);
    EXPECT_EQ(scene.render.atlas_rows, 2U);
    EXPECT_EQ(scene.render.mesh, std::filesystem::path("dir/m.obj"));
    ASSERT_EQ(scene.types.size(), 3U);
    ParticleLook first;
    first.size = {{0.0F, 0.25F}};
    first.color = {{0.0F, {1.0F, 0.0F, 0.5F}}};
    EXPECT_EQ(scene.types[0].look, first);
    ParticleLook second;
    second.size = {{0.0F, 1.0F}, {0.5F, 2.0F}};
    second.color = {{0.0F, {1.0F, 0.0F, 0.0F}}, {1.0F, {0.0F, 1.0F, 0.0F}}};
    second.opacity = {{0.0F, 0.0F}, {1.0F, 1.0F}};
    second.rotation = {{0.25F, -3.0F}};
    second.turn = 1.0F;
    second.spin = 2.0F;
    second.cell_first = 3;
    second.cell_last = 7;
    second.lit = false;
    second.fade_in = 0.0F;  // opacity says itself how it comes and goes
    second.fade_out = 0.0F;
    EXPECT_EQ(scene.types[1].look, second);
    EXPECT_EQ(scene.types[2].look.cell_last, 6U);
    EXPECT_EQ(scene.types[2].look.fade_out, 2.0F);
    EXPECT_EQ(scene.types[2].look.stretch, 0.25F);
}

TEST(SceneLooks, Mistakes) {
    expectError("[render]\nsprite = \"quads\"\n", "4:10", "did you mean 'quad'?");
    expectError("[render]\nblend = \"over\"\n", "4:9", "choose one of");
    expectError("[render]\nsoft = -1\n", "4:8", "out of range");
    expectError("[render]\nmesh = \"\"\n", "4:8", "names no file");
    for (const char* pose : {"scale = 2\n", "angle = 90\n", "position = [0, 1, 0]\n"}) {
        expectError(pose + std::string("[render]\nmesh = \"m.obj\"\n"), "5:8", "where it was baked");
    }
    expectError("[[collider.key]]\ntime = 0\n[[collider.key]]\ntime = 1\n[render]\nmesh = \"m.obj\"\n", "8:8",
                "where it was baked");
    expectError("[render]\natlas = 3\n", "4:9", "must be a string");
    expectError("[render]\natlas_cells = [1, 1]\n", "4:15", "does nothing without render.atlas");
    expectError("[render]\natlas = \"a.png\"\natlas_cells = [0, 1]\n[[type]]\ncell = 0\n", "5:16",
                "out of range");
    expectError("[render]\natlas = \"a.png\"\natlas_cells = 4\n", "5:15", "[columns, rows]");
    expectError("[render]\natlas = \"a.png\"\n", "4:9", "does nothing while no [[type]] has a cell");
    expectError("[[type]]\ncell = 0\n", "4:8", "type.cell does nothing without render.atlas");
    expectError("[render]\natlas = \"a.png\"\natlas_cells = [2, 2]\n[[type]]\ncell = 4\n", "7:8",
                "choose 0 to 3");
    expectError("[render]\natlas = \"a.png\"\natlas_cells = [2, 2]\n[[type]]\ncell = [2, 1]\n", "7:8",
                "swap");
    expectError("[type]\nsize = 1\n", "3:1", "[[type]]");
    expectError("[[type]]\nsize = \"1\"\n", "4:8", "must be a number, or keys");
    expectError("[[type]]\nsize = -1\n", "4:8", "out of range");
    expectError("[[type]]\nsize = []\n", "4:8", "must be a number, or keys");
    expectError("[[type]]\nsize = [0, 1]\n", "4:8", "must be a number, or keys");
    expectError("[[type]]\nsize = [[0, 1], 2]\n", "4:17", "must be a number, or keys");
    expectError("[[type]]\nsize = [[0, 1, 2]]\n", "4:9", "must be a number, or keys");
    expectError("[[type]]\nsize = [[0, 1], [0, 2]]\n", "4:18", "do not rise");
    expectError("[[type]]\nsize = [[0, 1], [1.5, 2]]\n", "4:18", "choose 0 to 1");
    expectError("[[type]]\nopacity = [[0, 1], [1, 2]]\n", "4:24", "choose 0 to 1");
    expectError("[[type]]\ncolor = [1, 1]\n", "4:9", "[r, g, b]");
    expectError("[[type]]\ncolor = 1\n", "4:9", "[r, g, b]");
    expectError("[[type]]\ncolor = [[0, 1, 1]]\n", "4:10", "[r, g, b]");
    expectError("[[type]]\nrotation = nan\n", "4:12", "out of range");
    expectError("[[type]]\nfade = 1\n", "4:8", "[in, out]");
    expectError("[[type]]\nsizes = 1\n", "4:1", "did you mean 'size'?");
    std::string keys;
    for (int i = 0; i < 256; ++i) {
        keys += (i > 0 ? ", [0." : "[0.") + std::to_string(1000 + i) + ", 1]";
    }
    expectError("[[type]]\nsize = [" + keys + "]\n", "4:8", "give 255 at most");
    expectError("[[type]]\nstretch = -1\n", "4:11", "out of range");
    expectError("[[type]]\nstretch = 0.1\n", "4:11", "choose render.sprite = \"quad\"");
    std::string types;
    for (int i = 0; i < 17; ++i) {
        types += "[[type]]\n";
    }
    expectError(types, "19:1", "more than 16");
}

Bounds unitBounds() {
    Bounds bounds;
    bounds.add({-1.0F, 0.0F, -0.5F});
    bounds.add({1.0F, 1.0F, 0.5F});
    return bounds;
}

TEST(SceneCamera, KeysAreFollowedAndFilledFromTheCamera) {
    const auto scene =
        withDefaults(good("[camera]\ntarget = [0, 1, 0]\nfov = 40\n"
                          "[[camera.key]]\ntime = 0\neye = [4, 1, 0]\n"
                          "[[camera.key]]\ntime = 2\neye = [8, 1, 0]\ntarget = [0, 3, 0]\nfov = 20\n"),
                     unitBounds());
    ASSERT_TRUE(scene) << scene.error().message;
    const Camera camera = sceneCamera(*scene, unitBounds(), 1.0);
    EXPECT_EQ(camera.eye, glm::vec3(6.0F, 1.0F, 0.0F));
    EXPECT_EQ(camera.target, glm::vec3(0.0F, 2.0F, 0.0F));
    EXPECT_EQ(camera.fov, 30.0F);
    EXPECT_GT(camera.far_plane, 6.0F);
    EXPECT_EQ(sceneCamera(*scene, unitBounds(), 0.0).target, glm::vec3(0.0F, 1.0F, 0.0F));
}

TEST(SceneCamera, Mistakes) {
    const std::string key = "[[camera.key]]\ntime = 1\neye = [1, 2, 3]\n";
    expectError("[[camera.key]]\ntime = 1\n", "3:1", "camera.key.eye is missing");
    expectError("[[camera.key]]\neye = [1, 2, 3]\n", "3:1", "camera.key.time is missing");
    expectError(key + key, "7:8", "does not rise");
    expectError("[[camera.key]]\ntime = -1\neye = [1, 2, 3]\n", "4:8", "out of range");
    expectError(key + "target = [1, 0, 3]\n", "5:7", "straight above or below");
    expectError(key + "target = [1, 2, 3]\n", "5:7", "straight above or below");
    expectError(key + "fov = 171\n", "6:7", "out of range");
    expectError(key + "up = 1\n", "6:1", "unknown key 'camera.key.up'");
    expectError("[camera]\neye = [1, 2, 3]\n" + key, "4:7", "exclude each other");
    expectError("[camera]\nkey = 3\n", "4:7", "[[camera.key]]");
}

}  // namespace
}  // namespace relief
