// SPDX-License-Identifier: Apache-2.0
// The surface extracted from a collider's field: near closed forms, closed, oriented outwards.
#include "runtime/births/collider_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <numbers>

#include "tests/runtime/collider/analytic_collider.h"

namespace relief {
namespace {

ColliderSurface surfaceOf(const Collider& collider, std::uint32_t cells = kSurfaceCells) {
    auto made = colliderSurface(collider, cells);
    EXPECT_TRUE(made) << made.error().message;
    return made ? std::move(*made) : ColliderSurface{};
}

double areaOf(const ColliderSurface& surface) {
    double area = 0.0;
    for (const glm::uvec3& t : surface.triangles) {
        const glm::dvec3 p(surface.positions[t.x]);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(surface.positions[t.y]) - p,
                                             glm::dvec3(surface.positions[t.z]) - p));
    }
    return area;
}

double volumeOf(const ColliderSurface& surface) {
    double volume = 0.0;
    for (const glm::uvec3& t : surface.triangles) {
        volume +=
            glm::dot(glm::dvec3(surface.positions[t.x]),
                     glm::cross(glm::dvec3(surface.positions[t.y]), glm::dvec3(surface.positions[t.z]))) /
            6.0;
    }
    return volume;
}

/// Every edge of a triangle is the reversed edge of another triangle.
bool isClosed(const ColliderSurface& surface) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (const glm::uvec3& t : surface.triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k];
            const std::uint32_t b = t[(k + 1) % 3];
            sides[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    }
    return std::all_of(sides.begin(), sides.end(), [](const auto& side) { return side.second == 0; });
}

TEST(ColliderSurface, MatchesABall) {
    const ColliderSurface surface =
        surfaceOf(analytic::frontBackCollider(analytic::sphere({1, 2, 3}, 0.5), 256));
    EXPECT_TRUE(isClosed(surface));
    // Texels are planes, 1/256 of the side wide. They deviate from the ball by up to a thousandth at steep angles.
    for (const glm::vec3& p : surface.positions) {
        ASSERT_NEAR(glm::length(glm::dvec3(p) - glm::dvec3(1, 2, 3)), 0.5, 3e-3);
    }
    EXPECT_NEAR(areaOf(surface) / std::numbers::pi, 1.0, 5e-3);
    ColliderSurface centred = surface;
    for (glm::vec3& p : centred.positions) {
        p -= glm::vec3(1, 2, 3);
    }
    EXPECT_NEAR(volumeOf(centred), std::numbers::pi / 6, 2e-3) << "oriented outwards";
}

TEST(ColliderSurface, KeepsTheEdgesOfABox) {
    const glm::dvec3 half(0.5, 0.31, 0.17);
    const ColliderSurface surface = surfaceOf(analytic::frontBackCollider(analytic::box(-half, half), 256));
    EXPECT_TRUE(isClosed(surface));
    const double area = 8 * (half.x * half.y + half.y * half.z + half.z * half.x);
    // A texel at the rim, 1/254 of a side, may be full or empty.
    EXPECT_NEAR(areaOf(surface) / area, 1.0, 8e-3);
    EXPECT_NEAR(volumeOf(surface) / (8 * half.x * half.y * half.z), 1.0, 3e-2);
    for (const glm::vec3& p : surface.positions) {
        const glm::dvec3 from = glm::abs(glm::dvec3(p)) - half;
        ASSERT_NEAR(std::max({from.x, from.y, from.z}), 0.0, 4e-3);
    }
}

TEST(ColliderSurface, MaterialsHaveTheirFractionOfTheArea) {
    const glm::dvec3 half(0.5, 0.3, 0.2);
    Collider box = analytic::frontBackCollider(analytic::box(-half, half), 128);
    // The half with x > 0 is felt.
    box.materials.list = {{"oak"}, {"felt"}};
    box.materials.origin = glm::vec3(-1.0F);
    box.materials.size = 2.0F;
    box.materials.nodes = {{0, {0, 1, 0, 1, 0, 1, 0, 1}}};
    ASSERT_EQ(faultOfMaterials(box.materials), "");
    ColliderSurface felt = surfaceOf(box);
    const double all = areaOf(felt);
    felt.triangles = materialTriangles(felt, box.materials, "felt").value();
    // Grid cells on the border may belong to either side.
    EXPECT_NEAR(areaOf(felt), 0.5 * all, 4.0 * (half.y + half.z) / kSurfaceCells);
    EXPECT_TRUE(std::all_of(felt.triangles.begin(), felt.triangles.end(), [&](const glm::uvec3& t) {
        return felt.positions[t.x].x > -1.1F / kSurfaceCells;
    }));
    ColliderSurface oak = surfaceOf(box);
    oak.triangles = materialTriangles(oak, box.materials, "oak").value();
    EXPECT_NEAR(areaOf(oak) + areaOf(felt), all, 1e-9);
    const auto none = materialTriangles(oak, box.materials, "ice");
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("'ice'"), std::string::npos) << none.error().message;
}

TEST(ColliderSurface, RejectsCollidersWithoutASurface) {
    const Collider ball = analytic::frontBackCollider(analytic::sphere({0, 0, 0}, 0.5), 32);
    EXPECT_FALSE(colliderSurface(ball, 1));
    EXPECT_FALSE(colliderSurface(ball, kSurfaceCellsMax + 1));
    EXPECT_TRUE(colliderSurface(ball, 2));
    Collider empty = ball;
    empty.bounds = {};
    EXPECT_FALSE(colliderSurface(empty));
    empty.bounds = {glm::vec3(0.0F), glm::vec3(std::numeric_limits<float>::infinity())};
    EXPECT_FALSE(colliderSurface(empty));
    // Bounds that do not touch the ball.
    empty.bounds = {glm::vec3(5.0F), glm::vec3(6.0F)};
    EXPECT_FALSE(colliderSurface(empty));
    // The ball lies between grid corners.
    empty.bounds = {glm::vec3(-10.1F), glm::vec3(1e6F)};
    EXPECT_FALSE(colliderSurface(empty));
}

}  // namespace
}  // namespace relief
