// SPDX-License-Identifier: Apache-2.0
// Budgets of a level shared among its meshes, in whole bakes, and the file of error curves that determine the shares.
#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <vector>

#include "bake/world/budget_share.h"
#include "bake/world/error_curves.h"
#include "formats/base/file_io.h"
#include "formats/base/portable_math.h"
#include "tests/bake/world/level_bakes.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

std::vector<std::uint64_t> bytesOf(const std::vector<BudgetShare>& shares) {
    std::vector<std::uint64_t> bytes;
    for (const BudgetShare& share : shares) {
        bytes.push_back(share.bytes);
    }
    return bytes;
}

std::uint64_t sumOf(const std::vector<std::uint64_t>& bytes) {
    return std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0});
}

std::vector<BudgetShare> sharesOf(const std::vector<double>& weights) {
    std::vector<BudgetShare> shares;
    for (const double weight : weights) {
        shares.push_back({weight});
    }
    return shares;
}

std::vector<std::uint64_t> byArea(std::uint64_t budget, const std::vector<double>& weights) {
    std::vector<BudgetShare> shares = sharesOf(weights);
    EXPECT_TRUE(shareByArea(budget, shares));
    return bytesOf(shares);
}

/// Errors as a function of bytes.
using Errors = std::function<double(double bytes)>;

Errors powerLaw(double errors, double power) {
    return [=](double bytes) { return errors * std::pow(bytes, -power); };
}

/// Shares by error curves, and the bytes of each plan.
struct Shared {
    std::vector<std::uint64_t> bytes;
    std::vector<std::vector<std::uint64_t>> planned;
};
Shared byErrors(std::uint64_t budget, const std::vector<Errors>& meshes, std::vector<double> weights = {}) {
    weights.resize(meshes.size(), 1.0);
    std::vector<BudgetShare> shares = sharesOf(weights);
    Shared shared;
    shared.planned.resize(meshes.size());
    EXPECT_TRUE(
        shareByErrors(budget, shares, [&](std::size_t mesh, std::uint64_t bytes) -> Result<ErrorCurve> {
            shared.planned[mesh].push_back(bytes);  // one thread at a time per mesh
            if (!meshes[mesh]) {
                return fail(ErrorCode::kFailure, "no solid");
            }
            ErrorCurve curve;
            for (double at = 1000.0; at <= static_cast<double>(bytes); at *= 1.7) {
                const double wrong = meshes[mesh](at);
                if (curve.empty() || wrong < curve.back().wrong) {
                    curve.push_back({at, wrong});
                }
            }
            return curve;
        }));
    shared.bytes = bytesOf(shares);
    return shared;
}

TEST(BudgetShares, StepsAreAnEighthOfAnOctave) {
    for (const std::uint64_t bytes : {1ULL, 2ULL, 3ULL, 4096ULL, 5000ULL, 1'000'000ULL, 1ULL << 40}) {
        const std::uint64_t step = roundDownToEighth(bytes);
        EXPECT_LE(step, bytes);
        EXPECT_GT(static_cast<double>(step), static_cast<double>(bytes) / 1.0906 - 1.0);
        EXPECT_EQ(roundDownToEighth(step), step);
    }
    EXPECT_EQ(roundDownToEighth(1'048'576), 1'048'576U);
}

TEST(BudgetShares, HalfIsByAreaAndHalfIsEven) {
    const std::vector<std::uint64_t> bytes = byArea(1 << 20, {3.0, 1.0});
    EXPECT_EQ(bytes[0], roundDownToEighth((1 << 18) + (1 << 17) * 3));
    EXPECT_EQ(bytes[1], roundDownToEighth((1 << 18) + (1 << 17)));
    EXPECT_EQ(byErrors(1 << 20, {powerLaw(1.0, 0.7)}).bytes, std::vector<std::uint64_t>{1 << 20})
        << "everything to the second mesh";
    EXPECT_EQ(byArea(1 << 20, {0.0, 0.0}), (std::vector<std::uint64_t>(2, 1 << 18))) << "without any area";
}

