// The scene file: every key with its default, both ends of its range and what lies beyond, and every mistake
// with its line and column.
#include "runtime/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "runtime/scene/scene_parser.h"
#include "tests/runtime/scene/scene_error.h"

namespace relief {
namespace {

const std::string kHead = "[collider]\nfile = \"a.relief\"\n";

Result<Scene> parse(const std::string& text) {
    return parseScene(text, "dir/scene.toml");
}

/// The scene of the head and some more lines, which start at line 3.
Scene good(const std::string& more) {
    const auto scene = parse(kHead + more);
    EXPECT_TRUE(scene) << more << "\n" << scene.error().message;
    return scene.value_or(Scene{});
}

void expectError(const std::string& text, const std::string& start, const std::string& part = "") {
    expectSceneError(text, start, part);
}

Bounds unitBounds() {
    Bounds bounds;
    bounds.add({-1.0F, 0.0F, -0.5F});
    bounds.add({1.0F, 1.0F, 0.5F});
    return bounds;
}

TEST(Scene, DefaultsAreThoseOfTheReadme) {
    const Scene scene = good("");
    EXPECT_EQ(scene.colliders.at(0).path, std::filesystem::path("dir/a.relief"));
    EXPECT_EQ(scene.colliders.at(0).origin, "dir/scene.toml:2:8");
    EXPECT_EQ(scene.time.dt, 1.0F / 60.0F);
    EXPECT_EQ(scene.time.steps, 300U);
    EXPECT_EQ(scene.particles.capacity, 65536U);
    EXPECT_FALSE(scene.emitters[0].has_box);
    EXPECT_FALSE(scene.emitters[0].has_rate);
    EXPECT_EQ(scene.emitters[0].burst, 0U);
    EXPECT_EQ(scene.emitters[0].lifetime_min, 30.0F);
    EXPECT_EQ(scene.emitters[0].lifetime_max, 30.0F);
    EXPECT_EQ(scene.emitters[0].seed, 1U);
    EXPECT_EQ(scene.forces.wind, glm::vec3(0.0F));
    EXPECT_EQ(scene.forces.drag, 2.5F);
    EXPECT_EQ(scene.collision.restitution, 0.0F);
    EXPECT_EQ(scene.collision.friction, 1.0F);
    EXPECT_EQ(scene.collision.friction_threshold, 0.0F);
    EXPECT_TRUE(scene.ground.enabled);
    EXPECT_EQ(scene.camera.fov, 30.0F);
    EXPECT_EQ(scene.render.width, 960U);
    EXPECT_EQ(scene.render.height, 720U);
    EXPECT_EQ(scene.render.every, 10U);
    EXPECT_EQ(scene.render.sort_frames, 0U);
}

TEST(Scene, FramesFromOneStepToAnother) {
    const auto due = [](const std::string& render, const std::string& time = "steps = 25\n") {
        const Scene scene = good("[time]\n" + time + "[render]\n" + render);
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
    EXPECT_EQ(due("every = 30\n"), (Steps{25}));
    EXPECT_EQ(due("every = 30\n", "steps = 0\n"), (Steps{0}));
    EXPECT_EQ(due("first = 0\n"), (Steps{0, 10, 20, 25}));
    EXPECT_EQ(due("first = 3\nlast = 17\nevery = 7\n"), (Steps{3, 10, 17}));
    EXPECT_EQ(due("first = 3\nlast = 18\nevery = 7\n"), (Steps{3, 10, 17, 18}));
    EXPECT_EQ(due("last = 5\n"), (Steps{5}));
    EXPECT_EQ(due("first = 4\nlast = 4\n"), (Steps{4}));
    expectError(kHead + "[render]\nfirst = 5\nlast = 4\n", "dir/scene.toml:5:8: ", "swap them");
}

TEST(Scene, PrewarmIsWholeSteps) {
    EXPECT_EQ(prewarmSteps(good("")), 0U);
    EXPECT_EQ(prewarmSteps(good("[time]\ndt = 0.1\nprewarm = 0.3\n")), 3U) << "0.1 of a float is not 0.1";
    EXPECT_EQ(prewarmSteps(good("[time]\ndt = 0.1\nprewarm = 0.31\n")), 4U);
    EXPECT_EQ(prewarmSteps(good("[time]\nprewarm = 2\n")), 120U);
    expectError(kHead + "[time]\ndt = 1e-5\nprewarm = 101\n", "dir/scene.toml:5:11: ", "shorten it");
}

TEST(Scene, ATypesGravityAndBodies) {
    const std::string two = "[[collider]]\nfile = \"a.relief\"\n[[collider]]\nfile = \"b.relief\"\n";
    const auto collides = [&](const std::string& list, const std::string& more = "") {
        const auto scene = parse(two + more + "[[type]]\ncollides = " + list + "\n");
        EXPECT_TRUE(scene) << list << "\n" << scene.error().message;
        return scene ? particleTypes(*scene).at(0).collides : 0U;
    };
    EXPECT_EQ(good("[[type]]\ngravity = -0.5\n").types.at(0).gravity, -0.5F);
    EXPECT_EQ(particleTypes(good("[[type]]\n")).at(0).collides, kCollidesWithAll);
    EXPECT_EQ(collides("[]"), 0U);
    EXPECT_EQ(collides("[1]"), 2U);
    EXPECT_EQ(collides("[0, \"ground\"]"), 1U + kCollidesWithGround);
    EXPECT_EQ(collides("[1, 0, \"ground\"]"), kCollidesWithAll);
    EXPECT_EQ(collides("[1, 0]"), 3U);
    EXPECT_EQ(collides("[1, 0]", "[ground]\nenabled = false\n"), kCollidesWithAll) << "nothing is left out";
    const auto wrong = [&](const std::string& line, const std::string& place, const std::string& part) {
        expectError(two + "[[type]]\n" + line + "\n", "dir/scene.toml:" + place + ": ", part);
    };
    wrong("gravity = 1001", "6:11", "out of range");
    wrong("collides = 0", "6:12", "numbers of colliders");
    wrong("collides = [2]", "6:13", "out of range; choose 0 to 1");
    wrong("collides = [-1]", "6:13", "out of range");
    wrong("collides = [1.5]", "6:13", "numbers of colliders");
    wrong("collides = [\"floor\"]", "6:13", "ground");
    expectError(two + "[ground]\nenabled = false\n[[type]]\ncollides = [\"ground\"]\n",
                "dir/scene.toml:8:13: ", "takes away");
}

TEST(Scene, ASortIsOffOrSpread) {
    EXPECT_EQ(good("[render]\nsort_frames = 0\n").render.sort_frames, 0U);
    EXPECT_EQ(good("[render]\nsort_frames = 2\n").render.sort_frames, 2U);
    EXPECT_EQ(good("[render]\nsort_frames = 30\n").render.sort_frames, 30U);
    expectError(kHead + "[render]\nsort_frames = 1\n", "dir/scene.toml:4:15: render.sort_frames = 1 ",
                "choose 0, for no sort, or 2 to 200");
}

TEST(Scene, DefaultsFromTheBounds) {
    const auto scene = withDefaults(good(""), unitBounds());
    ASSERT_TRUE(scene);
    // The longest side is 2: births start above the box, the floor is its lower end.
    EXPECT_GT(scene->emitters[0].box_min.y, 1.0F);
    EXPECT_EQ(*scene->forces.gravity, glm::vec3(0.0F, -6.0F, 0.0F));
    EXPECT_EQ(*scene->ground.height, 0.0F);
    EXPECT_FLOAT_EQ(*scene->render.point_size, 0.013F);
    // The whole capacity is born by the end.
    EXPECT_NEAR(scene->emitters[0].rate * 5.0, 65536.0, 1e-2);
    EXPECT_GT(scene->camera.eye->z, 2.0F);
    // Within the time that there is for births.
    const auto brief = withDefaults(good("[emitter]\nduration = 2\n"), unitBounds());
    ASSERT_TRUE(brief);
    EXPECT_NEAR(brief->emitters[0].rate * 2.0, 65536.0, 1e-6);
}

TEST(Scene, GivenValuesStand) {
    const Scene given = good(
        "[emitter]\npoint = [1, 2, 3]\nrate = 5\nvelocity = [0, 0, 0]\nvelocity_spread = [0, 1, 0]\n"
        "[forces]\ngravity = [0, -9.81, 0]\n[ground]\nheight = -4\n[camera]\neye = [1, 1, 1]\ntarget = [0, "
        "0, 0]\n"
        "[render]\npoint_size = 0.5\n");
    const auto scene = withDefaults(given, unitBounds());
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->emitters[0].box_min, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene->emitters[0].box_max, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene->emitters[0].rate, 5.0);
    EXPECT_EQ(scene->emitters[0].velocity, glm::vec3(0.0F));
    EXPECT_EQ(scene->emitters[0].velocity_spread, glm::vec3(0, 1, 0));
    EXPECT_EQ(*scene->forces.gravity, glm::vec3(0, -9.81F, 0));
    EXPECT_EQ(*scene->ground.height, -4.0F);
    EXPECT_EQ(*scene->camera.eye, glm::vec3(1.0F));
    EXPECT_EQ(*scene->render.point_size, 0.5F);
}

TEST(Scene, UnusableBoundsAreAnError) {
    EXPECT_FALSE(withDefaults(good(""), Bounds{}));
    Bounds huge;
    huge.add(glm::vec3(-3e38F));
    huge.add(glm::vec3(3e38F));
    EXPECT_FALSE(withDefaults(good(""), huge));
    Bounds flat;
    flat.add(glm::vec3(1.0F));
    const auto scene = withDefaults(good(""), flat);
    ASSERT_TRUE(scene);
    EXPECT_TRUE(std::isfinite(scene->camera.eye->x));
}

struct NumberKey {
    const char* table;
    const char* key;
    const char* low;  // the least value allowed
    const char* too_low;
    const char* high;
    const char* too_high;
    bool whole = false;
    const char* extra = "";  // lines of other tables that the ends of the range need
};

class SceneNumber : public testing::TestWithParam<NumberKey> {};

TEST_P(SceneNumber, BothEndsAndWhatLiesBeyond) {
    const NumberKey& k = GetParam();
    const auto text = [&](const std::string& value) {
        return kHead + k.extra + "[" + k.table + "]\n  " + k.key + " = " + value + "\n";
    };
    const auto line = std::to_string(4 + std::count(k.extra, k.extra + std::string(k.extra).size(), '\n'));
    const std::string start = "dir/scene.toml:" + line + ":" + std::to_string(6 + std::string(k.key).size()) +
                              ": " + k.table + "." + k.key + " ";
    EXPECT_TRUE(parse(text(k.low))) << parse(text(k.low)).error().message;
    EXPECT_TRUE(parse(text(k.high))) << parse(text(k.high)).error().message;
    expectError(text(k.too_low), start, "out of range; choose ");
    expectError(text(k.too_high), start, "out of range; choose ");
    expectError(text("\"1\""), start, k.whole ? "must be a whole number" : "must be a");
    expectError(text("[]"), start, "must be");
    expectError(text("2020-01-01"), start, "must be");
    if (k.whole) {
        expectError(text("1.0"), start, "must be a whole number");
    } else {
        expectError(text("nan"), start, "out of range");
        expectError(text("inf"), start, "out of range");
        expectError(text("-inf"), start, "out of range");
    }
}

INSTANTIATE_TEST_SUITE_P(
    Keys, SceneNumber,
    testing::Values(NumberKey{"time", "dt", "1e-6", "0", "1", "1.0001"},
                    NumberKey{"time", "steps", "0", "-1", "10000000", "10000001", true},
                    NumberKey{"time", "prewarm", "0", "-1", "1e5", "1.1e6"},
                    NumberKey{"particles", "capacity", "1", "0", "16777216", "16777217", true},
                    NumberKey{"emitter", "rate", "1e-9", "-1", "1e9", "1.1e9"},
                    NumberKey{"emitter", "duration", "1e-9", "0", "1e6", "1.1e6"},
                    NumberKey{"emitter", "burst", "0", "-1", "65536", "16777217", true},
                    NumberKey{"emitter", "lifetime", "1e-60", "0", "1e6", "1e7"},
                    NumberKey{"emitter", "seed", "0", "-1", "9007199254740992", "9007199254740994", true},
                    NumberKey{"forces", "drag", "0", "-0.1", "1e6", "1e7"},
                    NumberKey{"collision", "restitution", "0", "-0.1", "1", "1.5"},
                    NumberKey{"collision", "friction", "0", "-0.1", "1", "2"},
                    NumberKey{"collision", "friction_threshold", "0", "-0.1", "1e6", "1e7"},
                    NumberKey{"ground", "height", "-1e9", "-2e9", "1e9", "2e9"},
                    NumberKey{"camera", "fov", "1", "0.5", "170", "180"},
                    NumberKey{"render", "point_size", "1e-60", "0", "1e9", "2e9"},
                    NumberKey{"render", "opacity", "0.01", "0", "1", "1.1"},
                    NumberKey{"render", "every", "1", "0", "10000000", "10000001", true},
                    NumberKey{"render", "first", "0", "-1", "300", "301", true},
                    NumberKey{"render", "last", "0", "-1", "300", "301", true},
                    NumberKey{"render", "sort_frames", "0", "-1", "200", "201", true}),
    [](const auto& key) { return std::string(key.param.table) + "_" + key.param.key; });

struct VectorKey {
    const char* table;
    const char* key;
    const char* low;
    const char* too_low;
    const char* high;
    const char* too_high;
};

class SceneVector : public testing::TestWithParam<VectorKey> {};

TEST_P(SceneVector, ThreeNumbersInRange) {
    const VectorKey& k = GetParam();
    const auto text = [&](const std::string& value) {
        return kHead + "[" + k.table + "]\n" + k.key + " = " + value + "\n";
    };
    EXPECT_TRUE(parse(text(std::string("[0.5, ") + k.low + ", " + k.high + "]")));
    const std::string start = "dir/scene.toml:4:";
    const std::string name = std::string(k.table) + "." + k.key;
    expectError(text(std::string("[0.5, 0.5, ") + k.too_low + "]"), start, name);
    expectError(text(std::string("[") + k.too_high + ", 0.5, 0.5]"), start, "out of range");
    for (const char* wrong :
         {"[]", "[0.5]", "[0.5, 0.5]", "[0.5, 0.5, 0.5, 0.5]", "0.5", "\"x\"", "[[1,1,1],1,1]"}) {
        expectError(text(wrong), start, name + " must be");
    }
    expectError(text("[0.5, nan, 0.5]"), start, "out of range");
    expectError(text("[0.5, \"a\", 0.5]"), start, "must be a number");
}

INSTANTIATE_TEST_SUITE_P(Keys, SceneVector,
                         testing::Values(VectorKey{"emitter", "point", "-1e9", "-2e9", "1e9", "2e9"},
                                         VectorKey{"emitter", "velocity", "-1e6", "-2e6", "1e6", "2e6"},
                                         VectorKey{"emitter", "velocity_spread", "0", "-1", "1e6", "2e6"},
                                         VectorKey{"forces", "gravity", "-1e6", "-2e6", "1e6", "2e6"},
                                         VectorKey{"forces", "wind", "-1e6", "-2e6", "1e6", "2e6"},
                                         VectorKey{"camera", "eye", "-1e9", "-2e9", "1e9", "2e9"},
                                         VectorKey{"camera", "target", "-1e9", "-2e9", "1e9", "2e9"},
                                         VectorKey{"render", "color", "0", "-0.1", "1", "1.1"},
                                         VectorKey{"render", "background", "0", "-0.1", "1", "1.1"}),
                         [](const auto& key) { return std::string(key.param.table) + "_" + key.param.key; });

TEST(Scene, BoxNeedsBothEndsInOrder) {
    const Scene scene = good("[emitter]\nbox_min = [0, 1, 2]\nbox_max = [0, 3, 4]\n");
    EXPECT_EQ(scene.emitters[0].box_min, glm::vec3(0, 1, 2));
    EXPECT_EQ(scene.emitters[0].box_max, glm::vec3(0, 3, 4));
    expectError(kHead + "[emitter]\nbox_min = [0, 1, 2]\n",
                "dir/scene.toml:4:11: ", "without emitter.box_max");
    expectError(kHead + "[emitter]\nbox_max = [0, 1, 2]\n",
                "dir/scene.toml:4:11: ", "without emitter.box_min");
    expectError(kHead + "[emitter]\nbox_min = [0, 3, 2]\nbox_max = [0, 1, 2]\n",
                "dir/scene.toml:4:11: ", "y axis");
    expectError(kHead + "[emitter]\nbox_min = [0, 0, 0]\nbox_max = [0, 1, 2]\npoint = [0, 0, 0]\n",
                "dir/scene.toml:6:9: ", "exclude each other");
}

TEST(Scene, LifetimeIsOneNumberOrTwo) {
    EXPECT_EQ(good("[emitter]\nlifetime = 4\n").emitters[0].lifetime_max, 4.0F);
    const Scene scene = good("[emitter]\nlifetime = [2, 4.5]\n");
    EXPECT_EQ(scene.emitters[0].lifetime_min, 2.0F);
    EXPECT_EQ(scene.emitters[0].lifetime_max, 4.5F);
    expectError(kHead + "[emitter]\nlifetime = [5, 4]\n", "dir/scene.toml:4:12: ", "swap");
    expectError(kHead + "[emitter]\nlifetime = [5]\n", "dir/scene.toml:4:12: ", "two");
    EXPECT_GT(good("[emitter]\nlifetime = 1e-60\n").emitters[0].lifetime_min, 0.0F);
}

TEST(Scene, SizeAndSwitches) {
    const Scene scene = good("[render]\nsize = [1, 65535]\n[ground]\nenabled = false\n");
    EXPECT_EQ(scene.render.width, 1U);
    EXPECT_EQ(scene.render.height, 65535U);
    EXPECT_FALSE(scene.ground.enabled);
    expectError(kHead + "[render]\nsize = [0, 5]\n", "dir/scene.toml:4:9: ", "out of range");
    expectError(kHead + "[render]\nsize = [5, 65536]\n", "dir/scene.toml:4:", "out of range");
    expectError(kHead + "[render]\nsize = [5.5, 5]\n", "dir/scene.toml:4:9: ", "whole number");
    expectError(kHead + "[render]\nsize = 5\n", "dir/scene.toml:4:8: ", "two whole numbers");
    expectError(kHead + "[ground]\nenabled = 1\n", "dir/scene.toml:4:11: ", "true or false");
}

TEST(Scene, UnknownWordsNameTheNearestKnownOne) {
    expectError(kHead + "[collision]\nrestitutoin = 1\n",
                "dir/scene.toml:4:1: unknown key 'collision.restitutoin'", "did you mean 'restitution'?");
    expectError(kHead + "[collisions]\n", "dir/scene.toml:3:2: unknown table 'collisions'",
                "did you mean 'collision'?");
    expectError(kHead + "[render]\nzzzzzzzzz = 1\n",
                "dir/scene.toml:4:1: ", "known are size, point_size, color");
    expectError("steps = 4\n" + kHead, "dir/scene.toml:1:1: unknown table 'steps'");
    // The first mistake of the file is the one that is reported.
    expectError(kHead + "[time]\nzeta = 1\nalpha = 1\n", "dir/scene.toml:4:1: ", "'time.zeta'");
}

TEST(Scene, SettingsThatDoNothingAreErrors) {
    expectError(kHead + "[forces]\nwind = [1, 0, 0]\ndrag = 0\n",
                "dir/scene.toml:4:8: forces.wind does nothing");
    EXPECT_TRUE(parse(kHead + "[forces]\nwind = [0, 0, 0]\ndrag = 0\n"));
    EXPECT_TRUE(parse(kHead + "[forces]\nwind = [1, 0, 0]\n"));
    expectError(kHead + "[emitter]\nrate = 0\n", "dir/scene.toml:4:8: ", "gives birth to nothing");
    EXPECT_TRUE(parse(kHead + "[emitter]\nrate = 0\nburst = 10\n"));
    expectError(kHead + "[particles]\ncapacity = 9\n[emitter]\nburst = 10\n",
                "dir/scene.toml:6:9: ", "particles.capacity");
}

TEST(Scene, CameraThatSeesNothing) {
    expectError(kHead + "[camera]\neye = [1, 1, 1]\ntarget = [1, 1, 1]\n",
                "dir/scene.toml:4:7: ", "move one");
    expectError(kHead + "[camera]\neye = [1, 9, 1]\ntarget = [1, 1, 1]\n", "dir/scene.toml:4:7: ", "aside");
    // With one of the two from the defaults.
    EXPECT_FALSE(withDefaults(good("[camera]\neye = [0, 50, 0]\n"), unitBounds()));
}

TEST(Scene, ColliderIsNeeded) {
    expectError("", "dir/scene.toml:1:1: ", "collider.file");
    expectError("[collider]\n", "dir/scene.toml:1:1: ", "collider.file");
    expectError("[collider]\nfile = \"\"\n", "dir/scene.toml:2:8: ", "names no file");
    expectError("[collider]\nfile = 3\n", "dir/scene.toml:2:8: collider.file must be a string");
    expectError("[collider]\nfile = \"a\\u0000b\"\n", "dir/scene.toml:2:8: ", "zero byte");
    expectError("collider = 3\n", "dir/scene.toml:1:12: collider must be a table");
    expectError("collider = []\n", "dir/scene.toml:1:12: collider must be a table");
    expectError("[[collider]]\nfile = \"a\"\n[[collider]]\n", "dir/scene.toml:3:1: ", "collider.file");
}

TEST(Scene, PathsResolveAgainstTheScenesFolder) {
    EXPECT_EQ(parseScene(kHead, "scene.toml")->colliders.at(0).path, std::filesystem::path("a.relief"));
    EXPECT_EQ(parseScene(kHead, "/x/y/scene.toml")->colliders.at(0).path,
              std::filesystem::path("/x/y/a.relief"));
    EXPECT_EQ(parseScene("[collider]\nfile = \"b/../a.relief\"\n", "/x/scene.toml")->colliders.at(0).path,
              std::filesystem::path("/x/b/../a.relief"));
}

TEST(Scene, PathsDoNotLeaveTheScenesFolder) {
    expectError("[collider]\nfile = \"/z/a.relief\"\n",
                "dir/scene.toml:2:8: collider.file = '/z/a.relief' is an", "scene's folder");
    expectError("[collider]\nfile = \"../a.relief\"\n",
                "dir/scene.toml:2:8: collider.file = '../a.relief' leads");
    expectError("[collider]\nfile = \"b/../../dirt/a\"\n", "dir/scene.toml:2:8: ", "leads out");
}

TEST(Scene, WhatIsNoToml) {
    expectError("[collider\n", "dir/scene.toml:1:", "not TOML");
    expectError(kHead + "[time]\ndt = \n", "dir/scene.toml:4:", "not TOML");
    expectError(kHead + "[time]\ndt = 1\ndt = 1\n", "dir/scene.toml:5:", "not TOML");
    expectError("\xff\xfe\x00", "dir/scene.toml:1:", "");
    expectError(std::string("a = \"\x1b[31m\"\n"), "dir/scene.toml:1:", "");
    expectError(std::string(100'000, '['), "dir/scene.toml:1:", "");
    expectError("a = " + std::string(100'000, '['), "dir/scene.toml:1:", "");
    expectError("a" + std::string(".a", 3) + " = {" + std::string(5000, '{'), "dir/scene.toml:1:", "");
}

// Every prefix of a full scene is either read or refused; under the sanitizers this finds what a parser
// forgot.
TEST(Scene, EveryPrefixAndEveryFlippedByteIsSurvived) {
    const std::string text =
        kHead +
        "[time]\ndt = 0.01\nsteps = 10\n[emitter]\nbox_min = [0, 0, 0]\nbox_max = [1, 1, 1]\n"
        "lifetime = [1, 2]\n[render]\nsize = [4, 4]\ncolor = [1, 1, 1]\n";
    for (std::size_t i = 0; i <= text.size(); ++i) {
        const auto scene = parse(text.substr(0, i));
        EXPECT_TRUE(scene || scene.error().code == ErrorCode::kInvalidInput);
    }
    for (std::size_t i = 0; i < text.size(); ++i) {
        for (const int flip : {1, 0x20, 0x80, 0xff}) {
            std::string changed = text;
            changed[i] =
                static_cast<char>(static_cast<unsigned char>(changed[i]) ^ static_cast<unsigned>(flip));
            const auto scene = parse(changed);
            EXPECT_TRUE(scene || scene.error().code == ErrorCode::kInvalidInput);
        }
    }
}

TEST(Scene, MissingAndOversizedFiles) {
    const auto missing = loadScene("/nonexistent/scene.toml");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::kIo);
    EXPECT_NE(missing.error().message.find("/nonexistent/scene.toml"), std::string::npos);
    const std::string path = testing::TempDir() + "relief_scene_large.toml";
    std::ofstream(path) << std::string((1 << 20) + 1, '#');
    const auto large = loadScene(path);
    ASSERT_FALSE(large);
    EXPECT_EQ(large.error().code, ErrorCode::kLimit);
    std::filesystem::remove(path);
}

TEST(Scene, TheSampleIsGoodAndSetsWhatItSays) {
    const auto scene = loadScene(RELIEF_SOURCE_DIR "/samples/bunny_in_the_snow.toml");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->colliders.at(0).path.filename(), "bunny.relief");
    EXPECT_EQ(scene->time.steps, 300U);
}

}  // namespace
}  // namespace relief
