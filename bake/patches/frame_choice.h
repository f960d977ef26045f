// SPDX-License-Identifier: Apache-2.0
// Chooses the axis of a cell's patches from the normals of the surface in the cell.
#pragma once

#include <cstdint>
#include <span>

#include "bake/patches/cell_columns.h"

namespace relief {

struct FrameChoice {
    std::uint8_t index = 0;  ///< index into patchFrames()
    bool two_sides = false;  ///< surface is visible both from above and from below
};

/// Returns the frame whose axis shows most of the surface from one side. If the cell has surfaces that face both ways,
/// as in a thin wall, returns the frame whose axis shows most of them from above and below together. The sampling lines
/// of another frame may be parallel to the wall and miss it, so that errors at the wall are not detected.
[[nodiscard]] FrameChoice chooseFrame(std::span<const ClippedTriangle> pieces);

}  // namespace relief
