// SPDX-License-Identifier: Apache-2.0
#include "bake/named_maps/highest_below.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "tests/seeds.h"

namespace relief {
namespace {

using Points = std::vector<glm::dvec3>;

Points centred(Points points) {
    glm::dvec3 mean(0.0);
    for (const glm::dvec3& p : points) {
        mean += p / static_cast<double>(points.size());
    }
    for (glm::dvec3& p : points) {
        p -= glm::dvec3(mean.x, mean.y, 0.0);
    }
    return points;
}

/// Height over the origin of the highest plane with these slopes that is below all points.
double heightBelow(const Points& points, double along_x, double along_y) {
    double height = INFINITY;
    for (const glm::dvec3& p : points) {
        height = std::min(height, p.z - along_x * p.x - along_y * p.y);
    }
    return height;
}

/// The highest plane among those through three of the points. One of them is the facet of the hull over the origin.
double highestOfAll(const Points& points) {
    double highest = -INFINITY;
    for (const glm::dvec3& a : points) {
        for (const glm::dvec3& b : points) {
            for (const glm::dvec3& c : points) {
                const glm::dvec3 u = b - a;
                const glm::dvec3 v = c - a;
                const double area = u.x * v.y - u.y * v.x;
                if (std::abs(area) > 1e-9) {
                    highest = std::max(highest, heightBelow(points, (u.z * v.y - v.z * u.y) / area,
                                                            (v.z * u.x - u.z * v.x) / area));
                }
            }
        }
    }
    return highest;
}

Points grid(int side, const auto& height) {
    Points points;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            points.emplace_back(i, j, height(i, j));
        }
    }
    return centred(points);
}

void expectHighest(const Points& points) {
    const glm::dvec2 slope = highestBelow(points).value();
    const double extent =
        1.0 +
        std::abs(std::ranges::max_element(points, {}, [](const glm::dvec3& p) { return std::abs(p.z); })->z);
    EXPECT_NEAR(heightBelow(points, slope.x, slope.y), highestOfAll(points), 1e-7 * extent);
}

TEST(HighestBelow, IsTheBestPlaneThroughThreePoints) {
    std::mt19937_64 random(test::seedFrom(17));
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int round = 0; round < 200; ++round) {
        Points points(static_cast<std::size_t>(3 + round % 14));
        for (glm::dvec3& p : points) {
            p = {number(random), number(random), std::pow(10.0, round % 7 - 3) * number(random)};
        }
        expectHighest(centred(points));
        expectHighest(grid(2 + round % 5, [&](int, int) { return number(random); }));
        // Repeated heights, as on steps.
        expectHighest(grid(2 + round % 5, [&](int, int) { return std::floor(2.0 * number(random)); }));
    }
}

TEST(HighestBelow, MatchesFlatAndTouchesCurvedSurfaces) {
    const std::optional<glm::dvec2> flat =
        highestBelow(grid(4, [](int i, int j) { return 3.0 + 0.5 * i - 2.0 * j; }));
    EXPECT_LT(glm::distance(flat.value(), glm::dvec2(0.5, -2.0)), 1e-9);
    const std::optional<glm::dvec2> hill = highestBelow(grid(4, [](int i, int j) {
        return -(i - 1.5) * (i - 1.5) - (j - 1.5) * (j - 1.5);  // the corners are the hull
    }));
    EXPECT_LT(glm::length(hill.value()), 1e-9);
}

TEST(HighestBelow, CollinearPointsSpanNoPlane) {
    EXPECT_FALSE(highestBelow({}));
    EXPECT_FALSE(highestBelow(Points{{0, 0, 1}}));
    EXPECT_FALSE(highestBelow(Points{{-1, 0, 1}, {1, 0, 2}}));
    EXPECT_FALSE(highestBelow(Points{{-1, -1, 1}, {0, 0, 2}, {1, 1, 0}}));
}

}  // namespace
}  // namespace relief
