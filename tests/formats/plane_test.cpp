// SPDX-License-Identifier: Apache-2.0
// Plane votes that analytic_test does not cover, and texel rays.
#include "formats/plane.h"

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

#include "formats/collider.h"
#include "tests/formats/analytic_shapes.h"

namespace relief {
namespace {

using namespace test;

TEST(PlaneDecode, VolumeWindowAndEmptyTexelsMatchProjected) {
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
                // Step 5: an enclosing map votes inside only within its volume.
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

TEST(TexelRay, MatchesTheFrame) {
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
    }
}

}  // namespace
}  // namespace relief
