// SPDX-License-Identifier: Apache-2.0
// The scene file: keys, defaults, and hostile bytes. scene.schema.json pins the ranges of keys.
#include "runtime/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "tests/results.h"
#include "tests/runtime/scene/scene_text.h"

namespace relief {
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
    const auto scene = withDefaults(sceneWith(""), unitBounds());
    ASSERT_TRUE(scene);
    // The longest side is 2: births start above the box, and the floor is its lower end.
    EXPECT_GT(scene->emitters[0].box_min.y, 1.0F);
    EXPECT_EQ(*scene->forces.gravity, glm::vec3(0.0F, -6.0F, 0.0F));
    EXPECT_EQ(*scene->ground.height, 0.0F);
    EXPECT_FLOAT_EQ(*scene->render.point_size, 0.013F);
    EXPECT_NEAR(scene->emitters[0].rate * 5.0, 65536.0, 1e-2) << "the whole capacity is born by the end";
    EXPECT_GT(scene->camera.eye->z, 2.0F);
    const auto given =
        withDefaults(sceneWith("[emitter]\npoint = [1, 2, 3]\nduration = 2\nvelocity = [0, 0, 0]\n"
                               "velocity_spread = [0, 1, 0]\n[forces]\ngravity = [0, -9.81, 0]\n[ground]\n"
                               "height = -4\n[camera]\neye = [1, 1, 1]\n[render]\npoint_size = 0.5\n"),
                     unitBounds());
    ASSERT_TRUE(given);
    EXPECT_EQ(given->emitters[0].box_max, glm::vec3(1, 2, 3));
    EXPECT_NEAR(given->emitters[0].rate * 2.0, 65536.0, 1e-6) << "within its duration";
    EXPECT_EQ(given->emitters[0].velocity, glm::vec3(0.0F));
    EXPECT_EQ(given->emitters[0].velocity_spread, glm::vec3(0, 1, 0));
    EXPECT_EQ(*given->forces.gravity, glm::vec3(0, -9.81F, 0));
    EXPECT_EQ(*given->ground.height, -4.0F);
    EXPECT_EQ(*given->camera.eye, glm::vec3(1.0F));
    EXPECT_EQ(*given->render.point_size, 0.5F);
    EXPECT_FALSE(withDefaults(sceneWith("[camera]\neye = [0, 50, 0]\n"), unitBounds()))
        << "directly above the default target";
    EXPECT_FALSE(withDefaults(sceneWith(""), Bounds{}));
    EXPECT_FALSE(withDefaults(sceneWith(""), {glm::vec3(-3e38F), glm::vec3(3e38F)}));
    const auto flat = withDefaults(sceneWith(""), {glm::vec3(1.0F), glm::vec3(1.0F)});
    ASSERT_TRUE(flat);
    EXPECT_TRUE(std::isfinite(flat->camera.eye->x));
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
    const std::string path = testing::TempDir() + "relief_scene_large.toml";
    std::ofstream(path) << std::string((1 << 20) + 1, '#');
    expectError(loadScene(path), ErrorCode::kLimit);
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace relief
