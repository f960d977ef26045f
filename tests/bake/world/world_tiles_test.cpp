// A level whose terrain is cut into tiles: against its closed form and its mesh, and what is baked again.
#include "bake/world/world_tiles.h"
#include "bake/world/coarse_collider.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <sstream>

#include "bake/recipe/recipe_jobs.h"
#include "bake/world/world_bake.h"
#include "bake/world/world_check.h"
#include "formats/base/file_io.h"
#include "tests/bake/meshes.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kBudget = 800'000;
constexpr std::uint64_t kTileBytes = 205'000;  ///< more than the share of the box

/// Stripes of 25 units, which rows of squares keep to where there are eight of them, or a multiple.
const char* stripeAt(float x) {
    return static_cast<int>(std::floor((x + kHillsHalf) / 25.0F)) % 2 == 0 ? "grass" : "rock";
}

using Files = std::map<std::string, std::vector<std::byte>>;

class WorldTiles : public testing::Test {
  protected:
    void SetUp() override { writeLevel(1.0, 60); }

    /// Hills, and a box beside them.
    /// \param striped  of two materials, by stripeAt().
    void writeLevel(double high, std::uint32_t squares, bool striped = false) const {
        std::ostringstream text;
        std::size_t before = 1;
        const auto add = [&](const char* name, const TriangleMesh& mesh) {
            text << "o " << name << "\n";
            for (const glm::vec3& p : mesh.positions) {
                text << "v " << p.x << " " << p.y << " " << p.z << "\n";
            }
            for (const glm::uvec3& t : mesh.triangles) {
                if (striped) {
                    const float x =
                        (mesh.positions[t.x].x + mesh.positions[t.y].x + mesh.positions[t.z].x) / 3.0F;
                    text << "usemtl " << stripeAt(x) << "\n";
                }
                text << "f " << before + t.x << " " << before + t.y << " " << before + t.z << "\n";
            }
            before += mesh.positions.size();
        };
        add("hills", makeHills(squares));
        add("box", makeBoxMesh(glm::dvec3(150.0, 0.0, 0.0), glm::dvec3(2.0, high, 3.0)));
        folder_.write("level.obj", text.str());
    }

    WorldBakeResult bake(const char* into, std::uint64_t budget = kBudget,
                         std::optional<unsigned> threads = {}) const {
        WorldRequest request;
        request.bake.budget = budget;
        request.bake.threads = threads;
        request.bake.mesh = (folder_.path() / "level.obj").string();
        request.folder = folder_.path() / into;
        request.tile_bytes = kTileBytes;
        fs::create_directories(request.folder);
        Result<WorldBakeResult> result = bakeWorld(request);
        EXPECT_TRUE(result) << result.error().message;
        EXPECT_TRUE(result->written);
        return std::move(*result);
    }
    [[nodiscard]] WorldField load(const char* from, WorldDetail detail = WorldDetail::kFine) const {
        Result<LoadedWorld> loaded = loadWorld(folder_.path() / from / kWorldFileName, {}, detail);
        EXPECT_TRUE(loaded) << loaded.error().message;
        return WorldField(std::move(*loaded));
    }
    [[nodiscard]] Result<WorldAccuracy> check(const WorldField& field) const {
        WorldCheckRequest request;
        request.check.mesh = (folder_.path() / "level.obj").string();
        request.check.samples = 20'000;
        return checkWorld(request, field);
    }
    [[nodiscard]] Files filesOf(const char* folder) const {
        Files files;
        for (const auto& entry : fs::directory_iterator(folder_.path() / folder)) {
            const std::string name = entry.path().filename().string();
            if (name.front() != '.') {
                files[name] = *readFile(entry.path());
            }
        }
        return files;
    }
    static std::vector<std::string> namesOf(const WorldBakeResult& result, WorldColliderState state) {
        std::vector<std::string> names;
        for (const WorldColliderResult& collider : result.colliders) {
            if (collider.state == state) {
                names.push_back(collider.mesh);
            }
        }
        return names;
    }

