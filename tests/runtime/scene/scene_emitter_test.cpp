// SPDX-License-Identifier: Apache-2.0
// [emitter], [[emitter]] and [[spawn]]: their keys and defaults; surface emitters, and the meshes and weather of
// pictures.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <set>
#include <string>

#include "formats/container.h"
#include "runtime/births/emitter_motion.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/scene/scene_births.h"
#include "runtime/scene/scene_emitter.h"
#include "runtime/scene/scene_meshes.h"
#include "runtime/scene/scene_pictures.h"
#include "runtime/scene/scene_world.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/results.h"
#include "tests/runtime/bodies/three_bodies.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/live/animated_container.h"
#include "tests/runtime/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

SceneEmitter good(const std::string& keys) {
    return goodScene(kSceneHead + "[emitter]\n" + keys).emitters.at(0);
}

TEST(SceneEmitter, ReadsMotion) {
    const std::string keys =
        "[[emitter.key]]\ntime = 1\nposition = [1, 2, 3]\n"
        "[[emitter.key]]\ntime = 2\nangle = 90\n";
    const SceneEmitter rests = good("");
    const SceneEmitter moves = good("point = [1, 0, 0]\nattach = 0\ninherit = 0.5\n" + keys);
    EXPECT_FALSE(rests.moves());
    EXPECT_TRUE(moves.moves());
    ASSERT_EQ(moves.keys.size(), 2U);
    EXPECT_EQ(moves.keys[0].pose.position, glm::vec3(1, 2, 3));
    EXPECT_EQ(moves.keys[1].time, 2.0);
    SceneCollider collider;
    collider.pose.position = {0.0F, 7.0F, 0.0F};
    auto motions = emitterMotions(std::span(&moves, 1), std::span(&collider, 1));
    ASSERT_EQ(motions.size(), 1U);
    EXPECT_EQ(motions[0].keys.size(), 2U);
    ASSERT_EQ(motions[0].body.size(), 1U) << "attached to a resting collider";
    EXPECT_EQ(motions[0].body[0].pose, collider.pose);
    EXPECT_EQ(motions[0].inherit, 0.5F);
    collider.keys = moves.keys;
    EXPECT_EQ(emitterMotions(std::span(&moves, 1), std::span(&collider, 1))[0].body.size(), 2U);
    EXPECT_TRUE(emitterMotions(std::span(&rests, 1), std::span(&collider, 1))[0].none());
}

TEST(SceneEmitter, ReadsShapes) {
    const SceneEmitter point = good("shape = \"point\"\npoint = [1, 2, 3]\n");
    EXPECT_EQ(point.shape, EmitterShape::kBox);
    EXPECT_EQ(point.box_min, glm::vec3(1, 2, 3));
    EXPECT_EQ(point.box_max, glm::vec3(1, 2, 3));
    const SceneEmitter disc = good("shape = \"disc\"\ncenter = [1, 2, 3]\nradius = 4\nnormal = [1, 0, 0]\n");
    EXPECT_EQ(disc.shape, EmitterShape::kDisc);
    EXPECT_EQ(disc.center, glm::vec3(1, 2, 3));
    EXPECT_EQ(disc.radius, 4.0F);
    EXPECT_EQ(disc.normal, glm::vec3(1, 0, 0));
}

TEST(SceneEmitter, ReadsTimesAndSpeeds) {
    const SceneEmitter timed =
        good("start = 1.5\nburst = 10\nburst_every = 0.5\nduration = 3\ninterpolate = false\n");
    EXPECT_EQ(timed.start, 1.5);
    EXPECT_EQ(timed.burst, 10U);
    EXPECT_EQ(timed.burst_every, 0.5);
    EXPECT_EQ(timed.duration, 3.0);
    EXPECT_FALSE(timed.interpolate);
    const EmitterAim span = *good("direction = [0, 2, 0]\ncone = 20\nspeed = [1, 4]\n").aim;
    EXPECT_EQ(*span.direction, glm::vec3(0, 2, 0));
    EXPECT_EQ(span.cone_degrees, 20.0F);
    EXPECT_EQ(span.speed_min, 1.0F);
    EXPECT_EQ(span.speed_max, 4.0F);
    const EmitterAim normal = *good("direction = [0, 2, 0]\nspeed = { mean = 2, deviation = 0.5 }\n").aim;
    EXPECT_EQ(normal.speed_min, 2.0F);
    EXPECT_EQ(normal.speed_deviation, 0.5F);
    EXPECT_TRUE(good("shape = \"shell\"\ncenter = [0, 0, 0]\nradius = 1\nspeed = 1\n").aim);
    EXPECT_FALSE(good("velocity = [1, 0, 0]\n").aim);
    EXPECT_EQ(good("type = \"b\"\n[[type]]\nname = \"a\"\n[[type]]\nname = \"b\"\n").type, 1U);
}

