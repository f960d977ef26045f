// SPDX-License-Identifier: Apache-2.0
// What a row of a front-back map's image takes up: between its first and its last texel that is not empty. A silhouette
// fills some seven tenths of the rectangle round it, so that files and GPUs hold rows without their empty ends.
//
//     . . . # # . # .        first = 3, end = 7: four texels are kept
//     . . . . . . . .        first = end = 0
//     # # # # # # # #        first = 0, end = 8
//
// In memory a DepthMap is whole: nothing here changes its vote.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "formats/depth_map.h"

namespace relief {

/// The texels [first, end) of a row; both 0 where all of it is empty.
struct RowSpan {
    std::uint16_t first = 0;
    std::uint16_t end = 0;

    [[nodiscard]] std::uint32_t texels() const { return std::uint32_t{end} - first; }
};

/// Bytes for a row in a table of them, in files; on the GPU each takes a texel.
inline constexpr std::size_t kRowSpanBytes = 4;

/// Of each row from y = 0; a texel is empty if all its bytes are 0.
/// \param map  front-back, with all its texels.
[[nodiscard]] std::vector<RowSpan> rowSpans(const DepthMap& map);

/// Of the texels in all spans.
[[nodiscard]] std::uint64_t texelsOf(std::span<const RowSpan> spans);

/// Bytes that a map takes on the GPU: of a front-back map the texels of its spans, and one a row that says where they
/// are; of others all texels. \param map  with all its texels.
[[nodiscard]] std::uint64_t gpuBytes(const DepthMap& map);

/// The texels of a map as `Rows` of a file have them (README.md): first and end of each row as little-endian uint16, then
/// the texels of all spans. \param map  as rowSpans() has it.
[[nodiscard]] std::vector<std::byte> packRows(const DepthMap& map);

/// Turns them back into all texels of the map.
/// \param map  a valid front-back frame.
/// Errors: kInvalidInput (not what packRows() makes of any map of this size), without the map's index. Throws
/// std::bad_alloc.
[[nodiscard]] Result<std::vector<std::byte>> unpackRows(std::span<const std::byte> packed,
                                                        const DepthMap& map);

}  // namespace relief
