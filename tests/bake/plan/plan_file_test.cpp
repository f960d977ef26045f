// SPDX-License-Identifier: Apache-2.0
// Plan files: what is written reads back as the same specs, to the last bit, and whatever is wrong in a file
// is told with its place.
#include "bake/plan/plan_file.h"

#include <gtest/gtest.h>

#include "tests/results.h"

namespace relief::test {
namespace {

TEST(PlanFile, ReadsWhatItWrites) {
    PlanFile plan;
    plan.quality = Quality::kBest;
    plan.budget = 123'456'789'012;
    plan.thickness = double{0.012F};
    for (const char* text :
         {"front-back:dir=0.1/-0.7/1e-20,up=+x,size=7x9,depth=unorm16,decode=plane,box=tight",
          "front-back:dir=-y,size=16384x3,depth=half,decode=projected,box=-1/-2/-3/0.1/1e+20/3",
          "float:dir=+x,size=12x12,compare=greater,decode=plane,box=tight",
          "fixed8:dir=1/2/3,size=12x12,compare=less,decode=projected,box=tight",
          "cube:size=5,compare=less,center=0/0.1/-0.25,decode=plane,box=tight",
          "cube:size=5,compare=greater,decode=plane,box=0/0/0/1/1/1"}) {
        plan.maps.push_back({*parseMapSpec(text), "why\nnot\x1b"});
    }
    const std::string text = planText(plan);
    const PlanFile back = required(parsePlan(text, "plan.toml"));
    EXPECT_EQ(back.quality, Quality::kBest);
    EXPECT_EQ(back.budget, plan.budget);
    EXPECT_EQ(back.thickness, plan.thickness);
    ASSERT_EQ(back.maps.size(), plan.maps.size());
    for (std::size_t i = 0; i < plan.maps.size(); ++i) {
        EXPECT_EQ(back.maps[i].spec, plan.maps[i].spec) << toString(plan.maps[i].spec);
    }
    EXPECT_NE(text.find("\n# why"), std::string::npos) << "the reason stands above its map";
}

TEST(PlanFile, TakesWhatAPersonWrites) {
    const PlanFile plan = required(parsePlan(
        "version = 1  # no quality\n[[map]]\nsize = 12\nformat = 'front-back'\n[[map]]\nformat = 'cube'\n"
        "compare = \"less\"\nsize = \"8\"\n",
        "plan.toml"));
    EXPECT_EQ(plan.quality, Quality::kNormal);
    EXPECT_EQ(plan.maps[0].spec, *parseMapSpec("front-back:size=12"));
    EXPECT_EQ(plan.maps[1].spec, *parseMapSpec("cube:size=8,compare=less"));
}

TEST(PlanFile, SaysWhatIsWrongAndWhere) {
    struct Case {
        std::string text;
        const char* says;
    };
    const std::string head = "version = 1\n";
    const std::string map = "[[map]]\nformat = 'float'\nsize = 9\n";
    std::string many = head;
    for (int i = 0; i < 1025; ++i) {
        many += "[[map]]\nformat = 'float'\nsize = 9\n";
    }
    const Case cases[] = {
        {"", "p.toml:1:1: version is missing"},
        {"version = ", "p.toml:1:"},
        {"version = 2\n" + map, "p.toml:1:11: version = 2 is out of range"},
        {head, "map is missing"},
        {head + "map = []", "at least one [[map]]"},
        {head + "map = 3", "p.toml:2:7: map must be tables"},
        {head + "map = [3]", "p.toml:2:8: map must be tables"},
        {head + "[map]\nformat = 'float'", "as in [[map]]"},
        {head + "qualty = 'best'\n" + map, "p.toml:2:1: unknown table 'qualty'; did you mean 'quality'"},
        {head + "thickness = 0\n" + map, "p.toml:2:13: thickness = 0 is out of range"},
        {head + "thickness = nan\n" + map, "p.toml:2:13: thickness = nan is out of range"},
        {head + "[[map]]\nsize = 9\n", "p.toml:2:1: a map needs format"},
        {head + "[[map]]\nformat = 'float'\n", "p.toml:2:1: a map needs size"},
        {head + "[[map]]\nformat = 'flat'\nsize = 9\n", "p.toml:3:10: unknown format 'flat'"},
        {head + map + "sise = 3\n", "p.toml:5:1: unknown key 'sise'; did you mean 'size'"},
        {head + map + "\"a\\u001bb\" = 3\n", "p.toml:5:1: unknown key"},
        {head + map + "dir = [0, 1, 0]\n", "p.toml:5:7: map.dir must be a string"},
        {head + map + "dir = '+x,size=5'\n", "p.toml:5:7: dir is"},
        {head + map + "depth = 'half'\n", "p.toml:5:9: depth does nothing"},
        {head + map + "dir = '+x'\nup = '-x'\n", "p.toml:2:1: up is parallel"},
        {head + map + "size = 10\n", "p.toml:5:"},
        {head + "[[map]]\nformat = 'float'\nsize = -3\n", "p.toml:4:8: size is '-3'"},
        {head + "[[map]]\nformat = 'float'\nsize = 9.5\n", "p.toml:4:8: map.size must be"},
        {head + "[[map]]\nformat = 'float'\nsize = 16385\n", "p.toml:4:8: size is 16385"},
        {many, "there are 1025 of [[map]]"},
        {head + "x = " + std::string(5000, '['), "p.toml:2:"},
        {"\xff\xfe", "p.toml:1:"},
    };
    for (const Case& c : cases) {
        const bool limit = c.text == many || c.text.find("16385") != std::string::npos;
        const Result<PlanFile> plan = parsePlan(c.text, "p.toml");
        expectError(plan, limit ? ErrorCode::kLimit : ErrorCode::kInvalidInput, c.says);
        EXPECT_TRUE(!plan && plan.error().message.starts_with("p.toml:") &&
                    plan.error().message.find('\x1b') == std::string::npos);
    }
}

}  // namespace
}  // namespace relief::test
