// SPDX-License-Identifier: Apache-2.0
// Supporting planes: the guarantees of plane_fit.h and fitted_map.h, tested on closed-form shapes and by accuracy.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

#include "bake/maps/bake_maps.h"
#include "bake/measure/accuracy.h"
#include "bake/mesh/triangle_plane.h"
#include "bake/named_maps/plane_fit.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

WrongPercent wrongNear(const TriangleMesh& mesh, const Collider& collider) {
    const MeshQuery query = queryOf(mesh);
    return measureField(sampleTruth(query, {.samples = 30'000}), fieldOf(collider)).near;
}

/// Footprints whose rays are parallel and all hit use a faster search than footprints with a skewed or missed ray. Both
/// searches must find equally good planes, without a sampled point in front of them.
TEST(PlaneFit, NoSampledPointIsInFrontOfThePlane) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    PlaneFitOptions options{.reach = 0.05};
    int same = 0;
    constexpr int kRepeats = 2000;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        const std::size_t count =
            repeat % 3 == 0 ? 9 : 16;  // also a count that the SIMD width does not divide
        const std::size_t across = repeat % 3 == 0 ? 3 : 4;
        const glm::dvec3 slope(0.6 * unit(random), 0.6 * unit(random), 0.0);
        // Some are so near the viewer that planes start in front of it.
        const double depth = repeat % 5 == 0 ? 0.002 : 0.3;
        std::vector<FootprintRay> rays(count);
        for (std::size_t i = 0; i < count; ++i) {
            // Off the lattice, on which several planes can be the best.
            rays[i].origin = {0.005 * (double(i % across) + 0.3 * unit(random)) - 0.007,
                              0.005 * (double(i / across) + 0.3 * unit(random)) - 0.007, 0};
            rays[i].direction = {0, 0, 1};
            rays[i].u = std::max(
                0.0, depth + dot(slope, rays[i].origin) + (repeat % 4 == 0 ? 0.0 : 0.004 * unit(random)));
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
        // Either of two equally good planes is correct.
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

TEST(FittedMap, TiltedFaceIsExactToAQuantum) {
    // One face of a rotated box, seen obliquely. Away from the edges the plane equals the face, except for quantization
    // of the normal (at most 0.65°, over half a texel) and of the depth, both on the free side.
    const glm::dmat3 axes = rotation({0, 1, 0}, 25.0);
    const Collider collider = bakeSpecs(makeBoxMesh({0, 0, 0}, {1, 1, 1}, axes),
                                        {"front-back:dir=-z,size=66x66,depth=unorm16,decode=plane"});
    const glm::dvec3 normal = axes * glm::dvec3(0, 0, 1);
    const double texel = 2.0 * 1.33 / 64.0;
    const double bound = texel * 0.0114 + 4.0 / 65534.0;
    // The outermost eighth of a texel is beyond its samples.
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

/// A box seen along its edges. Its walls cross texels, so rays never hit them. No point of the box is outside, and no
/// point more than a texel away is inside.
TEST(FittedMap, WallsSeenEdgeOnLoseNoSolid) {
    const TriangleMesh mesh = makeBoxMesh({0, 0, 0}, {1.0, 0.7, 0.4}, glm::dmat3(1.0));
    const Collider collider = bakeSpecs(
        mesh, {"front-back:dir=-z,size=23x19,depth=unorm16,decode=plane,box=-1.2/-1.05/-0.4/1.3/1.15/0.4"});
    const double texel = std::max(2.5 / 21.0, 2.2 / 17.0);
    const double bound = texel / 4.0 / 63.0 + 4.0 * texel / 65534.0;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 4000; ++i) {
        const double f = 1.5 * texel * unit(random);
        const double sign = i % 4 < 2 ? 1.0 : -1.0;
        const double along = 0.8 * unit(random);  // away from the corners
        const glm::vec3 p = i % 2 == 0 ? glm::vec3(sign * (1.0 + f), 0.7 * along, 0.39 * unit(random))
                                       : glm::vec3(along, sign * (0.7 + f), 0.39 * unit(random));
        const FieldSample sample = evaluate(collider, p);
        ASSERT_EQ(sample.map, 0);
        if (f < -bound || f > texel) {
            ASSERT_EQ(sample.inside(), f < 0.0) << p.x << " " << p.y << " " << p.z;
        }
    }
}

/// Several maps are fitted or traced in parallel.
TEST(FittedMap, MapsBakedTogetherMatchSeparateBakes) {
    const TriangleMesh mesh = makeTorusMesh(1.0, 0.4, 48, 24);
    const std::vector<std::string> specs = {"front-back:dir=-z,size=40x52,depth=unorm16,decode=plane",
                                            "front-back:dir=1/2/3,size=61x33,depth=unorm16,decode=plane",
                                            "cube:size=24,decode=plane,box=-1.5/-1.5/-1.5/1.5/1.5/1.5",
                                            "front-back:dir=-y,size=44,depth=half,decode=projected",
                                            "float:dir=-x,size=47x31",
                                            "front-back:dir=-y,size=35x21,depth=unorm16,decode=plane"};
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

TEST(FittedMap, SupportingPlanesRarelyLosePoints) {
    const TriangleMesh mesh = makeTorusMesh(1.0, 0.4, 64, 32);
    std::vector<MapSpec> specs;
    for (const char* const text :
         {"front-back:dir=-x,size=52", "front-back:dir=-y,size=52", "front-back:dir=-z,size=52"}) {
        specs.push_back(required(parseMapSpec(text)));
    }
    const WrongPercent fitted = wrongNear(mesh, bakeMaps(mesh, specs));
    const WrongPercent centred = wrongNear(mesh, bakeMaps(mesh, specs, Quality::kFast));
    EXPECT_LT(fitted.false_outside, 0.5 * centred.false_outside);
    EXPECT_LT(fitted.total(), centred.total());
}

}  // namespace
}  // namespace relief::test
