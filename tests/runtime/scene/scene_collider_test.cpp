// SPDX-License-Identifier: Apache-2.0
// The scene's colliders: pose keys, particle types, materials, clips, and the bodies of a world. bodies_test.cpp tests
// poses between keys.
#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <memory>
#include <numbers>
#include <tuple>

#include "formats/container.h"
#include "runtime/bodies/world_bodies.h"
#include "runtime/picture/camera.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/scene/scene_collider.h"
#include "runtime/scene/scene_emitter.h"
#include "runtime/scene/scene_live.h"
#include "runtime/scene/scene_meshes.h"
#include "runtime/scene/scene_pictures.h"
#include "runtime/scene/scene_world.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"
#include "tests/runtime/bodies/three_bodies.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/live/animated_container.h"
#include "tests/runtime/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

void expectNear(const glm::vec3& a, const glm::vec3& b, float bound) {
    EXPECT_NEAR(a.x, b.x, bound);
    EXPECT_NEAR(a.y, b.y, bound);
    EXPECT_NEAR(a.z, b.z, bound);
}

/// Rotates by 120 degrees about z and moves from x = 1 to x = 5, from 2 s to 4 s.
SceneCollider turning() {
    SceneCollider collider;
    collider.posed = true;
    collider.pose.scale = 2.0F;
    const float angle = 2.0F / 3.0F * std::numbers::pi_v<float>;
    collider.keys = {{2.0, {{1.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F, 0.0F}, 2.0F}},
                     {4.0, {{5.0F, 0.0F, 0.0F}, glm::angleAxis(angle, glm::vec3(0.0F, 0.0F, 1.0F)), 2.0F}}};
    return collider;
}

TEST(SceneCollider, ReadsEveryKey) {
    const Scene scene = goodScene(
        "[[collider]]\nfile = \"a.relief\"\nposition = [1, 2, 3]\naxis = [0, 0, 5]\nangle = 90\nscale = 0.5\n"
        "restitution = 0.25\nfriction = 0.75\n"
        "[[collider.key]]\ntime = 1\n"
        "[[collider.key]]\ntime = 2.5\nposition = [4, 5, 6]\nangle = -180\n"
        "[[collider]]\nfile = \"b/b.relief\"\nangle = 180\n");
    ASSERT_EQ(scene.colliders.size(), 2U);
    const SceneCollider& first = scene.colliders[0];
    EXPECT_EQ(first.restitution, 0.25F);
    EXPECT_EQ(first.friction, 0.75F);
    // A quarter turn about z maps x to y.
    expectNear(toWorld(first.pose, {2.0F, 0.0F, 0.0F}), {1.0F, 3.0F, 3.0F}, 1e-6F);
    ASSERT_EQ(first.keys.size(), 2U);
    EXPECT_EQ(first.keys[0].time, 1.0);
    EXPECT_EQ(first.keys[0].pose, first.pose) << "missing values of a key are the collider's";
    EXPECT_EQ(poseAt(first, 9.0), first.keys[1].pose);
    // Half a turn about y, the default axis of an angle; the collider's scale.
    expectNear(toWorld(first.keys[1].pose, {2.0F, 0.0F, 0.0F}), {3.0F, 5.0F, 6.0F}, 1e-6F);
    const SceneCollider& second = scene.colliders[1];
    expectNear(toWorld(poseAt(second, 9.0), {1.0F, 2.0F, 3.0F}), {-1.0F, 2.0F, -3.0F}, 1e-6F);
    EXPECT_EQ(second.path, std::filesystem::path("dir/b/b.relief"));
    EXPECT_EQ(second.origin, "dir/scene.toml:16:8");
    const Scene tiny = sceneWith("axis = [0, 0, 1e-30]\nangle = 90\n");
    expectNear(toWorld(tiny.colliders.front().pose, {1.0F, 0.0F, 0.0F}), {0.0F, 1.0F, 0.0F}, 1e-6F);
}

TEST(SceneCollider, AnyPoseKeyPosesIt) {
    EXPECT_FALSE(sceneWith("").colliders.front().posed);
    for (const char* key : {"position = [0, 0, 0]", "angle = 0", "scale = 1", "restitution = 1",
                            "friction = 0", "[[collider.key]]\ntime = 0\n[[collider.key]]\ntime = 1"}) {
        EXPECT_TRUE(sceneWith(std::string(key) + "\n").colliders.front().posed) << key;
    }
}

