// How the bytes of a level are shared, in whole bakes of it.
#include "bake/world/budget_share.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <map>
#include <sstream>

#include "bake/world/mistake_curves.h"
#include "bake/world/world_bake.h"
#include "formats/base/file_io.h"
#include "formats/base/portable_math.h"
#include "tests/bake/meshes.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kBudget = 160'000;

/// A ball with bumps, as large in area as a box of 4 × 4 × 0.5: 40 square units.
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

class LevelShares : public testing::Test {
  protected:
    void SetUp() override { writeLevel(0.2); }

    void writeLevel(double bumps) const {
        std::ostringstream text;
        std::size_t before = 1;
        const auto add = [&](const std::string& name, const TriangleMesh& mesh, float x) {
            text << "o " << name << "\n";
            for (const glm::vec3& p : mesh.positions) {
                text << "v " << p.x + x << " " << p.y << " " << p.z << "\n";
            }
            for (const glm::uvec3& t : mesh.triangles) {
                text << "f " << before + t.x << " " << before + t.y << " " << before + t.z << "\n";
            }
            before += mesh.positions.size();
        };
        add("box", makeBoxMesh(glm::dvec3(0.0), glm::dvec3(2.0, 2.0, 0.25)), 0.0F);
        add("ball", makeBumpyBall(bumps), 10.0F);
        add("torus", makeTorusMesh(1.0, 0.35, 48, 32), 20.0F);
        add("rock", makeBumpyBall(0.1), 30.0F);
        folder_.write("level.obj", text.str());
    }

    WorldBakeResult bake(const char* into, std::optional<unsigned> threads = {}) const {
        WorldRequest request;
        request.bake.budget = kBudget;
        request.bake.threads = threads;
        request.bake.mesh = (folder_.path() / "level.obj").string();
        request.folder = folder_.path() / into;
        fs::create_directories(request.folder);
        Result<WorldBakeResult> result = bakeWorld(request);
        EXPECT_TRUE(result) << result.error().message;
        return std::move(*result);
    }
    static std::map<std::string, std::uint64_t> sharesOf(const WorldBakeResult& result) {
        std::map<std::string, std::uint64_t> shares;
        for (const WorldColliderResult& collider : result.colliders) {
            shares[collider.mesh] = *collider.budget;
        }
        return shares;
    }
    /// All, curves too.
    std::map<std::string, std::vector<std::byte>> filesOf(const char* folder) const {
        std::map<std::string, std::vector<std::byte>> files;
        for (const auto& entry : fs::directory_iterator(folder_.path() / folder)) {
            files[entry.path().filename().string()] = *readFile(entry.path());
        }
        return files;
    }

    TemporaryFolder folder_;
};

TEST_F(LevelShares, ABumpyBallGetsMoreThanABoxOfItsArea) {
    const WorldBakeResult result = bake("w");
    std::map<std::string, std::uint64_t> shares = sharesOf(result);
    EXPECT_GT(shares["ball"], 2 * shares["box"]);
    EXPECT_GT(shares["ball"], shares["rock"]) << "which has lower bumps";
    EXPECT_GT(shares["ball"] + shares["torus"] + shares["rock"], kBudget * 3 / 4) << "what the box leaves";
    EXPECT_LE(result.gpuBytes(), kBudget);
    std::uint64_t sum = 0;
    for (const auto& [mesh, bytes] : shares) {
        sum += bytes;
    }
    EXPECT_LE(sum, kBudget);
}

TEST_F(LevelShares, ThreadsChangeNoByte) {
    static_cast<void>(bake("w"));
    static_cast<void>(bake("one", 1));
    EXPECT_TRUE(filesOf("w") == filesOf("one"));
}

TEST_F(LevelShares, ASecondRunPlansAndBakesNothing) {
    std::map<std::string, std::uint64_t> shares = sharesOf(bake("w"));
    const auto files = filesOf("w");
    EXPECT_EQ(bake("w").countOf(WorldColliderState::kUpToDate), 4U);
    EXPECT_TRUE(filesOf("w") == files);
    // It shares by the curves that are there: with all of them alike, evenly but for the meshes' areas.
    Result<MistakeCurves> curves = loadMistakeCurves(folder_.path() / "w");
    ASSERT_TRUE(curves);
    EXPECT_GE(curves->size(), 4U);
    for (auto& [key, curve] : *curves) {
        curve = {{1000.0, 1.0}, {2000.0, 0.6}};
    }
    ASSERT_TRUE(saveMistakeCurves(folder_.path() / "w", *curves));
    std::map<std::string, std::uint64_t> alike = sharesOf(bake("w"));
    EXPECT_EQ(alike["box"], alike["ball"]);
    // Without them, or with others than curves, they are planned again, to the same bytes.
    for (const char* text : {"", "{}"}) {
        if (*text == '\0') {
            fs::remove(folder_.path() / "w" / kMistakeCurvesName);
        } else {
            folder_.write(std::string("w/") + kMistakeCurvesName, text);
        }
        const WorldBakeResult again = bake("w");
        EXPECT_EQ(sharesOf(again), shares);
        EXPECT_EQ(again.warnings.empty(), *text == '\0');
        EXPECT_TRUE(filesOf("w")[kMistakeCurvesName] == files.at(kMistakeCurvesName));
    }
}

TEST_F(LevelShares, AMeshThatChangesIsBakedAndFewOthers) {
    static_cast<void>(bake("w"));
    writeLevel(0.203);
    const WorldBakeResult result = bake("w");
    EXPECT_LE(result.countOf(WorldColliderState::kBaked), 2U);
    for (const WorldColliderResult& collider : result.colliders) {
        EXPECT_TRUE(collider.mesh != "ball" || collider.state == WorldColliderState::kBaked);
    }
}

}  // namespace
}  // namespace relief::test