TEST(SceneEmitter, SharesDefaultsAmongEmitters) {
    const auto scene = required(withDefaults(
        goodScene(kSceneHead +
                  "[time]\ndt = 0.1\nsteps = 100\n[particles]\ncapacity = 10000\n"
                  "[[emitter]]\nrate = 100\n[[emitter]]\nburst = 100\nburst_every = 1\nduration = 4.5\n"
                  "[[emitter]]\nstart = 5\ndirection = [0, 1, 0]\n"),
        unitBounds()));
    // 10000 minus 1000 by the first emitter's rate and 5 bursts of 100: 4250 for each of the two without a rate.
    EXPECT_NEAR(scene.emitters[1].rate, 8500.0 / 2.0 / 4.5, 1e-4);
    EXPECT_NEAR(scene.emitters[2].rate, 8500.0 / 2.0 / 5.0, 1e-4);
    EXPECT_EQ(scene.emitters[2].velocity, glm::vec3(0.0F));
    EXPECT_EQ(scene.emitters[2].velocity_spread, glm::vec3(0.0F));
    EXPECT_FLOAT_EQ(scene.emitters[2].aim->speed_max, 1.6F);  // 0.8 of the longest side, 2
    EXPECT_GT(scene.emitters[2].box_min.y, 1.0F);

    const std::string full =
        kSceneHead + "[particles]\ncapacity = 10\n[[emitter]]\nrate = 100\n[[emitter]]\n";
    EXPECT_FALSE(withDefaults(goodScene(full), unitBounds()));
}

TEST(SceneSpawn, ReadsEveryKey) {
    const Scene scene =
        goodScene(kSceneHead +
                  "[[type]]\nname = \"drop\"\n[[type]]\nname = \"splash\"\n"
                  "[[spawn]]\non = \"collision\"\nparent = \"drop\"\ntype = \"splash\"\ncount = [2, 5]\n"
                  "max_per_step = 70\nlifetime = [0.5, 2]\ninherit = 0.25\nspeed = [1, 3]\nkick = 0.5\n"
                  "cone = 20\nmin_speed = 0.75\nseed = 6\n[[spawn]]\non = \"death\"\nspeed = 2\n"
                  "[[spawn]]\non = \"collision\"\n");
    const SpawnSettings wanted{.parent = 0,
                               .min_speed = 0.75F,
                               .material = {},
                               .type = 1,
                               .count_min = 2,
                               .count_max = 5,
                               .max_per_step = 70,
                               .lifetime_min = 0.5F,
                               .lifetime_max = 2.0F,
                               .inherit = 0.25F,
                               .speed_min = 1.0F,
                               .speed_max = 3.0F,
                               .kick = 0.5F,
                               .cone_degrees = 20.0F};
    EXPECT_TRUE(SpawnSettings(scene.spawns.at(0)) == wanted);
    EXPECT_EQ(scene.spawns[0].seed, 6U);
    const SpawnSettings death{
        .on = SpawnOn::kDeath, .parent = {}, .material = {}, .speed_min = 2.0F, .speed_max = 2.0F};
    EXPECT_TRUE(SpawnSettings(scene.spawns.at(1)) == death);
    EXPECT_EQ(scene.spawns.at(2).cone_degrees, 60.0F);
}