    /// The shares of points on the wrong side, of those anywhere within so far of the hills, and of those within 5 cm of a seam.
    static std::pair<double, double> wrongAmong(const WorldField& field, const WorldBakeResult& result,
                                                float within) {
        std::mt19937 random(11);
        std::uniform_real_distribution<float> share(0.0F, 1.0F);
        std::array<int, 2> wrong{};
        constexpr int kPoints = 50'000;
        for (int i = 0; i < kPoints; ++i) {
            glm::vec3 p((2.0F * share(random) - 1.0F) * kHillsHalf, 0.0F,
                        (2.0F * share(random) - 1.0F) * kHillsHalf);
            if (i % 2 == 1) {
                // Tiles' boxes end in their seams, but where the hills end.
                const Bounds& tile = result.colliders[random() % (result.colliders.size() - 1)].box;
                const int axis = i % 4 == 1 ? 0 : 2;
                const float seam = tile.min[axis] > 0.1F - kHillsHalf ? tile.min[axis] : tile.max[axis];
                p[axis] = seam + 0.1F * share(random) - 0.05F;
            }
            p.y = hillsAt(p.x, p.z) + within * (2.0F * share(random) - 1.0F);
            const bool on_hills = std::max(std::abs(p.x), std::abs(p.z)) < kHillsHalf;
            wrong[i % 2] += (on_hills && p.y < hillsAt(p.x, p.z)) != field.evaluate(p).inside() ? 1 : 0;
        }
        return {2.0 * wrong[0] / kPoints, 2.0 * wrong[1] / kPoints};
    }

    TemporaryFolder folder_;
};

TEST_F(WorldTiles, HillsAreInTheirPlaceAndWithinTheirBytes) {
    writeLevel(1.0, 200);
    const WorldBakeResult result = bake("w");
    const WorldField field = load("w");
    ASSERT_GE(result.colliders.size(), 4U);
    EXPECT_LE(result.gpuBytes(), kBudget);
    ASSERT_EQ(field.world().bodies.size(), result.colliders.size());
    for (std::size_t i = 0; i < result.colliders.size(); ++i) {
        const WorldColliderResult& tile = result.colliders[i];
        EXPECT_EQ(field.world().bodies[i].collider, i);
        EXPECT_EQ(field.world().bodies[i].node, tile.mesh);
        EXPECT_EQ(tile.tile.empty(), tile.mesh == "box");
        EXPECT_EQ(tile.file.find(tile.tile.empty() ? "box-" : "hills-" + tile.tile + "-"), 0U) << tile.file;
        EXPECT_TRUE(tile.tile.empty() || tile.gpu_bytes <= kTileBytes) << tile.gpu_bytes;
    }
    const auto [wrong, at_seams] = wrongAmong(field, result, 1.0F);
    // The mesh's facets are up to 3 cm off the formula.
    EXPECT_LT(wrong, 0.02);
    EXPECT_LT(at_seams, 0.02);
}

TEST_F(WorldTiles, CoarseOnesAreTheWholeToo) {
    writeLevel(1.0, 200);
    const WorldBakeResult result = bake("w");
    const WorldField field = load("w");
    const WorldField coarse = load("w", WorldDetail::kCoarse);
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < result.colliders.size(); ++i) {
        const WorldColliderResult& tile = result.colliders[i];
        ASSERT_EQ(tile.coarse.has_value(), tile.gpu_bytes > kCoarseFrom) << tile.file;
        bytes += tile.coarse ? tile.coarse->gpu_bytes : 0;
        const Bounds outer = solidBox(coarse.colliderOf(i));
        const Bounds inner = solidBox(field.colliderOf(i));
        EXPECT_TRUE(glm::all(glm::lessThanEqual(outer.min, inner.min)) &&
                    glm::all(glm::greaterThanEqual(outer.max, inner.max)))
            << tile.file;
    }
    EXPECT_GT(bytes, 0U);
    EXPECT_LT(bytes, result.gpuBytes() / 8);
    const auto [wrong, at_seams] = wrongAmong(coarse, result, 1.0F);
    EXPECT_LT(wrong, 0.1);
    EXPECT_LT(at_seams, 1.3 * wrong + 0.01);
}