TEST(WorldBounds, ContainARotatingBoxAtEveryTime) {
    const Bounds object{glm::vec3(-1.0F), glm::vec3(1.0F)};
    SceneCollider collider = turning();
    // Without translation: the corners of a square of half side 2 pass ±2√2 on x and y; z does not change.
    collider.keys[1].pose.position = collider.keys[0].pose.position;
    const Bounds turned = worldBounds(collider, object);
    const float reach = 2.0F * std::sqrt(2.0F);
    expectNear(turned.min, {1.0F - reach, -reach, -2.0F}, 0.003F);
    expectNear(turned.max, {1.0F + reach, reach, 2.0F}, 0.003F);
    // With translation: from x = 1 − 2 (at the start of the rotation) to 5 + 2.
    const Bounds moved = worldBounds(turning(), object);
    EXPECT_LE(moved.min.x, -1.0F);
    EXPECT_GE(moved.max.x, 7.0F);
    EXPECT_NEAR(moved.max.y, reach, 0.003F);
    // At rest: only the pose.
    SceneCollider still;
    still.pose = {{1.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F, 0.0F}, 3.0F};
    EXPECT_EQ(worldBounds(still, object), (Bounds{{-2.0F, -3.0F, -3.0F}, {4.0F, 3.0F, 3.0F}}));
}

TEST(SceneTypes, DefaultsAreThoseOfCollisions) {
    const Scene scene = sceneWith(
        "[collision]\nrestitution = 0.2\nfriction = 0.3\nfriction_threshold = 0.4\n[[type]]\n"
        "[[type]]\nname = \"rain\"\nmass = 2\nradius = 0.25\nrestitution = 0.5\nfriction = 0.75\n"
        "friction_threshold = 0\non_collision = \"die\"\nlifetime_loss = 1.5\n");
    ASSERT_EQ(scene.types.size(), 2U);
    const ParticleType& first = scene.types[0];
    EXPECT_EQ(first.restitution, 0.2F);
    EXPECT_EQ(first.friction, 0.3F);
    EXPECT_EQ(first.friction_threshold, 0.4F);
    const ParticleType& rain = scene.types[1];
    EXPECT_EQ(rain.mass, 2.0F);
    EXPECT_EQ(rain.radius, 0.25F);
    EXPECT_EQ(rain.restitution, 0.5F);
    EXPECT_EQ(rain.friction, 0.75F);
    EXPECT_EQ(rain.friction_threshold, 0.0F);
    EXPECT_EQ(rain.on_collision, OnCollision::kDie);
    EXPECT_EQ(rain.lifetime_loss, 1.5F);
}

