// The words of a world's bodies, and what of them changes when bodies move.
#include "runtime/collider/body_table.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "shaders/collider/constants.h"

namespace relief {
namespace {

std::vector<TableBody> row(std::size_t count) {
    std::vector<TableBody> bodies(count);
    for (std::size_t i = 0; i < count; ++i) {
        bodies[i].pose.position.x = 3.0F * static_cast<float>(i);
        bodies[i].maps[1] = 1;
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
    return std::memcmp(block.row, block.before, sizeof(block.row)) == 0;
}

TEST(BodyTable, ABodyThatStopsIsAtRestAStepLater) {
    const std::vector<std::byte> no_maps;
    BodyTable table(no_maps, row(1'000));
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
    EXPECT_TRUE(table.isNew());  // it has left the grid of those at rest
    static_cast<void>(table.takeChanges());

    EXPECT_FALSE(table.setPoses({}));  // it stops
    EXPECT_TRUE(rests(blockOf(table, 2)));
    EXPECT_EQ(table[2].pose.position.y, 1.0F);
    EXPECT_FALSE(table.isNew());
    EXPECT_EQ(table.takeChanges().size(), 1U);
    EXPECT_FALSE(table.setPoses({}));
    EXPECT_TRUE(table.takeChanges().empty());

    poses[2].position.y = 2.0F;
    EXPECT_TRUE(table.setPoses(poses));
    EXPECT_FALSE(table.isNew());
    std::size_t rows = 0;
    for (const BodyTable::Rows& changed : table.takeChanges()) {
        rows += changed.end - changed.first;
    }
    EXPECT_LE(rows, 3U);  // of some hundred
}

TEST(BodyTable, TheTextureIsNoHigherThanWide) {
    const std::vector<std::byte> no_maps;
    for (const std::size_t count : {1U, 7U, 300U, 65'536U}) {
        const BodyTable table(no_maps, row(count));
        const std::size_t width = std::size_t{1} << table.log2Width();
        EXPECT_EQ(table.words().size() % width, 0U);
        EXPECT_LE(table.words().size() / width, width);
        EXPECT_LE(width, 2048U);  // that OpenGL ES 3.0 promises
        EXPECT_EQ(table.block().size(), 1U + kWorldLevels);
    }
}

}  // namespace
}  // namespace relief
