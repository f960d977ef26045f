// SPDX-License-Identifier: Apache-2.0
// How whole bakes share the budget of a level.
#include "bake/world/budget_share.h"

#include <glm/geometric.hpp>
#include <map>

#include "bake/world/error_curves.h"
#include "formats/base/portable_math.h"
#include "tests/bake/world/level_bakes.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLevelBudget = 160'000;

/// A ball with bumps, with the area of a box of 4 × 4 × 0.5: 40 square units.
TriangleMesh makeBumpyBall(double bumps) {
    TriangleMesh mesh = makeIcosphere(glm::dvec3(0.0), 1.0, 4);
    double area = 0.0;
    for (glm::vec3& p : mesh.positions) {
        const glm::dvec3 d(p);
        p *= static_cast<float>(1.0 + bumps * portable::sin(9.0 * d.x) * portable::sin(9.0 * d.y) *
                                          portable::sin(9.0 * d.z));
    }
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a,
                                             glm::dvec3(mesh.positions[t.z]) - a));
    }
    for (glm::vec3& p : mesh.positions) {
        p *= static_cast<float>(std::sqrt(40.0 / area));
    }
    return mesh;
}

class LevelShares : public LevelBakes {
  protected:
    void SetUp() override {
        writeLevel(0.2);
        request_.bake.budget = kLevelBudget;
    }

    void writeLevel(double bumps) const {
        write({{"box", makeBoxMesh(glm::dvec3(0.0), glm::dvec3(2.0, 2.0, 0.25))},
               {"ball", makeBumpyBall(bumps), {10.0F, 0.0F, 0.0F}},
               {"torus", makeTorusMesh(1.0, 0.35, 48, 32), {20.0F, 0.0F, 0.0F}},
               {"rock", makeBumpyBall(0.1), {30.0F, 0.0F, 0.0F}}});
    }

    static std::map<std::string, std::uint64_t> sharesOf(const WorldBakeResult& result) {
        std::map<std::string, std::uint64_t> shares;
        for (const WorldColliderResult& collider : result.colliders) {
            shares[collider.mesh] = *collider.budget;
        }
        return shares;
    }
};

TEST_F(LevelShares, BumpyBallGetsMoreThanABoxOfEqualArea) {
    const WorldBakeResult result = bake("w");
    std::map<std::string, std::uint64_t> shares = sharesOf(result);
    EXPECT_GT(shares["ball"], 2 * shares["box"]);
    EXPECT_GT(shares["ball"], shares["rock"]) << "the rock has lower bumps";
    EXPECT_GT(shares["ball"] + shares["torus"] + shares["rock"], kLevelBudget * 3 / 4)
        << "bytes that the box leaves";
    EXPECT_LE(result.gpuBytes(), kLevelBudget);
    EXPECT_LE(shares["ball"] + shares["torus"] + shares["rock"] + shares["box"], kLevelBudget);
    request_.bake.threads = 1;
    static_cast<void>(bake("one"));
    EXPECT_TRUE(filesOf("w") == filesOf("one"));
}

TEST_F(LevelShares, NamesCanBeLongOrLookLikePaths) {
    write({{"props/" + std::string(300, 'x'), makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0))},
           {"ball", makeIcosphere({5.0, 0.0, 0.0}, 1.0, 2)}});
    request_.bake.budget = 20'000;
    EXPECT_EQ(sharesOf(bake("w")).size(), 2U);
}

TEST_F(LevelShares, SecondRunPlansAndBakesOnlyChanges) {
    std::map<std::string, std::uint64_t> shares = sharesOf(bake("w"));
    const Files files = filesOf("w");
    EXPECT_EQ(bake("w").countOf(WorldColliderState::kUpToDate), 4U);
    EXPECT_TRUE(filesOf("w") == files);
    // Existing curves are used. If all are equal, only the areas of the meshes affect the shares.
    ErrorCurves curves = required(loadErrorCurves(folder_.path() / "w"));
    EXPECT_GE(curves.size(), 4U);
    for (auto& [key, curve] : curves) {
        curve = {{1000.0, 1.0}, {2000.0, 0.6}};
    }
    ASSERT_TRUE(saveErrorCurves(folder_.path() / "w", curves));
    std::map<std::string, std::uint64_t> alike = sharesOf(bake("w"));
    EXPECT_EQ(alike["box"], alike["ball"]);
    // Missing or invalid curves are planned again, with equal results.
    for (const char* text : {"", "{}"}) {
        if (*text == '\0') {
            fs::remove(folder_.path() / "w" / kErrorCurvesName);
        } else {
            folder_.write(std::string("w/") + kErrorCurvesName, text);
        }
        const WorldBakeResult again = bake("w");
        EXPECT_EQ(sharesOf(again), shares);
        EXPECT_EQ(again.warnings.empty(), *text == '\0');
        EXPECT_TRUE(filesOf("w")[kErrorCurvesName] == files.at(kErrorCurvesName));
    }
    // A changed mesh is baked again, and few others.
    writeLevel(0.203);
    const WorldBakeResult result = bake("w");
    EXPECT_LE(result.countOf(WorldColliderState::kBaked), 2U);
    for (const WorldColliderResult& collider : result.colliders) {
        EXPECT_TRUE(collider.mesh != "ball" || collider.state == WorldColliderState::kBaked);
    }
}

}  // namespace
}  // namespace relief::test
