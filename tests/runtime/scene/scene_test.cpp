// The scene file: what its keys mean, the ends of their ranges, what is filled in, and hostile bytes.
#include "runtime/scene/scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "tests/runtime/scene/scene_text.h"

namespace relief {
namespace {

Scene good(const std::string& more) {
    return goodScene(kSceneHead + more);
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
}

TEST(Scene, PrewarmIsWholeSteps) {
    EXPECT_EQ(prewarmSteps(good("")), 0U);
    EXPECT_EQ(prewarmSteps(good("[time]\ndt = 0.1\nprewarm = 0.3\n")), 3U) << "0.1 of a float is not 0.1";
    EXPECT_EQ(prewarmSteps(good("[time]\ndt = 0.1\nprewarm = 0.31\n")), 4U);
    EXPECT_EQ(prewarmSteps(good("[time]\nprewarm = 2\n")), 120U);
}

TEST(Scene, BodiesThatATypeCollidesWith) {
    const auto collides = [](const std::string& list, const std::string& more = "") {
        const Scene scene = goodScene(kSceneHead + kSceneHead + more + "[[type]]\ncollides = " + list + "\n");
        return particleTypes(scene).at(0).collides;
    };
    EXPECT_EQ(particleTypes(good("[[type]]\n")).at(0).collides, kCollidesWithAll);
    EXPECT_EQ(collides("[]"), 0U);
    EXPECT_EQ(collides("[1]"), 2U);
    EXPECT_EQ(collides("[0, \"ground\"]"), 1U + kCollidesWithGround);
    EXPECT_EQ(collides("[1, 0, \"ground\"]"), kCollidesWithAll);
    EXPECT_EQ(collides("[1, 0]"), 3U);
    EXPECT_EQ(collides("[1, 0]", "[ground]\nenabled = false\n"), kCollidesWithAll) << "nothing is left out";
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
    // The eye may be straight above a target that is filled in.
    EXPECT_FALSE(withDefaults(good("[camera]\neye = [0, 50, 0]\n"), unitBounds()));
}

TEST(Scene, GivenValuesStand) {
    const Scene given = good(
        "[emitter]\npoint = [1, 2, 3]\nlifetime = [2, 4.5]\nrate = 5\nvelocity = [0, 0, 0]\nvelocity_spread "
        "= [0, 1, 0]\n"
        "[forces]\ngravity = [0, -9.81, 0]\n[ground]\nheight = -4\n[camera]\neye = [1, 1, 1]\ntarget = [0, "
        "0, 0]\n"
        "[render]\npoint_size = 0.5\nsize = [1, 65535]\n");
    const auto scene = withDefaults(given, unitBounds());
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->emitters[0].box_min, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene->emitters[0].box_max, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene->emitters[0].lifetime_min, 2.0F);
    EXPECT_EQ(scene->emitters[0].lifetime_max, 4.5F);
    EXPECT_EQ(scene->emitters[0].rate, 5.0);
    EXPECT_EQ(scene->emitters[0].velocity, glm::vec3(0.0F));
    EXPECT_EQ(scene->emitters[0].velocity_spread, glm::vec3(0, 1, 0));
    EXPECT_EQ(*scene->forces.gravity, glm::vec3(0, -9.81F, 0));
    EXPECT_EQ(*scene->ground.height, -4.0F);
    EXPECT_EQ(*scene->camera.eye, glm::vec3(1.0F));
    EXPECT_EQ(*scene->render.point_size, 0.5F);
    EXPECT_EQ(scene->render.width, 1U);
    EXPECT_EQ(scene->render.height, 65535U);
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

TEST(Scene, RangesOfItsKeys) {
    struct Range {
        const char* key;
        std::array<const char*, 2> allowed;
        std::array<const char*, 2> beyond;
    };
    for (const Range& range :
         {Range{"time.dt", {"1e-6", "1"}, {"0", "1.0001"}},
          {"time.steps", {"0", "10000000"}, {"-1", "10000001"}},
          {"time.prewarm", {"0", "1e5"}, {"-1", "1.1e6"}},
          {"particles.capacity", {"1", "16777216"}, {"0", "16777217"}},
          {"emitter.rate", {"1e-9", "1e9"}, {"-1", "1.1e9"}},
          {"emitter.duration", {"1e-9", "1e6"}, {"0", "1.1e6"}},
          {"emitter.burst", {"0", "65536"}, {"-1", "16777217"}},
          {"emitter.lifetime", {"1e-60", "1e6"}, {"0", "1e7"}},
          {"emitter.seed", {"0", "9007199254740992"}, {"-1", "9007199254740994"}},
          {"emitter.velocity_spread", {"[0, 0, 0]", "[1, 1, 1e6]"}, {"[0, -1, 0]", "[2e6, 1, 1]"}},
          {"forces.drag", {"0", "1e6"}, {"-0.1", "nan"}},
          {"forces.gravity", {"[1, -1e6, 1]", "[1, 1, 1e6]"}, {"[1, -2e6, 1]", "[1, 1, inf]"}},
          {"collision.restitution", {"0", "1"}, {"-0.1", "1.5"}},
          {"collision.friction", {"0", "1"}, {"-0.1", "2"}},
          {"collision.friction_threshold", {"0", "1e6"}, {"-0.1", "1e7"}},
          {"collision.sweep", {"0", "0.25"}, {"-1", "inf"}},
          {"ground.height", {"-1e9", "1e9"}, {"-2e9", "2e9"}},
          {"camera.fov", {"1", "170"}, {"0.5", "180"}},
          {"camera.eye", {"[1, -1e9, 1]", "[1, 1, 1e9]"}, {"[1, -2e9, 1]", "[nan, 1, 1]"}},
          {"render.size", {"[1, 65535]", "[65535, 1]"}, {"[0, 5]", "[65536, 5]"}},
          {"render.color", {"[0, 0, 0]", "[1, 1, 1]"}, {"[0, -0.1, 0]", "[1, 1, 1.1]"}},
          {"render.opacity", {"0.01", "1"}, {"0", "1.1"}},
          {"render.every", {"1", "10000000"}, {"0", "10000001"}},
          {"render.sort_frames", {"2", "200"}, {"-1", "201"}},
          {"render.soft", {"0", "1e9"}, {"-1", "2e9"}},
          // Values of another type than the key's.
          {"emitter.burst", {"0", "1"}, {"1.0", "[]"}},
          {"emitter.point", {"[1, 1, 1]", "[0.5, 0, -1]"}, {"[1, 1]", "[1, 1, 1, 1]"}},
          {"emitter.velocity", {"[1, 1, 1]", "[0, 0, 0]"}, {"0.5", "[1, \"a\", 1]"}},
          {"emitter.spread", {"true", "false"}, {"1", "\"true\""}},
          {"render.sprite", {"\"quad\"", "\"point\""}, {"1", "\"quads\""}}}) {
        const std::string name = range.key;
        const std::string table = name.substr(0, name.find('.'));
        const auto text = [&](const char* value) {
            return kSceneHead + "[" + table + "]\n" + name.substr(table.size() + 1) + " = " + value + "\n";
        };
        for (const char* value : range.allowed) {
            EXPECT_TRUE(sceneOf(text(value))) << text(value) << sceneOf(text(value)).error().message;
        }
        for (const char* value : range.beyond) {
            const auto scene = sceneOf(text(value));
            ASSERT_FALSE(scene) << text(value);
            EXPECT_NE(scene.error().message.find(name), std::string::npos) << scene.error().message;
        }
    }
    EXPECT_GT(good("[emitter]\nlifetime = 1e-60\n").emitters[0].lifetime_min, 0.0F);
}

TEST(Scene, PathsResolveAgainstTheScenesFolder) {
    EXPECT_EQ(parseScene(kSceneHead, "scene.toml")->colliders.at(0).path, std::filesystem::path("a.relief"));
    EXPECT_EQ(parseScene(kSceneHead, "/x/y/scene.toml")->colliders.at(0).path,
              std::filesystem::path("/x/y/a.relief"));
    EXPECT_EQ(parseScene("[collider]\nfile = \"b/../a.relief\"\n", "/x/scene.toml")->colliders.at(0).path,
              std::filesystem::path("/x/b/../a.relief"));
}

// Every prefix of a full scene is either read or refused; under the sanitizers this finds what a parser
// forgot.
TEST(Scene, EveryPrefixAndEveryFlippedByteIsSurvived) {
    const std::string text =
        kSceneHead +
        "[time]\ndt = 0.01\nsteps = 10\n[[emitter]]\nbox_min = [0, 0, 0]\nbox_max = [1, 1, 1]\n"
        "lifetime = [1, 2]\n[render]\nsize = [4, 4]\ncolor = [1, 1, 1]\n[[emitter]]\nburst = 5\nseed = 7\n"
        "shape = \"disc\"\ncenter = [0, 0, 0]\nradius = 1\ncone = 9\nspeed = { mean = 1, deviation = 1 }\n"
        "type = 3\n[[emitter]]\npoints = \"p\"\nspeed = [1, 2]\nburst = 4\nburst_every = 0.5\nspread = "
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
    const auto missing = loadScene("/nonexistent/scene.toml");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::kIo);
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
}

}  // namespace
}  // namespace relief
