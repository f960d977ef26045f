// SPDX-License-Identifier: Apache-2.0
// The file shared by the two benchmarks: it round-trips, and all other bytes are rejected.
#include "formats/bricks/brick_atlas.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <span>

#include "formats/base/file_io.h"
#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

BrickAtlas smallAtlas() {
    BrickAtlas atlas;
    atlas.box = {{-1, -2, -3}, {4, 5, 6}};
    atlas.origin = {-1.5F, -2.5F, -3.5F};
    atlas.cube_size = {2, 3, 4};
    atlas.cubes = {2, 1, 2};
    atlas.cells = {1, 2, 1};
    atlas.range = 0.25F;
    atlas.bytes = 77;
    atlas.index = {BrickAtlas::kOutside, BrickAtlas::kFirstBrick + 1, BrickAtlas::kInside,
                   BrickAtlas::kFirstBrick};
    for (std::int16_t i = 0; i < 24; ++i) {
        atlas.codes.push_back(static_cast<std::int16_t>(11 * i - 127));
    }
    return atlas;
}

class BrickAtlasTest : public testing::Test {
  protected:
    [[nodiscard]] Result<BrickAtlas> saved(const BrickAtlas& atlas) const {
        const Result<void> done = saveBrickAtlas(atlas, path_);
        EXPECT_TRUE(done) << done.error().message;
        return loadBrickAtlas(path_);
    }
    [[nodiscard]] Result<BrickAtlas> written(std::span<const std::byte> bytes) const {
        const Result<void> done = writeFile(path_, bytes);
        EXPECT_TRUE(done) << done.error().message;
        return loadBrickAtlas(path_);
    }

    test::TemporaryFolder folder_;
    std::filesystem::path path_ = folder_.path() / "atlas";
};

TEST_F(BrickAtlasTest, RoundTrips) {
    const BrickAtlas atlas = smallAtlas();
    const BrickAtlas read = required(saved(atlas));
    const std::vector<std::byte> bytes = readFile(path_).value();
    ASSERT_TRUE(saved(read));
    EXPECT_EQ(readFile(path_).value(), bytes);
    EXPECT_EQ(read.box, atlas.box);
    EXPECT_EQ(read.cells, atlas.cells);
    EXPECT_EQ(read.index, atlas.index);
    EXPECT_EQ(read.codes, atlas.codes);
    EXPECT_EQ(read.bricks(), 2U);
}

TEST_F(BrickAtlasTest, InconsistentHeadersAreRejected) {
    const std::vector<std::function<void(BrickAtlas&)>> lies = {
        [](auto& atlas) { atlas.index[0] = BrickAtlas::kFirstBrick + 2; },
        [](auto& atlas) { atlas.index.pop_back(); },
        [](auto& atlas) {
            atlas.cubes = {65536, 65536, 65536};
        },
        [](auto& atlas) { atlas.cubes.x = 0; },
        [](auto& atlas) { atlas.cells.y = 3; },
        [](auto& atlas) { atlas.codes.pop_back(); },
        [](auto& atlas) { atlas.codes[3] = 128; },
        [](auto& atlas) { atlas.bits = 12; },
        [](auto& atlas) { atlas.range = std::numeric_limits<float>::quiet_NaN(); },
        [](auto& atlas) { atlas.cube_size.z = 0.0F; },
        [](auto& atlas) { atlas.origin.x = std::numeric_limits<float>::infinity(); },
        [](auto& atlas) { std::swap(atlas.box.min, atlas.box.max); },
    };
    for (std::size_t i = 0; i < lies.size(); ++i) {
        BrickAtlas atlas = smallAtlas();
        lies[i](atlas);
        expectError(saved(atlas), ErrorCode::kInvalidInput);
    }
}

TEST_F(BrickAtlasTest, ShorterAndLongerFilesAreRejected) {
    ASSERT_TRUE(saved(smallAtlas()));
    std::vector<std::byte> whole = readFile(path_).value();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        ASSERT_FALSE(written(std::span(whole).first(size))) << size;
    }
    whole.push_back(std::byte{0});
    EXPECT_FALSE(written(whole));
    whole.pop_back();
    whole[7] = std::byte{'9'};
    EXPECT_FALSE(written(whole));
}

}  // namespace
}  // namespace relief
