// SPDX-License-Identifier: Apache-2.0
// Slices at wrong points: the plane through a surface, and the colours of verdicts.
#include "bake/images/verdict_slice.h"

#include <gtest/gtest.h>

namespace relief::test {
namespace {

TEST(Errors, PlaneContainsTheNormalAndSamplesSurroundThePlace) {
    const VerdictSlice wall = verdictSlice({1.0F, 2.0F, 3.0F}, {0.6F, 0.8F, 0.0F}, 4.0);
    EXPECT_EQ(wall.axis, 2);
    EXPECT_EQ(verdictSlice({}, {0.0F, 0.6F, 0.8F}, 1.0).axis, 0);
    EXPECT_EQ(verdictSlice({}, {0.6F, 0.0F, -0.8F}, 1.0).axis, 1);
    EXPECT_EQ(verdictSlice({}, {0.0F, 1.0F, 0.0F}, 1.0).axis, 2);
    const double half = 2.0 * (1.0 - 1.0 / wall.size);
    const glm::dvec3 low = wall.point(0, 0);
    const glm::dvec3 high = wall.point(wall.size - 1, wall.size - 1);
    EXPECT_NEAR(low.x, 1.0 - half, 1e-12);
    EXPECT_NEAR(high.y, 2.0 + half, 1e-12);
    EXPECT_EQ(low.z, 3.0);
}

TEST(Errors, EveryVerdictHasAColorAndPicturesAreDeterministic) {
    VerdictSlice slice = verdictSlice({}, {0.0F, 1.0F, 0.0F}, 1.0);
    const auto picture = [&] { return *drawVerdicts(slice, "m"); };
    const std::vector<std::byte> outside = picture();
    EXPECT_EQ(outside, picture());
    std::vector<std::vector<std::byte>> pictures{outside};
    for (const SideVerdict verdict :
         {SideVerdict::kInside, SideVerdict::kFalseInside, SideVerdict::kFalseOutside}) {
        for (std::size_t i = 0; i < 25; ++i) {  // the outline of the inside is the contour
            slice.verdicts[(50 + i / 5) * slice.size + 50 + i % 5] = verdict;
        }
        const std::vector<std::byte> drawn = picture();
        for (const std::vector<std::byte>& other : pictures) {
            EXPECT_NE(drawn, other);
        }
        pictures.push_back(drawn);
    }
}

}  // namespace
}  // namespace relief::test
