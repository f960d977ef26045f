// SPDX-License-Identifier: Apache-2.0
// Estimated ray costs, compared with manual counts.
#include "bake/mesh/ray_cost.h"

#include <cmath>
#include <numbers>

#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

TEST(RayCost, BoxCountsTwoFacesTwice) {
    // The bounds of both triangles of a face equal the face, and a line crosses two faces.
    EXPECT_NEAR(boxesOnLine(makeBoxMesh({1, 2, 3}, {1, 2, 3})), 4.0, 1e-6);
    const TriangleMesh fine_ball = makeIcosphere({0, 0, 0}, 1.0, 5);
    EXPECT_LT(boxesOnLine(fine_ball), 8.0);
    EXPECT_EQ(affordableRays(fine_ball), 1.0);
}

TEST(RayCost, FanCountsMostTriangles) {
    constexpr unsigned kBlades = 2000;
    std::vector<glm::vec3> positions = {{0, 1, 0}};
    std::vector<glm::uvec3> triangles;
    for (unsigned i = 0; i < kBlades; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kBlades;
        positions.emplace_back(std::cos(angle), 0.0, std::sin(angle));
        triangles.emplace_back(0, 1 + i, 1 + (i + 1) % kBlades);
    }
    const TriangleMesh fan = finished(std::move(positions), std::move(triangles));
    const double boxes = boxesOnLine(fan);
    EXPECT_GT(boxes, 0.1 * kBlades);
    EXPECT_LT(boxes, 1.0 * kBlades);
    EXPECT_NEAR(affordableRays(fan) * boxes, 32.0, 1e-9);
}

}  // namespace
}  // namespace relief::test
