// SPDX-License-Identifier: Apache-2.0
// The nearest-surface search against shapes with closed-form distances.
// A collider of planes differs from the shape by about a texel. Each plane touches the surface at the texel's centre
// and deviates from a curved surface towards the texel's rim, most of all at grazing angles. Edges of the shape end at
// texel borders. So a fraction of the points may be off by a texel; the tested distances reach ten texels.
#include "formats/nearest_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <string>

#include "formats/validate.h"
#include "tests/formats/analytic_shapes.h"
#include "tests/formats/sample_colliders.h"

namespace relief {
namespace {

using namespace test;

using Distance = std::function<double(const glm::dvec3&)>;

double boxDistance(const glm::dvec3& p, const glm::dvec3& half) {
    const glm::dvec3 q = glm::abs(p) - half;
    return glm::length(glm::max(q, glm::dvec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

struct Scene {
    Collider collider;
    double texel = 0.0;  // object units
};

/// Three front-back plane maps around a box of this half side.
Scene sceneOf(const Shape& shape, double half, std::uint32_t size, const glm::dmat3& axes = glm::dmat3(1.0)) {
    Scene scene;
    scene.collider =
        threeMaps(shape, glm::dvec3(0.0), axes, half, size, MapFormat::kFrontBackFixed, Decode::kPlane);
    scene.collider.bounds = {glm::vec3(static_cast<float>(-half)), glm::vec3(static_cast<float>(half))};
    scene.texel = double{scene.collider.maps[0].object_per_map.x} / size;
    return scene;
}

struct Errors {
    double mean = 0.0;          // texels
    double over_a_texel = 0.0;  // fraction of points with a larger distance error
    int inside = 0;
    int count = 0;
};

/// Measures random points within `half` of the origin and 1 to 10 texels from the surface. Also checks the invariants
/// of every result.
Errors measure(const Scene& scene, const Distance& truth, double half) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> within(-half, half);
    Errors errors;
    while (errors.count < 20'000 && !testing::Test::HasFailure()) {
        const double z = within(random);
        const double y = within(random);
        const glm::vec3 p(glm::dvec3(within(random), y, z));
        const double distance = truth(glm::dvec3(p));
        if (std::abs(distance) > 10.0 * scene.texel || std::abs(distance) < scene.texel) {
            continue;
        }
        SCOPED_TRACE(std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z));
        const FieldSample vote = evaluate(scene.collider, p);
        const SurfaceSample nearest = nearestSurface(scene.collider, p);
        EXPECT_EQ(nearest.inside(), vote.inside());
        EXPECT_EQ(nearest.inside(), distance < 0.0);
        EXPECT_LT(std::abs(nearest.distance), kFarOutside);
        EXPECT_NEAR(glm::length(nearest.point - p), std::abs(nearest.distance), 1e-5);
        EXPECT_NEAR(glm::length(nearest.normal), 1.0F, 1e-5F);
        EXPECT_GE(nearest.map, 0);
        const double error = std::abs(nearest.distance - distance) / scene.texel;
        errors.mean += error;
        errors.over_a_texel += error > 1.0 ? 1.0 : 0.0;
        errors.inside += distance < 0.0 ? 1 : 0;
        ++errors.count;
    }
    errors.mean /= errors.count;
    errors.over_a_texel /= errors.count;
    EXPECT_GT(errors.inside, errors.count / 10);
    EXPECT_LT(errors.inside, errors.count / 2);
    return errors;
}

TEST(NearestSurface, Sphere) {
    constexpr double kRadius = 0.9;
    const Scene scene = sceneOf(*makeSphere({0, 0, 0}, kRadius), kRadius, 64);
    const Errors errors = measure(
        scene, [&](const glm::dvec3& p) { return glm::length(p) - kRadius; }, 1.3);
    EXPECT_LT(errors.mean, 0.04);
    EXPECT_LT(errors.over_a_texel, 0.002);
}

/// With only one map, texels beside the hole are seen at grazing angles, so their surface is steep.
TEST(NearestSurface, TorusWithItsHole) {
    constexpr std::uint32_t kSize = 96;
    Scene scene;
    scene.texel = 2.0 / kSize;
    scene.collider.bounds = {{-0.95F, -0.95F, -0.25F}, {0.95F, 0.95F, 0.25F}};
    scene.collider.maps.push_back(makeMap(*makeTorus(0.7, 0.25),
                                          centeredFrame({0, 0, 0}, glm::dmat3(1.0), {2.0, 2.0, 0.6}),
                                          MapFormat::kFrontBackFixed, Compare::kBoth, kSize, kSize));
    scene.collider.maps.back().decode = Decode::kPlane;
    const Errors errors = measure(
        scene,
        [](const glm::dvec3& p) {
            const double ring = std::sqrt(p.x * p.x + p.y * p.y) - 0.7;
            return std::sqrt(ring * ring + p.z * p.z) - 0.25;
        },
        1.2);
    EXPECT_LT(errors.mean, 0.06);
    EXPECT_LT(errors.over_a_texel, 0.005);
}

/// Edges fall between texels of each map, and corners stick out of all maps.
TEST(NearestSurface, RotatedBox) {
    const glm::dvec3 half(0.5, 0.35, 0.6);
    Scene scene = sceneOf(*makeBox({0, 0, 0}, half), 0.8, 64, kTurned);
    scene.collider.bounds = {-glm::vec3(half), glm::vec3(half)};
    const Errors errors = measure(
        scene, [&](const glm::dvec3& p) { return boxDistance(p, half); }, 0.9);
    EXPECT_LT(errors.mean, 0.06);
    EXPECT_LT(errors.over_a_texel, 0.02);
    // Beside a convex edge, either face's plane is nearer than the edge.
    double worst = 0.0;
    for (int i = 0; i <= 100; ++i) {
        for (const double off : {2.0, 4.0, 8.0}) {
            // Beside an edge along y, equidistant from its two faces.
            const glm::dvec3 edge(half.x, half.y * (0.016 * i - 0.8), half.z);
            const glm::vec3 p(edge + off * scene.texel * glm::dvec3(1.0, 0.0, 1.0));
            const double truth = boxDistance(glm::dvec3(p), half);
            ASSERT_NEAR(truth, std::sqrt(2.0) * off * scene.texel, 1e-6);
            worst = std::max(worst, std::abs(nearestSurface(scene.collider, p).distance - truth));
        }
    }
    EXPECT_LT(worst, 1.0 * scene.texel);
}

/// Three planes, one per map, seen from the origin. The nearest point of their corner is on a face, an edge or the tip.
TEST(NearestSurface, CornerOfThreePlanes) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int count = 0; count < 1000;) {
        std::array<glm::dvec3, 3> normals;
        std::array<double, 3> at{};  // distances of the planes
        Collider collider;
        collider.bounds = {glm::vec3(-1.0F), glm::vec3(1.0F)};
        for (int i = 0; i < 3; ++i) {
            const double x = unit(random);
            const double y = unit(random);
            normals[i] = glm::normalize(glm::dvec3(x, y, unit(random) + 0.3));
            at[i] = 0.45 + 0.4 * unit(random);
            // The plane at the ray of the only texel, from z = −4.
            const double depth = (4.0 - at[i] / normals[i].z) / 8.0;
            if (depth < 0.0 || depth > 1.0) {
                break;
            }
            DepthMap map = emptyMap(centeredFrame({0, 0, 0}, glm::dmat3(1.0), {8, 8, 8}), MapFormat::kFloat32,
                                    Compare::kLess, 3, 3);
            map.decode = Decode::kPlane;
            encodeTexel(map.format, {Surface{static_cast<float>(depth), glm::vec3(normals[i])}, std::nullopt},
                        map.texelAt(0, 1, 1));
            collider.maps.push_back(map);
        }
        if (collider.maps.size() < 3) {
            continue;
        }
        double truth = 1e30;
        const auto offer = [&](const glm::dvec3& y) {
            bool behind = true;
            for (int i = 0; i < 3; ++i) {
                behind = behind && at[i] + glm::dot(normals[i], y) < 1e-9;
            }
            truth = behind ? std::min(truth, glm::length(y)) : truth;
        };
        for (int i = 0; i < 3; ++i) {
            const int next = (i + 1) % 3;
            const double cosine = glm::dot(normals[i], normals[next]);
            offer(-at[i] * normals[i]);
            offer(((cosine * at[next] - at[i]) * normals[i] + (cosine * at[i] - at[next]) * normals[next]) /
                  (1.0 - cosine * cosine));
        }
        offer(-glm::dvec3(at[0], at[1], at[2]) *
              glm::inverse(glm::dmat3(normals[0], normals[1], normals[2])));
        if (truth < 0.9) {  // within the bounds
            ASSERT_NEAR(nearestSurface(collider, glm::vec3(0.0F)).distance, truth, 1e-3) << count;
            ++count;
        }
    }
}

/// A central cube map sees floor and walls at grazing angles beside their edges.
TEST(NearestSurface, NearestWallCountsInsideABox) {
    const glm::dvec3 half(0.25, 0.8, 0.4);
    Collider collider;
    collider.bounds = {-glm::vec3(half), glm::vec3(half)};
    collider.maps = {makeMap(*makeBox({0, 0, 0}, half),
                             CubeFrame{{0, 0, 0.05}, glm::dmat3(1.0), glm::dvec3(1.0)}, Compare::kGreater,
                             128)};
    collider.maps[0].decode = Decode::kPlane;
    std::mt19937 random(9);
    std::uniform_real_distribution<float> x(-0.24F, 0.24F);
    std::uniform_real_distribution<float> z(-0.39F, 0.1F);
    double worst = 0.0;
    for (int i = 0; i < 5000; ++i) {
        const glm::vec3 p(x(random), 0.5F * x(random), z(random));
        const double truth = boxDistance(glm::dvec3(p), half);
        const SurfaceSample nearest = nearestSurface(collider, p);
        ASSERT_LT(nearest.distance, 0.0F);
        worst = std::max(worst, std::abs(nearest.distance - truth));
    }
    EXPECT_LT(worst, 0.05) << "a fifth of the box's half side";
}

/// For any valid file and finite point, results are finite and have evaluate()'s side.
TEST(NearestSurface, IsFiniteAndOnTheVotedSideForAnyTexels) {
    constexpr float kMax = std::numeric_limits<float>::max();
    std::mt19937 random(21);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    std::vector<glm::vec3> points;
    for (const float x : {0.0F, 1e-40F, -1e4F, 3e9F, -1e15F, 1e19F, -1e30F, kMax, -kMax}) {
        for (const float y : {0.0F, 0.5F, -1e15F, kMax}) {
            points.insert(points.end(), {{x, y, 0.0F}, {y, x, y}, {-y, 0.0F, x}});
        }
    }
    for (int i = 0; i < 500; ++i) {
        points.emplace_back(unit(random), unit(random), unit(random));
    }
    const Bounds all_bounds[] = {{{-1, -1, -1}, {1, 1, 1}},        {{0, 0, 0}, {0, 0, 0}},
                                 {{-kMax, -1, 0}, {kMax, 1, 0}},   {{1e-20F, 0, 0}, {2e-20F, 0, 0}},
                                 {{-1e15F, -1, 0}, {1e15F, 1, 0}}, {}};
    int inside = 0;
    for (int round = 0; round < 40; ++round) {
        Collider collider = oneMapOfEveryFormat();
        if (round % 2 == 0) {
            collider.maps.pop_back();  // the patch map, which votes outside almost everywhere
        }
        for (DepthMap& map : collider.maps) {
            map.decode = (random() & 1U) != 0 ? Decode::kPlane : Decode::kProjected;
            map.encloses = (random() & 1U) != 0;
            map.empty_is_outside = (random() & 1U) != 0;
            if (map.format == MapFormat::kFixed8 || map.format == MapFormat::kFrontBackFixed ||
                map.format == MapFormat::kCube8) {
                for (std::byte& byte : map.texels) {  // any bytes are valid texels of these formats
                    byte = static_cast<std::byte>(random());
                }
            }
            ASSERT_TRUE(validateTexels(map));
        }
        for (const Bounds& bounds : all_bounds) {
            collider.bounds = bounds;
            for (const glm::vec3& p : points) {
                const FieldSample vote = evaluate(collider, p);
                const SurfaceSample nearest = nearestSurface(collider, p);
                ASSERT_TRUE(std::isfinite(nearest.distance)) << p.x << " " << p.y << " " << p.z;
                for (int k = 0; k < 3; ++k) {
                    ASSERT_TRUE(std::isfinite(nearest.point[k]) && std::isfinite(nearest.normal[k]));
                }
                ASSERT_EQ(nearest.map < 0, vote.map < 0);
                ASSERT_EQ(nearest.inside(), vote.inside());
                inside += nearest.inside() ? 1 : 0;
            }
        }
    }
    EXPECT_GT(inside, 1000);
}

TEST(NearestSurface, NoDataIsReported) {
    Scene scene = sceneOf(*makeSphere({0, 0, 0}, 0.5), 0.5, 16);
    for (DepthMap& map : scene.collider.maps) {
        map.encloses = false;
    }
    EXPECT_EQ(nearestSurface(scene.collider, {5, 5, 5}).map, -1);
    // Outside, without any surface.
    for (DepthMap& map : scene.collider.maps) {
        map.encloses = true;
        std::fill(map.texels.begin(), map.texels.end(), std::byte{0});
    }
    const SurfaceSample nothing = nearestSurface(scene.collider, {0.1F, 0, 0});
    EXPECT_EQ(nothing.distance, kFarOutside);
    EXPECT_EQ(nothing.point, glm::vec3(0.1F, 0, 0));
    EXPECT_EQ(nothing.normal, glm::vec3(0.0F));
    EXPECT_EQ(nothing.map, 0);
}

/// A point for which every map votes only "far outside" still has a distance.
TEST(NearestSurface, HasADistanceFarOutsideAllVolumes) {
    const Scene scene = sceneOf(*makeSphere({0, 0, 0}, 0.9), 0.9, 64);
    for (const glm::vec3& p : {glm::vec3(3, 2, 1.5F), glm::vec3(-1.5F, 1.2F, -2), glm::vec3(10, -10, 5)}) {
        ASSERT_EQ(evaluate(scene.collider, p).distance, kFarOutside);
        EXPECT_NEAR(nearestSurface(scene.collider, p).distance, glm::length(p) - 0.9F, 0.1F * glm::length(p));
    }
}

}  // namespace
}  // namespace relief
