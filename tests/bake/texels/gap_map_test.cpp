// SPDX-License-Identifier: Apache-2.0
// Maps of gaps: shapes whose gaps have a closed form, and the promises of gap_map.h.
#include "bake/texels/gap_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/measure/sight.h"
#include "bake/pipeline/budget_search.h"
#include "bake/plan/gap_grid.h"
#include "formats/validate.h"
#include "tests/bake/meshes.h"
#include "tests/bake/points.h"

namespace relief::test {
namespace {

/// A ball in the middle of a hollow one: no ray from outside gets into the gap.
constexpr double kOuter = 1.0;
constexpr double kHollow = 0.9;
constexpr double kBall = 0.5;
TriangleMesh ballInABall() {
    return joined({makeIcosphere({0, 0, 0}, kOuter, 4), reversed(makeIcosphere({0, 0, 0}, kHollow, 4)),
                   makeIcosphere({0, 0, 0}, kBall, 4)});
}

/// Four plates across z, one half apart, then one and a half, then a quarter.
TriangleMesh plates() {
    const auto plate = [](double low, double high) {
        return makeBoxMesh({0, 0, 0.5 * (low + high)}, {1, 1, 0.5 * (high - low)});
    };
    return joined({plate(0.0, 0.25), plate(0.75, 1.0), plate(2.5, 2.75), plate(3.0, 3.25)});
}

DepthMap gapMap(const TriangleMesh& mesh, const std::string& spec, const IsKnown& is_known) {
    const MeshQuery query = queryOf(mesh);
    const View view = required(makeView(required(parseMapSpec(spec)), mesh));
    std::uint64_t covered = 0;
    DepthMap map = bakeGapMap(query, TriangleNormals(mesh), view, {.reach = 0.05}, is_known, covered,
                              [](std::uint32_t) {});
    EXPECT_GT(covered, 0U);
    EXPECT_TRUE(validateFrame(map));
    return map;
}

/// Solids that overlap are one.
MeshQuery unionOf(const TriangleMesh& mesh) {
    return queryOf(PreparedMesh::unionOf(mesh, std::vector<std::uint32_t>(mesh.triangles.size(), 0)));
}

const IsKnown kNothingKnown = [](const glm::vec3&) { return false; };

TEST(GapMap, KnowsHowFarTheEndsOfTheLongestGapAre) {
    const DepthMap map = gapMap(plates(), "front-back:dir=-z,size=34,compare=gap", kNothingKnown);
    EXPECT_FALSE(map.encloses);
    EXPECT_FALSE(map.empty_is_outside);
    MersenneRandom random(3);
    for (int i = 0; i < 5000; ++i) {
        const glm::vec3 p(glm::dvec3(0.0, 0.0, 1.625) + glm::dvec3(0.93, 0.93, 1.615) * inCube(random));
        const Vote said = vote(map, p).value();
        const float expected = std::min(p.z - 1.0F, 2.5F - p.z);
        EXPECT_NEAR(said.distance, expected, 2e-4F) << p.z;
        EXPECT_NEAR(said.normal.z, p.z < 1.75F ? 1.0F : -1.0F, 1e-4F);
    }
    EXPECT_FALSE(vote(map, {1.5F, 0.0F, 1.7F}));  // beside the plates
    EXPECT_FALSE(vote(map, {0.0F, 0.0F, 4.0F}));  // behind them
}

TEST(GapMap, KeepsTheGapOfWhichLeastIsKnown) {
    // The longest is known from its first to its last third: what is left of it is shorter than the half.
    const DepthMap map = gapMap(plates(), "front-back:dir=+z,size=34,compare=gap",
                                [](const glm::vec3& p) { return p.z > 1.3F && p.z < 2.5F; });
    EXPECT_GT(vote(map, {0.1F, 0.2F, 0.5F})->distance, 0.2F);
    EXPECT_LT(vote(map, {0.1F, 0.2F, 1.7F})->distance, 0.0F);
    // All but the shortest is known.
    const DepthMap third = gapMap(plates(), "front-back:dir=+z,size=34,compare=gap",
                                  [](const glm::vec3& p) { return p.z < 2.6F; });
    EXPECT_NEAR(vote(third, {0.1F, 0.2F, 2.875F})->distance, 0.125F, 1e-3F);
}

/// No gap counts more than its length, so that of forty the maps are asked about the longest alone.
TEST(GapMap, AsksAboutTheLongestGapsFirst) {
    std::vector<TriangleMesh> stack;
    double at = 0.0;
    for (int i = 0; i < 41; ++i) {
        stack.push_back(makeBoxMesh({0, 0, at}, {20, 20, 0.01}));
        at += 0.02 + 0.01 * (i % 20 + 1) + (i == 17 ? 1.0 : 0.0);
    }
    std::atomic<std::size_t> asked = 0;
    const DepthMap map =
        gapMap(joined(stack), "front-back:dir=-z,size=18,compare=gap", [&](const glm::vec3&) {
            ++asked;
            return false;
        });
    EXPECT_LE(asked, std::size_t{4} * 18 * 18);  // four parts of one gap
    EXPECT_GT(asked, std::size_t{3} * 16 * 16);
}

TEST(GapMap, FindsThinGapsAcrossTheLineOfSight) {
    // Two plates a hundredth apart, at 45° to the view and thinner than a texel.
    const glm::dmat3 turned = rotation({1, 0, 0}, 45.0);
    const TriangleMesh mesh = joined({makeBoxMesh(turned * glm::dvec3(0, 0, 0.205), {1, 1, 0.2}, turned),
                                      makeBoxMesh(turned * glm::dvec3(0, 0, -0.205), {1, 1, 0.2}, turned)});
    const DepthMap map = gapMap(mesh, "front-back:dir=-z,size=66,compare=gap", kNothingKnown);
    const auto isOutside = [&](const glm::dvec3& p) {
        const auto said = vote(map, glm::vec3(turned * p));
        return said && said->distance >= 0.0F;
    };
    MersenneRandom random(4);
    int right = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 p = 0.8 * inCube(random);
        right += isOutside({p.x, p.y, 0.0}) && !isOutside({p.x, p.y, 0.03}) ? 1 : 0;
    }
    EXPECT_GT(right, 1970);
}

TEST(GapMap, SparesAWallAlongTheLineOfSight) {
    // As thick as a texel, half in one and half in the next.
    const double half = 1.0 / 32.0;
    const TriangleMesh mesh =
        joined({makeBoxMesh({0, 0, 0.1}, {1, 1, 0.1}), makeBoxMesh({0, 0, 2.1}, {1, 1, 0.1}),
                makeBoxMesh({0, 0, 1.1}, {half, 1, 0.9 - 1e-3})});
    const DepthMap map = gapMap(mesh, "front-back:dir=-z,size=34,compare=gap", kNothingKnown);
    MersenneRandom random(7);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 p = 0.9 * inCube(random);
        const auto in_wall = vote(map, {0.9 * half * p.x, p.y, 1.1 + 0.8 * p.z});
        ASSERT_FALSE(in_wall && in_wall->distance >= 0.0F) << p.x;
        const auto beside = vote(map, {p.x < 0.0 ? -0.5 : 0.5, p.y, 1.1});
        ASSERT_TRUE(beside && beside->distance > 0.8F);
    }
}

