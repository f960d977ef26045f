// SPDX-License-Identifier: Apache-2.0
// The scene file: keys, defaults, hostile bytes, and errors with line and column. scene.schema.json pins the ranges of
// keys; toml_reader_test.cpp tests ranges, value types and unknown keys.
#include <gtest/gtest.h>
#include <cmath>
#include <string>

#include "formats/fields/json.h"
#include "runtime/bodies/world_textures.h"
#include "runtime/player/report.h"
#include "runtime/scene/scene.h"
#include "tests/results.h"
#include "tests/runtime/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

TEST(Scene, FramesMatchTheirSteps) {
    const auto due = [](const std::string& render, const std::string& time = "steps = 25\n") {
        const Scene scene = sceneWith("[time]\n" + time + "[render]\n" + render);
        std::vector<std::uint32_t> steps;
        for (std::uint32_t step = 0; step <= scene.time.steps; ++step) {
            if (frameDue(scene, step)) {
                steps.push_back(step);
            }
        }
        EXPECT_EQ(frameCount(scene), steps.size()) << time << render;
        return steps;
    };
    using Steps = std::vector<std::uint32_t>;
    EXPECT_EQ(due(""), (Steps{10, 20, 25}));
    EXPECT_EQ(due("steps_per_frame = 30\n"), (Steps{25}));
    EXPECT_EQ(due("steps_per_frame = 30\n", "steps = 0\n"), (Steps{0}));
    EXPECT_EQ(due("first_frame = 0\n"), (Steps{0, 10, 20, 25}));
    EXPECT_EQ(due("first_frame = 3\nlast_frame = 17\nsteps_per_frame = 7\n"), (Steps{3, 10, 17}));
    EXPECT_EQ(due("first_frame = 3\nlast_frame = 18\nsteps_per_frame = 7\n"), (Steps{3, 10, 17, 18}));
    EXPECT_EQ(due("last_frame = 5\n"), (Steps{5}));
    EXPECT_EQ(due("first_frame = 4\nlast_frame = 4\n"), (Steps{4}));
}

TEST(Scene, PrewarmIsWholeSteps) {
    EXPECT_EQ(prewarmSteps(sceneWith("")), 0U);
    EXPECT_EQ(prewarmSteps(sceneWith("[time]\ndt = 0.1\nprewarm = 0.3\n")), 3U)
        << "0.1 as a float is not exactly 0.1";
    EXPECT_EQ(prewarmSteps(sceneWith("[time]\ndt = 0.1\nprewarm = 0.31\n")), 4U);
    EXPECT_EQ(prewarmSteps(sceneWith("[time]\nprewarm = 2\n")), 120U);
}

TEST(Scene, CollidesMasksBodies) {
    const auto collides = [](const std::string& list, const std::string& more = "") {
        const Scene scene =
            goodScene(kSceneHead + kSceneHead + more + "[[type]]\ncollides_with = " + list + "\n");
        return particleTypes(scene).at(0).collides_with;
    };
    EXPECT_EQ(particleTypes(sceneWith("[[type]]\n")).at(0).collides_with, kCollidesWithAll);
    EXPECT_EQ(collides("[]"), 0U);
    EXPECT_EQ(collides("[1]"), 2U);
    EXPECT_EQ(collides("[0, \"ground\"]"), 1U + kCollidesWithGround);
    EXPECT_EQ(collides("[1, 0, \"ground\"]"), kCollidesWithAll);
    EXPECT_EQ(collides("[1, 0]"), 3U);
    EXPECT_EQ(collides("[1, 0]", "[ground]\nenabled = false\n"), kCollidesWithAll) << "no body is excluded";
}

