// SPDX-License-Identifier: Apache-2.0
// A level with tiled terrain: compared with its closed form and its mesh, and rebuilt incrementally.
#include "bake/world/world_tiles.h"
#include "bake/world/coarse_collider.h"

#include <algorithm>
#include <random>

#include "tests/bake/world/level_bakes.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kTilesBudget = 800'000;
constexpr std::uint64_t kTileBytes = 205'000;  ///< larger than the share of the box

/// Stripes of 25 units. Their borders match rows of squares if the number of rows is a multiple of eight.
const char* stripeAt(float x) {
    return static_cast<int>(std::floor((x + kHillsHalf) / 25.0F)) % 2 == 0 ? "grass" : "rock";
}

class WorldTiles : public LevelBakes {
  protected:
    void SetUp() override {
        writeLevel(1.0, 60);
        request_.bake.budget = kTilesBudget;
        request_.tile_bytes = kTileBytes;
    }

    /// Hills, and a box beside them.
    /// \param striped  use the two materials of stripeAt()
    void writeLevel(double high, std::uint32_t squares, bool striped = false) const {
        const auto material = [](const Object& object, std::size_t triangle) {
            const glm::uvec3& t = object.mesh.triangles[triangle];
            const std::vector<glm::vec3>& p = object.mesh.positions;
            return std::string(stripeAt((p[t.x].x + p[t.y].x + p[t.z].x) / 3.0F));
        };
        write({{"hills", makeHills(squares)},
               {"box", makeBoxMesh(glm::dvec3(150.0, 0.0, 0.0), glm::dvec3(2.0, high, 3.0))}},
              striped ? std::function(material) : nullptr);
    }
    /// Files that are not hidden.
    [[nodiscard]] Files filesOf(const char* folder) const {
        Files files = LevelBakes::filesOf(folder);
        std::erase_if(files, [](const auto& file) { return file.first.front() == '.'; });
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

    /// The fractions of wrong points within this distance of the hills, and within 5 cm of a seam.
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
                // Boxes of tiles end at seams, except at the border of the hills.
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
};

TEST_F(WorldTiles, HillsKeepPlaceMaterialsAndBudget) {
    writeLevel(1.0, 200, true);
    const WorldBakeResult result = bake("w");
    const WorldField fine = load("w");
    const WorldField coarse = load("w", WorldDetail::kCoarse);
    ASSERT_GE(result.colliders.size(), 4U);
    EXPECT_LE(result.gpuBytes(), kTilesBudget);
    ASSERT_EQ(fine.world().bodies.size(), result.colliders.size());
    std::uint64_t coarse_bytes = 0;
    for (std::size_t i = 0; i < result.colliders.size(); ++i) {
        const WorldColliderResult& tile = result.colliders[i];
        SCOPED_TRACE(tile.file);
        EXPECT_EQ(fine.world().bodies[i].collider, i);
        EXPECT_EQ(fine.world().bodies[i].node, tile.mesh);
        EXPECT_EQ(tile.tile.empty(), tile.mesh == "box");
        EXPECT_EQ(tile.file.find(tile.tile.empty() ? "box-" : "hills-" + tile.tile + "-"), 0U);
        EXPECT_TRUE(tile.tile.empty() || tile.gpu_bytes <= kTileBytes) << tile.gpu_bytes;
        ASSERT_EQ(tile.coarse.has_value(), tile.gpu_bytes > kCoarseFrom);
        coarse_bytes += tile.coarse ? tile.coarse->gpu_bytes : 0;
        const Bounds outer = solidBox(coarse.colliderOf(i));
        const Bounds inner = solidBox(fine.colliderOf(i));
        EXPECT_TRUE(outer.contains(inner.min) && outer.contains(inner.max));
    }
    EXPECT_GT(coarse_bytes, 0U);
    EXPECT_LT(coarse_bytes, result.gpuBytes() / 8);
    // The facets deviate from the formula by up to 3 cm.
    const auto [wrong, at_seams] = wrongAmong(fine, result, 1.0F);
    EXPECT_LT(wrong, 0.02);
    EXPECT_LT(at_seams, 0.02);
    const auto [coarse_wrong, coarse_at_seams] = wrongAmong(coarse, result, 1.0F);
    EXPECT_LT(coarse_wrong, 0.1);
    EXPECT_LT(coarse_at_seams, 1.3 * coarse_wrong + 0.01);
    for (const WorldField* const field : {&fine, &coarse}) {
        std::mt19937 random(12);
        std::uniform_real_distribution<float> along(-kHillsHalf + 1.0F, kHillsHalf - 1.0F);
        int other = 0;
        int asked = 0;
        for (int i = 0; i < 20'000; ++i) {
            const float x = along(random);
            const float z = along(random);
            if (std::abs(x / 25.0F - std::round(x / 25.0F)) * 25.0F < 0.5F) {
                continue;
            }
            // The position at which a drop from above stops.
            const glm::vec3 p(x, hillsAt(x, z) - 0.05F, z);
            const WorldSample sample = field->evaluate(p);
            if (!sample.inside()) {
                continue;  // the surface of coarse tiles is lower here
            }
            const auto body = static_cast<std::size_t>(sample.body);
            const Materials& materials = field->colliderOf(body).materials;
            ++asked;
            other += materials.empty() || materials
                                                  .list[materialAt(materials, field->toObject(body, p),
                                                                   glm::vec3(0.0F, 1.0F, 0.0F))]
                                                  .name != stripeAt(x)
                         ? 1
                         : 0;
        }
        EXPECT_GT(asked, 15'000);
        // A coarse tile also decides beyond its own part of the hills, but has only the materials of that part.
        EXPECT_LE(other, field == &fine ? asked / 100 : asked / 20) << (field == &fine ? "fine" : "coarse");
    }
}

TEST_F(WorldTiles, ChecksAndMovesTreatTilesAsOneMesh) {
    static_cast<void>(bake("w"));
    const WorldField field = load("w");
    const WorldAccuracy accuracy = check(field, 20'000);
    EXPECT_TRUE(accuracy.warnings.empty());
    ASSERT_EQ(accuracy.bodies.size(), 2U);
    EXPECT_LT(accuracy.all.total(), 0.5);
    EXPECT_EQ(accuracy.bodies[0].tiles, field.world().bodies.size() - 1);
    EXPECT_EQ(accuracy.bodies[1].tiles, 1U);
    // If a tile is missing, its part is missing.
    LoadedWorld broken = field.loaded();
    broken.world.bodies.erase(broken.world.bodies.begin() + 2);
    EXPECT_GT(check(WorldField(std::move(broken)), 20'000).bodies[0].wrong.false_outside, 2.0);
    // A moved tile no longer belongs to its node.
    LoadedWorld moved = field.loaded();
    moved.world.bodies[2].position.y += 5.0F;
    EXPECT_EQ(check(WorldField(std::move(moved)), 20'000).warnings.size(), 1U);
    // Moving a node moves all its bodies.
    LoadedWorld hills = field.loaded();
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
    const WorldField shifted(std::move(hills));
    const WorldField torn(std::move(by_first));
    std::mt19937 random(5);
    std::uniform_real_distribution<float> share(-1.0F, 1.0F);
    int changed = 0;
    int torn_apart = 0;
    for (int i = 0; i < 20'000; ++i) {
        glm::vec3 p(share(random) * kHillsHalf, 0.0F, share(random) * kHillsHalf);
        p.y = hillsAt(p.x, p.z) + 4.0F * share(random);
        const bool inside = still.evaluate(p).inside();
        changed += inside != shifted.evaluate(p + shift).inside() ? 1 : 0;
        torn_apart += inside != torn.evaluate(p + shift).inside() ? 1 : 0;
    }
    EXPECT_LE(changed, 5) << "differences are rounding errors";
    EXPECT_GT(torn_apart, 2000);
}

TEST_F(WorldTiles, OnlyChangesAreBakedDeterministically) {
    request_.bake.quality = Quality::kFast;
    request_.bake.no_check = true;
    const std::size_t all = bake("w").colliders.size();
    const Files before = filesOf("w");
    EXPECT_EQ(bake("w").countOf(WorldColliderState::kUpToDate), all);
    EXPECT_TRUE(filesOf("w") == before);
    request_.bake.threads = 1;
    static_cast<void>(bake("one"));
    request_.bake.threads.reset();
    EXPECT_TRUE(filesOf("one") == before);
    // A forged cache only causes a new bake.
    const fs::path cache = folder_.path() / "w" / kBakeCacheName;
    const std::vector<std::byte> bytes = required(readFile(cache));
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const char* tiles : {"", "../0-0-0", "0-0-0,0-0-0"}) {
        std::string made = text;
        for (std::size_t at = 0; (at = made.find("--tiles=", at)) != std::string::npos; at += 8) {
            made.replace(at + 8, made.find('"', at) - at - 8, tiles);
        }
        ASSERT_TRUE(writeFile(cache, std::as_bytes(std::span(made))));
        EXPECT_EQ(bake("w").countOf(WorldColliderState::kBaked), all - 1) << tiles;
        EXPECT_TRUE(filesOf("w") == before);
    }
    // If a tile is missing, its mesh is baked again to the same bytes.
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
    // Another budget gives other tiles, and the old ones are removed.
    request_.bake.budget = kTilesBudget / 2;
    again = bake("w");
    const auto coarse = std::ranges::count_if(
        again.colliders, [](const WorldColliderResult& collider) { return collider.coarse.has_value(); });
    EXPECT_EQ(filesOf("w").size(), again.colliders.size() + static_cast<std::size_t>(coarse) + 1);
}

TEST(MaxTiles, KeepsWorldsWithinTheLimits) {
    EXPECT_EQ(maxTiles(1, 1), 64U);
    EXPECT_EQ(maxTiles(64, 64), 64U);
    EXPECT_EQ(maxTiles(65, 65), 32U);
    EXPECT_EQ(maxTiles(kWorldCollidersMax, kWorldCollidersMax), 1U);
    EXPECT_EQ(maxTiles(2, kWorldBodiesMax), 1U);
    EXPECT_EQ(maxTiles(2, 10'000), 4U);
}

}  // namespace
}  // namespace relief::test
