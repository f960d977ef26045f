// SPDX-License-Identifier: Apache-2.0
// Layout of maps that are drawn on the GPU.
#include "runtime/layout/map_layout.h"

#include <gtest/gtest.h>

#include <vector>

namespace relief {
namespace {

TEST(TexelLayout, RectanglesLieBelowPackedTexels) {
    TexelLayout layout;
    layout.addPacked(1000);
    const int sizes[][2] = {{256, 256}, {100, 7}, {3, 512}, {256, 512}, {200, 30}, {64, 384}};
    for (const auto& size : sizes) {
        layout.addRectangle(size[0], size[1]);
    }
    ASSERT_TRUE(layout.finish(4096));
    EXPECT_EQ(layout.width(), 1024);  // at width 512 it would be higher
    EXPECT_LE(layout.height(), layout.width());
    std::vector<int> used(static_cast<std::size_t>(layout.width()) *
                          static_cast<std::size_t>(layout.height()));
    std::fill_n(used.begin(), 1000, 1);
    for (std::size_t i = 0; i < std::size(sizes); ++i) {
        const TexelRectangle r = layout.rectangle(i);
        EXPECT_EQ(r.width, sizes[i][0]);
        EXPECT_EQ(r.height, sizes[i][1]);
        ASSERT_LE(r.x + r.width, layout.width());
        ASSERT_LE(r.y + r.height, layout.height());
        for (int y = 0; y < r.height; ++y) {
            for (int x = 0; x < r.width; ++x) {
                const std::size_t at_texel =
                    layout.index(r) + static_cast<std::size_t>(y) * static_cast<std::size_t>(layout.width()) +
                    static_cast<std::size_t>(x);
                EXPECT_EQ(used[at_texel]++, 0);
            }
        }
    }
    EXPECT_FALSE(layout.finish(512));  // needs a wider texture
    TexelLayout none;
    ASSERT_TRUE(none.finish(64));
    EXPECT_EQ(none.height(), 0);
}

}  // namespace
}  // namespace relief
