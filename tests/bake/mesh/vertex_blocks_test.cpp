// SPDX-License-Identifier: Apache-2.0
// The farthest vertex along a direction, against a look at each.
#include "bake/mesh/vertex_blocks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "bake/mesh/triangle_plane.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

std::size_t farthestByLooking(const std::vector<glm::vec3>& positions, const glm::dvec3& direction) {
    std::size_t found = 0;
    for (std::size_t i = 1; i < positions.size(); ++i) {
        if (dot(glm::dvec3(positions[i]), direction) > dot(glm::dvec3(positions[found]), direction)) {
            found = i;
        }
    }
    return found;
}

/// Clouds of many sizes and kinds, along random and axial directions: the same index, ties included.
TEST(VertexBlocks, FindWhatALookAtEachFinds) {
    std::mt19937_64 random(seedFrom(1));
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    for (const std::size_t count : {1U, 2U, 31U, 1000U, 20'000U}) {
        for (int kind = 0; kind < 4; ++kind) {
            std::vector<glm::vec3> positions;
            for (std::size_t i = 0; i < count; ++i) {
                glm::dvec3 p(between(-1, 1), between(-2, 2), between(5, 6));
                if (kind == 1) {
                    p = glm::dvec3(std::round(4 * p.x), std::round(4 * p.y),
                                   std::round(4 * p.z));  // many ties
                } else if (kind == 2) {
                    p.y = 3.0;  // flat
                } else if (kind == 3) {
                    p *= 1e15 / 8.0;  // as far as a mesh may reach
                }
                positions.emplace_back(p);
            }
            const VertexBlocks blocks(positions);
            for (int i = 0; i < 60; ++i) {
                glm::dvec3 direction(between(-1, 1), between(-1, 1), between(-1, 1));
                if (i % 3 == 0) {
                    direction =
                        glm::dvec3(std::round(direction.x), std::round(direction.y), std::round(direction.z));
                }
                ASSERT_EQ(blocks.farthest(direction), farthestByLooking(positions, direction))
                    << count << " positions of kind " << kind << " along " << direction.x << ' '
                    << direction.y << ' ' << direction.z;
            }
        }
    }
}

}  // namespace
}  // namespace relief::test
