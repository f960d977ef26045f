// SPDX-License-Identifier: Apache-2.0
// Supporting planes and planned views: promises of plane_fit.h, fitted_map.h and view_planner.h, first on
// shapes with a closed form, then by the yardstick.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

#include "bake/measure/accuracy.h"
#include "bake/mesh/triangle_plane.h"
#include "bake/pipeline/budget_search.h"
#include "bake/plan/outer_views.h"
#include "bake/texels/plane_fit.h"
#include "formats/container.h"
#include "tests/bake/meshes.h"
#include "tests/bake/plan_views.h"
#include "tests/bake/voxels.h"

namespace relief::test {
namespace {

constexpr std::uint64_t kBudget = 65536;

Plan planOf(const TriangleMesh& mesh, std::uint64_t budget = kBudget) {
    return required(planViews(queryOf(mesh), {budget, {}}));
}

PlannedBake madeOf(const TriangleMesh& mesh, std::uint64_t budget = kBudget) {
    const MeshQuery query = queryOf(mesh);
    const ViewChoice views = required(chooseViews(query, {}));
    return required(bakePlanned(query, views, budget, {}));
}

WrongShare wrongNear(const TriangleMesh& mesh, const Collider& collider) {
    const MeshQuery query = queryOf(mesh);
    return measureField(sampleTruth(query, {.samples = 30'000}), fieldOf(collider)).near;
}

/// A box of side 2, hollow, with a small square mouth in its top: no straight line from outside reaches most
/// of the cavity's walls.
TriangleMesh makeJar() {
    VoxelGrid grid(glm::ivec3(10));
    for (int i = 0; i < 1000; ++i) {
        const glm::ivec3 cell(i % 10, i / 10 % 10, i / 100);
        const glm::ivec3 deep = glm::min(cell, 9 - cell);
        const bool mouth = cell.x == 5 && cell.z == 5 && cell.y == 9;
        grid.set(cell, std::min({deep.x, deep.y, deep.z}) == 0 && !mouth);
    }
    return grid.mesh(glm::dvec3(-1.0), 0.2);
}

/// No sampled point of the surface lies in front of the plane. Footprints whose rays run side by side and all meet a surface
/// are searched in another way than those of which one runs askew, if by far less than matters, or misses: the first two find
/// planes that are as good.
TEST(PlaneFit, NoSampledSurfacePointLiesInFrontOfThePlaneWhicheverWayIsSearched) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    PlaneFitOptions options{.reach = 0.05};
    int same = 0;
    constexpr int kRepeats = 2000;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        const std::size_t count = repeat % 3 == 0 ? 9 : 16;  // also what no block of lanes divides
        const std::size_t across = repeat % 3 == 0 ? 3 : 4;
        const glm::dvec3 slope(0.6 * unit(random), 0.6 * unit(random), 0.0);
        // Some lie so near the viewer that planes begin in front of it.
        const double depth = repeat % 5 == 0 ? 0.002 : 0.3;
        std::vector<FootprintRay> rays(count);
        for (std::size_t i = 0; i < count; ++i) {
            // Off the lattice, on which several planes may be the best.
            rays[i].origin = {0.005 * (double(i % across) + 0.3 * unit(random)) - 0.007,
                              0.005 * (double(i / across) + 0.3 * unit(random)) - 0.007, 0};
            rays[i].direction = {0, 0, 1};
            rays[i].u = std::max(
                0.0, depth + dot(slope, rays[i].origin) + (repeat % 4 == 0 ? 0.0 : 0.004 * unit(random)));
            rays[i].u_last = 1.0;
            rays[i].normal =
                glm::normalize(glm::dvec3(slope.x + 0.2 * unit(random), slope.y + 0.2 * unit(random), -1.0));
        }
        const FootprintRay center{{0, 0, 0}, {0, 0, 1}, -1.0, glm::dvec3(0.0)};
        const auto fit = [&] {
            return fitSupportingPlane(rays, nullptr, {}, center, center.origin, options);
        };
        const std::optional<FittedPlane> straight = fit();
        rays.back().direction.x = 1e-15;
        const std::optional<FittedPlane> askew = fit();
        ASSERT_TRUE(straight);
        ASSERT_TRUE(askew);
        // Of planes that are equally good one may be taken for the other.
        const auto costOf = [&](const FittedPlane& plane) {
            double cost = 0.0;
            for (const FootprintRay& ray : rays) {
                if (ray.u < 0.0) {
                    continue;
                }
                const glm::dvec3 met = ray.origin + ray.u * ray.direction;
                const glm::dvec3 stored(0, 0, plane.code / 65534.0);
                const double free = dot(plane.normal, met - stored) / plane.normal.z;
                EXPECT_GT(free, -1e-12);
                cost += std::min({free, ray.u, options.reach});
            }
            return cost;
        };
        EXPECT_NEAR(costOf(*straight), costOf(*askew), 1e-12);
        for (FootprintRay& ray : rays) {
            ray.normal =
                glm::normalize(glm::dvec3(0.5 * unit(random), 0.5 * unit(random), -std::abs(unit(random))));
        }
        rays.pop_back();
        rays.push_back(center);
        const FittedPlane torn = fit().value();
        ASSERT_FALSE(torn.stands);
        EXPECT_LE(torn.normal.z, -1.0 / 32.0);
        costOf(torn);
        same += straight->code == askew->code && straight->normal == askew->normal ? 1 : 0;
    }
    EXPECT_GT(same, 0.99 * kRepeats);
}

TEST(PlaneFit, FootprintWithoutSurfaceIsEmpty) {
    const FootprintRay ray{{0, 0, 0}, {0, 0, 1}, -1.0, glm::dvec3(0.0)};
    EXPECT_FALSE(fitSupportingPlane(std::vector<FootprintRay>(4, ray), nullptr, {}, ray, ray.origin, {}));
}

TEST(FittedMap, ATiltedFaceIsFoundToAQuantumEverywhere) {
    // One face of a turned box, seen obliquely: away from the edges the plane is the face itself, but for the
    // normal's index (at most 0.65°, over half a texel) and the depth's quantum, both on the free side.
    const glm::dmat3 axes = rotation({0, 1, 0}, 25.0);
    const Collider collider = bakeSpecs(makeBoxMesh({0, 0, 0}, {1, 1, 1}, axes),
                                        {"front-back:dir=-z,size=66x66,depth=unorm16,decode=plane"});
    const glm::dvec3 normal = axes * glm::dvec3(0, 0, 1);
    const double texel = 2.0 * 1.33 / 64.0;
    const double bound = texel * 0.0114 + 4.0 / 65534.0;
    // The outermost eighth of a texel lies beyond its samples.
    const double rim = std::sqrt(2.0) / 8.0 * texel * 0.0114;
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(-0.9, 0.9);
    for (int i = 0; i < 5000; ++i) {
        const double f = 0.05 * unit(random);
        const glm::dvec3 p = axes * glm::dvec3(unit(random), unit(random), 1.0 + f);
        const FieldSample sample = evaluate(collider, glm::vec3(p));
        ASSERT_EQ(sample.map, 0);
        EXPECT_LE(sample.distance, f + 0.002 * std::abs(f) + rim) << "in front of the face by " << f;
        EXPECT_GE(sample.distance, f - bound - 0.002 * std::abs(f)) << "in front of the face by " << f;
        EXPECT_GT(dot(glm::dvec3(sample.normal), normal), 0.9998);
    }
}

TEST(FittedMap, WallsSeenEdgeOnAreFoundInsideTheirTexels) {
    // A box whose walls run through texels, not along their edges, seen along three of its edges: the map's
    // rays never meet the walls, yet it says on which side of them a point is, to the 63rd part of the
    // quarter of a texel to which their place is known and the quantum of the offset.
    const TriangleMesh mesh = makeBoxMesh({0, 0, 0}, {1.0, 0.7, 0.4}, glm::dmat3(1.0));
    const Collider collider = bakeSpecs(
        mesh, {"front-back:dir=-z,size=23x19,depth=unorm16,decode=plane,box=-1.2/-1.05/-0.4/1.3/1.15/0.4"});
    const double texel = std::max(2.5 / 21.0, 2.2 / 17.0);
    const double bound = texel / 4.0 / 63.0 + 4.0 * texel / 65534.0;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 4000; ++i) {
        const double f = 0.3 * texel * unit(random);
        const double sign = i % 4 < 2 ? 1.0 : -1.0;
        const double along = 0.8 * unit(random);  // away from the corners
        const glm::vec3 p = i % 2 == 0 ? glm::vec3(sign * (1.0 + f), 0.7 * along, 0.39 * unit(random))
                                       : glm::vec3(along, sign * (0.7 + f), 0.39 * unit(random));
        const FieldSample sample = evaluate(collider, p);
        ASSERT_EQ(sample.map, 0);
        if (std::abs(f) > bound) {
            ASSERT_EQ(sample.inside(), f < 0.0) << p.x << " " << p.y << " " << p.z;
        }
        if (f > bound && sample.distance < kFarOutside) {
            EXPECT_NEAR(sample.distance, f, bound);
        }
    }
}

/// Several maps are fitted, or traced, at the same time: each as it would be alone.
TEST(FittedMap, MapsBakedTogetherAreAsAlone) {
    const TriangleMesh mesh = makeTorusMesh(1.0, 0.4, 48, 24);
    const std::vector<std::string> specs = {"front-back:dir=-z,size=40x52,depth=unorm16,decode=plane",
                                            "front-back:dir=1/2/3,size=61x33,depth=unorm16,decode=plane",
                                            "cube:size=24,decode=plane,box=-1.5/-1.5/-1.5/1.5/1.5/1.5",
                                            "front-back:dir=-y,size=44,depth=half,decode=projected",
                                            "float:dir=-x,size=47x31",
                                            "front-back:dir=-y,size=35x21,depth=unorm16,decode=plane"};
    // Refined together, planes would differ.
    BakeOptions options;
    options.quality = Quality::kFast;
    const auto baked = [&](const std::vector<std::string>& texts) {
        options.maps.clear();
        for (const std::string& text : texts) {
            options.maps.push_back(*parseMapSpec(text));
        }
        return required(bake(mesh, options));
    };
    const Baked together = baked(specs);
    ASSERT_EQ(together.collider.maps.size(), specs.size());
    for (std::size_t i = 0; i < specs.size(); ++i) {
        const Baked alone = baked({specs[i]});
        ASSERT_EQ(alone.collider.maps.size(), 1U);
        EXPECT_EQ(together.collider.maps[i].texels, alone.collider.maps[0].texels) << specs[i];
        EXPECT_EQ(together.report.maps[i].covered, alone.report.maps[0].covered) << specs[i];
        EXPECT_EQ(toString(together.report.maps[i].spec), toString(alone.report.maps[0].spec));
    }
}

TEST(FittedMap, SupportingPlanesHardlyEverCallAnInsidePointOutside) {
    const TriangleMesh mesh = makeTorusMesh(1.0, 0.4, 64, 32);
    const WrongShare fitted = wrongNear(mesh, bakeMaps(mesh, specsOf(planOf(mesh))));
    const WrongShare centred = wrongNear(mesh, bakeMaps(mesh, specsOf(planOf(mesh)), Quality::kFast));
    EXPECT_LT(fitted.false_outside, 0.5 * centred.false_outside);
    EXPECT_LT(fitted.total(), centred.total());
}

TEST(ViewPlanner, KeepsTheBudgetAndSeesAllOfAConvexShape) {
    const TriangleMesh mesh = makeIcosphere({1, 2, 3}, 2.0, 4);
    for (const std::uint64_t budget : {std::uint64_t{8192}, std::uint64_t{100'000}, std::uint64_t{1} << 20}) {
        const Plan plan = planOf(mesh, budget);
        EXPECT_LE(plan.bytes, budget);
        EXPECT_GE(plan.bytes, budget * 9 / 10);
        const PlannedBake made = madeOf(mesh, budget);
        EXPECT_EQ(made.plan.unseen_percent, 0.0);
        EXPECT_LE(made.baked.collider.gpuBytes(), budget);
    }
}

/// Of a box twice as long as wide a diagonal is one of the directions that are spread over the sphere.
TEST(ViewPlanner, DirectionsMayCoincide) {
    for (const glm::dvec3& half :
         {glm::dvec3(0.5, 0.5, 1.0), glm::dvec3(0.5, 1.0, 0.5), glm::dvec3(1.0, 0.5, 0.5)}) {
        const TriangleMesh mesh = makeBoxMesh({0, 0, 0}, half);
        const std::vector<glm::dvec3> directions = outerDirections(mesh.bounds);
        bool coincide = false;
        for (std::size_t i = 0; i < directions.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                coincide = coincide || glm::vec3(directions[i]) == glm::vec3(directions[j]);
            }
        }
        EXPECT_TRUE(coincide);
        double serves = 0.0;
        const Plan plan = planOf(mesh);
        for (const PlannedMap& map : plan.maps) {
            serves += map.serves;
        }
        EXPECT_GT(serves, 0.9);
        EXPECT_LE(serves, 1.0);
    }
}

TEST(ViewPlanner, MakesAThirdOfTheMistakesOfThePapersMaps) {
    for (const TriangleMesh& mesh : {makeIcosphere({0, 0, 0}, 1.0, 4), makeTorusMesh(1.0, 0.4, 64, 32),
                                     makeBoxMesh({0, 0, 0}, {1, 0.6, 0.3}, rotation({1, 2, 3}, 33.0))}) {
        // 52² · 8 · 3 bytes, the budget.
        const Collider paper = bakeSpecs(
            mesh,
            {"front-back:dir=-x,size=52x52", "front-back:dir=-y,size=52x52", "front-back:dir=-z,size=52x52"});
        ASSERT_LE(paper.gpuBytes(), kBudget);
        EXPECT_LT(wrongNear(mesh, bakeMaps(mesh, specsOf(planOf(mesh)))).total(),
                  wrongNear(mesh, paper).total() / 3.0);
    }
}

TEST(ViewPlanner, LooksIntoACavity) {
    const PlannedBake made = madeOf(makeJar());
    const auto within =
        std::count_if(made.plan.maps.begin(), made.plan.maps.end(), [](const PlannedMap& map) {
            return map.spec.compare.has_value();  // a cube, or gaps
        });
    EXPECT_GE(within, 1);
    EXPECT_LT(made.plan.unseen_percent, 1.0);
    // The middle of the cavity is free, which no outer view can know.
    const Collider& collider = made.baked.collider;
    EXPECT_FALSE(evaluate(collider, {0.5F, -0.5F, 0.5F}).inside());
    EXPECT_TRUE(evaluate(collider, {0.9F, -0.5F, 0.0F}).inside());
}

TEST(ViewPlanner, KeepsToItsMapsAndSaysWhatOneMoreWouldServe) {
    const MeshQuery query = queryOf(makeJar());
    PlanOptions options;
    options.views.max_maps = 1;
    const Plan one = required(planViews(query, options));
    EXPECT_EQ(one.maps.size(), 1U);
    EXPECT_GT(one.next_gain, 0.1);  // the cavity
    options.views.max_maps = 64;
    const Plan all = required(planViews(query, options));
    EXPECT_GT(all.maps.size(), 1U);
    EXPECT_LT(all.next_gain, 0.01);
}

TEST(ViewPlanner, RefusesABudgetThatIsTooSmall) {
    expectError(planViews(queryOf(makeIcosphere({0, 0, 0}, 1.0, 2)), {100, {}}), ErrorCode::kUsage);
}

/// What lies between parts far apart takes no bytes of the budget, but time and memory: it has a limit of its own.
TEST(PlannedBake, PartsFarApartHaveMapsOfBoundedSize) {
    const MeshQuery query = queryOf(joined(
        {makeBoxMesh({0, 0, 0}, glm::dvec3(0.5)), makeBoxMesh(glm::dvec3(60'000.0), glm::dvec3(0.5))}));
    const ViewChoice views = required(chooseViews(query, {}));
    const auto rectangles = [&](std::uint64_t budget) {
        const Plan plan = required(planSizes(views, budget));
        std::uint64_t bytes = 0;
        for (const PlannedMap& map : plan.maps) {
            bytes += std::uint64_t{map.spec.format == MapFormat::kCube8 ? 24U : 8U} * map.spec.width *
                     map.spec.height;
        }
        return bytes;
    };
    EXPECT_LE(rectangles(1'000'000), std::uint64_t{128} << 20);
    EXPECT_LE(rectangles(16'000'000), std::uint64_t{16} * 16'000'000);
}

}  // namespace
}  // namespace relief::test
