// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <algorithm>
#include <filesystem>

#include "bake/report/collider_report.h"
#include "bake/report/points_csv.h"
#include "bake/report/recipe_report.h"
#include "bake/verdict/report_text.h"
#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

TEST(PointsCsv, ReadsCommonVariants) {
    const std::vector<glm::vec3> points = required(parsePoints(
        "\xef\xbb\xbf# a comment\r\nx,y,z\r\n1,2,3\r\n\n  -1.5 ,\t+2e-3, .5 \n# more\n0,0,-0", "in.csv"));
    ASSERT_EQ(points.size(), 3U);
    EXPECT_EQ(points[0], glm::vec3(1, 2, 3));
    EXPECT_EQ(points[1], glm::vec3(-1.5F, 2e-3F, 0.5F));
    EXPECT_TRUE(parsePoints("", "in.csv")->empty());
    EXPECT_TRUE(parsePoints("x,y,z\n", "in.csv")->empty());
}

TEST(PointsCsv, ErrorsNameTheLine) {
    // The last line is wrong.
    for (const std::string text :
         {"1,2,3\n1,2\n", "1,2,3,4\n", "1,2,nan\n", "nan,nan,nan\n", "inf,0,0\n", "1e99,0,0\n",
          "# c\n\n1;2;3\n", "1,2,3\nx,y,z\n", "x,y,z\na,b,c\n", "1,,3\n", "a,b\n", "0x1,0,0\n"}) {
        SCOPED_TRACE(text);
        expectErrorStart(parsePoints(text, "in.csv"), ErrorCode::kInvalidInput,
                         "in.csv:" + std::to_string(std::ranges::count(text, '\n')) + ":");
    }
}

TEST(PointsCsv, WritesExactValuesAndMarksUnknowns) {
    const std::vector<glm::vec3> points = {{0.1F, -2, 3}, {1e20F, 0, 0}, {7, 8, 9}};
    const std::vector<FieldSample> samples = {{-0.25F, {0, 1, 0}, 2}, {kFarOutside, glm::vec3(0), 0}, {}};
    EXPECT_EQ(formatSamples(points, samples),
              "x,y,z,f,nx,ny,nz,map\n0.1,-2,3,-0.25,0,1,0,2\n1e+20,0,0,inf,0,0,0,0\n7,8,9,,,,,\n");
}

TEST(ColliderReport, WorldsShowTheCommonOrigin) {
    const Provenance chair{"chair", "aa", 12, "relief 1", {{"quality", "fast"}, {"budget", "4096"}}};
    const std::string rest = " (--json lists the options of each collider)\nbaked    by relief 1";
    EXPECT_EQ(commonOriginText({chair, chair}), "meshes   1" + rest + " with --quality fast --budget 4096\n");
    Provenance lamp = chair;
    lamp.mesh_hash = "bb";
    lamp.options[1].value = "8192";
    lamp.options.push_back({"as", "shell"});
    EXPECT_EQ(commonOriginText({chair, lamp}), "meshes   2" + rest + " with --quality fast\n");
    lamp.tool_version = "relief 2";
    lamp.options[0].value = "best";
    EXPECT_EQ(commonOriginText({chair, lamp}), "meshes   2" + rest + ", relief 2\n");
}

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
                     {name + ".obj: " + *missingUnitText({glm::vec3(0.0F), glm::vec3(side)}),
                      name + ".obj: " + std::to_string(int(side)) + " % is wrong"});
    };
    const std::string unit = *missingUnitText({glm::vec3(0.0F), glm::vec3(1800.0F)});
    EXPECT_EQ(warningLines({told("a", 1800.0F), told("b", 200.0F), told("c", 300.0F)}),
              (std::vector<std::string>{"3 assets (a.relief, b.relief, c.relief): first of several: " + unit,
                                        "a.relief: 1800 % is wrong", "b.relief: 200 % is wrong",
                                        "c.relief: 300 % is wrong"}));
    EXPECT_EQ(warningLines({told("a", 1800.0F)})[0], "a.relief: " + unit);
}

TEST(RecipeReport, LevelWarningsWithDifferentNumbersAreReportedOnce) {
    const std::vector<std::string> chair = {"chair: 5.1 % wrong with 4.1 kB"};
    const std::vector<std::string> lamp = {"lamp: 12 % wrong with 5 kB", "lamp: open"};
    const std::vector<OwnerWarnings> all = {{"chair", "chair", chair}, {"lamp", "lamp", lamp}};
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
}  // namespace relief::test