TEST(SceneEmitter, EmittersSpawn) {
    const test::TemporaryFolder folder;
    folder.write("points.csv", "1,2,3\n");
    const auto make = [&](const std::string& keys) {
        const Scene scene =
            required(parseScene(kSceneHead + "[emitter]\n" + keys, folder.path() / "scene.toml"));
        return makeEmitters(required(withDefaults(scene, unitBounds())).emitters, SceneMeshes{});
    };
    auto made =
        required(make("points = \"points.csv\"\nburst = 3\nrate = 0\nvelocity_spread = [0, 0, 0]\n"
                      "velocity = [4, 5, 6]\ntype = 3\nlifetime = 2\n"));
    std::vector<Birth> births;
    emitAll(made, 0.1, 100, births);
    ASSERT_EQ(births.size(), 3U);
    EXPECT_EQ(births[0].position, glm::vec3(1, 2, 3));
    EXPECT_EQ(births[0].velocity, glm::vec3(4, 5, 6));
    EXPECT_EQ(births[0].type, 3U);
    EXPECT_EQ(births[0].lifetime, 2.0F);

    EXPECT_TRUE(make("points = \"points.csv\"\nspeed = 1\ndirection = [0, 1, 0]\n"));
    expectErrorOf(make("points = \"points.csv\"\nspeed = 1\n"), "scene.toml:4:10: emitter.points: ");
    EXPECT_EQ(make("points = \"none.csv\"\n").error().code, ErrorCode::kIo);
}

const std::string kCollider = "[[collider]]\nfile = \"tube.relief\"\n";
const std::string kPlayed = kCollider + "play = { clip = \"bend\", start = 0.5 }\n";
const std::string kSurface = "[[emitter]]\nshape = \"surface\"\n";

double areaOf(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles) {
    double area = 0.0;
    for (const glm::uvec3& t : triangles) {
        const glm::dvec3 p(positions[t.x]);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(positions[t.y]) - p, glm::dvec3(positions[t.z]) - p));
    }
    return area;
}

class SceneSurface : public testing::Test {
  protected:
    SceneSurface() {
        EXPECT_TRUE(saveCollider(folder_.path() / "tube.relief", animatedContainer(mesh_)));
        folder_.write(
            "cube.obj",
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
            "f 4 3 2 1\no shell\nusemtl wood\nf 5 6 7 8\ng lid top\nusemtl iron\nf 4 8 7 3\nf 1 2 6 5\n");
    }
    Result<LoadedScene> load(const std::string& text) {
        return loadAll(folder_.write("scene.toml", text), {});
    }
    double area(const std::string& text) {
        return required(load(text)).emitters.at(0).settings().surface->area();
    }
    void expectRefused(const std::string& text, const std::string& place, const std::string& words) {
        expectErrorOf(load(text), "scene.toml:" + place + ": ", words);
    }

    const AnimatedMesh mesh_ = tubeWithMaterials("cloth", "skin");
    const test::TemporaryFolder folder_;
};

TEST_F(SceneSurface, SelectsGroupsAndMaterials) {
    const std::vector<glm::vec3> bent = posed(mesh_, poseAt(mesh_, mesh_.clips[0], 0.5));
    EXPECT_NEAR(area(kPlayed + kSurface + "attach = 0\n"), areaOf(bent, mesh_.triangles), 1e-6);
    EXPECT_NEAR(area(kCollider + kSurface + "attach = 0\n"), areaOf(mesh_.positions, mesh_.triangles), 1e-6)
        << "at rest";
    EXPECT_GT(std::abs(areaOf(bent, mesh_.triangles) - areaOf(mesh_.positions, mesh_.triangles)), 1e-3);
    double skin = 0.0;
    double upper = 0.0;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
        const glm::uvec3& t = mesh_.triangles[i];
        const double own = areaOf(mesh_.positions, {t});
        skin += mesh_.triangle_materials[i] == 1 ? own : 0.0;
        for (int corner = 0; corner < 3; ++corner) {
            // The joint weight that the tube is made with.
            const float y = mesh_.positions[t[corner]].y;
            upper += own / 3.0 * double{std::clamp((y / 2.0F - 0.5F) * 3.0F + 0.5F, 0.0F, 1.0F)};
        }
    }
    const std::string head = kCollider + kSurface + "attach = 0\n";
    EXPECT_NEAR(area(head + "material = \"skin\"\n"), skin, 1e-6);
    EXPECT_NEAR(area(head + "group = \"middle\"\n"), upper, 1e-6);
    const double both = area(head + "group = \"middle\"\nmaterial = \"skin\"\n");
    EXPECT_LT(both, std::min(skin, upper));
    EXPECT_GT(both, 0.5 * skin);
}

