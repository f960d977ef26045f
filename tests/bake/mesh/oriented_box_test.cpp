// SPDX-License-Identifier: Apache-2.0
// The axes of the oriented box, against shapes whose least box is known and against random frames, and on points without a
// volume; then what the planner makes of them.
#include "bake/mesh/oriented_box.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <random>

#include "bake/measure/accuracy.h"
#include "bake/plan/view.h"
#include "tests/bake/meshes.h"
#include "tests/bake/plan_views.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

const glm::dmat3 kTurned = rotation({1, 2, 3}, 33.0) * rotation({0, 1, 0}, 17.0);

std::vector<glm::dvec3> verticesOf(const TriangleMesh& mesh) {
    return extremeVertices(VertexBlocks(mesh.positions));
}

double largestCosine(const glm::dvec3& direction, const glm::dmat3& axes) {
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
        largest = std::max(largest, std::abs(glm::dot(glm::normalize(direction), axes[i])));
    }
    return largest;
}

double volumeAlong(const std::vector<glm::dvec3>& points, const std::array<glm::dvec3, 3>& axes) {
    double volume = 1.0;
    for (const glm::dvec3& axis : axes) {
        const auto [low, high] =
            std::ranges::minmax_element(points, {}, [&](const glm::dvec3& p) { return glm::dot(p, axis); });
        volume *= glm::dot(*high - *low, axis);
    }
    return volume;
}

double leastVolume(const std::vector<glm::dvec3>& points) {
    const auto axes = orientedBoxAxes(points);
    EXPECT_TRUE(axes);
    return axes ? volumeAlong(points, *axes) : 0.0;
}

/// Uniform over all rotations: a unit quaternion by rejection.
glm::dmat3 randomTurn(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    while (true) {
        const double w = unit(random);
        const double x = unit(random);
        const double y = unit(random);
        const double z = unit(random);
        const double s = w * w + x * x + y * y + z * z;
        if (s > 0.01 && s < 1.0) {
            return {1 - 2 * (y * y + z * z) / s, 2 * (x * y + z * w) / s,     2 * (x * z - y * w) / s,
                    2 * (x * y - z * w) / s,     1 - 2 * (x * x + z * z) / s, 2 * (y * z + x * w) / s,
                    2 * (x * z + y * w) / s,     2 * (y * z - x * w) / s,     1 - 2 * (x * x + y * y) / s};
        }
    }
}

std::vector<glm::dvec3> turned(std::vector<glm::dvec3> points, const glm::dmat3& turn) {
    for (glm::dvec3& p : points) {
        p = glm::dvec3(3, -5, 2) + turn * p;
    }
    return points;
}

// Breaks when a face or an edge of the hull is missed, or when the search stops short of a minimum.
TEST(OrientedBox, HasTheLeastVolume) {
    std::vector<glm::dvec3> box;
    for (int corner = 0; corner < 8; ++corner) {
        box.emplace_back((corner & 1) * 0.7, (corner & 2) * 0.5, (corner & 4) * 0.01);
    }
    // No face of the least box holds a face of a regular tetrahedron: each holds an edge, which is its diagonal.
    const std::vector<glm::dvec3> tetrahedron = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    constexpr int kSides = 36;
    std::vector<glm::dvec3> cylinder;
    for (int i = 0; i < kSides; ++i) {
        const double angle = 2.0 * glm::pi<double>() * i / kSides;
        for (const double z : {-2.0, 2.0}) {
            cylinder.emplace_back(std::cos(angle), std::sin(angle), z);
        }
    }
    const double width = 2.0 * std::cos(glm::pi<double>() / kSides);  // between opposite sides
    std::mt19937 random(seedFrom(11));
    for (int i = 0; i < 20; ++i) {
        const glm::dmat3 turn = randomTurn(random);
        EXPECT_NEAR(leastVolume(turned(box, turn)), 0.7 * 1.0 * 0.04, 1e-9);
        EXPECT_NEAR(leastVolume(turned(tetrahedron, turn)), 8.0, 1e-5);
        EXPECT_NEAR(leastVolume(turned(cylinder, turn)), 4.0 * width * width, 1e-6);
    }
}

TEST(OrientedBox, NoRandomFrameHasASmallerBox) {
    std::mt19937 random(seedFrom(12));
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (const std::size_t count :
         {std::size_t{4}, std::size_t{5}, std::size_t{7}, std::size_t{12}, std::size_t{100}}) {
        for (int repeat = 0; repeat < 4; ++repeat) {
            std::vector<glm::dvec3> points(count);
            for (glm::dvec3& p : points) {
                p = {unit(random), 0.7 * unit(random), 0.4 * unit(random)};
            }
            double random_least = std::numeric_limits<double>::infinity();
            for (int i = 0; i < 5'000; ++i) {
                const glm::dmat3 turn = randomTurn(random);
                random_least = std::min(random_least, volumeAlong(points, {turn[0], turn[1], turn[2]}));
            }
            EXPECT_LE(leastVolume(points), random_least) << count << " points";
        }
    }
}