TEST_F(WorldTiles, MaterialsGoOnFromTileToTile) {
    writeLevel(1.0, 200, true);
    const WorldBakeResult result = bake("w");
    ASSERT_GE(result.colliders.size(), 4U);
    for (const WorldDetail detail : {WorldDetail::kFine, WorldDetail::kCoarse}) {
        const WorldField field = load("w", detail);
        std::mt19937 random(12);
        std::uniform_real_distribution<float> along(-kHillsHalf + 1.0F, kHillsHalf - 1.0F);
        int wrong = 0;
        int asked = 0;
        for (int i = 0; i < 20'000; ++i) {
            const float x = along(random);
            const float z = along(random);
            if (std::abs(x / 25.0F - std::round(x / 25.0F)) * 25.0F < 0.5F) {
                continue;
            }
            // The place in which a drop from above stops.
            const glm::vec3 p(x, hillsAt(x, z) - 0.05F, z);
            const WorldSample sample = field.evaluate(p);
            if (!sample.inside()) {
                continue;  // the coarse ones have their surface below
            }
            const auto body = static_cast<std::size_t>(sample.body);
            const Materials& materials = field.colliderOf(body).materials;
            ++asked;
            wrong += materials.empty() || materials
                                                  .list[materialAt(materials, field.toObject(body, p),
                                                                   glm::vec3(0.0F, 1.0F, 0.0F))]
                                                  .name != stripeAt(x)
                         ? 1
                         : 0;
        }
        EXPECT_GT(asked, 15'000);
        // A coarse tile decides beyond its own part of the hills, too, whose materials alone it has.
        const bool fine = detail == WorldDetail::kFine;
        EXPECT_LE(wrong, fine ? asked / 100 : asked / 20) << (fine ? "fine" : "coarse");
    }
}

TEST_F(WorldTiles, ACheckTakesTilesForOneMesh) {
    static_cast<void>(bake("w"));
    const WorldField field = load("w");
    const Result<WorldAccuracy> accuracy = check(field);
    ASSERT_TRUE(accuracy) << accuracy.error().message;
    EXPECT_TRUE(accuracy->warnings.empty());
    ASSERT_EQ(accuracy->bodies.size(), 2U);
    EXPECT_LT(accuracy->all.total(), 0.5);
    EXPECT_EQ(accuracy->bodies[0].tiles, field.world().bodies.size() - 1);
    EXPECT_EQ(accuracy->bodies[1].tiles, 1U);
    // Without one of the tiles, what was in it is missing.
    LoadedWorld broken = field.loaded();
    broken.world.bodies.erase(broken.world.bodies.begin() + 2);
    const Result<WorldAccuracy> less = check(WorldField(std::move(broken)));
    ASSERT_TRUE(less) << less.error().message;
    EXPECT_GT(less->bodies[0].wrong.false_outside, 2.0);
    // And a tile elsewhere is no part of its node any more.
    LoadedWorld moved = field.loaded();
    moved.world.bodies[2].position.y += 5.0F;
    const Result<WorldAccuracy> other = check(WorldField(std::move(moved)));
    ASSERT_TRUE(other) << other.error().message;
    EXPECT_EQ(other->warnings.size(), 1U);
}

TEST_F(WorldTiles, ANodeMovesByAllItsBodies) {
    static_cast<void>(bake("w"));
    LoadedWorld hills = load("w").loaded();
    ASSERT_EQ(findBodies(hills.world, "box").size(), 1U);
    hills.world.bodies.erase(hills.world.bodies.begin() +
                             static_cast<std::ptrdiff_t>(findBodies(hills.world, "box").front()));
    const WorldField still(hills);
    const std::vector<std::size_t> bodies = findBodies(hills.world, "hills");
    ASSERT_GE(bodies.size(), 4U);
    const glm::vec3 shift(16.0F, 32.0F, -8.0F);
    LoadedWorld by_first = hills;
    by_first.world.bodies[bodies.front()].position += shift;
    for (const std::size_t body : bodies) {
        hills.world.bodies[body].position += shift;
    }
    const WorldField moved(std::move(hills));
    const WorldField torn(std::move(by_first));
    std::mt19937 random(5);
    std::uniform_real_distribution<float> share(-1.0F, 1.0F);
    int other = 0;
    int torn_apart = 0;
    for (int i = 0; i < 20'000; ++i) {
        glm::vec3 p(share(random) * kHillsHalf, 0.0F, share(random) * kHillsHalf);
        p.y = hillsAt(p.x, p.z) + 4.0F * share(random);
        const bool inside = still.evaluate(p).inside();
        other += inside != moved.evaluate(p + shift).inside() ? 1 : 0;
        torn_apart += inside != torn.evaluate(p + shift).inside() ? 1 : 0;
    }
    EXPECT_LE(other, 5) << "sums of floats are rounded";
    EXPECT_GT(torn_apart, 2000);
}

TEST_F(WorldTiles, ThreadsChangeNoByte) {
    static_cast<void>(bake("w"));
    static_cast<void>(bake("one", kBudget, 1));
    EXPECT_TRUE(filesOf("w") == filesOf("one"));
}

TEST_F(WorldTiles, OnlyWhatHasChangedIsBaked) {
    const std::size_t all = bake("w").colliders.size();
    const Files before = filesOf("w");
    EXPECT_EQ(bake("w").countOf(WorldColliderState::kUpToDate), all);
    EXPECT_TRUE(filesOf("w") == before);
    // Without one of its tiles, a mesh is baked again, to the same bytes.
    const auto tile = std::find_if(before.begin(), before.end(),
                                   [](const auto& file) { return file.first.starts_with("hills-1-"); });
    ASSERT_NE(tile, before.end());
    fs::remove(folder_.path() / "w" / tile->first);
    WorldBakeResult again = bake("w");
    EXPECT_EQ(namesOf(again, WorldColliderState::kUpToDate), std::vector<std::string>{"box"});
    EXPECT_TRUE(filesOf("w") == before);
    writeLevel(1.5, 60);
    again = bake("w");
    EXPECT_EQ(namesOf(again, WorldColliderState::kBaked), std::vector<std::string>{"box"});
    EXPECT_EQ(again.removed.size(), 1U);
    // Of another budget there are other tiles, and those from before go.
    again = bake("w", kBudget / 2);
    const auto coarse = std::ranges::count_if(
        again.colliders, [](const WorldColliderResult& collider) { return collider.coarse.has_value(); });
    EXPECT_EQ(filesOf("w").size(), again.colliders.size() + static_cast<std::size_t>(coarse) + 1);
}

TEST_F(WorldTiles, ACacheThatIsMadeUpCostsABake) {
    const std::size_t all = bake("w").colliders.size();
    const Files before = filesOf("w");
    const fs::path cache = folder_.path() / "w" / kBakeCacheName;
    ASSERT_TRUE(fs::exists(cache));
    const auto bytes = readFile(cache);
    std::string text(bytes->size(), ' ');
    std::transform(bytes->begin(), bytes->end(), text.begin(),
                   [](std::byte b) { return static_cast<char>(b); });
    for (const char* tiles : {"", "../0-0-0", "0-0-0,0-0-0"}) {
        std::string made = text;
        for (std::size_t at = 0; (at = made.find("--tiles=", at)) != std::string::npos; at += 8) {
            made.replace(at + 8, made.find('"', at) - at - 8, tiles);
        }
        ASSERT_TRUE(writeFile(cache, std::as_bytes(std::span(made))));
        EXPECT_EQ(bake("w").countOf(WorldColliderState::kBaked), all - 1) << tiles;
        EXPECT_TRUE(filesOf("w") == before);
    }
}

TEST(TilesMost, KeepsAWorldWithinItsLimits) {
    EXPECT_EQ(tilesMost(1, 1), 64U);
    EXPECT_EQ(tilesMost(64, 64), 64U);
    EXPECT_EQ(tilesMost(65, 65), 32U);
    EXPECT_EQ(tilesMost(kWorldCollidersMax, kWorldCollidersMax), 1U);
    EXPECT_EQ(tilesMost(2, kWorldBodiesMax), 1U);
    EXPECT_EQ(tilesMost(2, 10'000), 4U);
}

}  // namespace
}  // namespace relief::test
