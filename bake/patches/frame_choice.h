// SPDX-License-Identifier: Apache-2.0
// The axis of a cell's patches, by the normals of the surface in it.
#pragma once

#include <cstdint>
#include <span>

#include "bake/patches/cell_columns.h"

namespace relief {

struct FrameChoice {
    std::uint8_t index = 0;  ///< of patchFrames()
    bool two_sides = false;  ///< there is surface to see from above, and from below
};

/// The frame that sees most of the surface in a cell from both sides, where there is some on each: lines along a thin wall
/// pass it by, and find nothing to mend. Else that which sees most from above, or from below.
[[nodiscard]] FrameChoice chooseFrame(std::span<const ClippedTriangle> pieces);

}  // namespace relief