TEST(OrientedBox, FindsTheAxesOfATurnedBox) {
    const TriangleMesh mesh = makeBoxMesh({5, -2, 1}, {1, 3, 2}, kTurned);
    const auto axes = orientedBoxAxes(verticesOf(mesh)).value();
    const int sorted[] = {1, 2, 0};  // the longest side first
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 wanted = kTurned[sorted[i]];
        EXPECT_LT(glm::length(glm::cross(axes[i], wanted)), 1e-5) << i;
        EXPECT_NEAR(glm::length(axes[i]), 1.0, 1e-12);
    }
    EXPECT_NEAR(glm::dot(glm::cross(axes[0], axes[1]), axes[2]), 1.0, 1e-6) << "right-handed";
}

TEST(OrientedBox, AxesOfSpaceAreExact) {
    const auto axes = orientedBoxAxes(verticesOf(makeBoxMesh({0.1, 0.2, 0.3}, {3, 1, 2}))).value();
    EXPECT_EQ(glm::abs(axes[0]), glm::dvec3(1, 0, 0));
    EXPECT_EQ(glm::abs(axes[1]), glm::dvec3(0, 0, 1));
    EXPECT_EQ(glm::abs(axes[2]), glm::dvec3(0, 1, 0));
}

TEST(OrientedBox, WithoutVolumeThereIsNone) {
    EXPECT_FALSE(orientedBoxAxes({}));
    EXPECT_FALSE(orientedBoxAxes(std::vector<glm::dvec3>(100, glm::dvec3(1, 2, 3))));
    EXPECT_FALSE(orientedBoxAxes(verticesOf(makePlane(3.0F, 10))));
    std::vector<glm::dvec3> line;
    std::vector<glm::dvec3> plane;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 50; ++i) {
        const double a = unit(random);
        line.emplace_back(a, 2 * a, -3 * a);
        plane.push_back(kTurned * glm::dvec3(a, unit(random), 0.0));
    }
    EXPECT_FALSE(orientedBoxAxes(line));
    EXPECT_FALSE(orientedBoxAxes(plane));
    EXPECT_FALSE(
        orientedBoxAxes(std::vector<glm::dvec3>{{0, 0, 0}, {1e308, 0, 0}, {0, 1e308, 0}, {-1e308, 0, 1e308}}))
        << "a size beyond double";
    // Hardly any volume, of any size: whatever comes back, nothing breaks.
    for (const double thickness : {1e-2, 1e-4, 1e-6, 1e-9, 1e-15}) {
        for (const double size : {1e-30, 1.0, 1e30}) {
            std::vector<glm::dvec3> thin(20);
            for (glm::dvec3& p : thin) {
                p = size *
                    (kTurned * glm::dvec3(unit(random), std::round(unit(random)), thickness * unit(random)));
            }
            if (const auto axes = orientedBoxAxes(thin)) {
                for (std::size_t i = 0; i < 3; ++i) {
                    EXPECT_NEAR(glm::length((*axes)[i]), 1.0, 1e-9);
                }
            }
        }
    }
}

TEST(OrientedBox, PlannedViewsLookAlongTheWallsOfATurnedPart) {
    const TriangleMesh mesh = makeBoxMesh({0, 0, 0}, {1, 0.6, 0.3}, kTurned);
    const MeshQuery query = queryOf(mesh);
    const TruthSamples truth = sampleTruth(query, {.samples = 30'000});
    double wrong[2] = {};
    for (const bool oriented_box : {false, true}) {
        PlanOptions options;
        options.budget_bytes = 16'000;
        options.views.oriented_box = oriented_box;
        const Plan plan = required(planViews(query, options));
        if (oriented_box) {
            // The first view, which serves most, looks along a wall and is turned with the others.
            const MapSpec& first = plan.maps.front().spec;
            EXPECT_GT(largestCosine(first.direction, kTurned), 1.0 - 1e-6);
            EXPECT_GT(
                largestCosine(required(makeView(*completeSpec(first, mesh, 64), mesh)).axis[0], kTurned),
                1.0 - 1e-6);
        }
        wrong[oriented_box ? 1 : 0] =
            measureField(truth, fieldOf(bakeMaps(mesh, specsOf(plan)))).near.total();
    }
    EXPECT_LT(wrong[1], 0.85 * wrong[0]);
}

}  // namespace
}  // namespace relief::test
