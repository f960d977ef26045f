#include "bake/report/recipe_report.h"

#include <gtest/gtest.h>

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

TEST(RecipeReport, AWarningOfSeveralAssetsIsToldOnce) {
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

TEST(RecipeReport, NamesWhatTookLong) {
    EXPECT_EQ(slowestText({}), "");
    EXPECT_EQ(slowestText({baked("a", 1), baked("b", 1.5), baked("c", 1.2)}), "");
    std::vector<AssetResult> assets{baked("a", 1), baked("b", 30), baked("c", 1), baked("d", 12),
                                    baked("e", 0.5)};
    EXPECT_EQ(slowestText(assets), "the slowest: b.relief 30.0 s, d.relief 12.0 s");
    assets[1].state = AssetState::kFailed;
    EXPECT_EQ(slowestText(assets), "the slowest: d.relief 12.0 s");
}

}  // namespace
}  // namespace relief