TEST(GapMap, NoPointDeepInASolidIsOutside) {
    const TriangleMesh mesh = ballInABall();
    MersenneRandom random(5);
    for (const char* spec :
         {"front-back:dir=-z,size=66,compare=gap", "front-back:dir=1/2/3,size=50x80,compare=gap",
          "front-back:dir=+x,size=66,compare=gap,depth=half"}) {
        SCOPED_TRACE(spec);
        const DepthMap map = gapMap(mesh, spec, kNothingKnown);
        const double texel = 2.0 * std::sqrt(3.0) / 48.0;
        int known = 0;
        for (int i = 0; i < 20'000; ++i) {
            const glm::dvec3 way = random.direction();
            const double share = random.uniform();
            for (const double radius :
                 {kHollow + texel + share * (0.999 - kHollow - texel), (kBall - texel) * share}) {
                const auto in_solid = vote(map, glm::vec3(radius * way));
                ASSERT_FALSE(in_solid && in_solid->distance >= 0.0F) << radius;
            }
            const auto in_gap = vote(map, glm::vec3((kBall + share * (kHollow - kBall)) * way));
            known += in_gap && in_gap->distance >= 0.0F ? 1 : 0;
        }
        // Before and behind the ball a line of sight has two gaps, of which it keeps one.
        EXPECT_GT(known, 12'000);
    }
}

TEST(GapMap, ItsSightIsWhatItsTexelsSay) {
    const TriangleMesh mesh = ballInABall();
    const MeshQuery query = queryOf(mesh);
    const DepthMap map = gapMap(mesh, "front-back:dir=-z,size=130,compare=gap", kNothingKnown);
    const Sight sight(map, query);
    MersenneRandom random(6);
    int reached = 0;
    int differ = 0;
    for (int i = 0; i < 20'000; ++i) {
        const glm::vec3 p(0.9 * inCube(random));
        const double r = glm::length(glm::dvec3(p));
        if (r < kBall + 0.03 || r > kHollow - 0.03) {
            continue;
        }
        const bool reaches = sight.reaches(p).has_value();
        const auto said = vote(map, p);
        reached += reaches ? 1 : 0;
        differ += reaches != (said && said->distance >= 0.0F) ? 1 : 0;
    }
    EXPECT_GT(reached, 3000);
    EXPECT_LT(differ, reached / 50);  // beside the ball's silhouette a texel speaks for points of both gaps
    EXPECT_FALSE(sight.reaches({0.0F, 0.0F, 1.5F}));
}

TEST(GapMap, APlannedBakeLooksBetweenShelves) {
    // A closed cupboard: a cube in free space sees one of its shelves, a map of gaps from the side all.
    std::vector<TriangleMesh> boards;
    for (const double sign : {-1.0, 1.0}) {
        boards.push_back(makeBoxMesh({0.95 * sign, 0, 0}, {0.05, 1, 1}));
        boards.push_back(makeBoxMesh({0, 0.95 * sign, 0}, {1, 0.05, 1}));
        boards.push_back(makeBoxMesh({0, 0, 0.95 * sign}, {1, 1, 0.05}));
    }
    for (int i = 1; i < 8; ++i) {
        boards.push_back(makeBoxMesh({0, 0.25 * i - 1.0, 0}, {0.99, 0.02, 0.99}));
    }
    const MeshQuery query = unionOf(joined(boards));
    const auto wrongOf = [&](bool gaps) {
        const ViewChoice views = required(chooseViews(query, {.gaps = gaps}));
        const PlannedBake made = required(bakePlanned(query, views, 200'000, {}));
        EXPECT_LE(made.baked.collider.gpuBytes(), 200'000U);
        EXPECT_EQ(made.plan.bytes, made.baked.collider.gpuBytes());
        const std::vector<DepthMap>& maps = made.baked.collider.maps;
        EXPECT_EQ(std::ranges::any_of(maps, [](const DepthMap& map) { return map.compare == Compare::kGap; }),
                  gaps);
        return measureNear(sampleNear(query, {.samples = 30'000, .seed = 8}), fieldOf(made.baked.collider))
            .total();
    };
    EXPECT_LT(wrongOf(true), 0.2 * wrongOf(false));
}

TEST(GapsAlong, AreWhatALineCrosses) {
    const MeshQuery query = queryOf(plates());
    const std::vector<LineGap> gaps = query.gapsAlong({0.1, 0.2, 1.5}, {0, 0, 3.0});
    ASSERT_EQ(gaps.size(), 3U);
    const double expected[3][2] = {{0.25, 0.75}, {1.0, 2.5}, {2.75, 3.0}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(1.5 + 3.0 * gaps[i].begin, expected[i][0], 1e-9);
        EXPECT_NEAR(1.5 + 3.0 * gaps[i].end, expected[i][1], 1e-9);
    }
    EXPECT_TRUE(query.gapsAlong({1.1, 0.0, 0.0}, {0, 0, 1}).empty());
    // Through the middle of every plate, where two triangles of it share an edge.
    EXPECT_EQ(query.gapsAlong({0, 0, -9}, {0, 0, 1}).size(), 3U);
    // Solids that overlap are one.
    const MeshQuery overlapping =
        unionOf(joined({makeBoxMesh({0, 0, 0}, {1, 1, 1}), makeBoxMesh({0, 0, 0.5}, {0.5, 0.5, 1.0}),
                        makeBoxMesh({0, 0, 3}, {1, 1, 1})}));
    const std::vector<LineGap> one = overlapping.gapsAlong({0.1, 0.3, 0}, {0, 0, 1});
    ASSERT_EQ(one.size(), 1U);
    EXPECT_NEAR(one[0].begin, 1.5, 1e-9);
    EXPECT_NEAR(one[0].end, 2.0, 1e-9);
}

TEST(GapGrid, APointInTheKeptGapIsFoundByAskingLess) {
    std::vector<TriangleMesh> balls;
    MersenneRandom random(11);
    for (int i = 0; i < 60; ++i) {
        balls.push_back(makeIcosphere(inCube(random), 0.2, 1));
    }
    const MeshQuery query = unionOf(joined(balls));
    const auto is_seen = [](const glm::dvec3& p) { return p.x + 0.5 * p.y > 0.1; };
    int held = 0;
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
        const glm::dvec3 p = inCube(random);
        const glm::dvec3 along = inCube(random);
        const std::optional<LineGap> kept = keptGap(query, p, along, is_seen);
        const bool in_kept = kept && kept->begin <= 0.0 && kept->end >= 0.0;
        ASSERT_EQ(isInKeptGap(query, p, along, is_seen), in_kept) << i;
        held += in_kept ? 1 : 0;
        met += kept ? 1 : 0;
    }
    EXPECT_GT(held, 100);
    EXPECT_GT(met, held + 100);
}

TEST(GapGrid, HoldsWhatTheMapWill) {
    const TriangleMesh mesh = plates();
    const MeshQuery query = queryOf(mesh);
    MapSpec spec = *parseMapSpec("front-back:dir=-z,size=64,compare=gap");
    const GapGrid grid(query, *makeView(spec, mesh),
                       [](const glm::dvec3& p) { return p.z > 1.2 && p.z < 2.4; });
    EXPECT_TRUE(grid.holds({0.3, 0.4, 0.5}));
    EXPECT_FALSE(grid.holds({0.3, 0.4, 0.1}));
    EXPECT_FALSE(grid.holds({0.3, 0.4, 1.8}));
    EXPECT_FALSE(grid.holds({1.3, 0.4, 0.5}));
    EXPECT_NEAR(grid.area(), 4.0, 0.01);
    EXPECT_NEAR(static_cast<double>(grid.silhouette().texels(102, 102)), 1e4, 100.0);
}

}  // namespace
}  // namespace relief::test
