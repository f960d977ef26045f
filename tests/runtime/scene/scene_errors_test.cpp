// SPDX-License-Identifier: Apache-2.0
// Errors in a scene's text, with line and column. toml_reader_test.cpp tests ranges, value types and unknown keys; this
// file tests the scene's own rules.
#include <gtest/gtest.h>

#include "runtime/bodies/world_textures.h"
#include "tests/runtime/scene/scene_text.h"

namespace relief {
namespace {

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
        expectErrorOf(sceneOf(text), "dir/scene.toml:" + std::to_string(line) + ":", "");
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

TEST(SceneErrors, Air) {
    const std::string flow =
        "[flow]\nraw = \"a.raw\"\nsize = [1, 1, 1]\nbox_min = [0, 0, 0]\nbox_max = [1, 2, 3]\n";
    expectErrors(
        kSceneHead,
        {{"[forces]\nwind = [1, 0, 0]\ndrag = 0\n", "4:8", "forces.drag"},
         {"[forces]\nviscosity = 0\nwind = [1, 0, 0]\n", "5:8", "forces.viscosity"},
         {"[forces]\nviscosity = 1\ndrag = 2\n", "4:13", "forces.drag"},
         {"[forces]\ndrag = 0\n" + flow, "5:1", "forces.drag"},
         {"[curl_noise]\namplitude = 1\nscale = 1\n[forces]\nviscosity = 0\n", "3:1", "forces.viscosity"},
         {"[curl_noise]\namplitude = 1\nscale = 1\ndrift = 1001\n", "6:9", "lower it"},
         {"[flow]\nraw = \"a.raw\"\nsize = [1, 1, 1]\nbox_min = [0, 2, 0]\nbox_max = [1, 2, 3]\n", "6:11",
          "y axis"},
         {"[flow]\nraw = \"a.raw\"\nsize = [512, 512, 65]\nbox_min = [0, 0, 0]\nbox_max = [1, 2, 3]\n", "5:8",
          "flow.size"},
         {"[flow]\nraw = \"a.raw\"\nsize = [1, 1]\nbox_min = [0, 0, 0]\nbox_max = [1, 2, 3]\n", "5:8",
          "flow.size"},
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
                              {"[[material]]\nname = \"a\"\n[[material]]\nname = \"a\"\n", "6:8", "material"},
                              {"[[spawn]]\non = \"death\"\nmaterial = \"a\"\n", "5:12", "collision"}});
    expectErrors(
        "[[collider]]\nfile = \"a.relief\"\n[[collider]]\nfile = \"b.relief\"\n",
        {{"[[type]]\ncollides_with = 0\n", "6:17", "numbers of colliders"},
         {"[[type]]\ncollides_with = [2]\n", "6:18", "choose 0 to 1"},
         {"[[type]]\ncollides_with = [1.5]\n", "6:18", "numbers of colliders"},
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
                  {"on = \"death\"\nmin_speed = 1", "9:13", "does nothing"},
                  {"on = \"death\"\ncone = 10", "9:8", "does nothing"}});
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
                  {"touching = { within = 1, material = [] }\n", "6:37", "has no name"},
                  {"touching = { within = 1, material = \"\" }\n", "6:37", "an empty one"}});
}

}  // namespace
}  // namespace relief