TEST(Scene, OnlyMissingKeysDefaultToTheBounds) {
    const auto scene = required(withDefaults(sceneWith(""), unitBounds()));
    // The longest side is 2: births start above the box, and the floor is its lower end.
    EXPECT_GT(scene.emitters[0].box_min.y, 1.0F);
    EXPECT_EQ(*scene.forces.gravity, glm::vec3(0.0F, -6.0F, 0.0F));
    EXPECT_EQ(*scene.ground.height, 0.0F);
    EXPECT_FLOAT_EQ(*scene.render.point_size, 0.013F);
    EXPECT_NEAR(scene.emitters[0].rate * 5.0, 65536.0, 1e-2) << "the whole capacity is born by the end";
    EXPECT_GT(scene.camera.eye->z, 2.0F);
    const auto given = required(
        withDefaults(sceneWith("[emitter]\npoint = [1, 2, 3]\nduration = 2\nvelocity = [0, 0, 0]\n"
                               "velocity_spread = [0, 1, 0]\n[forces]\ngravity = [0, -9.81, 0]\n[ground]\n"
                               "height = -4\n[camera]\neye = [1, 1, 1]\n[render]\npoint_size = 0.5\n"),
                     unitBounds()));
    EXPECT_EQ(given.emitters[0].box_max, glm::vec3(1, 2, 3));
    EXPECT_NEAR(given.emitters[0].rate * 2.0, 65536.0, 1e-6) << "within its duration";
    EXPECT_EQ(given.emitters[0].velocity, glm::vec3(0.0F));
    EXPECT_EQ(given.emitters[0].velocity_spread, glm::vec3(0, 1, 0));
    EXPECT_EQ(*given.forces.gravity, glm::vec3(0, -9.81F, 0));
    EXPECT_EQ(*given.ground.height, -4.0F);
    EXPECT_EQ(*given.camera.eye, glm::vec3(1.0F));
    EXPECT_EQ(*given.render.point_size, 0.5F);
    EXPECT_FALSE(withDefaults(sceneWith("[camera]\neye = [0, 50, 0]\n"), unitBounds()))
        << "directly above the default target";
    EXPECT_FALSE(withDefaults(sceneWith(""), Bounds{}));
    EXPECT_FALSE(withDefaults(sceneWith(""), {glm::vec3(-3e38F), glm::vec3(3e38F)}));
    const auto flat = required(withDefaults(sceneWith(""), {glm::vec3(1.0F), glm::vec3(1.0F)}));
    EXPECT_TRUE(std::isfinite(flat.camera.eye->x));
}

TEST(Scene, SurvivesPrefixesAndFlippedBytes) {
    const std::string text =
        kSceneHead +
        "[time]\ndt = 0.01\nsteps = 10\n[[emitter]]\nbox_min = [0, 0, 0]\nbox_max = [1, 1, 1]\n"
        "lifetime = [1, 2]\n[render]\nsize = [4, 4]\ncolor = [1, 1, 1]\n[[emitter]]\nburst = 5\nseed = 7\n"
        "shape = \"disc\"\ncenter = [0, 0, 0]\nradius = 1\ncone = 9\nspeed = { mean = 1, deviation = 1 }\n"
        "type = 3\n[[emitter]]\npoints = \"p\"\nspeed = [1, 2]\nburst = 4\nburst_every = 0.5\ninterpolate = "
        "true\n";
    ASSERT_TRUE(sceneOf(text)) << sceneOf(text).error().message;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto cut = sceneOf(text.substr(0, i));
        EXPECT_TRUE(cut || cut.error().code == ErrorCode::kInvalidInput);
        for (const unsigned flip : {1U, 0x20U, 0x80U, 0xffU}) {
            std::string changed = text;
            changed[i] = static_cast<char>(static_cast<unsigned char>(changed[i]) ^ flip);
            const auto scene = sceneOf(changed);
            EXPECT_TRUE(scene || scene.error().code == ErrorCode::kInvalidInput);
        }
    }
}

TEST(Scene, MissingAndOversizedFiles) {
    expectError(loadScene("/nonexistent/scene.toml"), ErrorCode::kIo);
    const TemporaryFolder folder;
    expectError(loadScene(folder.write("a.toml", std::string((1 << 20) + 1, '#'))), ErrorCode::kLimit);
}

