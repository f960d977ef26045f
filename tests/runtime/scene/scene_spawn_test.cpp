// [[spawn]]: what it says, and what is given by mistake.
#include <gtest/gtest.h>

#include "tests/runtime/scene/scene_error.h"

namespace relief {
namespace {

const std::string kHead =
    "[collider]\nfile = \"x.relief\"\n[[type]]\nname = \"drop\"\n[[type]]\nname = \"splash\"\n";

TEST(SceneSpawn, EveryKeyIsRead) {
    const auto scene =
        parseScene(kHead +
                       "[[spawn]]\non = \"collision\"\nof = \"drop\"\ntype = \"splash\"\ncount = [2, 5]\n"
                       "most = 70\nlifetime = [0.5, 2]\ninherit = 0.25\nspeed = [1, 3]\nkick = 0.5\n"
                       "cone = 20\nmin_speed = 0.75\nseed = 6\n[[spawn]]\non = \"death\"\nspeed = 2\n"
                       "[[spawn]]\non = \"collision\"\nof = 1\n",
                   "dir/scene.toml");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->spawns.size(), 3U);
    const SceneSpawn& first = scene->spawns[0];
    SpawnSettings wanted;
    wanted.of = 0;
    wanted.type = 1;
    wanted.count_min = 2;
    wanted.count_max = 5;
    wanted.most = 70;
    wanted.lifetime_min = 0.5F;
    wanted.lifetime_max = 2.0F;
    wanted.inherit = 0.25F;
    wanted.speed_min = 1.0F;
    wanted.speed_max = 3.0F;
    wanted.kick = 0.5F;
    wanted.cone_degrees = 20.0F;
    wanted.min_speed = 0.75F;
    EXPECT_TRUE(SpawnSettings(first) == wanted);
    EXPECT_EQ(first.seed, 6U);
    SpawnSettings death;
    death.on = SpawnOn::kDeath;
    death.speed_min = death.speed_max = 2.0F;
    EXPECT_TRUE(SpawnSettings(scene->spawns[1]) == death);
    EXPECT_EQ(scene->spawns[2].of, 1U);
    EXPECT_EQ(scene->spawns[2].cone_degrees, 60.0F);
    EXPECT_EQ(makeSpawners(scene->spawns, {}).size(), 3U);
}

TEST(SceneSpawn, MistakesAreNamedWithTheirPlace) {
    const auto bad = [](const std::string& keys, const std::string& place, const std::string& part) {
        expectSceneError(kHead + "[[spawn]]\n" + keys, "dir/scene.toml:" + place + ": ", part);
    };
    bad("count = 2", "7:1", "spawn.on is missing");
    bad("on = \"birth\"", "8:6", "spawn.on");
    bad("on = \"death\"\ncolour = 1", "9:1", "colour");
    bad("on = \"death\"\nof = \"dorp\"", "9:6", "did you mean 'drop'");
    bad("on = \"death\"\ntype = 2", "9:8", "none of the 2 types");
    bad("on = \"death\"\ntype = \"\"", "9:8", "empty name");
    bad("on = \"death\"\ntype = 1.5", "9:8", "spawn.type");
    bad("on = \"death\"\ncount = 0", "9:9", "spawn.count");
    bad("on = \"death\"\ncount = 1.5", "9:9", "whole number");
    bad("on = \"death\"\ncount = [5, 2]", "9:9", "swap them");
    bad("on = \"death\"\nlifetime = 0", "9:12", "spawn.lifetime");
    bad("on = \"death\"\nmin_speed = 1", "9:13", "does nothing");
    bad("on = \"death\"\ncone = 10", "9:8", "does nothing");
    bad("on = \"death\"\ninherit = -1", "9:11", "spawn.inherit");
    expectSceneError(kHead + "[spawn]\non = \"death\"", "dir/scene.toml:7:1: ", "[[spawn]]");
    std::string many = kHead;
    for (std::size_t i = 0; i <= kSpawnsMax; ++i) {
        many += "[[spawn]]\non = \"death\"\n";
    }
    expectSceneError(many, "dir/scene.toml:39:1: ", "more than 16");
}

}  // namespace
}  // namespace relief