TEST_F(SceneSurface, MayBeAMeshFile) {
    const std::string head = kCollider + kSurface + "mesh = \"cube.obj\"\n";
    EXPECT_NEAR(area(head), 4.0, 1e-6);
    EXPECT_NEAR(area(head + "group = \"lid top\"\n"), 2.0, 1e-6);
    EXPECT_NEAR(area(head + "group = \"shell\"\n"), 1.0, 1e-6);
    EXPECT_NEAR(area(head + "material = \"iron\"\n"), 2.0, 1e-6);
    EXPECT_NEAR(area(head + "material = \"wood\"\ngroup = \"shell\"\n"), 1.0, 1e-6);
    EXPECT_NEAR(area(head + "attach = 0\n"), 4.0, 1e-6) << "in the collider's space";
    expectRefused(head + "group = \"floor\"\n", "6:9", "'shell', 'lid top'");
    expectRefused(head + "material = \"glass\"\n", "6:12", "'wood', 'iron'");
    expectRefused(head + "material = \"wood\"\ngroup = \"lid top\"\n", "3:1", "no area");
    const auto files = filesOf(required(load(head)).scene);
    EXPECT_NE(std::ranges::find(files, folder_.path() / "cube.obj"), files.end());
}

TEST_F(SceneSurface, CollidersWithoutAMeshGiveASurface) {
    const glm::dvec3 half(0.5, 0.3, 0.2);
    ASSERT_TRUE(saveCollider(folder_.path() / "box.relief",
                             analytic::frontBackCollider(analytic::box(-half, half), 128)));
    const std::string box = "[[collider]]\nfile = \"box.relief\"\n";
    EXPECT_NEAR(area(box + kSurface + "attach = 0\n"), 2.48, 0.03);
    const auto two = required(
        load(box + box + "position = [3, 0, 0]\n" + kSurface + "attach = 0\n" + kSurface + "attach = 1\n"));
    EXPECT_EQ(two.emitters[0].settings().surface->area(), two.emitters[1].settings().surface->area());
    folder_.write("ball.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const std::string wobbles =
        "[[collider]]\nmesh = \"ball.obj\"\ndeform = { amplitude = 0.1, frequency = 1 }\n";
    EXPECT_NEAR(area(wobbles + kSurface + "attach = 0\n"), 1.5 + 0.5 * std::sqrt(3.0), 1e-6);
    expectRefused(wobbles + kSurface + "attach = 0\ngroup = \"a\"\n", "7:9", "emitter.group");
}

TEST_F(SceneSurface, MissingPartsAreErrors) {
    const std::string head = kPlayed + kSurface + "attach = 0\n";
    expectRefused(head + "group = \"Head\"\n", "7:9", "emitter.group");
    expectRefused(head + "material = \"hair\"\n", "7:12", "emitter.material");
    Collider bare = animatedContainer(mesh_);
    bare.animation.clear();
    ASSERT_TRUE(saveCollider(folder_.path() / "tube.relief", bare));
    expectRefused(kCollider + kSurface + "attach = 0\ngroup = \"Head\"\n", "6:9", "emitter.group");
    expectRefused(kCollider + kSurface + "attach = 0\n", "3:1", (folder_.path() / "tube.relief").string());
    folder_.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    expectRefused(kCollider + kSurface + "mesh = \"flat.obj\"\n", "3:1", "no area");
}

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
        LoadedScene loaded;
        loaded.scene = required(parseScene("world = \"world.json\"\n" + tables +
                                               "[ground]\nenabled = false\n[render]\nmeshes = \"" +
                                               folder_.path().filename().string() + "\"\n",
                                           folder_.path().parent_path() / "scene.toml"));
        EXPECT_TRUE(placeBodies(loaded.scene, world));
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
    const LoadedScene scene =
        loaded(namedWorld(), "[[collider]]\nfile = \"own.relief\"\nposition = [0, 5, 0]\n");
    const auto meshes = required(loadDrawnMeshes(scene));
    EXPECT_EQ(meshes.meshes.size(), 3U);
    EXPECT_EQ(*drawnFiles(scene),
              (std::vector<fs::path>{folder_.path() / "door.ply", folder_.path() / "floor.obj",
                                     folder_.path() / "own.obj"}));
    ASSERT_EQ(meshes.places.size(), 4U);
    EXPECT_FALSE(meshes.floor) << "the scene has no ground";
    EXPECT_EQ(meshes.places[2].mesh, meshes.places[3].mesh) << "door and gate share a mesh";
    const std::vector<MeshInstance> places = meshPlaces(scene, meshes, 0.0);
    EXPECT_EQ(places[0].pose.position, glm::vec3(0.0F, 5.0F, 0.0F));
    EXPECT_EQ(places[2].pose, scene.scene.colliders[2].pose);
    EXPECT_FALSE(places[2].moves);
}

