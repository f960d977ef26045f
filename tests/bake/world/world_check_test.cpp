// SPDX-License-Identifier: Apache-2.0
// Worlds with lost thin parts, compared with their levels.
#include "bake/world/world_check.h"

#include "bake/report/world_report.h"
#include "tests/bake/world/level_bakes.h"

namespace relief::test {
namespace {

using WorldCheck = LevelBakes;

TEST_F(WorldCheck, AdvisesNoBudgetIfFloatsAreTooCoarse) {
    std::string far = "o far\n";
    const TriangleMesh torus = makeTorusMesh(0.5, 0.15, 24, 12);
    for (const glm::vec3& p : torus.positions) {
        far += "v " + std::to_string(4e5 + double{p.x}) + " " + std::to_string(p.y) + " " +
               std::to_string(4e5 + double{p.z}) + "\n";
    }
    for (const glm::uvec3& t : torus.triangles) {
        far += "f " + std::to_string(t.x + 1) + " " + std::to_string(t.y + 1) + " " +
               std::to_string(t.z + 1) + "\n";
    }
    folder_.write("level.obj", far);
    request_.bake.budget = 60'000;
    const WorldBakeResult baked = bake("w");
    const WorldField field = load("w");
    const WorldAccuracy accuracy = check(field, 10'000);
    EXPECT_GT(accuracy.all.total(), 5.0);
    EXPECT_EQ(accuracy.places.front().cause, WorldCause::kPrecision);
    const std::string& warning = baked.colliders.front().warnings.back();
    for (const std::string& text : {worldCheckText(field, "w", &accuracy), warning}) {
        EXPECT_EQ(text.find("--budget"), std::string::npos) << text;
        EXPECT_NE(text.find("origin"), std::string::npos) << text;
    }
}

TEST_F(WorldCheck, NamesMeshesWithLostThinParts) {
    // 20 posts of 0.5 m on a slab of 20 m; most points near the mesh are far from the posts.
    const auto accuracyOf = [&](double half, std::uint64_t budget) {
        std::vector<TriangleMesh> house = {makeBoxMesh({0, 0, 0}, {10, 0.25, 10})};
        for (int i = 0; i < 20; ++i) {
            house.push_back(makeBoxMesh({0.9 * i - 9.0, 0.45, 0.2 * i - 2.0}, {half, 0.25, half}));
        }
        write({{"house", joined(house)}});
        request_.bake.budget = budget;
        static_cast<void>(bake("w"));
        WorldAccuracy accuracy = check(load("w"), 10'000);
        EXPECT_LT(accuracy.all.total(), 1.0);
        return accuracy;
    };
    const WorldAccuracy coarse = accuracyOf(0.0025, 24'000);
    ASSERT_EQ(coarse.lost.size(), 1U);
    EXPECT_EQ(coarse.lost[0].mesh, "house");
    EXPECT_GT(coarse.lost[0].lost, 10U) << coarse.lost[0].text;
    EXPECT_FALSE(coarse.passes(1.0F));
    const Verdict verdict = verdictOf(coarse, "");
    EXPECT_EQ(verdict.grade, "poor");
    EXPECT_NE(verdict.text.find("but 1 mesh lost parts"), std::string::npos) << verdict.text;
    EXPECT_TRUE(coarse.passes({}));
    const WorldAccuracy fine = accuracyOf(0.04, 300'000);
    EXPECT_TRUE(fine.lost.empty()) << fine.lost[0].text;
    EXPECT_TRUE(fine.passes(1.0F));
}

TEST_F(WorldCheck, CountsSmallLostPartsOfAllMeshes) {
    std::vector<TriangleMesh> yard = {makeBoxMesh({0, 0, 0}, {10, 0.25, 10})};
    for (int i = 0; i < 20; ++i) {
        yard.push_back(makeBoxMesh({0.9 * i - 9.0, 0.252, 0.2 * i - 2.0}, glm::dvec3(0.005)));
    }
    write({{"yard", joined(yard)}});
    request_.bake.budget = 24'000;
    const WorldBakeResult baked = bake("w");
    ASSERT_TRUE(baked.colliders[0].verdict);
    EXPECT_EQ(baked.colliders[0].verdict->grade, "good");
    EXPECT_GT(baked.colliders[0].ignored.lost, 15U);  // with 16 points each
    EXPECT_NE(worldBakeText(baked, "w", 1.0, false).find(" of 21 parts, at most 0.01 long, are not"),
              std::string::npos);
    const WorldField field = load("w");
    const WorldAccuracy accuracy = check(field, 2000);
    EXPECT_TRUE(accuracy.lost.empty());
    EXPECT_GT(accuracy.ignored.lost, 15U);
    EXPECT_EQ(verdictOf(accuracy, "").grade, "good");
    EXPECT_NE(worldCheckText(field, "w", &accuracy).find(" of 21 parts, at most 0.01 long, are not"),
              std::string::npos);
}

}  // namespace
}  // namespace relief::test
