// SPDX-License-Identifier: Apache-2.0
// Trees cut into tiles: their union compared with the whole tree and with closed forms, in particular at seams.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <utility>
#include <vector>

#include "bake/patches/depth_planes.h"
#include "bake/patches/patch_planner.h"
#include "bake/patches/patch_tiles.h"
#include "formats/patch_tree.h"
#include "formats/validate.h"
#include "tests/bake/meshes.h"
#include "tests/bake/threads.h"
#include "tests/seeds.h"

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

// Inside a thick plate the nearer face decides and has an exact normal, for every rotation of the plate.

/// A plate of 10 by 1 by 10, rotated and baked into this many bytes.
struct Plate {
    static constexpr double kHalf = 5.0;
    static constexpr double kBesideEdges = 0.8;

    Plate(double degrees, std::uint64_t bytes) : Plate(turnBy(degrees), bytes) {}
    Plate(const glm::dquat& rotation, std::uint64_t bytes)
        : Plate(rotation, bytes, boxFromTo(-kHalf, kHalf, rotation)) {}
    /// \param mesh  another mesh of the same solid
    Plate(const glm::dquat& rotation, std::uint64_t bytes, PreparedMesh mesh)
        : turn(rotation), map(bakePatches(queryOf(std::move(mesh)), {.bytes = bytes})->map) {
        EXPECT_TRUE(validateFrame(map) && validateTexels(map));
        EXPECT_LE(map.texels.size(), bytes);
    }

    static glm::dquat turnBy(double degrees, const glm::dvec3& axis = {0.0, 0.0, 1.0}) {
        return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
    }
    /// The part of the plate between these x coordinates.
    static TriangleMesh boxFromTo(double low, double high, const glm::dquat& turn) {
        return makeBoxMesh(turn * glm::dvec3(0.5 * (low + high), 0.0, 0.0), {0.5 * (high - low), 0.5, kHalf},
                           glm::mat3_cast(turn));
    }

    struct Point {
        glm::vec3 position;
        double depth;
        glm::dvec3 normal;
    };
    /// A point at a depth of `least` to `most` below the top or the bottom.
    template <class Random>
    [[nodiscard]] Point pointAt(Random& random, double least, double most,
                                double beside_edges = kBesideEdges) const {
        const auto uniform = [&](double low, double high) {
            return low + (high - low) * (static_cast<double>(random()) * std::ldexp(1.0, -32));
        };
        const double up = random() % 2 == 0 ? 1.0 : -1.0;
        const double depth = uniform(least, most);
        const double x = uniform(beside_edges - kHalf, kHalf - beside_edges);
        const double z = uniform(beside_edges - kHalf, kHalf - beside_edges);
        return {glm::vec3(turn * glm::dvec3(x, up * (0.5 - depth), z)), depth,
                turn * glm::dvec3(0.0, up, 0.0)};
    }

    glm::dquat turn;
    DepthMap map;
};

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
}

/// \param beside  minimum distance from the plate's plane x = 0
void expectNearerFace(const Plate& plate, double beside = 0.0, double beside_edges = Plate::kBesideEdges) {
    std::mt19937 random(7);
    double turned = 0.0;
    double off = 0.0;
    for (int i = 0; i < 5000; ++i) {
        const Plate::Point point = plate.pointAt(random, 0.005, 0.45, beside_edges);
        const Vote found = vote(plate.map, point.position).value();
        ASSERT_LT(found.distance, 0.0F);
        if (std::abs((glm::conjugate(plate.turn) * glm::dvec3(point.position)).x) < beside) {
            continue;
        }
        turned = std::max(turned, degreesBetween(found.normal, point.normal));
        off = std::max(off, std::abs(double{found.distance} + point.depth));
    }
    EXPECT_LT(turned, 1.0);
    EXPECT_LT(off, 0.01);
}