TEST(BudgetShares, SmallPartsOfALargeLevelKeepTheEvenHalf) {
    std::vector<double> weights(51, 8.0);
    weights[0] = 1e6;
    const std::vector<std::uint64_t> bytes = byArea(16'000'000, weights);
    EXPECT_GT(bytes[1], 140'000U);
    EXPECT_GT(bytes[0], 7'000'000U);
    EXPECT_LE(sumOf(bytes), 16'000'000U);
    // A growing prop leaves the shares of the others unchanged.
    weights[7] = 16.0;
    std::vector<std::uint64_t> after = byArea(16'000'000, weights);
    after[7] = bytes[7];
    EXPECT_EQ(after, bytes);
}

TEST(BudgetShares, ErrorCurvesEqualizeTheGainPerByte) {
    // For equal p, the sum of w·c·b^-p is minimal if shares are proportional to (w·c)^(1 / (1 + p)).
    const std::vector<double> errors = {1.0, 2.0, 4.0, 1.0};
    const std::vector<double> weights = {1.0, 1.0, 1.0, 8.0};
    for (const double power : {0.5, 0.73, 1.0}) {
        std::vector<Errors> meshes;
        double sum = 0.0;
        for (std::size_t i = 0; i < errors.size(); ++i) {
            meshes.push_back(powerLaw(errors[i], power));
            sum += std::pow(weights[i] * errors[i], 1.0 / (1.0 + power));
        }
        const std::vector<std::uint64_t> bytes = byErrors(4'000'000, meshes, weights).bytes;
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            const double best = 4e6 * std::pow(weights[i] * errors[i], 1.0 / (1.0 + power)) / sum;
            // Rounding down to eighths of an octave costs half a step on average. The curves may cost another half
            // step.
            EXPECT_NEAR(std::log2(static_cast<double>(bytes[i]) / best), -1.0 / 16.0, 1.0 / 8.0)
                << power << " " << i;
        }
        EXPECT_LE(sumOf(bytes), 4'000'000U);
        EXPECT_GT(sumOf(bytes), 3'600'000U);
    }
}

