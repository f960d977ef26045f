// SPDX-License-Identifier: Apache-2.0
#include "bake/report/recipe_report.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "bake/verdict/report_text.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

AssetResult baked(const std::string& name, double seconds, std::vector<std::string> warnings = {}) {
    AssetResult asset;
    asset.job.mesh = "meshes/" + name + ".obj";
    asset.job.output = name + ".relief";
    asset.state = AssetState::kBaked;
    asset.ms = 1000.0 * seconds;
    asset.warnings = std::move(warnings);
    return asset;
}

TEST(RecipeReport, SharedWarningIsReportedOnce) {
    std::vector<AssetResult> assets{baked("a", 1, {"a.obj: it is skinned", "a.obj: it is open"}),
                                    baked("b", 1)};
    for (const char* name : {"c", "d", "e"}) {
        assets.push_back(baked(name, 1, {std::string(name) + ".obj: it is skinned"}));
    }
    EXPECT_EQ(warningLines(assets),
              (std::vector<std::string>{"4 assets (a.relief, c.relief, d.relief, and 1 more): it is skinned",
                                        "a.relief: it is open"}));
    EXPECT_TRUE(warningLines({}).empty());
}

TEST(RecipeReport, MissingUnitIsReportedOnce) {
    const auto told = [](const std::string& name, float side) {
        return baked(name, 1,
                     {name + ".obj: " + *forgottenUnit({glm::vec3(0.0F), glm::vec3(side)}),
                      name + ".obj: " + std::to_string(int(side)) + " % is wrong"});
    };
    const std::string unit = *forgottenUnit({glm::vec3(0.0F), glm::vec3(1800.0F)});
    EXPECT_EQ(warningLines({told("a", 1800.0F), told("b", 200.0F), told("c", 300.0F)}),
              (std::vector<std::string>{"3 assets (a.relief, b.relief, c.relief): first of several: " + unit,
                                        "a.relief: 1800 % is wrong", "b.relief: 200 % is wrong",
                                        "c.relief: 300 % is wrong"}));
    EXPECT_EQ(warningLines({told("a", 1800.0F)})[0], "a.relief: " + unit);
}

TEST(RecipeReport, LevelWarningsWithDifferentNumbersAreReportedOnce) {
    const std::vector<std::string> chair = {"chair: 5.1 % wrong with 4.1 kB"};
    const std::vector<std::string> lamp = {"lamp: 12 % wrong with 5 kB", "lamp: open"};
    const std::vector<OwnWarnings> all = {{"chair", "chair", chair}, {"lamp", "lamp", lamp}};
    EXPECT_EQ(warningLines(all, "meshes", true),
              (std::vector<std::string>{"2 meshes (chair, lamp): first of several: 5.1 % wrong with 4.1 kB",
                                        "lamp: open"}));
    EXPECT_EQ(warningLines(all, "meshes", false).size(), 3U);
}

TEST(RecipeReport, OnlyAnOlderLogIsTruncated) {
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "events";
    const auto opens = [&](const std::string& text) {
        return RecipeEvents().open(folder.write("events", text).string()).has_value();
    };
    EXPECT_TRUE(opens(""));
    EXPECT_TRUE(opens("{\"event\":\"start\"}\n"));
    EXPECT_EQ(std::filesystem::file_size(file), 0U);
    for (const char* text : {"newmtl a\n", "{", "{\"asset\":{}}"}) {
        EXPECT_FALSE(opens(text)) << text;
        EXPECT_GT(std::filesystem::file_size(file), 0U) << text;
    }
}

}  // namespace
}  // namespace relief
