// SPDX-License-Identifier: Apache-2.0
// The bodies of a world: their broad phase against a test of every box, the words for the GPU and which of them change,
// and pose keys, checked by differences.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <vector>

#include "runtime/bodies/body_grid.h"
#include "runtime/bodies/body_table.h"
#include "runtime/bodies/pose_keys.h"
#include "runtime/bodies/world_bodies.h"
#include "runtime/particles/random.h"
#include "shaders/bodies/constants.h"
#include "tests/runtime/bodies/three_bodies.h"

namespace relief::test {
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

std::vector<TableBody> row(std::size_t count) {
    std::vector<TableBody> bodies(count);
    for (std::size_t i = 0; i < count; ++i) {
        bodies[i].pose.position.x = 3.0F * static_cast<float>(i);
        bodies[i].maps = 1;
        bodies[i].box = Bounds{glm::vec3(-1.0F), glm::vec3(1.0F)};
    }
    return bodies;
}

BlockBody blockOf(const BodyTable& table, std::size_t body) {
    const auto first = static_cast<std::size_t>(table.block()[0].y);
    BlockBody block{};
    std::memcpy(&block, &table.words()[first + kWorldBodyTexels * body], sizeof(block));
    return block;
}

bool rests(const BlockBody& block) {
    return block.response.w == 0.0F;
}

/// One map shared by all bodies, whose space is the object's.
std::vector<BlockMap> oneMap() {
    BlockMap map{};
    for (int i = 0; i < 3; ++i) {
        map.row[i][i] = map.column[i][i] = map.object_per_map[i] = 1.0F;
    }
    return {map};
}

glm::vec3 through(const glm::vec4 (&rows)[3], const glm::vec3& p) {
    const glm::vec4 at(p, 1.0F);
    return {glm::dot(rows[0], at), glm::dot(rows[1], at), glm::dot(rows[2], at)};
}

TEST(BodyTable, StoppedBodiesAreAtRestAStepLater) {
    BodyTable table(oneMap(), row(1'000), true);
    EXPECT_TRUE(table.isNew());
    static_cast<void>(table.takeChanges());
    std::vector<Pose> poses(3);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        poses[i] = table[i].pose;
    }
    EXPECT_FALSE(table.setPoses(poses));
    EXPECT_TRUE(table.takeChanges().empty());

    poses[2].position.y = 1.0F;
    EXPECT_TRUE(table.setPoses(poses));
    EXPECT_FALSE(rests(blockOf(table, 2)));
    EXPECT_TRUE(rests(blockOf(table, 1)));
    EXPECT_TRUE(table.isNew());  // it has left the grid of resting bodies
    static_cast<void>(table.takeChanges());

    EXPECT_FALSE(table.setPoses({}));  // it stops
    EXPECT_TRUE(rests(blockOf(table, 2)));
    EXPECT_EQ(table[2].pose.position.y, 1.0F);
    EXPECT_FALSE(table.isNew());
    EXPECT_EQ(table.takeChanges().size(), 2U);  // the body and its maps
    EXPECT_FALSE(table.setPoses({}));
    EXPECT_TRUE(table.takeChanges().empty());

    poses[2].position.y = 2.0F;
    EXPECT_TRUE(table.setPoses(poses));
    EXPECT_FALSE(table.isNew());
    std::size_t rows = 0;
    for (const BodyTable::Rows& changed : table.takeChanges()) {
        rows += changed.end - changed.first;
    }
    EXPECT_LE(rows, 4U);  // of about a hundred
}

TEST(BodyTable, PlacedMapsAndMovesFollowThePoses) {
    BodyTable table(oneMap(), row(3), true);
    const Pose from{{5.0F, -2.0F, 1.0F}, glm::normalize(glm::quat(1.0F, 0.2F, -0.5F, 0.3F)), 2.0F};
    const Pose to{{4.0F, -1.0F, 1.5F}, glm::normalize(glm::quat(0.3F, 1.0F, 0.1F, 0.0F)), 3.0F};
    const std::vector<Pose> at_first{table[0].pose, from};
    const std::vector<Pose> later{table[0].pose, to};
    EXPECT_TRUE(table.setPoses(at_first));
    EXPECT_TRUE(table.setPoses(later));
    const BlockBody body = blockOf(table, 1);
    BlockMap map;
    std::memcpy(&map, &table.words()[kWorldMapTexels * body.maps[0]], sizeof(map));
    EXPECT_EQ(body.maps[0], 1);
    EXPECT_EQ(map.object_per_map.x, 3.0F);
    for (const glm::vec3& p : {glm::vec3(0.0F), glm::vec3(1.0F, 2.0F, 3.0F), glm::vec3(-7.0F, 0.5F, 0.0F)}) {
        EXPECT_LT(glm::distance(through(body.move, toWorld(from, p)), toWorld(to, p)), 1e-5F);
        EXPECT_LT(glm::distance(through(body.row, toWorld(to, p)), p), 1e-5F);
        EXPECT_LT(glm::distance(through(map.row, toWorld(to, p)), p), 1e-5F);
        // The columns map a step in map space to the world.
        const glm::vec3 step =
            glm::mat3(glm::vec3(map.column[0]), glm::vec3(map.column[1]), glm::vec3(map.column[2])) * p;
        EXPECT_LT(glm::distance(step, toWorld(to, p) - to.position), 1e-5F);
    }
}

TEST(BodyTable, TextureIsNoHigherThanWide) {
    for (const std::size_t count : {1U, 7U, 300U, 65'536U}) {
        const BodyTable table(oneMap(), row(count), true);
        const std::size_t width = std::size_t{1} << table.log2Width();
        EXPECT_EQ(table.words().size() % width, 0U);
        EXPECT_LE(table.words().size() / width, width);
        EXPECT_LE(width, 2048U);  // guaranteed by OpenGL ES 3.0
        EXPECT_EQ(table.block().size(), 1U + kWorldLevels);
    }
}

Pose pose(const glm::vec3& position, const glm::vec3& axis, float angle) {
    return {position, glm::angleAxis(angle, glm::normalize(axis)), 2.0F};
}

std::vector<PoseKey> path() {
    return {{1.0, pose({0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, 0.0F)},
            {3.0, pose({4.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, 0.5F * std::numbers::pi_v<float>)},
            {4.0, pose({4.0F, -1.0F, 2.0F}, {0.3F, 1.0F, -0.5F}, -2.5F)},
            {4.5, pose({4.0F, -1.0F, 2.0F}, {0.3F, 1.0F, -0.5F}, -2.5F)}};
}

TEST(PoseKeys, InterpolatesLinearlyAtConstantRotation) {
    const auto keys = path();
    EXPECT_EQ(poseAt(keys, -5.0), keys.front().pose);
    EXPECT_EQ(poseAt(keys, 1.0), keys.front().pose);
    EXPECT_EQ(poseAt(keys, 9.0), keys.back().pose);
    const Pose half = poseAt(keys, 2.0);
    EXPECT_EQ(half.position, glm::vec3(2.0F, 0.0F, 0.0F));
    EXPECT_EQ(half.scale, 2.0F);
    EXPECT_NEAR(glm::angle(half.rotation), 0.25F * std::numbers::pi_v<float>, 1e-6F);
}

TEST(PoseKeys, MotionMatchesTheClosedForm) {
    const Motion motion = motionAt(path(), 2.0);
    EXPECT_NEAR(glm::length(motion.velocity - glm::vec3(2.0F, 0.0F, 0.0F)), 0.0F, 1e-6F);
    EXPECT_NEAR(glm::length(motion.turn - glm::vec3(0.0F, 0.0F, 0.25F * std::numbers::pi_v<float>)), 0.0F,
                1e-6F);
    for (const double time : {0.5, 4.2, 4.5, 9.0}) {
        EXPECT_EQ(motionAt(path(), time).velocity, glm::vec3(0.0F)) << time;
        EXPECT_LT(glm::length(motionAt(path(), time).turn), 1e-6F) << time;
    }
    EXPECT_EQ(motionAt(path(), 1.0).velocity, glm::vec3(2.0F, 0.0F, 0.0F))
        << "at a key, the motion of the next segment";
}

// A quarter turn by either of its two quaternions is the same rotation.
TEST(PoseKeys, RotatesTheShorterWay) {
    auto keys = path();
    keys[1].pose.rotation = -keys[1].pose.rotation;
    EXPECT_NEAR(motionAt(keys, 2.0).turn.z, 0.25F * std::numbers::pi_v<float>, 1e-6F);
    EXPECT_NEAR(glm::angle(poseAt(keys, 2.0).rotation), 0.25F * std::numbers::pi_v<float>, 1e-5F);
}

// Neither direction is shorter: the rotation follows the angles, however they are rounded.
TEST(PoseKeys, HalfTurnsFollowTheAngles) {
    for (const glm::vec3& axis : {glm::vec3(0.0F, 1.0F, 0.0F), glm::vec3(0.3F, 1.0F, -0.5F)}) {
        for (const auto& [from, to] :
             {std::pair{0.0F, 180.0F}, std::pair{0.0F, -180.0F}, std::pair{180.0F, 360.0F},
              std::pair{-90.0F, 90.0F}, std::pair{100.0F, -80.0F}, std::pair{33.0F, 213.0F},
              std::pair{540.0F, 360.0F}}) {
            const std::vector<PoseKey> keys = {{0.0, pose({}, axis, glm::radians(from))},
                                               {2.0, pose({}, axis, glm::radians(to))}};
            const Motion motion = motionAt(keys, 1.0);
            const glm::vec3 expected = glm::radians(0.5F * (to - from)) * glm::normalize(axis);
            EXPECT_LT(glm::length(motion.turn - expected), 1e-5F) << from << " to " << to;
            const glm::quat middle = glm::angleAxis(glm::radians(0.5F * (from + to)), glm::normalize(axis));
            EXPECT_NEAR(std::abs(glm::dot(poseAt(keys, 1.0).rotation, middle)), 1.0F, 1e-6F)
                << from << " to " << to;
        }
    }
}

// For any rotation, velocity + turn × arm is the change of a point's toWorld().
TEST(PoseKeys, MotionIsTheDerivativeOfThePose) {
    const auto keys = path();
    constexpr double kShort = 1e-3;
    const glm::vec3 q(0.7F, -0.4F, 1.1F);
    for (const double time : {1.25, 2.9, 3.25, 3.5, 3.9}) {
        const glm::vec3 before = toWorld(poseAt(keys, time - kShort), q);
        const glm::vec3 after = toWorld(poseAt(keys, time + kShort), q);
        const Pose now = poseAt(keys, time);
        const Motion motion = motionAt(keys, time);
        const glm::vec3 velocity = motion.velocity + glm::cross(motion.turn, toWorld(now, q) - now.position);
        const glm::vec3 measured = (after - before) / static_cast<float>(2.0 * kShort);
        EXPECT_LT(glm::length(velocity - measured), 5e-3F) << time;
    }
}

TEST(WorldBodies, BodiesPosesAndBoxMatchTheWorld) {
    const LoadedWorld loaded = {test::threeBodies(), std::vector<Collider>(2)};
    const std::vector<ColliderBody> bodies = worldBodies(loaded);
    ASSERT_EQ(bodies.size(), 3U);
    EXPECT_EQ(bodies[1].collider, &loaded.colliders[1]);
    EXPECT_EQ(bodies[2].collider, bodies[1].collider) << "uploaded once";
    EXPECT_EQ(bodies[1].friction, 0.75F);
    const std::vector<Pose> poses = worldPoses(loaded.world);
    ASSERT_EQ(poses.size(), 3U);
    EXPECT_EQ(poses[1], bodies[1].pose);
    EXPECT_EQ(findBodies(loaded.world, "door"), std::vector<std::size_t>{1});
    EXPECT_TRUE(findBodies(loaded.world, "doo").empty());
    const Bounds box = worldBounds(loaded.world);
    EXPECT_EQ(box.min, glm::vec3(-9.0F));
    EXPECT_EQ(box.max, glm::vec3(9.0F));
    // Rotated by slightly more than 90° about y, and scaled by 2: a corner of the door.
    const glm::vec3 corner = toWorld(poses[1], glm::vec3(1.0F, 2.0F, 0.0F));
    EXPECT_NEAR(corner.x, 3.0F + 2.0F * 0.28F, 1e-6F);
    EXPECT_NEAR(corner.y, 4.5F, 1e-6F);
    EXPECT_NEAR(corner.z, 1.0F - 2.0F * 0.96F, 1e-6F);
}

}  // namespace
}  // namespace relief::test
