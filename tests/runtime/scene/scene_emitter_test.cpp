// [emitter] and [[emitter]]: every key, every mistake with its line and column.
#include "runtime/scene/scene_emitter.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "runtime/scene/scene.h"
#include "runtime/scene/scene_births.h"
#include "runtime/scene/scene_parser.h"
#include "tests/runtime/scene/scene_error.h"

namespace relief {
namespace {

const std::string kHead = "[collider]\nfile = \"a.relief\"\n[emitter]\n";

Result<Scene> parse(const std::string& text) {
    return parseScene(text, "dir/scene.toml");
}

/// The emitter of some keys, which start at line 4.
SceneEmitter good(const std::string& keys) {
    const auto scene = parse(kHead + keys);
    EXPECT_TRUE(scene) << keys << "\n" << scene.error().message;
    return scene ? scene->emitters.at(0) : SceneEmitter{};
}

void expectError(const std::string& keys, const std::string& start, const std::string& part = "") {
    expectSceneError(kHead + keys, "dir/scene.toml:" + start, part);
}

Bounds unitBounds() {
    Bounds bounds;
    bounds.add({-1.0F, 0.0F, -0.5F});
    bounds.add({1.0F, 1.0F, 0.5F});
    return bounds;
}

TEST(SceneEmitter, WhatMovesIt) {
    const std::string keys =
        "[[emitter.key]]\ntime = 1\nposition = [1, 2, 3]\n"
        "[[emitter.key]]\ntime = 2\nangle = 90\n";
    const SceneEmitter rests = good("");
    EXPECT_FALSE(rests.moves());
    const SceneEmitter moves = good("point = [1, 0, 0]\nattach = 0\ninherit = 0.5\n" + keys);
    EXPECT_TRUE(moves.moves());
    EXPECT_EQ(moves.attach, 0U);
    EXPECT_EQ(moves.inherit, 0.5F);
    ASSERT_EQ(moves.keys.size(), 2U);
    EXPECT_EQ(moves.keys[0].pose.position, glm::vec3(1, 2, 3));
    EXPECT_EQ(moves.keys[1].time, 2.0);

    SceneCollider collider;
    collider.pose.position = {0.0F, 7.0F, 0.0F};
    auto motions = emitterMotions(std::span(&moves, 1), std::span(&collider, 1));
    ASSERT_EQ(motions.size(), 1U);
    EXPECT_EQ(motions[0].keys.size(), 2U);
    ASSERT_EQ(motions[0].body.size(), 1U) << "a collider at rest";
    EXPECT_EQ(motions[0].body[0].pose, collider.pose);
    EXPECT_EQ(motions[0].inherit, 0.5F);
    collider.keys = moves.keys;
    EXPECT_EQ(emitterMotions(std::span(&moves, 1), std::span(&collider, 1))[0].body.size(), 2U);
    EXPECT_TRUE(emitterMotions(std::span(&rests, 1), std::span(&collider, 1))[0].none());

    expectError("attach = 0\n", "4:10", "emitter.point");
    expectError("point = [1, 0, 0]\nattach = 1\n", "5:10", "none of the 1 colliders");
    expectError("point = [1, 0, 0]\nattach = \"0\"\n", "5:10", "unknown");
    expectError("inherit = 1\n", "4:11", "without emitter.attach or emitter.key");
    expectError("[[emitter.key]]\ntime = 1\n", "4:1", "emitter.key alone moves nothing");
    expectError("[[emitter.key]]\nposition = [1, 2, 3]\n", "4:1", "emitter.key.time is missing");
    expectError("[[emitter.key]]\ntime = 1\n[[emitter.key]]\ntime = 1\n", "7:8", "does not rise");
    expectError("[[emitter.key]]\ntime = 1\nscale = 2\n", "6:1", "scale");
}

TEST(SceneEmitter, Shapes) {
    EXPECT_EQ(good("").shape, EmitterShape::kBox);
    EXPECT_EQ(good("shape = \"box\"\n").shape, EmitterShape::kBox);
    const SceneEmitter point = good("shape = \"point\"\npoint = [1, 2, 3]\n");
    EXPECT_EQ(point.shape, EmitterShape::kBox);
    EXPECT_EQ(point.box_min, glm::vec3(1, 2, 3));
    EXPECT_EQ(point.box_max, glm::vec3(1, 2, 3));
    const SceneEmitter sphere = good("shape = \"sphere\"\ncenter = [1, 2, 3]\nradius = 4\n");
    EXPECT_EQ(sphere.shape, EmitterShape::kSphere);
    EXPECT_EQ(sphere.center, glm::vec3(1, 2, 3));
    EXPECT_EQ(sphere.radius, 4.0F);
    EXPECT_EQ(good("shape = \"shell\"\ncenter = [1, 2, 3]\nradius = 0\n").shape, EmitterShape::kShell);
    const SceneEmitter disc = good("shape = \"disc\"\ncenter = [1, 2, 3]\nradius = 4\nnormal = [1, 0, 0]\n");
    EXPECT_EQ(disc.shape, EmitterShape::kDisc);
    EXPECT_EQ(disc.normal, glm::vec3(1, 0, 0));
    for (const char* keys : {"points = \"p.ply\"\n", "shape = \"points\"\npoints = \"p.ply\"\n"}) {
        const SceneEmitter points = good(keys);
        EXPECT_EQ(points.shape, EmitterShape::kPoints);
        EXPECT_EQ(points.points_file, std::filesystem::path("dir/p.ply"));
    }
}

TEST(SceneEmitter, ShapesSayWhatTheyNeedAndWhatDoesNothing) {
    expectError("shape = \"spere\"\n", "4:9: ", "did you mean 'sphere'?");
    expectError("shape = 3\n", "4:9: ", "one of \"box\"");
    expectError("shape = \"sphere\"\n", "4:9: ", "needs emitter.center");
    expectError("shape = \"disc\"\ncenter = [0, 0, 0]\n", "4:9: ", "needs emitter.radius");
    expectError("shape = \"points\"\n", "4:9: ", "needs emitter.points");
    expectError("shape = \"point\"\n", "4:9: ", "needs emitter.point ");
    expectError("radius = 1\n", "4:10: emitter.radius does nothing", "choose emitter.shape = \"sphere\"");
    expectError("center = [0, 0, 0]\n", "4:10: emitter.center does nothing");
    expectError("point = [0, 0, 0]\nradius = 1\n", "5:10: emitter.radius does nothing");
    expectError("shape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nnormal = [0, 1, 0]\n",
                "7:10: emitter.normal does nothing");
    expectError(
        "shape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nbox_min = [0, 1, 0]\nbox_max = [1, 1, 1]\n",
        "7:11: emitter.box_min does nothing");
    expectError("shape = \"box\"\npoint = [0, 0, 0]\n", "5:9: emitter.point does nothing");
    expectError("point = [0, 0, 0]\npoints = \"p\"\n", "4:9: emitter.point does nothing");
    expectError("shape = \"disc\"\ncenter = [0, 0, 0]\nradius = 1\nnormal = [0, 0, 0]\n",
                "7:10: ", "no direction");
    expectError("shape = \"sphere\"\ncenter = [0, 0, 0]\nradius = -1\n", "6:10: ", "out of range");
    expectError("points = \"\"\n", "4:10: ", "names no file");
    expectError("points = \"a\\u0000\"\n", "4:10: ", "zero byte");
    expectError("points = [1]\n", "4:10: ", "a string");
}

TEST(SceneEmitter, Moments) {
    const SceneEmitter emitter = good("start = 1.5\nburst = 10\nburst_every = 0.5\nrate = 0\nduration = 3\n");
    EXPECT_EQ(emitter.start, 1.5);
    EXPECT_EQ(emitter.burst_every, 0.5);
    EXPECT_EQ(emitter.duration, 3.0);
    EXPECT_TRUE(emitter.spread);
    EXPECT_FALSE(good("spread = false\n").spread);
    expectError("start = -1\n", "4:9: ", "out of range");
    expectError("start = 1e7\n", "4:9: ", "out of range");
    expectError("burst = 1\nburst_every = 1e-5\n", "5:15: ", "out of range");
    expectError("spread = 1\n", "4:10: ", "true or false");
}

TEST(SceneEmitter, AimAndSpeed) {
    const SceneEmitter plain = good("direction = [0, 2, 0]\ncone = 20\nspeed = 3\n");
    ASSERT_TRUE(plain.aim);
    EXPECT_EQ(*plain.aim->direction, glm::vec3(0, 2, 0));
    EXPECT_EQ(plain.aim->cone_degrees, 20.0F);
    EXPECT_EQ(plain.aim->speed_min, 3.0F);
    EXPECT_EQ(plain.aim->speed_max, 3.0F);
    const SceneEmitter span = good("direction = [0, 2, 0]\nspeed = [1, 4]\n");
    EXPECT_EQ(span.aim->speed_min, 1.0F);
    EXPECT_EQ(span.aim->speed_max, 4.0F);
    const SceneEmitter normal = good("direction = [0, 2, 0]\nspeed = { mean = 2, deviation = 0.5 }\n");
    EXPECT_EQ(normal.aim->speed_min, 2.0F);
    EXPECT_EQ(normal.aim->speed_deviation, 0.5F);
    EXPECT_TRUE(good("shape = \"shell\"\ncenter = [0, 0, 0]\nradius = 1\nspeed = 1\n").aim);
    EXPECT_FALSE(good("velocity = [1, 0, 0]\n").aim);

    expectError("direction = [0, 0, 0]\n", "4:13: ", "no direction");
    expectError("direction = [0, 1, 0]\ncone = 181\n", "5:8: ", "out of range");
    expectError("direction = [0, 1, 0]\ncone = -1\n", "5:8: ", "out of range");
    expectError("direction = [0, 1, 0]\nspeed = -1\n", "5:9: ", "out of range");
    expectError("direction = [0, 1, 0]\nspeed = [2, 1]\n", "5:9: ", "swap");
    expectError("direction = [0, 1, 0]\nspeed = [2]\n", "5:9: ", "two [least, most]");
    expectError("direction = [0, 1, 0]\nspeed = \"fast\"\n", "5:9: ", "two [least, most]");
    expectError("direction = [0, 1, 0]\nspeed = { deviation = 1 }\n", "5:9: ", "mean is missing");
    expectError("direction = [0, 1, 0]\nspeed = { mean = 1, deviation = -1 }\n", "5:33: ", "out of range");
    expectError("direction = [0, 1, 0]\nspeed = { mean = 1, devation = 1 }\n",
                "5:21: ", "'emitter.speed.devation'; did you mean 'deviation'?");
    expectError("cone = 20\n", "4:8: emitter.cone needs emitter.direction");
    expectError("point = [0, 0, 0]\nspeed = 20\n", "5:9: emitter.speed needs emitter.direction");
    expectError("velocity = [1, 0, 0]\ndirection = [0, 1, 0]\n", "4:12: ", "exclude each other");
}

TEST(SceneEmitter, TypesByIndexAndByName) {
    EXPECT_EQ(good("type = 15\n").type, 15U);
    expectError("type = 16\n", "4:8: ", "out of range");
    expectError("type = 1.5\n", "4:8: ", "a whole number or the name");
    expectError("type = \"\"\n", "4:8: ", "empty name");
    expectError("type = \"smoke\"\n", "4:8: emitter.type = 'smoke' is unknown");
    const std::string types = "[[type]]\nname = \"snow\"\n[[type]]\nname = \"smoke\"\n";
    EXPECT_EQ(good("type = \"smoke\"\n" + types).type, 1U);
    EXPECT_EQ(good("type = 1\n" + types).type, 1U);
    expectError("type = \"smok\"\n" + types, "4:8: emitter.type = 'smok' is unknown; did you mean 'smoke'?");
    expectError("type = 2\n" + types, "4:8: ", "none of the 2 types");
}

const std::string kTwo =
    "[collider]\nfile = \"a.relief\"\n[[emitter]]\nrate = 10\n[[emitter]]\nburst = 5\nseed = 7\n";

TEST(SceneEmitter, SeveralTables) {
    const auto scene = parse(kTwo);
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->emitters.size(), 2U);
    EXPECT_EQ(scene->emitters[0].rate, 10.0);
    EXPECT_EQ(scene->emitters[1].burst, 5U);
    EXPECT_EQ(scene->emitters[1].seed, 7U);
    EXPECT_EQ(parse("[collider]\nfile = \"a\"\n")->emitters.size(), 1U);