TEST(SceneLive, ReadsKeys) {
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

TEST(SceneLive, MapsContainTheMotionOfTheMesh) {
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
    EXPECT_EQ(live.mesh.positions.size(), 5U) << "no vertex is duplicated";
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
    expectErrorOf(loadLiveMesh(collider), "scene.toml:2:8");
}

const std::string kHead = "[[collider]]\nfile = \"box.relief\"\n";

void writeBox(const test::TemporaryFolder& folder) {
    Collider box = analytic::frontBackCollider(analytic::box({-0.4, -0.2, -0.3}, {0.4, 0.2, 0.3}), 16);
    box.materials.list = {{"oak", 0.5F, 0.25F}, {"stove"}};
    box.materials.size = 1.0F;
    box.materials.origin = glm::vec3(-0.5F);
    box.materials.nodes.resize(1);
    box.materials.nodes[0].leaves = {0, 1, 0, 1, 0, 1, 0, 1};
    EXPECT_TRUE(saveCollider(folder.path() / "box.relief", box));
}

TEST(SceneMaterial, ResponsesAreAppliedByName) {
    const test::TemporaryFolder folder;
    writeBox(folder);
    const auto loaded = required(loadAll(
        folder.write("scene.toml", kHead +
                                       "[[material]]\nname = \"stove\"\nfriction = 0.75\nlifetime_loss = 3\n"
                                       "[[material]]\nname = \"oak\"\nrestitution = 0.125\n"
                                       "[[spawn]]\non = \"collision\"\nmaterial = \"stove\"\n"),
        {}));
    const std::vector<Material>& list = loaded.colliders.front()->materials.list;
    EXPECT_EQ(list[0], (Material{"oak", 0.125F, 0.25F}));
    EXPECT_EQ(list[1], (Material{"stove", 1.0F, 0.75F, 3.0F}));
    // Indices into the names of the textures. A name that is missing there is never hit.
    const std::vector<std::string> names{"oak", "stove"};
    EXPECT_EQ(makeSpawners(loaded.scene.spawns, names).front().settings().material, 1);
    EXPECT_EQ(makeSpawners(loaded.scene.spawns, std::span(names).first(1)).front().settings().material, 1);
}

TEST(SceneMaterial, UnknownNamesAreErrors) {
    const test::TemporaryFolder folder;
    writeBox(folder);
    for (const auto& [more, what] :
         {std::pair("[[material]]\nname = \"stave\"\n", "scene.toml:4:8: material[0].name = 'stave'"),
          {"[[spawn]]\non = \"collision\"\nmaterial = \"ice\"\n",
           "scene.toml:5:12: spawn[0].material = 'ice'"}}) {
        expectErrorOf(loadAll(folder.write("scene.toml", kHead + more), {}), what);
        // Another scene that replaces this one during play.
        const auto plays = required(loadAll(folder.write("plays.toml", kHead), {}));
        EXPECT_TRUE(checkMaterials(plays.scene, plays));
        EXPECT_FALSE(checkMaterials(goodScene(kHead + more), plays));
    }
}

TEST(SceneMaterial, WorldsHaveMaterials) {
    World world;
    world.materials = {{"oak", 0.5F, {}, {}}, {"ice", {}, 0.0F, 1.0F}};
    world.colliders.resize(1);
    world.colliders[0].file = "a.relief";
    world.colliders[0].hash.assign(32, '0');
    world.colliders[0].gpu_bytes = 1;
    world.bodies.resize(1);
    const auto read = required(parseWorld(worldText(world)));
    EXPECT_EQ(read.materials, world.materials);
    world.materials[1].name = "oak";
    EXPECT_EQ(parseWorld(worldText(world)).error().code, ErrorCode::kInvalidInput);
    world.materials.clear();
    EXPECT_EQ(worldText(world).find("materials"), std::string::npos);
}

const std::string kTube = "[[collider]]\nfile = \"tube.relief\"\n";

TEST(ScenePlay, IsLoadedWithItsClip) {
    const std::string keys =
        "clip = \"bend\", start = 0.5, speed = -2, loop = false, bounds_scale = 1.5, resolution = 64";
    EXPECT_EQ(goodScene(kTube + "play = { " + keys + " }\n").colliders.front().play,
              (ScenePlay{"bend", 0.5F, -2.0F, false, 1.5F, 64}));
    const test::TemporaryFolder folder;
    ASSERT_TRUE(saveCollider(folder.path() / "tube.relief", animatedContainer(bendingTube(12, 8))));
    const std::string two = kTube + "position = [3, 0, 0]\nplay = { clip = \"bend\" }\n" + kTube +
                            "play = { clip = \"grow\", start = 0.25, loop = false }\n" + kTube;
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
    const auto expectRefused = [&](const std::string& words, const std::string& place = "2:8") {
        expectErrorOf(loadAll(folder.write("scene.toml", kTube + "play = { clip = \"run\" }\n"), {}),
                      "scene.toml:" + place + ": ", words);
    };
    expectRefused("'bend', 'grow'", "3:17");
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
            folder.write("scene.toml", kTube + "play = {}\n" + keys +
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
                  "scene.toml:5:8: collider.material: ", "hat");
}

Scene placed(const std::string& text, const World& world = test::threeBodies()) {
    Scene scene = goodScene("world = \"level/world.json\"\n" + text);
    const auto done = placeBodies(scene, world);
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
        expectErrorStart(checkOverlap(refused), ErrorCode::kLimit, words);
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
        for (unsigned i = 0; i < 8; ++i) {
            const glm::vec4 clip =
                camera.projection(640.0F / 360.0F) * camera.view() * glm::vec4(bounds.corner(i), 1.0F);
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
    const Scene moved = placed(
        "[[collider]]\nnode = \"door\"\nangle = 30\n[[collider.key]]\ntime = 1\n[[collider.key]]\ntime = 2\n"
        "position = [4, 0.5, 1]\n",
        threeBodiesAndATile());
    ASSERT_EQ(moved.colliders.size(), 4U);
    EXPECT_EQ(moved.colliders[1].node, "floor");
    EXPECT_EQ(moved.colliders[2].node, "gate") << "has the same index as without the tile";
    const SceneCollider& door = moved.colliders[0];
    const SceneCollider& tile = moved.colliders[3];
    EXPECT_EQ(tile.path, std::filesystem::path("dir/level/door-1.relief"));
    EXPECT_EQ(tile.tile_of, 0U);
    EXPECT_FALSE(door.tile_of);
    EXPECT_NE(door.pose, poseOf(test::threeBodies().bodies[1]));
    for (const double time : {0.0, 1.25, 1.5, 3.0}) {
        EXPECT_EQ(poseAt(tile, time), poseAt(door, time));
    }
    EXPECT_EQ(tile.restitution, 0.25F);
    const Scene still = placed("", threeBodiesAndATile());
    ASSERT_EQ(still.colliders.size(), 4U);
    EXPECT_EQ(still.colliders[2].path, std::filesystem::path("dir/level/door-1.relief"))
        << "in the world's order";
    EXPECT_FALSE(still.colliders[2].tile_of);
}

TEST(SceneWorld, NodesHaveOnePlaceInTheWorld) {
    World elsewhere = threeBodiesAndATile();
    elsewhere.bodies[2].position.x += 1.0F;
    const std::string door = "[[collider]]\nnode = \"door\"\n";
    const std::string window = "[[collider]]\nnode = \"window\"\n";
    for (const auto& [nodes, world, place] :
         {std::tuple(door, elsewhere, "3:8: collider[0].node = 'door'"),
          {window, test::threeBodies(), "3:8: collider[0].node = 'window'"},
          {door + door, test::threeBodies(), "5:8: collider[1].node = 'door'"}}) {
        Scene scene = goodScene("world = \"w.json\"\n" + nodes);
        expectErrorStart(placeBodies(scene, world), ErrorCode::kInvalidInput,
                         std::string("dir/scene.toml:") + place);
    }
}

}  // namespace
}  // namespace relief::test
