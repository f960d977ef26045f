// SPDX-License-Identifier: Apache-2.0
// Rows without their empty ends: nothing is lost, nothing is kept that need not be.
#include "formats/row_spans.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/results.h"

namespace relief::test {
namespace {

constexpr std::size_t kTexel = 8;

DepthMap frontBack(std::uint32_t width, std::uint32_t height) {
    DepthMap map;
    map.format = MapFormat::kFrontBackFixed;
    map.compare = Compare::kBoth;
    map.width = width;
    map.height = height;
    map.texels.resize(map.texelBytes());
    return map;
}

TEST(RowSpans, GoFromTheFirstTexelToTheLast) {
    DepthMap map = frontBack(8, 4);
    map.texelAt(0, 3, 1)[0] = std::byte{1};
    map.texelAt(0, 6, 1)[7] = std::byte{1};
    map.texelAt(0, 0, 3)[3] = std::byte{1};
    map.texelAt(0, 7, 3)[4] = std::byte{1};
    const std::vector<RowSpan> spans = rowSpans(map);
    ASSERT_EQ(spans.size(), 4U);
    const std::uint16_t expected[4][2] = {{0, 0}, {3, 7}, {0, 0}, {0, 8}};
    for (std::size_t y = 0; y < 4; ++y) {
        EXPECT_EQ(spans[y].first, expected[y][0]) << y;
        EXPECT_EQ(spans[y].end, expected[y][1]) << y;
    }
    EXPECT_EQ(texelsOf(spans), 12U);
    EXPECT_EQ(gpuBytes(map), (12U + 4U) * kTexel);
    const std::vector<std::byte> packed = packRows(map);
    ASSERT_EQ(packed.size(), 4 * kRowSpanBytes + 12 * kTexel);
    // Row 1, little-endian, and its first texel.
    EXPECT_EQ(packed[4], std::byte{3});
    EXPECT_EQ(packed[6], std::byte{7});
    EXPECT_EQ(packed[16], std::byte{1});
}

TEST(RowSpans, ComeBackAsTheyWere) {
    std::mt19937 random(5);
    for (int round = 0; round < 300; ++round) {
        DepthMap map = frontBack(static_cast<std::uint32_t>(3 + random() % 40),
                                 static_cast<std::uint32_t>(3 + random() % 40));
        const std::uint_fast32_t full = random() % 100;
        for (std::size_t at = 0; at < map.texels.size(); at += kTexel) {
            if (random() % 100 < full) {
                map.texels[at + random() % kTexel] = static_cast<std::byte>(random());
            }
        }
        const std::vector<std::byte> packed = packRows(map);
        EXPECT_EQ(packed.size() - kRowSpanBytes * map.height, kTexel * texelsOf(rowSpans(map)));
        const auto back = required(unpackRows(packed, map));
        ASSERT_EQ(back, map.texels);
    }
}

TEST(RowSpans, OneMapHasOneForm) {
    // Whatever is read was written so: no two files for the same texels.
    std::mt19937 random(6);
    const DepthMap frame = frontBack(5, 3);
    int read = 0;
    for (int round = 0; round < 200'000; ++round) {
        std::vector<std::byte> bytes(3 * kRowSpanBytes + kTexel * (random() % 5));
        for (std::size_t y = 0; y < 3; ++y) {
            bytes[4 * y] = static_cast<std::byte>(random() % 3);
            bytes[4 * y + 2] = static_cast<std::byte>(random() % 7);
        }
        for (std::size_t at = 3 * kRowSpanBytes; at < bytes.size(); ++at) {
            bytes[at] = static_cast<std::byte>(random() % 4 == 0);
        }
        if (const auto texels = unpackRows(bytes, frame)) {
            ++read;
            DepthMap map = frame;
            map.texels = *texels;
            ASSERT_EQ(packRows(map), bytes);
        }
    }
    EXPECT_GT(read, 100);
}

}  // namespace
}  // namespace relief::test
