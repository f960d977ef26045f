// SPDX-License-Identifier: Apache-2.0
// The broad phase against a test of every box.
#include "runtime/bodies/body_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "runtime/particles/random.h"

namespace relief {
namespace {

glm::vec3 inCube(Pcg32& random, float half) {
    return {random.between(-half, half), random.between(-half, half), random.between(-half, half)};
}

/// Coordinates relative to the centre of a box, in half edges: from −1 to 1 inside.
glm::vec3 inBox(const BodyBox& box, const glm::vec3& p) {
    return glm::inverse(box.half) * (p - box.center);
}

bool holds(const BodyBox& box, const glm::vec3& p) {
    const glm::vec3 at = glm::abs(inBox(box, p));
    return box.unbounded || std::max({at.x, at.y, at.z}) <= 1.0F;
}

/// The same lookup as in shaders/bodies/bodies.glsl.
std::vector<std::uint32_t> found(const BodyGrid& grid, const glm::vec3& p) {
    std::vector<std::uint32_t> bodies;
    for (const BodyGrid::Level& level : grid.levels) {
        const std::uint32_t hash =
            cellHash(glm::ivec3(glm::floor(glm::clamp(p * level.cells_per_unit, -1e9F, 1e9F))));
        const BodyGrid::List& list = grid.lists[level.first + (hash & level.mask)];
        EXPECT_LE(list.first, list.end);
        for (std::uint32_t i = list.first; i < list.end; ++i) {
            if (grid.entries[i].hash == hash) {
                bodies.push_back(grid.entries[i].body);
            }
        }
    }
    std::ranges::sort(bodies);
    return bodies;
}

glm::mat3 randomTurn(Pcg32& random) {
    return glm::mat3_cast(glm::normalize(
        glm::quat(random.signedUniform(), random.signedUniform(), random.signedUniform(), 0.1F)));
}

/// With random rotations.
/// \param spread  of the logarithms of sizes.
std::vector<BodyBox> randomBoxes(std::uint32_t count, float half, float spread, Pcg32& random) {
    std::vector<BodyBox> boxes;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 size = std::exp(random.between(-spread, spread)) * (inCube(random, 0.2F) + 0.25F);
        glm::mat3 axes = randomTurn(random);
        for (int k = 0; k < 3; ++k) {
            axes[k] *= size[k];
        }
        const glm::vec3 center = inCube(random, half);
        boxes.push_back({center, axes, 1e-6F * half, i, random.uniform() < 0.01F});
    }
    return boxes;
}

TEST(BodyGrid, FindsTheBodiesWhoseBoxesContainAPoint) {
    Pcg32 random(3);
    std::size_t met = 0;
    for (const float half : {1.0F, 30.0F, 5000.0F}) {
        for (const float spread : {0.0F, 2.0F, 12.0F}) {
            const std::vector<BodyBox> boxes = randomBoxes(300, half, spread, random);
            const BodyGrid grid = BodyGrid::of(boxes, spread < 1.0F ? 0.25F : 1.4F);
            EXPECT_LE(grid.levels.size(), kGridLevelsMax);
            for (int i = 0; i < 600; ++i) {
                // Anywhere, within a box, and exactly at its corners.
                const BodyBox& box = boxes[random.next() % boxes.size()];
                const glm::vec3 at = inCube(random, 1.0F);
                const glm::vec3 p = i % 3 == 0   ? inCube(random, 1.2F * half)
                                    : i % 3 == 1 ? box.center + box.half * at
                                                 : box.center + box.half * (0.9999F * glm::sign(at));
                std::vector<std::uint32_t> expected;
                for (const BodyBox& one : boxes) {
                    if (holds(one, p)) {
                        expected.push_back(one.body);
                    }
                }
                // A cell lists more bodies than those whose boxes contain the point.
                const std::vector<std::uint32_t> candidates = found(grid, p);
                ASSERT_TRUE(std::ranges::includes(candidates, expected)) << p.x << ' ' << p.y << ' ' << p.z;
                ASSERT_EQ(std::ranges::adjacent_find(candidates), candidates.end());
                met += expected.size();
            }
        }
    }
    EXPECT_GT(met, 2'000U);
}

BodyBox along(const glm::vec3& low, const glm::vec3& size, std::uint32_t body) {
    const glm::vec3 half = 0.5F * size;
    return {low + half, {half.x, 0, 0, 0, half.y, 0, 0, 0, half.z}, 0.0F, body, false};
}

TEST(BodyGrid, TestsFewBodiesOfMany) {
    Pcg32 random(5);
    std::vector<BodyBox> boxes;
    const glm::vec3 spread(500.0F, 5.0F, 500.0F);
    for (std::uint32_t i = 0; i < 65'536; ++i) {
        const float side = 0.5F + std::exp(random.between(-1.0F, 0.7F));
        boxes.push_back(along(spread * inCube(random, 1.0F) - 0.5F, glm::vec3(side), i));
    }
    boxes.push_back(along(glm::vec3(-500.0F, -20.0F, -500.0F), glm::vec3(1000.0F, 20.0F, 1000.0F), 65'536));
    const BodyGrid grid = BodyGrid::of(boxes, 0.5F);
    EXPECT_LE(grid.entries.size(), 30 * boxes.size());
    std::size_t tested = 0;
    constexpr int kPoints = 5'000;
    for (int i = 0; i < kPoints; ++i) {
        const glm::vec3 p = spread * inCube(random, 1.0F);
        for (const BodyGrid::Level& level : grid.levels) {
            const glm::ivec3 cell(glm::floor(p * level.cells_per_unit));
            const BodyGrid::List& list = grid.lists[level.first + (cellHash(cell) & level.mask)];
            tested += list.end - list.first;
        }
    }
    EXPECT_LT(static_cast<double>(tested) / kPoints, 5.0);
}

TEST(BodyGrid, LongBodiesOccupyOnlyCellsAlongThem) {
    // A needle through a cube of 40³ cells: its axis-aligned box contains 64,000.
    BodyBox needle;
    const glm::vec3 way = glm::normalize(glm::vec3(1.0F));
    const glm::vec3 across = glm::normalize(glm::vec3(1.0F, -1.0F, 0.0F));
    needle.half = {10.0F * way, 0.01F * across, 0.01F * glm::cross(way, across)};
    const BodyGrid grid = BodyGrid::of({&needle, 1}, 0.02F);
    EXPECT_LT(grid.entries.size(), 400U);
    for (float at = -1.0F; at <= 1.0F; at += 0.001F) {
        ASSERT_EQ(found(grid, at * needle.half[0]), std::vector<std::uint32_t>{0});
    }
}

TEST(BodyGrid, NoBodiesMakeAnEmptyGrid) {
    EXPECT_TRUE(BodyGrid::of({}, 0.25F).levels.empty());
    const BodyBox point{.center = glm::vec3(3.0F), .body = 7};
    EXPECT_EQ(found(BodyGrid::of({&point, 1}, 0.25F), glm::vec3(3.0F)), std::vector<std::uint32_t>{7});
}

}  // namespace
}  // namespace relief