    const auto message = [](const std::string& text) {
        const auto wrong = parse(text);
        return wrong ? std::string() : wrong.error().message;
    };
    EXPECT_TRUE(message(kTwo + "ratee = 1\n").starts_with("dir/scene.toml:8:1: unknown key 'emitter.ratee'"));
    for (const char* wrong :
         {"emitter = 3\n", "emitter = []\n", "emitter = [1, 2]\n", "emitter = [{}, 1]\n"}) {
        EXPECT_TRUE(message(wrong + kHead.substr(0, kHead.find("[emitter]")))
                        .starts_with("dir/scene.toml:1:11: emitter must be a table"))
            << wrong << message(wrong + kHead);
    }
    std::string many = kHead.substr(0, kHead.find("[emitter]"));
    for (int i = 0; i < 65; ++i) {
        many += "[[emitter]]\n";
    }
    EXPECT_TRUE(message(many).starts_with("dir/scene.toml:67:1: there are 65 of [[emitter]]"));
}

TEST(SceneEmitter, DefaultsOfSeveral) {
    auto scene = parse(
        "[collider]\nfile = \"a\"\n[time]\ndt = 0.1\nsteps = 100\n[particles]\ncapacity = 10000\n"
        "[[emitter]]\nrate = 100\n[[emitter]]\nburst = 100\nburst_every = 1\nduration = 4.5\n"
        "[[emitter]]\nstart = 5\ndirection = [0, 1, 0]\n");
    ASSERT_TRUE(scene) << scene.error().message;
    scene = withDefaults(std::move(*scene), unitBounds());
    ASSERT_TRUE(scene) << scene.error().message;
    // 10000 less 1000 by the first's rate and 5 bursts of 100: 4250 for each of the two that say no rate.
    EXPECT_NEAR(scene->emitters[1].rate, 8500.0 / 2.0 / 4.5, 1e-4);
    EXPECT_NEAR(scene->emitters[2].rate, 8500.0 / 2.0 / 5.0, 1e-4);
    EXPECT_EQ(scene->emitters[2].velocity, glm::vec3(0.0F));
    EXPECT_EQ(scene->emitters[2].velocity_spread, glm::vec3(0.0F));
    EXPECT_FLOAT_EQ(scene->emitters[2].aim->speed_max, 1.6F);  // 0.8 of the longest side, 2
    EXPECT_GT(scene->emitters[2].box_min.y, 1.0F);

    auto full =
        parse("[collider]\nfile = \"a\"\n[particles]\ncapacity = 10\n[[emitter]]\nrate = 100\n[[emitter]]\n");
    ASSERT_TRUE(full);
    const auto none = withDefaults(std::move(*full), unitBounds());
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("used up by the others"), std::string::npos);
}

