// SPDX-License-Identifier: Apache-2.0
// The meshes of a scene's pictures: the file drawn for each collider, and the weather over time.
#include "runtime/scene/scene_meshes.h"

#include <gtest/gtest.h>

#include <set>

#include "runtime/scene/scene_pictures.h"
#include "runtime/scene/scene_world.h"
#include "tests/results.h"
#include "tests/runtime/bodies/three_bodies.h"
#include "tests/runtime/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

class DrawnMeshesTest : public testing::Test {
  protected:
    DrawnMeshesTest() {
        for (const char* name : {"floor.obj", "own.obj"}) {
            folder_.write(name, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        }
        folder_.write("door.ply",
                      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                      "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                      "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    }

    /// A scene with a world, like the result of loadAll(), but without its containers.
    [[nodiscard]] LoadedScene loaded(const World& world, const std::string& tables = {}) const {
        auto scene = parseScene(tables + "[ground]\nenabled = false\n[render]\nmeshes = \"" +
                                    folder_.path().filename().string() + "\"\n",
                                folder_.path().parent_path() / "scene.toml");
        EXPECT_TRUE(scene) << scene.error().message;
        scene->world = folder_.path().parent_path() / "world.json";
        EXPECT_TRUE(placeBodies(*scene, world));
        LoadedScene loaded;
        loaded.scene = std::move(*scene);
        loaded.world = world;
        loaded.live.resize(loaded.scene.colliders.size());
        loaded.played.resize(loaded.scene.colliders.size());
        return loaded;
    }

    test::TemporaryFolder folder_;
};

World namedWorld() {
    World world = test::threeBodies();
    world.colliders[0].mesh = "floor";
    world.colliders[1].mesh = "door";
    return world;
}

TEST_F(DrawnMeshesTest, MeshesAreReadOnceAndDrawnForEachBody) {
    const LoadedScene scene = loaded(
        namedWorld(), "world = \"world.json\"\n[[collider]]\nfile = \"own.relief\"\nposition = [0, 5, 0]\n");
    const auto meshes = loadDrawnMeshes(scene);
    ASSERT_TRUE(meshes) << meshes.error().message;
    EXPECT_EQ(meshes->meshes.size(), 3U);
    EXPECT_EQ(*drawnFiles(scene),
              (std::vector<fs::path>{folder_.path() / "door.ply", folder_.path() / "floor.obj",
                                     folder_.path() / "own.obj"}));
    ASSERT_EQ(meshes->places.size(), 4U);
    EXPECT_FALSE(meshes->floor) << "the scene has no ground";
    EXPECT_EQ(meshes->places[2].mesh, meshes->places[3].mesh) << "door and gate share a mesh";
    const std::vector<MeshPlace> places = meshPlaces(scene, *meshes, 0.0);
    EXPECT_EQ(places[0].pose.position, glm::vec3(0.0F, 5.0F, 0.0F));
    EXPECT_EQ(places[2].pose, scene.scene.colliders[2].pose);
    EXPECT_FALSE(places[2].moves);
}

TEST_F(DrawnMeshesTest, MeshFilesAreNamedAsInTheContainer) {
    for (const char* name : {"props/chair", "props\\chair"}) {
        folder_.write("props_chair.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        World world = namedWorld();
        world.colliders[1].mesh = name;
        const LoadedScene scene = loaded(world, "world = \"world.json\"\n");
        const auto files = required(drawnFiles(scene));
        EXPECT_EQ(files.back(), folder_.path() / "props_chair.obj");
    }
}

TEST_F(DrawnMeshesTest, LinksOutOfTheFolderAreNotRead) {
    const test::TemporaryFolder elsewhere;
    fs::rename(folder_.path() / "floor.obj", folder_.path() / "stored");
    fs::create_symlink("stored", folder_.path() / "floor.obj");
    const LoadedScene scene = loaded(namedWorld(), "world = \"world.json\"\n");
    EXPECT_TRUE(drawnFiles(scene)) << "a link that stays inside";
    const fs::path secret = elsewhere.write("secret.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    fs::remove(folder_.path() / "floor.obj");
    fs::create_symlink(secret, folder_.path() / "floor.obj");
    expectErrorOf(drawnFiles(scene), "scene.toml:5:", "floor.obj' is a link out of its folder");
    expectErrorOf(loadDrawnMeshes(scene), "scene.toml:5:", "floor.obj' is a link out of its folder");
}

TEST_F(DrawnMeshesTest, AllFilesCoverEveryRun) {
    World world = namedWorld();
    world.colliders[0].coarse = WorldFile{"floor.coarse.relief", "", 0};
    world.colliders[1].mesh = "missing";
    const fs::path folder = folder_.path().parent_path();
    std::set<fs::path> wanted = {folder / "world.json", folder_.path() / "floor.obj",
                                 folder / "floor.coarse.relief"};
    for (const WorldCollider& collider : world.colliders) {
        wanted.insert(folder / collider.file);
    }
    const std::vector<fs::path> files = allFilesOf(loaded(world, "world = \"world.json\"\n"));
    EXPECT_EQ(std::set(files.begin(), files.end()), wanted);
}

TEST_F(DrawnMeshesTest, TilesOfAMeshAreDrawnOnce) {
    World world = namedWorld();
    test::addTile(world, 0, "floor-1.relief", world.bodies.size());
    EXPECT_EQ(loadDrawnMeshes(loaded(world, "world = \"world.json\"\n"))->places.size(), 3U);
    world.bodies.back().position.x += 10.0F;  // at another place it is another body
    EXPECT_EQ(loadDrawnMeshes(loaded(world, "world = \"world.json\"\n"))->places.size(), 4U);
}

TEST_F(DrawnMeshesTest, MissingFilesAreErrors) {
    for (const char* name : {"", ".", "..", "../door", "a/b", "a\\b"}) {
        World world = namedWorld();
        world.colliders[1].mesh = name;
        expectErrorOf(loadDrawnMeshes(loaded(world, "world = \"world.json\"\n")), "scene.toml:5:", "");
    }
    World world = namedWorld();
    world.colliders[1].mesh = "window";
    EXPECT_NE(loadDrawnMeshes(loaded(world, "world = \"world.json\"\n")).error().message.find("'window.ply'"),
              std::string::npos);
}

TEST(SceneWeather, InterpolatesLinearly) {
    const std::string meshes = kSceneHead + "[render]\nmeshes = \"m\"\n";
    const Scene scene = goodScene(meshes +
                                  "fog_distance = 5\n[[render.weather]]\ntime = 1\nsnow = 0.2\nsun = 0.5\n"
                                  "[[render.weather]]\ntime = 3\nsnow = 0.6\nwet = 1\n");
    EXPECT_EQ(meshStyle(scene, 0.0).snow, 0.2F);
    EXPECT_FLOAT_EQ(meshStyle(scene, 2.0).snow, 0.4F);
    EXPECT_FLOAT_EQ(meshStyle(scene, 2.0).wet, 0.5F);
    EXPECT_FLOAT_EQ(meshStyle(scene, 2.0).sun, 0.75F);
    EXPECT_EQ(meshStyle(scene, 9.0).snow, 0.6F);
    EXPECT_EQ(meshStyle(scene, 9.0).fog_distance, 5.0F);
    EXPECT_EQ(meshStyle(goodScene(meshes), 1.0).sun, 1.0F);
}

TEST(SceneLooks, ReadsEveryKey) {
    const Scene scene = sceneWith(
        "[render]\nsprite = \"quad\"\nblend = \"additive\"\nsoft_distance = 0.5\natlas = "
        "\"a.png\"\natlas_cells = [4, "
        "2]\n"
        "mesh = \"m.obj\"\n[[type]]\nsize = 0.25\ncolor = [1, 0, 0.5]\n"
        "[[type]]\nsize = [[0, 1], [0.5, 2]]\ncolor = [[0, 1, 0, 0], [1, 0, 1, 0]]\nopacity = [[0, 0], [1, "
        "1]]\n"
        "rotation = [[0.25, -3]]\nrotation_spread = 1\nspin_spread = 2\ncell = [3, 7]\nlit = "
        "false\n[[type]]\ncell = 6\nfade = "
        "[1, 2]\nstretch = 0.25\n");
    EXPECT_EQ(scene.render.atlas, std::filesystem::path("dir/a.png"));
    EXPECT_EQ(scene.render.atlas_columns, 4U);
    EXPECT_EQ(scene.render.atlas_rows, 2U);
    EXPECT_EQ(scene.render.mesh, std::filesystem::path("dir/m.obj"));
    ASSERT_EQ(scene.types.size(), 3U);
    ParticleLook first;
    first.size = {{0.0F, 0.25F}};
    first.color = {{0.0F, {1.0F, 0.0F, 0.5F}}};
    EXPECT_EQ(scene.types[0].look, first);
    EXPECT_EQ(scene.types[1].look,
              (ParticleLook{.size = {{0.0F, 1.0F}, {0.5F, 2.0F}},
                            .color = {{0.0F, {1.0F, 0.0F, 0.0F}}, {1.0F, {0.0F, 1.0F, 0.0F}}},
                            .opacity = {{0.0F, 0.0F}, {1.0F, 1.0F}},
                            .rotation = {{0.25F, -3.0F}},
                            .rotation_spread = 1.0F,
                            .spin_spread = 2.0F,
                            .cell_first = 3,
                            .cell_last = 7,
                            .lit = false,
                            .fade_in = 0.0F,  // the opacity track replaces the fades
                            .fade_out = 0.0F}));
    EXPECT_EQ(scene.types[2].look.cell_last, 6U);
    EXPECT_EQ(scene.types[2].look.fade_out, 2.0F);
}

TEST(SceneCamera, KeysDefaultToTheCamera) {
    const auto scene = required(
        withDefaults(sceneWith("[camera]\ntarget = [0, 1, 0]\nfov = 40\n"
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