TEST_F(DrawnMeshesTest, MeshFilesAreNamedAsInTheContainer) {
    for (const char* name : {"props/chair", "props\\chair"}) {
        folder_.write("props_chair.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        World world = namedWorld();
        world.colliders[1].mesh = name;
        EXPECT_EQ(required(drawnFiles(loaded(world))).back(), folder_.path() / "props_chair.obj");
    }
}

TEST_F(DrawnMeshesTest, LinksOutOfTheFolderAreNotRead) {
    const test::TemporaryFolder elsewhere;
    fs::rename(folder_.path() / "floor.obj", folder_.path() / "stored");
    fs::create_symlink("stored", folder_.path() / "floor.obj");
    const LoadedScene scene = loaded(namedWorld());
    EXPECT_TRUE(drawnFiles(scene)) << "a link that stays inside";
    const fs::path secret = elsewhere.write("secret.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    fs::remove(folder_.path() / "floor.obj");
    fs::create_symlink(secret, folder_.path() / "floor.obj");
    const std::string words = "floor.obj' is a link to a file outside its folder";
    expectErrorOf(drawnFiles(scene), "scene.toml:5:", words);
    expectErrorOf(loadDrawnMeshes(scene), "scene.toml:5:", words);
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
    const std::vector<fs::path> files = allFilesOf(loaded(world));
    EXPECT_EQ(std::set(files.begin(), files.end()), wanted);
}

TEST_F(DrawnMeshesTest, TilesOfAMeshAreDrawnOnce) {
    World world = namedWorld();
    test::addTile(world, 0, "floor-1.relief", world.bodies.size());
    EXPECT_EQ(loadDrawnMeshes(loaded(world))->places.size(), 3U);
    world.bodies.back().position.x += 10.0F;  // at another place it is another body
    EXPECT_EQ(loadDrawnMeshes(loaded(world))->places.size(), 4U);
}

TEST_F(DrawnMeshesTest, MissingFilesAreErrors) {
    for (const char* name : {"", ".", "..", "../door", "a/b", "a\\b"}) {
        World world = namedWorld();
        world.colliders[1].mesh = name;
        expectErrorOf(loadDrawnMeshes(loaded(world)), "scene.toml:5:");
    }
    World world = namedWorld();
    world.colliders[1].mesh = "window";
    expectErrorOf(loadDrawnMeshes(loaded(world)), "scene.toml:5:", "'window.ply'");
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
        "[render]\nsprite = \"quad\"\nblend = \"additive\"\nsoft_distance = 0.5\natlas = \"a.png\"\n"
        "atlas_cells = [4, 2]\nmesh = \"m.obj\"\n[[type]]\nsize = 0.25\ncolor = [1, 0, 0.5]\n[[type]]\n"
        "size = [[0, 1], [0.5, 2]]\ncolor = [[0, 1, 0, 0], [1, 0, 1, 0]]\nopacity = [[0, 0], [1, 1]]\n"
        "rotation = [[0.25, -3]]\nrotation_spread = 1\nspin_spread = 2\ncell = [3, 7]\nlit = false\n"
        "[[type]]\ncell = 6\nfade = [1, 2]\nstretch = 0.25\n");
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
}  // namespace relief::test
