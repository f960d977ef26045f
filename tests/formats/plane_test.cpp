// SPDX-License-Identifier: Apache-2.0
// Votes of planes where analytic_test does not have them, and the helpers that writers of planes use.
#include "formats/plane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

#include "formats/collider.h"
#include "formats/normal_index.h"
#include "formats/validate.h"
#include "tests/formats/analytic_shapes.h"

namespace relief {
namespace {

using namespace test;

TEST(PlaneDecode, VolumeWindowAndEmptyTexelsAreThoseOfProjected) {
    const auto sphere = makeSphere({0, 0, 0}, 0.7);
    std::vector<DepthMap> maps;
    for (const Encoding& e : kOrthographic) {
        maps.push_back(
            makeMap(*sphere, centeredFrame({0, 0, 0}, kTurned, {2, 2.2, 2.4}), e.format, e.compare, 12, 13));
    }
    for (const Compare compare : {Compare::kLess, Compare::kGreater}) {
        maps.push_back(makeMap(*sphere, CubeFrame{{0.9, 0, 0}, kTurned, {1.8, 2.0, 2.2}}, compare, 8));
    }
    std::mt19937 random(9);
    std::uniform_real_distribution<float> within(-2.5F, 2.5F);
    int same = 0;
    for (int i = 0; i < 5000; ++i) {
        const glm::vec3 p(within(random), within(random), within(random));
        for (DepthMap map : maps) {
            for (const int flags : {0, 1, 2, 3}) {
                map.encloses = (flags & 1) != 0;
                map.empty_is_outside = (flags & 2) != 0;
                map.decode = Decode::kProjected;
                const std::optional<Vote> projected = vote(map, p);
                map.decode = Decode::kPlane;
                const std::optional<Vote> plane = vote(map, p);
                ASSERT_EQ(projected.has_value(), plane.has_value());
                if (plane && plane->normal == glm::vec3(0.0F)) {
                    ASSERT_EQ(plane->distance, kFarOutside);
                    ++same;
                }
                if (!map.encloses || !plane) {
                    continue;
                }
                // Step 5: an enclosing map says inside in its volume only.
                const float low = map.projection() == Projection::kCube ? -1.0F : 0.0F;
                const glm::vec3 in_map = map.object_to_map.apply(p);
                if (glm::clamp(in_map, low, 1.0F) != in_map) {
                    ASSERT_GE(plane->distance, 0.0F);
                }
            }
        }
    }
    EXPECT_GT(same, 1000);
}

TEST(TexelRay, IsTheFramesOwnAndMeetsPlanes) {
    const OrthographicFrame frame = centeredFrame({2.0, -1.0, 0.5}, kTurned, {3.0, 1.0, 0.75});
    const DepthMap map = emptyMap(frame, MapFormat::kFixed8, Compare::kGreater, 9, 5);
    for (std::uint32_t y = 0; y < 5; ++y) {
        for (std::uint32_t x = 0; x < 9; ++x) {
            const TexelRay ray = texelRay(map, 0, x, y);
            for (const double depth : {0.0, 0.3, 1.0}) {
                const glm::dvec3 expected = frame.toObject({(x + 0.5) / 9, (y + 0.5) / 5, depth});
                EXPECT_LT(glm::length(ray.at(depth) - expected), 3e-6);
            }
        }
    }
    const CubeFrame cube{{2.0, -1.0, 0.5}, kTurned, {3.0, 1.0, 0.75}};
    const DepthMap cube_map = emptyMap(cube, Compare::kLess, 7);
    for (std::uint32_t texel = 0; texel < 6 * 49; ++texel) {
        const std::uint32_t face = texel / 49;
        const TexelRay ray = texelRay(cube_map, face, texel % 7, texel / 7 % 7);
        const glm::dvec3 unit = glm::normalize(cubeTexelDirection(face, texel % 7, texel / 7 % 7, 7));
        EXPECT_LT(glm::length(ray.at(1.25) - cube.toObject(1.25 * unit)), 5e-6);
        EXPECT_LT(glm::length(ray.origin - cube.center), 3e-6);
        const glm::dvec3 point(1.0, 2.0, 0.1 * texel);
        const glm::dvec3 normal = glm::normalize(unit + glm::dvec3(0.3, -0.2, 0.1));
        EXPECT_NEAR(glm::dot(normal, ray.at(planeDepth(ray, normal, point)) - point), 0.0, 1e-9);
    }
}

TEST(Grazing, ATurnedNormalKeepsItsAngleToTheRayWhenStored) {
    std::mt19937 random(21);
    std::normal_distribution<double> gauss;
    const auto direction = [&] {
        return glm::normalize(glm::dvec3(gauss(random), gauss(random), gauss(random)));
    };
    double worst = 0.0;
    for (int i = 0; i < 200'000; ++i) {
        const glm::dvec3 viewer = direction();
        glm::dvec3 normal = direction();
        if (i % 2 == 0) {  // grazing
            normal = glm::normalize(normal - (glm::dot(normal, viewer) - 0.04 * gauss(random)) * viewer);
        }
        const glm::dvec3 turned = turnedToViewer(3.0 * normal, 5.0 * viewer);
        ASSERT_NEAR(glm::length(turned), 1.0, 1e-12);
        const glm::dvec3 stored = storedNormal(MapFormat::kFixed8, turned);
        worst = std::max(worst, glm::length(stored - turned));
        ASSERT_GE(glm::dot(stored, viewer), double{kPlaneCosineMin});
        if (glm::dot(normal, viewer) > double{kPlaneCosineMin} + kNormalIndexError) {
            ASSERT_LT(glm::length(turned - normal), 1e-12);
        } else {  // no farther than needed: in the plane of both
            ASSERT_NEAR(glm::dot(turned, glm::cross(normal, viewer)), 0.0, 1e-9);
            ASSERT_GT(glm::dot(turned, normal - glm::dot(normal, viewer) * viewer), 0.0);
        }
    }
    EXPECT_LE(worst, kNormalIndexError);
    EXPECT_GT(worst, 0.9 * kNormalIndexError) << "the bound is not what the index needs";
    for (const glm::dvec3& away : {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)}) {
        EXPECT_EQ(turnedToViewer(away, {0, 0, -2}), glm::dvec3(0, 0, -1));
    }
}

}  // namespace
}  // namespace relief
