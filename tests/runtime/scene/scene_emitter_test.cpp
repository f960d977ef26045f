// SPDX-License-Identifier: Apache-2.0
// [emitter], [[emitter]] and [[spawn]]: their keys and defaults.
#include "runtime/scene/scene_emitter.h"
#include "runtime/births/emitter_motion.h"

#include <gtest/gtest.h>

#include <string>

#include "runtime/scene/scene_births.h"
#include "tests/results.h"
#include "tests/runtime/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace relief {
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
        auto complete = withDefaults(
            required(parseScene(kSceneHead + "[emitter]\n" + keys, folder.path() / "scene.toml")),
            unitBounds());
        EXPECT_TRUE(complete);
        return makeEmitters(complete->emitters, SceneMeshes{});
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
    expectErrorOf(make("points = \"points.csv\"\nspeed = 1\n"), "scene.toml:4:10: emitter.points: ", "");
    EXPECT_EQ(make("points = \"none.csv\"\n").error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace relief
