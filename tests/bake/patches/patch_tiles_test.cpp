// SPDX-License-Identifier: Apache-2.0
// Trees cut into tiles: their union compared with the whole tree and with closed forms, in particular at seams.
#include "bake/patches/patch_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

#include "bake/patches/patch_planner.h"
#include "formats/patch_tree.h"
#include "formats/validate.h"
#include "tests/bake/meshes.h"
#include "tests/bake/threads.h"

namespace relief::test {
namespace {

struct Tree {
    DepthMap whole;
    std::vector<PatchTile> tiles;

    /// Distance in a world of the tiles.
    [[nodiscard]] float distance(const glm::vec3& p) const {
        float least = kFarOutside;
        for (const PatchTile& tile : tiles) {
            least = std::min(least, vote(tile.map, p)->distance);
        }
        return least;
    }
    /// Lower corner in object space.
    [[nodiscard]] glm::vec3 cornerOf(const PatchTile& tile) const {
        glm::vec3 corner;
        for (int i = 0; i < 3; ++i) {
            corner[i] =
                (static_cast<float>(tile.first[i]) - whole.object_to_map.row[i].w) * whole.object_per_map.x;
        }
        return corner;
    }
};

Tree cut(const TriangleMesh& mesh, const PatchOptions& planned, const PatchTileOptions& tiles) {
    PatchTree tree = required(bakePatches(queryOf(mesh), planned));
    Tree made{std::move(tree.map), {}};
    made.tiles = cutIntoTiles(made.whole, tiles);
    for (const PatchTile& tile : made.tiles) {
        EXPECT_TRUE(validateFrame(tile.map) && validateTexels(tile.map));
    }
    return made;
}

/// Points anywhere in the box, and within 5 cm of seams.
std::vector<glm::vec3> pointsOf(const Tree& tree, const Bounds& box, std::size_t count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> share(0.0F, 1.0F);
    std::vector<glm::vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        glm::vec3 p{share(random), share(random), share(random)};  // braces fix the order of the calls
        p = glm::mix(box.min, box.max, p * 1.1F - 0.05F);
        points.push_back(p);
        const glm::vec3 seam = tree.cornerOf(tree.tiles[random() % tree.tiles.size()]);
        const auto axes = static_cast<unsigned>(1 + random() % 7);
        for (int axis = 0; axis < 3; ++axis) {
            if ((axes >> axis & 1U) != 0 && seam[axis] > box.min[axis]) {
                p[axis] = seam[axis] + (i % 4 == 0 ? 0.0F : 0.1F * share(random) - 0.05F);
            }
        }
        points.push_back(p);
    }
    return points;
}

/// Expects the union of the tiles to have the same inside as the whole tree. \return the number of points with equal
/// distances
std::size_t expectSameField(const Tree& tree, const std::vector<glm::vec3>& points) {
    // The whole tree has more roots, so positions among them have another rounding error.
    const float rounding =
        4e-7F * glm::length(glm::vec3(patchTreeSize(tree.whole.texels).roots)) * tree.whole.object_per_map.x;
    std::size_t near = 0;
    std::size_t same = 0;
    for (const glm::vec3& p : points) {
        const float whole = vote(tree.whole, p)->distance;
        const float tiles = tree.distance(p);
        if (std::abs(whole) > rounding) {
            EXPECT_EQ(whole < 0.0F, tiles < 0.0F) << p.x << " " << p.y << " " << p.z << ": " << whole;
        } else {
            ++near;
        }
        // On a face between cells or squares of heights, either side can decide. So neighbouring points are tested too.
        constexpr std::array<float, 4> kSteps = {-1.0F, -0.5F, 0.5F, 1.0F};
        bool is_same = false;
        for (unsigned i = 0; i < 64 && !is_same; ++i) {
            const glm::vec3 beside(kSteps[i % 4], kSteps[i / 4 % 4], kSteps[i / 16]);
            is_same = std::abs(vote(tree.whole, p + rounding * beside)->distance - tiles) <= 4.0F * rounding;
        }
        same += is_same ? 1 : 0;
        EXPECT_TRUE(is_same || tiles == kFarOutside)
            << p.x << " " << p.y << " " << p.z << ": " << whole << " " << tiles;
    }
    EXPECT_LT(near, points.size() / 1000);
    return same;
}

TEST(PatchTiles, OneTileEqualsTheTree) {
    const TriangleMesh plates = joined({makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0, 0.01, 0.7)),
                                        makeIcosphere(glm::dvec3(0.3, 0.9, 0.1), 0.4, 4)});
    for (const PatchOptions& options :
         {PatchOptions{.bytes = 40'000}, PatchOptions{.bytes = kPatchBytesMax, .texel = 0.01}}) {
        const DepthMap whole = bakePatches(queryOf(plates), options)->map;
        EXPECT_TRUE(cutPatches(whole, glm::uvec3(0), patchTreeSize(whole.texels).roots) == whole);
    }
}

TEST(PatchTiles, HillsMatchTheWholeTreeAtSeams) {
    const TriangleMesh mesh = makeHills(200);
    const Tree tree = cut(mesh, {.bytes = 400'000}, {.bytes = 60'000});
    ASSERT_GE(tree.tiles.size(), 8U);
    for (const PatchTile& tile : tree.tiles) {
        EXPECT_LE(tile.map.texels.size(), 60'000U);
        EXPECT_EQ(tile.place.y, 0U) << "flat ground is cut only along its long sides";
    }
    const std::vector<glm::vec3> points = pointsOf(tree, mesh.bounds, 50'000);
    EXPECT_GT(expectSameField(tree, points), points.size() * 9 / 10);
    // Compare with the closed form, which the tree itself approximates.
    int wrong = 0;
    for (const glm::vec3& p : points) {
        const bool within = std::max(std::abs(p.x), std::abs(p.z)) < kHillsHalf && p.y > -20.0F;
        wrong += (within && p.y < hillsAt(p.x, p.z)) != (tree.distance(p) < 0.0F) ? 1 : 0;
    }
    EXPECT_LT(wrong, 500);
}

TEST(PatchTiles, SphereInEightTilesMatchesTheClosedForm) {
    const TriangleMesh mesh = makeIcosphere(glm::dvec3(3.0, -2.0, 1.0), 50.0, 6);
    for (const PatchOptions& options :
         {PatchOptions{.bytes = 200'000},
          PatchOptions{.bytes = kPatchBytesMax, .texel = 0.02, .tile_bytes = 40'000}}) {
        const Tree tree = cut(mesh, options, {.bytes = 60'000});
        ASSERT_GE(tree.tiles.size(), 8U) << tree.whole.texels.size();
        const std::vector<glm::vec3> points = pointsOf(tree, mesh.bounds, 50'000);
        expectSameField(tree, points);
        std::array<int, 2> wrong{};
        for (std::size_t i = 0; i < points.size(); ++i) {
            const bool truth = glm::length(points[i] - glm::vec3(3.0F, -2.0F, 1.0F)) < 50.0F;
            wrong[i % 2] += truth != (tree.distance(points[i]) < 0.0F) ? 1 : 0;
        }
        EXPECT_LT(wrong[0], 250);
        EXPECT_LT(wrong[1], 250) << "near seams";
    }
    // Among 4³ tiles, the inner 8 have no surface, but must be kept.
    const Tree tree = cut(mesh, {.bytes = 1'000'000}, {.bytes = 20'000});
    EXPECT_TRUE(std::ranges::any_of(tree.tiles, [](const PatchTile& tile) {
        const glm::uvec3 roots = patchTreeSize(tile.map.texels).roots;
        for (std::uint32_t i = 1; i <= roots.x * roots.y * roots.z; ++i) {
            if (patchTexel(tile.map.texels, i).kind() != PatchRecord::Kind::kInside) {
                return false;
            }
        }
        return true;
    }));
    expectSameField(tree, pointsOf(tree, mesh.bounds, 20'000));
}

TEST(PatchTiles, KeepTheirLimits) {
    const DepthMap whole = bakePatches(queryOf(makeHills(60)), {.bytes = 200'000})->map;
    EXPECT_EQ(cutIntoTiles(whole, {.bytes = 200'000}).size(), 1U);
    EXPECT_EQ(cutIntoTiles(whole, {.bytes = 20'000, .most = 4}).size(), 4U);
    // Additional roots of tiles also use bytes.
    EXPECT_EQ(cutIntoTiles(whole, {.bytes = 20'000, .total = whole.texels.size()}).size(), 1U);
    std::uint64_t total = 0;
    const std::vector<PatchTile> some = cutIntoTiles(whole, {.bytes = 20'000, .total = 225'000});
    for (const PatchTile& tile : some) {
        total += tile.map.texels.size();
    }
    EXPECT_GT(some.size(), 1U);
    EXPECT_LE(total, 225'000U);
}

TEST(PatchTiles, TexelModeHasSmallRoots) {
    const TriangleMesh mesh = makeHills(60);
    const PatchOptions plain{.bytes = kPatchBytesMax, .texel = 0.5};
    PatchOptions small = plain;
    small.tile_bytes = 50'000;
    const auto bake = [&](const PatchOptions& options) { return bakePatches(queryOf(mesh), options)->map; };
    const DepthMap one = bake(plain);
    const DepthMap other = bake(small);
    const auto roots = [](const DepthMap& map) {
        const glm::uvec3 n = patchTreeSize(map.texels).roots;
        return n.x * n.y * n.z;
    };
    EXPECT_LE(roots(one), 64U);
    EXPECT_GE(roots(other), 256U);
    EXPECT_LT(static_cast<double>(other.texels.size()), 1.1 * static_cast<double>(one.texels.size()));
    EXPECT_TRUE(onThreads(1, [&] { return bake(small); }) == other)
        << "the number of threads changes the tree";
    // The budget also holds with small roots.
    small.bytes = one.texels.size() / 2;
    small.coarsen = true;
    EXPECT_LE(bake(small).texels.size(), small.bytes);
}

}  // namespace
}  // namespace relief::test
