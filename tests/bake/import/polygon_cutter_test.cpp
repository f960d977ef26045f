// SPDX-License-Identifier: Apache-2.0
// Polygons are triangulated without gaps and overlaps, also far from the origin.
#include "bake/import/polygon_cutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "bake/mesh/triangle_plane.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

/// Twice the area vector of a polygon.
double areaOf(const std::vector<glm::vec3>& corners) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum += planeOf(corners[0], corners[i], corners[i + 1]).normal;
    }
    return length(sum);
}

/// Expects triangles with positive areas and the polygon's winding, whose areas sum to that of the polygon.
void expectWhole(const std::vector<glm::vec3>& corners, const std::string& what, double tolerance = 1e-3) {
    PolygonCutter cutter;
    const auto triangles = cutter.cut(corners);
    ASSERT_EQ(triangles.size(), corners.size() - 2) << what;
    glm::dvec3 sum(0.0);
    double areas = 0.0;
    for (const glm::uvec3& t : triangles) {
        const TrianglePlane plane = planeOf(corners, t);
        EXPECT_TRUE(hasArea(plane)) << what;
        areas += length(plane.normal);
        sum += plane.normal;
    }
    EXPECT_NEAR(areas, length(sum), tolerance * areas) << what << ": some triangles are reversed";
    EXPECT_NEAR(areas, areaOf(corners), tolerance * areas) << what;
}

/// A rectangle with `more` extra vertices on its edges.
std::vector<glm::vec3> rectangle(int more, const glm::dvec3& origin, const glm::dvec3& u,
                                 const glm::dvec3& v) {
    std::vector<glm::vec3> corners;
    const glm::dvec3 ends[4] = {origin, origin + u, origin + u + v, origin + v};
    for (int side = 0; side < 4; ++side) {
        const glm::dvec3 step = (ends[(side + 1) % 4] - ends[side]) / (more + 1.0);
        for (int i = 0; i <= more; ++i) {
            corners.emplace_back(ends[side] + static_cast<double>(i) * step);
        }
    }
    return corners;
}

TEST(PolygonCutter, CornersOnStraightEdges) {
    for (const double far : {0.0, 1.4e5, -1.4e5, 1e7}) {
        for (const int more : {1, 2, 7}) {
            const double size = std::max(1.0, std::abs(far) * 1e-5) * (more + 1);
            const glm::dvec3 origin(far, 0.3 * far, -far);
            const std::string what = std::to_string(far) + ", " + std::to_string(more);
            expectWhole(rectangle(more, origin, {size, 0, 0}, {0, size, 0}), what);
            expectWhole(rectangle(more, origin, {0, 0, size}, {size, 0, 0}), what);
        }
    }
    // A triangle with an extra vertex on any edge.
    for (int i = 0; i < 3; ++i) {
        std::vector<glm::vec3> corners{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
        corners.insert(corners.begin() + i + 1, 0.5F * (corners[i] + corners[(i + 1) % 3]));
        for (int turn = 0; turn < 4; ++turn) {
            std::rotate(corners.begin(), corners.begin() + 1, corners.end());
            expectWhole(corners, std::to_string(i) + ", " + std::to_string(turn));
        }
    }
}

TEST(PolygonCutter, ConcavePolygonsFarFromTheOrigin) {
    for (std::uint32_t seed = seedFrom(31), end = seed + 200; seed < end; ++seed) {
        // A star with random radii, which does not intersect itself.
        std::mt19937 random(seed);
        const int count = 5 + static_cast<int>(random() % 40);
        const double far = (seed % 4) * 1.4e5;
        std::vector<glm::vec3> corners;
        for (int i = 0; i < count; ++i) {
            const double angle = 6.283185307179586 * i / count;
            const double radius = 200.0 + static_cast<double>(random() % 1000);
            const glm::dvec3 p(radius * std::cos(angle), radius * std::sin(angle), 0.0);
            corners.emplace_back(p.x + far, p.z - far, p.y + 2.0 * far);
        }
        expectWhole(corners, "seed " + std::to_string(seed));
    }
}

TEST(PolygonCutter, DegeneratePolygonsAreTriangulated) {
    PolygonCutter cutter;
    const std::vector<glm::vec3> knot{{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}, {2, 9, 0}};
    const std::vector<glm::vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}};
    const std::vector<glm::vec3> nowhere(7, glm::vec3(NAN));
    for (const auto& corners : {knot, line, nowhere, std::vector<glm::vec3>(4, glm::vec3(1))}) {
        const auto triangles = cutter.cut(corners);
        ASSERT_EQ(triangles.size(), corners.size() - 2);
        for (const glm::uvec3& t : triangles) {
            EXPECT_LT(std::max({t.x, t.y, t.z}), corners.size());
        }
    }
}

TEST(PolygonCutter, CombWithThousandsOfTeethIsTriangulated) {
    // A quadratic search for ears among 8,000 vertices took most of a minute.
    constexpr int kTeeth = 2000;
    std::vector<glm::vec3> corners;
    for (int i = 0; i < kTeeth; ++i) {
        const auto x = static_cast<float>(2 * i);
        corners.emplace_back(x, 5.0F, 0.0F);
        corners.emplace_back(x + 1.0F, 0.0F, 0.0F);
    }
    corners.emplace_back(2.0F * kTeeth, 5.0F, 0.0F);
    corners.emplace_back(2.0F * kTeeth, -1.0F, 0.0F);
    corners.emplace_back(0.0F, -1.0F, 0.0F);
    expectWhole(corners, "comb", 1e-6);
}

TEST(PolygonCutter, SelfIntersectingPolygonLosesNoTriangles) {
    // An incomplete first attempt must not be preferred to a complete one.
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    PolygonCutter cutter;
    for (int round = 0; round < 3000; ++round) {
        std::vector<glm::vec3> corners(static_cast<std::size_t>(5 + round % 12));
        for (glm::vec3& corner : corners) {
            corner = {unit(random), unit(random), 0.0F};
        }
        EXPECT_EQ(cutter.cut(corners).size(), corners.size() - 2) << "round " << round;
    }
}

}  // namespace
}  // namespace relief::test