void expectSideAndNormalBesideFaces(const Plate& plate) {
    std::mt19937 random(9);
    double turned = 0.0;
    int wrong = 0;
    for (int i = 0; i < 5000; ++i) {
        const Plate::Point point = plate.pointAt(random, -0.05, 0.05);
        const Vote found = vote(plate.map, point.position).value();
        wrong += std::abs(point.depth) > 1e-3 && (found.distance < 0.0F) != (point.depth > 0.0) ? 1 : 0;
        if (found.distance < kFarOutside) {  // otherwise outside the volume of the map
            turned = std::max(turned, degreesBetween(found.normal, point.normal));
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_LT(turned, 1.0);
}

class PlateTest : public testing::TestWithParam<int> {};

TEST_P(PlateTest, NearerFaceDecides) {
    for (const std::uint64_t bytes : {64'000U, 256'000U}) {
        SCOPED_TRACE(bytes);
        expectNearerFace(Plate(GetParam(), bytes));
    }
}

TEST_P(PlateTest, PointsBesideAFaceHaveItsSideAndNormal) {
    expectSideAndNormalBesideFaces(Plate(GetParam(), 512'000));
}

INSTANTIATE_TEST_SUITE_P(Degrees, PlateTest, testing::Values(0, 20, 35, 50, 60));

// A former bug: the lines of a cell missed a corner that one face cuts off. Then the other face decided in the whole cell.
TEST(DepthPlanes, FacesBetweenTheLinesOfACellArePreserved) {
    for (const auto& [degrees, bytes] :
         {std::pair(42.0, 64'000U), std::pair(47.0, 72'000U), std::pair(48.0, 128'000U)}) {
        SCOPED_TRACE(degrees);
        const Plate plate(degrees, bytes);
        expectNearerFace(plate);
        expectSideAndNormalBesideFaces(plate);
    }
}

// A former bug: the heights of a face several cells away were out of range if it was tilted relative to all axes.
TEST(DepthPlanes, FacesFarFromACellAreStored) {
    const Plate plate(Plate::turnBy(60.0, {1.0, 2.0, 3.0}), 128'000);
    std::mt19937 random(7);
    int opposite = 0;
    for (int i = 0; i < 5000; ++i) {
        const Plate::Point point = plate.pointAt(random, 0.005, 0.45);
        opposite += glm::dot(glm::dvec3(vote(plate.map, point.position)->normal), point.normal) < 0.0 ? 1 : 0;
    }
    EXPECT_LE(opposite, 2);
}

TEST(DepthPlanes, NearerFaceDecidesForAnyTurn) {
    std::mt19937 random(seedFrom(28));
    const double degrees = 90.0 * std::ldexp(static_cast<double>(random()), -32);
    SCOPED_TRACE(degrees);
    // Leaves store two planes, so a root that also contains the end of the plate may omit a face.
    constexpr double kRoot = 1.4;
    expectNearerFace(Plate(degrees, 64'000), 0.0, kRoot);
}

// A former bug: octants beside a face had the coarse normal of their split parent cell, with errors up to 1.6 degrees.
TEST(DepthPlanes, FlatFacesHaveExactNormalsOnBothSides) {
    const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, 3.0)));
    const glm::dvec3 half(5.0, 1.5, 5.0);
    const MeshQuery query = queryOf(makeBoxMesh(glm::dvec3(0.0), half, glm::mat3_cast(turn)));
    const DepthMap map = bakePatches(query, {.bytes = 512'000})->map;
    std::mt19937 random(9);
    const auto uniform = [&](double most) {
        return most * (std::ldexp(static_cast<double>(random()), -31) - 1.0);
    };
    double turned = 0.0;
    for (int i = 0; i < 5000; ++i) {
        const int axis = i % 3;
        glm::dvec3 normal(0.0);
        normal[axis] = random() % 2 == 0 ? 1.0 : -1.0;
        glm::dvec3 point = glm::dvec3(uniform(half.x - 0.8), uniform(half.y - 0.8), uniform(half.z - 0.8));
        point[axis] = normal[axis] * (half[axis] + uniform(0.05));
        const Vote found = vote(map, glm::vec3(turn * point)).value();
        turned = std::max(turned, degreesBetween(found.normal, turn * normal));
    }
    EXPECT_LT(turned, 1.0);
}

TEST(DepthPlanes, LargeBudgetsAreExact) {
    expectNearerFace(Plate(30.0, 1'000'000));
}

TEST(DepthPlanes, WindingDoesNotMatter) {
    const glm::dquat turn = Plate::turnBy(30.0);
    const TriangleMesh mesh = reversed(Plate::boxFromTo(-Plate::kHalf, Plate::kHalf, turn), 3);
    expectNearerFace(Plate(turn, 128'000, finished(mesh.positions, mesh.triangles)));
}

// The ends of two overlapping boxes are inside the plate that they form, and are not part of its surface. Near them all
// samples of a cell are dropped, so the cell has no depth planes.
TEST(DepthPlanes, FacesInsideOtherSolidsAreIgnored) {
    const glm::dquat turn = Plate::turnBy(30.0);
    const TriangleMesh two =
        joined({Plate::boxFromTo(-Plate::kHalf, 0.5, turn), Plate::boxFromTo(-0.5, Plate::kHalf, turn)});
    const std::vector<std::uint32_t> by_winding(two.triangles.size(), 0);
    expectNearerFace(Plate(turn, 128'000, PreparedMesh::unionOf(two, by_winding)), 1.0);
}

TEST(MeanPlane, EmptySetGivesTheMiddle) {
    const CellPlane plane = meanPlane(std::vector<ClippedTriangle>(2));
    EXPECT_EQ(plane.offset, 0.0);
    EXPECT_EQ(glm::length(plane.normal), 1.0);
}

}  // namespace
}  // namespace relief::test
