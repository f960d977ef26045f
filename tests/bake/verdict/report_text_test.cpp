// SPDX-License-Identifier: Apache-2.0
#include "bake/verdict/report_text.h"

#include <gtest/gtest.h>

#include "bake/verdict/parts_report.h"
#include "tests/formats/analytic_shapes.h"
#include "tests/formats/random_patches.h"

namespace relief {
namespace {

Bounds box(float x, float y, float z) {
    return {{0.0F, 0.0F, 0.0F}, {x, y, z}};
}

TEST(SizeReport, BoxHasItsUnit) {
    EXPECT_EQ(boxText({{-1, -2, -3}, {1, 2, 3.04999F}}, "m"),
              "2 x 4 x 6.05 m, from (-1, -2, -3) to (1, 2, 3.05)");
    EXPECT_EQ(boxText(box(1800, 0, 0.001F), ""),
              "1800 x 0 x 0.001 object units, from (0, 0, 0) to (1800, 0, 0.001)");
}

TEST(SizeReport, MissingUnitIsSuggestedWithTheResultingSizes) {
    EXPECT_FALSE(missingUnitText(box(99, 99, 99)));
    EXPECT_FALSE(missingUnitText(Bounds()));
    const auto person = missingUnitText(box(50, 180, 30));
    ASSERT_TRUE(person);
    EXPECT_NE(person->find("with --unit cm 0.5 x 1.8 x 0.3 m, with --unit mm 0.05 x 0.18 x 0.03 m"),
              std::string::npos)
        << *person;
}

TEST(PartCure, NamedMapsNeedResolutionNotBudget) {
    Collider collider;
    collider.maps = {test::emptyMap(test::centeredFrame({0, 0, 0}, glm::dmat3(1.0), {4, 4, 4}),
                                    MapFormat::kFloat32, Compare::kLess, 64, 64)};
    collider.bounds = {glm::vec3(-2.0F), glm::vec3(2.0F)};
    SurfacePart rod;
    rod.bounds = {glm::vec3(0.0F), {1.0F, 0.046875F, 0.046875F}};
    EXPECT_EQ(partFix(rod, collider),
              "its texels are 0.062 wide; texels of 0.016 need --resolution 256 (--map: size=256), or a "
              "separate bake of this part");
}

// A former fault: --budget was advised for colliders that were baked with --map or --texel.
TEST(PartCure, PatchesNeedTheOptionOfTheirBake) {
    Collider collider;
    collider.maps = {test::patchesOf(
        {{1, 1, 1}, 1}, {PatchRecord::patch({}, false, PatchHeights::of({{0.2, 0.2, 0.2, 0.2}}, 2), 0)})};
    SurfacePart rod;
    rod.bounds = {glm::vec3(0.0F), {1.0F, 0.3F, 0.3F}};
    const auto cure = [&](std::vector<RecordedOption> options) {
        collider.provenance.options = std::move(options);
        return partFix(rod, collider);
    };
    EXPECT_NE(cure({{"budget", "4000"}}).find("try --budget 0.1MB, or"), std::string::npos);
    EXPECT_NE(cure({{"map", "patches:budget=4000"}}).find("try --map patches:budget=0.1MB, or"),
              std::string::npos);
    EXPECT_NE(cure({{"map", "patches:texel=1"}}).find("try --map patches:texel=0.1, or"), std::string::npos);
    EXPECT_NE(cure({{"texel", "1"}}).find("try --texel 0.1, or"), std::string::npos);
    EXPECT_NE(cure({{"budget", "4000"}, {"texel", "1"}}).find("try --budget 0.1MB, or"), std::string::npos);
}

}  // namespace
}  // namespace relief