// Read or refused, whatever the bytes; the sanitizers watch.
TEST(SceneEmitter, EveryPrefixAndEveryFlippedByteIsSurvived) {
    const std::string text = kTwo +
                             "shape = \"disc\"\ncenter = [0, 0, 0]\nradius = 1\ncone = 9\n"
                             "speed = { mean = 1, deviation = 1 }\ntype = 3\n[[emitter]]\npoints = \"p\"\n"
                             "speed = [1, 2]\nburst = 4\nburst_every = 0.5\nspread = true\n";
    ASSERT_TRUE(parse(text)) << parse(text).error().message;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto cut = parse(text.substr(0, i));
        EXPECT_TRUE(cut || cut.error().code == ErrorCode::kInvalidInput);
        for (const unsigned flip : {1U, 0x20U, 0x80U, 0xffU}) {
            std::string changed = text;
            changed[i] = static_cast<char>(static_cast<unsigned char>(changed[i]) ^ flip);
            const auto scene = parse(changed);
            EXPECT_TRUE(scene || scene.error().code == ErrorCode::kInvalidInput);
        }
    }
}

TEST(SceneEmitter, MadeEmittersGiveBirth) {
    const std::string folder = testing::TempDir();
    std::ofstream(folder + "relief_emitter_points.csv") << "1,2,3\n";
    const auto make = [&](const std::string& keys) {
        auto scene = parseScene(kHead + keys, folder + "scene.toml");
        EXPECT_TRUE(scene) << scene.error().message;
        auto complete = withDefaults(std::move(*scene), unitBounds());
        EXPECT_TRUE(complete);
        return makeEmitters(complete->emitters, SceneMeshes{});
    };
    auto made = make(
        "points = \"relief_emitter_points.csv\"\nburst = 3\nrate = 0\nvelocity_spread = [0, 0, 0]\n"
        "velocity = [4, 5, 6]\ntype = 3\nlifetime = 2\n");
    ASSERT_TRUE(made) << made.error().message;
    std::vector<Birth> births;
    emitAll(*made, 0.1, 100, births);
    ASSERT_EQ(births.size(), 3U);
    EXPECT_EQ(births[0].position, glm::vec3(1, 2, 3));
    EXPECT_EQ(births[0].velocity, glm::vec3(4, 5, 6));
    EXPECT_EQ(births[0].type, 3U);
    EXPECT_EQ(births[0].lifetime, 2.0F);

    const auto bare = make("points = \"relief_emitter_points.csv\"\nspeed = 1\n");
    ASSERT_FALSE(bare);
    EXPECT_NE(bare.error().message.find("scene.toml:4:10: emitter.points: "), std::string::npos);
    EXPECT_NE(bare.error().message.find("no normals"), std::string::npos);
    EXPECT_TRUE(make("points = \"relief_emitter_points.csv\"\nspeed = 1\ndirection = [0, 1, 0]\n"));
    std::filesystem::remove(folder + "relief_emitter_points.csv");
    const auto missing = make("points = \"relief_emitter_points.csv\"\n");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::kIo);
    EXPECT_NE(missing.error().message.find("scene.toml:4:10: "), std::string::npos);
}

}  // namespace
}  // namespace relief