TEST(BudgetShares, BytesLeftByExactMeshesGoToOthers) {
    // A box is exact with 3000 bytes.
    const Errors box = [](double bytes) { return bytes < 3000.0 ? 1.0 : 0.0; };
    const Errors rock = powerLaw(1.0, 0.73);
    const std::vector<std::uint64_t> bytes = byErrors(800'000, {box, box, box, rock}).bytes;
    EXPECT_LE(bytes[0], 25'000U) << "an eighth of an even share";
    EXPECT_EQ(bytes[0], bytes[1]);
    EXPECT_GT(bytes[3], 650'000U);
    EXPECT_LE(sumOf(bytes), 800'000U);
}

TEST(BudgetShares, EveryMeshGetsAShare) {
    const std::vector<std::uint64_t> bytes =
        byErrors(8'000'000, {powerLaw(1e9, 0.7), powerLaw(1e-9, 0.7), powerLaw(1.0, 0.7)}).bytes;
    EXPECT_GE(bytes[1], roundDownToEighth(8'000'000 / 3 / 8));
    EXPECT_GT(bytes[0], 7'000'000U);
    EXPECT_GE(byErrors(2 * 2 * kShareMin, {powerLaw(1e9, 0.7), powerLaw(1.0, 0.7)}).bytes[1], kShareMin);
}

TEST(BudgetShares, LargeIncreasesAreReplanned) {
    // Beyond 50 kB more bytes hardly reduce the errors. A plan with an eighth of an even share does not show this.
    const Errors knee = [](double bytes) {
        return 1e3 * std::pow(std::min(bytes, 5e4), -0.7) - 1e-9 * bytes;
    };
    std::vector<Errors> meshes(20, powerLaw(1.0, 0.7));
    meshes[7] = knee;
    const Shared shared = byErrors(4'000'000, meshes);
    EXPECT_EQ(shared.planned[0], std::vector<std::uint64_t>{16'384});
    EXPECT_GT(shared.planned[7].size(), 1U);
    EXPECT_GT(shared.bytes[7], 40'000U);
    EXPECT_LT(shared.bytes[7], 400'000U) << "the power law would give 3 MB";
    std::uint64_t planned = 0;
    for (const std::vector<std::uint64_t>& plans : shared.planned) {
        planned += sumOf(plans);
    }
    EXPECT_LT(planned, 4'000'000U / 2);
}

TEST(BudgetShares, UnplannableMeshGetsAnEvenShare) {
    const std::vector<std::uint64_t> bytes =
        byErrors(1 << 20, {powerLaw(1.0, 0.7), {}, powerLaw(100.0, 0.7), powerLaw(1.0, 0.7)}).bytes;
    EXPECT_EQ(bytes[1], 1U << 18U);
    EXPECT_LE(sumOf(bytes), 1U << 20U);
    EXPECT_GT(bytes[2], bytes[0]);
}

TEST(BudgetShares, TooFewBytesAreRejectedWithTheMinimum) {
    std::vector<BudgetShare> shares(100);
    const PlanErrors none = [](std::size_t, std::uint64_t) { return ErrorCurve(); };
    expectError(shareByArea(819'199, shares), ErrorCode::kUsage, "at least 819200");
    EXPECT_EQ(shareByErrors(819'199, shares, none).error().message,
              shareByArea(819'199, shares).error().message);
    EXPECT_TRUE(shareByArea(819'200, shares));
    EXPECT_TRUE(shareByErrors(819'200, shares, none));
}

namespace fs = std::filesystem;

const ErrorCurves kCurves = {{"a", {{1024.0, 0.1}, {3000.0, 1e-17}}}, {"b", {{4096.0, 0.0}}}};

TEST(ErrorCurves, RoundTrip) {
    const TemporaryFolder folder;
    EXPECT_TRUE(loadErrorCurves(folder.path())->empty());
    ASSERT_TRUE(saveErrorCurves(folder.path(), kCurves));
    EXPECT_TRUE(*loadErrorCurves(folder.path()) == kCurves);
}

TEST(ErrorCurves, InvalidFilesAreRejected) {
    const auto text = [](const char* curve) {
        return std::string(R"({"format":"relief-curves","version":1,"curves":{"a":)") + curve + "}}";
    };
    EXPECT_TRUE(parseErrorCurves(text("[1024,2,2048,1]")));
    for (const char* curve : {"[]", "[1024]", "[0,2]", "[1024,-2]", "[1024,2,1024,1]", "[1024,2,2048,2]",
                              "[\"1024\",2]", "[1e999,2]", "{}"}) {
        EXPECT_FALSE(parseErrorCurves(text(curve))) << curve;
    }
    for (const char* other : {"{", "[]", R"({"format":"relief-curves","version":2,"curves":{}})",
                              R"({"format":"relief-cache","version":1,"curves":{}})",
                              R"({"format":"relief-curves","version":1,"curves":[]})"}) {
        EXPECT_FALSE(parseErrorCurves(other)) << other;
    }
}

TEST(ErrorCurves, LinksAreNotFollowed) {
    const TemporaryFolder folder;
    const fs::path elsewhere = folder.write("elsewhere.json", errorCurvesText(kCurves));
    fs::create_directory(folder.path() / "w");
    fs::create_symlink(elsewhere, folder.path() / "w" / kErrorCurvesName);
    EXPECT_FALSE(loadErrorCurves(folder.path() / "w"));
    ASSERT_TRUE(saveErrorCurves(folder.path() / "w", {}));
    EXPECT_TRUE(loadErrorCurves(folder.path() / "w")->empty());
    EXPECT_EQ(readFile(elsewhere)->size(), errorCurvesText(kCurves).size());
}

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
    for (const bool missing : {true, false}) {
        const fs::path file = folder_.write(std::string("w/") + kErrorCurvesName, "{}");
        EXPECT_TRUE(!missing || fs::remove(file));
        const WorldBakeResult again = bake("w");
        EXPECT_EQ(sharesOf(again), shares);
        EXPECT_EQ(again.warnings.empty(), missing);
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
