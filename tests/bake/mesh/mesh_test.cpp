// SPDX-License-Identifier: Apache-2.0
// Triangles by area, ray costs, surface parts, random numbers, and many Embree scenes.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "bake/mesh/mersenne.h"
#include "bake/mesh/mesh.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_parts.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/mesh/triangle_plane.h"
#include "tests/bake/meshes.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

TEST(AreaTable, FindsTrianglesByAreaFraction) {
    std::mt19937_64 random(seedFrom(1));
    for (const TriangleMesh& mesh : {makeBoxMesh({0, 0, 0}, {1, 2, 3}), makeTorusMesh(1.0, 0.3, 60, 41)}) {
        const AreaTable areas(mesh);
        std::vector<double> up_to;
        double sum = 0.0;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const glm::dvec3 normal = planeOf(mesh, i).normal;
            up_to.push_back(sum += std::sqrt(dot(normal, normal)));
        }
        for (int repeat = 0; repeat < 3000; ++repeat) {
            const double share = repeat == 0   ? 0.0
                                 : repeat == 1 ? 1.0
                                               : std::uniform_real_distribution(0.0, 1.0)(random);
            std::uint32_t expected = 0;
            while (expected + 1 < up_to.size() && !(up_to[expected] > share * sum)) {
                ++expected;
            }
            ASSERT_EQ(areas.triangleAt(share), expected) << share;
        }
    }
}

// As many meshes at once as a level can have. With one Embree device per mesh, the thousandth would fail.
TEST(EmbreeMesh, ThousandsCoexist) {
    std::vector<MeshQuery> queries;
    for (int i = 0; i < 2500; ++i) {
        queries.push_back(queryOf(makeIcosphere(glm::dvec3(double(i), 0.0, 0.0), 1.0, 0)));
    }
    EXPECT_TRUE(queries[0].inside(glm::vec3(0.0F)));
    EXPECT_TRUE(queries[2499].inside(glm::vec3(2499.0F, 0.0F, 0.0F)));
    EXPECT_FALSE(queries[2499].inside(glm::vec3(0.0F)));
}

TEST(Mersenne64, MatchesTheStandardLibrary) {
    for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{5489},
                                     std::uint64_t{0x9e3779b97f4a7c15U}, ~std::uint64_t{0}}) {
        Mersenne64 ours(seed);
        std::mt19937_64 theirs(seed);
        for (int i = 0; i < 2000; ++i) {  // six refills of the state
            ASSERT_EQ(ours(), theirs()) << "number " << i << " of seed " << seed;
        }
    }
}

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

SurfacePart part(const glm::vec3& low, const glm::vec3& high, double area) {
    SurfacePart made;
    made.bounds = {low, high};
    made.area = area;
    made.triangles = 1;
    return made;
}

TEST(SurfaceParts, OutliersAreFarAndSmall) {
    const SurfacePart body = part(glm::vec3(-5.0F), glm::vec3(5.0F), 600.0);
    const SurfacePart knob = part(glm::vec3(5.0F), glm::vec3(6.0F), 0.1);
    const SurfacePart stray = part(glm::vec3(1e6F, 0.0F, 0.0F), glm::vec3(1e6F, 1.0F, 1.0F), 0.5);
    const OutlierParts found = findOutlierParts({stray, body, knob});
    EXPECT_EQ(found.parts, std::vector<std::uint32_t>({0}));
    EXPECT_EQ(found.rest.max, glm::vec3(6.0F));

    EXPECT_TRUE(findOutlierParts({body, knob}).parts.empty());
    EXPECT_TRUE(findOutlierParts({body}).parts.empty());
    EXPECT_TRUE(findOutlierParts({}).parts.empty());
    // Two boxes 100 km apart are a scene of two boxes, not outliers.
    EXPECT_TRUE(
        findOutlierParts({body, part(glm::vec3(1e5F), glm::vec3(1e5F + 10.0F), 600.0)}).parts.empty());
    // A small part within one body length belongs to the body.
    EXPECT_TRUE(findOutlierParts({body, part(glm::vec3(12.0F), glm::vec3(13.0F), 0.1)}).parts.empty());
}

TEST(SurfaceParts, LabelsSplitPieces) {
    TriangleMesh mesh = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0));
    mesh.surface_names = {{3, "box", "wood"}, {3, "box", "glass"}};
    mesh.labels.assign(12, 0);
    mesh.labels[5] = 1;
    SurfaceParts found;
    found.add(mesh, {0, 1, 2, 3, 4, 5, 6}, PartKind::kSheet);
    ASSERT_EQ(found.parts.size(), 2U);
    EXPECT_EQ(found.parts[0].triangles, 6U);
    EXPECT_EQ(found.parts[1].material, "glass");
    EXPECT_EQ(found.parts[1].node_index, 3U);
    EXPECT_DOUBLE_EQ(found.parts[1].area, 2.0);
    EXPECT_EQ(found.part_of[5], 1U);
    EXPECT_EQ(found.part_of[7], kNoLabel);
}

}  // namespace
}  // namespace relief::test
