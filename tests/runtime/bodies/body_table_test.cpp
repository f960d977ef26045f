// SPDX-License-Identifier: Apache-2.0
// The words of a world's bodies, and which of them change when bodies move.
#include "runtime/bodies/body_table.h"

#include <gtest/gtest.h>

#include <cstring>
#include <glm/glm.hpp>
#include <vector>

#include "shaders/bodies/constants.h"

namespace relief {
namespace {

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

}  // namespace
}  // namespace relief
