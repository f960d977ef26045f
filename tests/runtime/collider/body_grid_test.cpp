// The broad phase against a look at every box.
#include "runtime/collider/body_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <vector>

#include "runtime/particles/random.h"

namespace relief {
namespace {

glm::vec3 inCube(Pcg32& random, float half) {
    return {random.between(-half, half), random.between(-half, half), random.between(-half, half)};
}

bool holds(const BodyBox& box, const glm::vec3& p) {
    return box.unbounded ||
           (glm::all(glm::greaterThanEqual(p, box.low)) && glm::all(glm::lessThanEqual(p, box.high)));
}

/// As shaders/collider/bodies.glsl does it.
std::vector<std::uint32_t> found(const BodyGrid& grid, const glm::vec3& p) {
    std::vector<std::uint32_t> bodies;
    for (const BodyGrid::Level& level : grid.levels) {
        const glm::ivec3 cell(glm::floor(glm::clamp(p * level.cells_per_unit, -1e9F, 1e9F)));
        const std::uint32_t hash = cellHash(cell);
        const glm::uvec3 place = placeInCell(p, level.cells_per_unit, cell);
        const BodyGrid::List& list = grid.lists[level.first + (hash & level.mask)];
        EXPECT_LE(list.first, list.end);
        for (std::uint32_t i = list.first; i < list.end; ++i) {
            const BodyGrid::Entry& entry = grid.entries[i];
            const glm::uvec3 low(entry.low & 255U, entry.low >> 8U & 255U, entry.low >> 16U);
            const glm::uvec3 high(entry.high & 255U, entry.high >> 8U & 255U, entry.high >> 16U);
            if (entry.hash == hash && glm::all(glm::greaterThanEqual(place, low)) &&
                glm::all(glm::lessThanEqual(place, high))) {
                bodies.push_back(entry.body);
            }
        }
    }
    std::ranges::sort(bodies);
    return bodies;
}

/// \param spread  of the logarithms of sizes.
std::vector<BodyBox> randomBoxes(std::uint32_t count, float half, float spread, Pcg32& random) {
    std::vector<BodyBox> boxes;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 at = inCube(random, half);
        const glm::vec3 size = std::exp(random.between(-spread, spread)) * (inCube(random, 0.4F) + 0.5F);
        boxes.push_back({at, at + size, i, random.uniform() < 0.01F});
    }
    return boxes;
}

TEST(BodyGrid, FindsTheBodiesWhoseBoxesHoldAPoint) {
    Pcg32 random(3);
    std::size_t met = 0;
    std::size_t more = 0;
    for (const float half : {1.0F, 30.0F, 5000.0F}) {
        for (const float spread : {0.0F, 2.0F, 12.0F}) {
            const std::vector<BodyBox> boxes = randomBoxes(300, half, spread, random);
            const BodyGrid grid = BodyGrid::of(boxes);
            EXPECT_LE(grid.levels.size(), kGridLevelsMax);
            for (int i = 0; i < 3'000; ++i) {
                // Everywhere, within a box, and in its very corners.
                const BodyBox& box = boxes[random.next() % boxes.size()];
                const glm::vec3 share = inCube(random, 0.5F) + 0.5F;
                const glm::vec3 p = i % 3 == 0   ? inCube(random, 1.2F * half)
                                    : i % 3 == 1 ? box.low + share * (box.high - box.low)
                                                 : glm::mix(box.low, box.high, glm::round(share));
                std::vector<std::uint32_t> expected;
                for (const BodyBox& one : boxes) {
                    if (holds(one, p)) {
                        expected.push_back(one.body);
                    }
                }
                // Boxes are rounded outwards.
                const std::vector<std::uint32_t> asked = found(grid, p);
                ASSERT_TRUE(std::ranges::includes(asked, expected)) << p.x << ' ' << p.y << ' ' << p.z;
                ASSERT_EQ(std::ranges::adjacent_find(asked), asked.end());
                met += expected.size();
                more += asked.size();
            }
        }
    }
    EXPECT_GT(met, 10'000U);
    EXPECT_LT(static_cast<double>(more), 1.4 * static_cast<double>(met));
}

TEST(BodyGrid, AsksFewOfMany) {
    Pcg32 random(5);
    std::vector<BodyBox> boxes;
    for (std::uint32_t i = 0; i < 65'536; ++i) {
        const glm::vec3 at = glm::vec3(500.0F, 5.0F, 500.0F) * inCube(random, 1.0F);
        boxes.push_back({at - 0.5F, at + std::exp(random.between(-1.0F, 0.7F)), i, false});
    }
    boxes.push_back({glm::vec3(-500.0F, -20.0F, -500.0F), glm::vec3(500.0F, 0.0F, 500.0F), 65'536, false});
    const BodyGrid grid = BodyGrid::of(boxes);
    EXPECT_LE(grid.entries.size(), 12 * boxes.size());
    std::size_t asked = 0;
    constexpr int kPoints = 20'000;
    for (int i = 0; i < kPoints; ++i) {
        const glm::vec3 p = glm::vec3(500.0F, 5.0F, 500.0F) * inCube(random, 1.0F);
        for (const BodyGrid::Level& level : grid.levels) {
            const glm::ivec3 cell(glm::floor(p * level.cells_per_unit));
            const BodyGrid::List& list = grid.lists[level.first + (cellHash(cell) & level.mask)];
            asked += list.end - list.first;
        }
    }
    EXPECT_LT(static_cast<double>(asked) / kPoints, 8.0);
}

TEST(BodyGrid, OfNothingIsEmpty) {
    EXPECT_TRUE(BodyGrid::of({}).levels.empty());
    const BodyBox point{.low = glm::vec3(3.0F), .high = glm::vec3(3.0F), .body = 7};
    EXPECT_EQ(found(BodyGrid::of({&point, 1}), glm::vec3(3.0F)), std::vector<std::uint32_t>{7});
}

}  // namespace
}  // namespace relief