TEST(SceneErrors, File) {
    expectErrors("", {{"", "1:1", "collider.file"},
                      {"[[collider]]\nfile = \"a\"\n[[collider]]\n", "3:1", "collider.file"},
                      {"[collider]\nfile = \"\"\n", "2:8", "file"},
                      {"[collider]\nfile = \"a\\u0000b\"\n", "2:8", "zero byte"},
                      {"[collider]\nfile = \"/z/a.relief\"\n", "2:8", "'/z/a.relief'"},
                      {"[collider]\nfile = \"b/../../dirt/a\"\n", "2:8", "'b/../../dirt/a'"},
                      {"collider = []\n", "1:12", "collider"},
                      {"emitter = [{}, 1]\n" + kSceneHead, "1:11", "emitter"},
                      {"steps = 4\n" + kSceneHead, "1:1", "'steps'"},
                      // The first error in the file is reported.
                      {kSceneHead + "[time]\nzeta = 1\nalpha = 1\n", "4:1", "'time.zeta'"},
                      {kSceneHead + "[attractor]\nstrength = 1\n", "3:1", "[[attractor]]"}});
}

TEST(SceneErrors, Syntax) {
    for (const auto& [text, line] : {std::pair<std::string, int>{"[collider\n", 1},
                                     {kSceneHead + "[time]\ndt = \n", 4},
                                     {kSceneHead + "[time]\ndt = 1\ndt = 1\n", 5},
                                     {"\xff\xfe\x00", 1},
                                     {"a = \"\x1b[31m\"\n", 1},
                                     {std::string(100'000, '['), 1},
                                     {"a = " + std::string(100'000, '['), 1},
                                     {"a" + std::string(".a", 3) + " = {" + std::string(5000, '{'), 1}}) {
        expectErrorOf(sceneOf(text), "dir/scene.toml:" + std::to_string(line) + ":");
    }
}

TEST(SceneErrors, TableCounts) {
    for (const auto& [table, count, line] :
         {std::tuple{"[[attractor]]\nposition = [0, 0, 0]\nstrength = 1\nradius = 1\n", 9U, 35U},
          {"[[type]]\n", 17U, 19U},
          {"[[spawn]]\non = \"death\"\n", 17U, 35U},
          {"[[emitter]]\n", 65U, 67U}}) {
        std::string text;
        for (unsigned i = 0; i < count; ++i) {
            text += table;
        }
        expectErrors(kSceneHead, {{text, std::to_string(line) + ":1", "there are " + std::to_string(count)}});
    }
    std::string many;
    for (std::size_t i = 0; i <= WorldTextures::kBodiesMax; ++i) {
        many += kSceneHead;
    }
    EXPECT_FALSE(sceneOf(many)) << "more bodies than a step allows";
}

TEST(SceneErrors, TimeAndFrames) {
    expectErrors(kSceneHead, {{"[time]\ndt = 1e-5\nprewarm = 101\n", "5:11", "time.dt"},
                              {"[render]\nfirst_frame = 5\nlast_frame = 4\n", "5:14", "render.first_frame"},
                              {"[render]\nfirst_frame = 301\n", "4:15", "choose 0 to 300"},
                              {"[render]\nlast_frame = 301\n", "4:14", "choose 0 to 300"},
                              {"[render]\nsort_frames = 1\n", "4:15", "2 to 200"}});
}

const std::string kBox = "box_min = [0, 0, 0]\nbox_max = [1, 2, 3]\n";

TEST(SceneErrors, Air) {
    const std::string flow = "[flow]\nraw = \"a.raw\"\nsize = ";
    expectErrors(
        kSceneHead,
        {{"[forces]\nwind = [1, 0, 0]\ndrag = 0\n", "4:8", "forces.drag"},
         {"[forces]\nviscosity = 0\nwind = [1, 0, 0]\n", "5:8", "forces.viscosity"},
         {"[forces]\nviscosity = 1\ndrag = 2\n", "4:13", "forces.drag"},
         {"[forces]\ndrag = 0\n" + flow + "[1, 1, 1]\n" + kBox, "5:1", "forces.drag"},
         {"[curl_noise]\namplitude = 1\nscale = 1\n[forces]\nviscosity = 0\n", "3:1", "forces.viscosity"},
         {"[curl_noise]\namplitude = 1\nscale = 1\ndrift = 1001\n", "6:9", "lower it"},
         {flow + "[1, 1, 1]\nbox_min = [0, 2, 0]\nbox_max = [1, 2, 3]\n", "6:11", "y axis"},
         {flow + "[512, 512, 65]\n" + kBox, "5:8", "flow.size"},
         {flow + "[1, 1]\n" + kBox, "5:8", "flow.size"},
         {"[[attractor]]\nposition = [0, 0, 0]\nstrength = 0\nradius = 1\n", "5:12", "attractor.strength"},
         {"[[vortex]]\ncenter = [0, 0, 0]\naxis = [0, 0, 0]\nstrength = 1\nradius = 1\n", "5:8",
          "vortex.axis"}});
}

TEST(SceneErrors, ColliderPosesAndKeys) {
    const std::string key = "[[collider.key]]\ntime = 1\n";
    expectErrors(kSceneHead, {{"axis = [0, 1, 0]\n", "3:8", "collider.angle"},
                              {"axis = [0, 0, 0]\nangle = 3\n", "3:8", "collider.axis"},
                              {key, "3:1", "collider.key"},
                              {key + key, "6:8", "is not ascending"},
                              {key + "axis = [1, 0, 0]\n" + key, "5:8", "collider.key.angle"},
                              {key + "scale = 2\n" + key, "5:1", "collider.key.scale"}});
}

TEST(SceneErrors, LiveAndAnimatedColliders) {
    const std::string wobble = "deform = { amplitude = 40, frequency = 1 }\n";
    expectErrors(
        "", {{"[collider]\nmesh = \"a.obj\"\n", "2:8", "collider.deform"},
             {"[collider]\nmesh = \"a.obj\"\nfile = \"b.relief\"\n" + wobble, "2:8", "exclude each other"},
             {"[collider]\nmesh = \"a.obj\"\ndeform = { amplitude = 1 }\n", "3:10", "frequency"},
             {"[collider]\nmesh = \"a.obj\"\n" + wobble + "[render]\nmesh = \"b.obj\"\n", "5:8",
              "collider.mesh"}});
    expectErrors(kSceneHead, {{wobble, "3:10", "collider.mesh"},
                              {"resolution = 64\n", "3:14", "collider.mesh"},
                              {"[[collider.material]]\nname = \"a\"\ncolor = [1, 1, 1]\n", "3:1", "play"}});
}

TEST(SceneErrors, WorldColliders) {
    expectErrors("", {{"[[collider]]\nnode = \"door\"\n", "2:8", "world"},
                      {"world = \"/etc/world.json\"\n", "1:9", "world"}});
    expectErrors("world = \"w.json\"\n[collider]\nnode = ",
                 {{"\"door\"\nfriction = 0\n", "4:12", "collider.friction"},
                  {"\"\"\n", "3:8", "collider.node"},
                  {"\"door\"\n[[collider.key]]\ntime = 1\n", "4:1", "collider.key"}});
}

TEST(SceneErrors, TypesAndMaterials) {
    expectErrors(kSceneHead, {{"[[type]]\nname = \"\"\n", "4:8", "type.name"},
                              {"[[type]]\nname = \"a\"\n[[type]]\nname = \"a\"\n", "6:8", "type"},
                              {"[[type]]\nstretch = 0.1\n", "4:11", "render.sprite"},
                              {"[[type]]\nstretch = 0.1\nrotation = 1\n[render]\nsprite = \"quad\"\n", "5:12",
                               "no effect with stretch"},
                              {"[[material]]\nname = \"a\"\n[[material]]\nname = \"a\"\n", "6:8", "material"},
                              {"[[spawn]]\non = \"death\"\nmaterial = \"a\"\n", "5:12", "collision"}});
    expectErrors(
        kSceneHead + kSceneHead,
        {{"[[type]]\ncollides_with = 0\n", "6:17", "indices of colliders"},
         {"[[type]]\ncollides_with = [2]\n", "6:18", "choose 0 to 1"},
         {"[[type]]\ncollides_with = [1.5]\n", "6:18", "indices of colliders"},
         {"[[type]]\ncollides_with = [\"floor\"]\n", "6:18", "ground"},
         {"[ground]\nenabled = false\n[[type]]\ncollides_with = [\"ground\"]\n", "8:18", "disables"}});
}

TEST(SceneErrors, LooksAndPictures) {
    const std::string mesh = "[render]\nmesh = \"m.obj\"\n";
    const std::string atlas = "[render]\natlas = \"a.png\"\natlas_cells = [2, 2]\n";
    std::string keys;
    for (int i = 0; i < 256; ++i) {
        keys += (i > 0 ? ", [0." : "[0.") + std::to_string(1000 + i) + ", 1]";
    }
    expectErrors(kSceneHead,
                 {{"scale = 2\n" + mesh, "5:8", "render.mesh"},
                  {"angle = 90\n" + mesh, "5:8", "render.mesh"},
                  {"position = [0, 1, 0]\n" + mesh, "5:8", "render.mesh"},
                  {"[[collider.key]]\ntime = 0\n[[collider.key]]\ntime = 1\n" + mesh, "8:8", "render.mesh"},
                  {mesh + "meshes = \"m\"\n", "5:10", "render.mesh"},
                  {"[render]\natlas_cells = [1, 1]\n", "4:15", "render.atlas"},
                  {"[render]\natlas = \"a.png\"\n", "4:9", "[[type]]"},
                  {"[[type]]\ncell = 0\n", "4:8", "render.atlas"},
                  {atlas + "[[type]]\ncell = 4\n", "7:8", "0 to 3"},
                  {"[[type]]\nsize = []\n", "4:8", "type.size"},
                  {"[[type]]\nsize = [0, 1]\n", "4:8", "type.size"},
                  {"[[type]]\nsize = [[0, 1], 2]\n", "4:17", "type.size"},
                  {"[[type]]\nsize = [[0, 1, 2]]\n", "4:9", "type.size"},
                  {"[[type]]\nsize = [[0, 1], [0, 2]]\n", "4:18", "are not ascending"},
                  {"[[type]]\nsize = [[0, 1], [1.5, 2]]\n", "4:18", "choose 0 to 1"},
                  {"[[type]]\nsize = [" + keys + "]\n", "4:8", "255"},
                  {"[[type]]\nopacity = [[0, 1], [1, 2]]\n", "4:24", "choose 0 to 1"},
                  {"[[type]]\ncolor = [1, 1]\n", "4:9", "[r, g, b]"},
                  {"[[type]]\ncolor = [[0, 1, 1]]\n", "4:10", "[r, g, b]"},
                  {"[render]\nfog_distance = 5\n", "4:16", "render.meshes"},
                  {"[render]\n[[render.weather]]\nsnow = 1\n", "4:1", "render.meshes"},
                  {"[render]\nmeshes = \"m\"\n[[render.weather]]\ntime = 1\n[[render.weather]]\ntime = 1\n",
                   "8:8", "is not ascending"}});
}

TEST(SceneErrors, Camera) {
    const std::string key = "[[camera.key]]\ntime = 1\neye = [1, 2, 3]\n";
    expectErrors(kSceneHead, {{"[camera]\neye = [1, 1, 1]\ntarget = [1, 1, 1]\n", "4:7", "camera.target"},
                              {"[camera]\neye = [1, 9, 1]\ntarget = [1, 1, 1]\n", "4:7", "sideways"},
                              {key + key, "7:8", "is not ascending"},
                              {key + "target = [1, 0, 3]\n", "5:7", "sideways"},
                              {key + "target = [1, 2, 3]\n", "5:7", "sideways"},
                              {"[camera]\neye = [1, 2, 3]\n" + key, "4:7", "exclude each other"}});
}

TEST(SceneErrors, Emitters) {
    const std::string sphere = "shape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n";
    const std::string key = "[[emitter.key]]\ntime = 1\n";
    expectErrors(
        kSceneHead + "[emitter]\n",
        {{"rate = 0\n", "4:8", "emitter.rate"},
         {"burst = 10\n[particles]\ncapacity = 9\n", "4:9", "particles.capacity"},
         {"attach = 0\n", "4:10", "emitter.point"},
         {"point = [1, 0, 0]\nattach = 1\n", "5:10", "1 colliders"},
         {"inherit = 1\n", "4:11", "emitter.attach or emitter.key"},
         {key, "4:1", "emitter.key"},
         {key + key, "7:8", "is not ascending"},
         {"box_min = [0, 1, 2]\n", "4:11", "emitter.box_max"},
         {"box_max = [0, 1, 2]\n", "4:11", "emitter.box_min"},
         {"box_min = [0, 3, 2]\nbox_max = [0, 1, 2]\n", "4:11", "y axis"},
         {"box_min = [0, 0, 0]\nbox_max = [0, 1, 2]\npoint = [0, 0, 0]\n", "6:9", "exclude each other"},
         {"shape = \"sphere\"\n", "4:9", "emitter.center"},
         {"shape = \"disc\"\ncenter = [0, 0, 0]\n", "4:9", "emitter.radius"},
         {"shape = \"points\"\n", "4:9", "emitter.points"},
         {"shape = \"point\"\n", "4:9", "emitter.point"},
         {"radius = 1\n", "4:10", "emitter.radius"},
         {"center = [0, 0, 0]\n", "4:10", "emitter.center"},
         {"point = [0, 0, 0]\nradius = 1\n", "5:10", "emitter.radius"},
         {sphere + "normal = [0, 1, 0]\n", "7:10", "emitter.normal"},
         {sphere + "box_min = [0, 1, 0]\nbox_max = [1, 1, 1]\n", "7:11", "emitter.box_min"},
         {"shape = \"box\"\npoint = [0, 0, 0]\n", "5:9", "emitter.point"},
         {"point = [0, 0, 0]\npoints = \"p\"\n", "4:9", "emitter.point"},
         {"direction = [0, 1, 0]\nspeed = [2]\n", "5:9", "two [least, most]"},
         {"direction = [0, 1, 0]\nspeed = { deviation = 1 }\n", "5:9", "mean"},
         {"cone = 20\n", "4:8", "emitter.direction"},
         {"point = [0, 0, 0]\nspeed = 20\n", "5:9", "emitter.direction"},
         {"velocity = [1, 0, 0]\ndirection = [0, 1, 0]\n", "4:12", "exclude each other"}});
}

TEST(SceneErrors, TypeNames) {
    const std::string types = "[[type]]\nname = \"snow\"\n[[type]]\nname = \"smoke\"\n";
    expectErrors(kSceneHead + "[emitter]\n", {{"type = 16\n", "4:8", "out of range"},
                                              {"type = 1.5\n", "4:8", "whole number or the name"},
                                              {"type = \"\"\n", "4:8", "empty name"},
                                              {"type = \"smoke\"\n", "4:8", "unknown"},
                                              {"type = \"smok\"\n" + types, "4:8", "'smoke'"},
                                              {"type = 2\n" + types, "4:8", "2 types"}});
    expectErrors(kSceneHead + types + "[[spawn]]\n",
                 {{"on = \"death\"\ntype = 2", "9:8", "2 types"},
                  {"on = \"death\"\nmin_speed = 1", "9:13", "has no effect"},
                  {"on = \"death\"\ncone = 10", "9:8", "has no effect"}});
}

TEST(SceneErrors, EmitterSurfaces) {
    expectErrors(kSceneHead + "[[emitter]]\n",
                 {{"shape = \"surface\"\n", "4:9", "emitter.attach"},
                  {"group = \"Head\"\n", "4:9", "emitter.shape"},
                  {"point = [0, 0, 0]\ntouching = { within = 1 }\n", "5:12", "emitter.shape"}});
    expectErrors(kSceneHead + "[[emitter]]\nshape = \"surface\"\nattach = 0\n",
                 {{"group = \"\"\n", "6:9", "emitter.group"},
                  {"material = \"\"\n", "6:12", "emitter.material"},
                  {"center = [0, 0, 0]\n", "6:10", "emitter.center"},
                  {"[[emitter.key]]\ntime = 0\n[[emitter.key]]\ntime = 1\n", "6:1", "emitter.mesh"},
                  {"touching = { within = 1, material = 3 }\n", "6:37", "list of names"},
                  {"touching = { within = 1, material = [\"earth\", 3] }\n", "6:47", "list of names"},
                  {"touching = { within = 1, material = [] }\n", "6:37", "at least one name"},
                  {"touching = { within = 1, material = \"\" }\n", "6:37", "no empty name"}});
}

TEST(SceneAir, KeysSetTheAir) {
    const Scene scene = sceneWith(
        "[[attractor]]\nposition = [1, 2, 3]\nstrength = 4\nradius = 0.5\n"
        "[[attractor]]\nposition = [0, 0, 0]\nstrength = -1\nradius = 1\nfalloff = 0\nreach = 2.5\n"
        "[[vortex]]\ncenter = [1, 0, 1]\naxis = [0, 0, -1e-20]\nstrength = 3\nradius = 0.25\nfalloff = 2\n"
        "[curl_noise]\namplitude = 0.5\nscale = 2\noctaves = 4\ndrift = 2000\nseed = 4294967295\n"
        "[flow]\nraw = \"f.raw\"\nsize = [512, 1, 8]\ncomponents = 2\noutside = \"edge\"\ngain = -2\n" +
        kBox + "[forces]\nwind = [1, 0, 0]\nviscosity = 1.8e-5\n");
    EXPECT_EQ(scene.air.attractors,
              (std::vector<Attractor>{{{1, 2, 3}, 4.0F, 0.5F}, {{0, 0, 0}, -1.0F, 1.0F, 0, 2.5F}}));
    EXPECT_EQ(scene.air.vortices,  // the axis has unit length
              (std::vector<Vortex>{{{1, 0, 1}, {0, 0, -1}, 3.0F, 0.25F, 2}}));
    EXPECT_EQ(scene.air.curl_noise, (CurlNoise{0.5F, 2.0F, 4, 2000.0F, 4294967295U}));
    EXPECT_EQ(scene.flow->origin, "dir/scene.toml:26:7: flow.raw: ");
    EXPECT_EQ(scene.flow->size, (std::array<std::uint32_t, 3>{512, 1, 8}));
    EXPECT_EQ(scene.flow->components, 2U);
    EXPECT_EQ(scene.flow->outside, FlowOutside::kEdge);
    EXPECT_EQ(scene.flow->gain, -2.0F);
    EXPECT_EQ(scene.air.wind, glm::vec3(1, 0, 0));
    EXPECT_EQ(scene.air.viscosity, 1.8e-5F);
    EXPECT_TRUE(checkAir(scene.air));
    // The runtime accepts the smallest values that the file may contain.
    EXPECT_TRUE(checkAir(sceneWith("[curl_noise]\namplitude = 1e-300\nscale = 1e-300\n").air));
}

TEST(SceneAir, ReportListsTheActiveAir) {
    const auto report = [](const std::string& more) {
        PlayerReport result;
        result.scene = required(withDefaults(sceneWith(more), unitBounds()));
        std::string json = jsonTextOf(result);
        std::erase_if(json, [](char c) { return c == ' ' || c == '\n'; });
        return json;
    };
    const std::string none = report("");
    for (const char* key : {"attractor", "vortex", "flow", "curl_noise", "viscosity"}) {
        EXPECT_EQ(none.find(key), std::string::npos) << key;
    }
    const std::string all = report(
        "[forces]\nviscosity = 0.1\n"
        "[[attractor]]\nposition = [1, 2, 3]\nstrength = 4\nradius = 0.1\n"
        "[[attractor]]\nposition = [1, 2, 3]\nstrength = 4\nradius = 0.1\nreach = 2\n"
        "[[vortex]]\ncenter = [1, 0, 1]\nstrength = 3\nradius = 0.25\n"
        "[flow]\nraw = \"f.raw\"\nsize = [3, 2, 1]\n" +
        kBox + "[curl_noise]\namplitude = 0.3\nscale = 2\n");
    for (const char* part :
         {"\"viscosity\":0.1",
          "\"attractor\":[{\"position\":[1.0,2.0,3.0],\"strength\":4.0,\"radius\":0.1,\"falloff\":2},",
          "\"falloff\":2,\"reach\":2.0}]",
          "\"vortex\":[{\"center\":[1.0,0.0,1.0],\"axis\":[0.0,1.0,0.0],\"strength\":3.0,\"radius\":0.25,"
          "\"falloff\":1}]",
          "\"flow\":{\"raw\":\"dir/f.raw\",\"size\":[3,2,1],\"components\":3,\"box_min\":[0.0,0.0,0.0],"
          "\"box_max\":[1.0,2.0,3.0],\"outside\":\"zero\",\"gain\":1.0}",
          "\"curl_noise\":{\"amplitude\":0.3,\"scale\":2.0,\"octaves\":2,\"drift\":0.0,\"seed\":1}"}) {
        EXPECT_NE(all.find(part), std::string::npos) << part << "\n" << all;
    }
    EXPECT_EQ(all.find("drag"), std::string::npos) << "viscosity replaces it";
}

}  // namespace
}  // namespace relief::test
