// SPDX-License-Identifier: Apache-2.0
// A handmade tree with known leaves and sizes. Detects uncounted patches, confused siblings, and the heights of wrong
// leaves.
#include "bake/measure/patch_cells.h"

#include <gtest/gtest.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "formats/patch_tree.h"

namespace relief::test {
namespace {

constexpr glm::vec3 kUp(0.0F, 0.0F, 1.0F);

/// Two roots along x, each 4 object units wide, from the origin. The first is split: octant 1 is a patch of 3² heights,
/// 6 is split and contains a patch of 5², the others have no record. The second root is outside.
DepthMap handMade() {
    PatchHeights five{.side = 5};
    PatchHeights three{.side = 3};
    DepthMap map;
    map.format = MapFormat::kPatches;
    map.decode = Decode::kPlane;
    for (int i = 0; i < 3; ++i) {
        map.object_to_map.row[i] = glm::vec4(0.0F);
        map.object_to_map.row[i][i] = 0.25F;
    }
    map.object_per_map = glm::vec3(4.0F);
    const PatchFrame frame = patchFrames()[0];
    const std::uint32_t records = 6;
    appendPatchTexel(map.texels, {2U | 1U << 16U, 1U | 2U << 16U});
    appendPatchTexel(map.texels, PatchRecord::split(0b0100'0010U, 0, 3, kUp, 0.0F));
    appendPatchTexel(map.texels, PatchRecord::flat(false, kUp, 1.0F));
    appendPatchTexel(map.texels, PatchRecord::patch(frame, false, three, records));
    appendPatchTexel(map.texels, PatchRecord::split(0b0000'0001U, 0, 5, kUp, 0.0F));
    appendPatchTexel(map.texels, PatchRecord::patch(frame, false, five, records + heightTexels(3)));
    for (std::uint32_t i = 0; i < heightTexels(3); ++i) {
        appendPatchTexel(map.texels, three.texel(i));
    }
    for (std::uint32_t i = 0; i < heightTexels(5); ++i) {
        appendPatchTexel(map.texels, five.texel(i));
    }
    EXPECT_TRUE(validatePatches(map.texels));
    return map;
}

TEST(PatchCells, CountsCellsWithHeights) {
    DepthMap map = handMade();
    EXPECT_EQ(patchCount(map), 2U);
    // Heights can look like records.
    for (std::byte& byte : std::span(map.texels).subspan(std::size_t{6} * 8)) {
        byte = std::byte{3};
    }
    EXPECT_EQ(patchCount(map), 2U);
    map.texels.clear();
    appendPatchTexel(map.texels, {1U | 1U << 16U, 1U});
    appendPatchTexel(map.texels, PatchRecord::flat(true, kUp, -1.0F));
    EXPECT_EQ(patchCount(map), 0U);
}

TEST(PatchCells, SpacingDependsOnTheLeaf) {
    const DepthMap map = handMade();
    EXPECT_EQ(patchSpacingAt(map, {3.0F, 1.0F, 1.0F}), 1.0) << "half a cell of 2";
    EXPECT_EQ(patchSpacingAt(map, {0.5F, 2.5F, 2.5F}), 0.25) << "a quarter of a cell of 1";
    EXPECT_EQ(patchSpacingAt(map, {0.5F, 3.5F, 2.5F}), 1.0) << "a neighbour without heights";
    EXPECT_EQ(patchSpacingAt(map, {1.0F, 1.0F, 1.0F}), 2.0) << "an octant without a record";
    EXPECT_EQ(patchSpacingAt(map, {6.0F, 1.0F, 1.0F}), 4.0) << "a root without heights";
    // Points beyond the roots and on their last faces use the nearest cell.
    EXPECT_EQ(patchSpacingAt(map, {3.0F, -9.0F, -9.0F}), 1.0);
    EXPECT_EQ(patchSpacingAt(map, {8.0F, 4.0F, 4.0F}), 4.0);
    EXPECT_EQ(patchSpacingAt(map, {1e30F, 0.0F, 0.0F}), 4.0);
}

}  // namespace
}  // namespace relief::test
