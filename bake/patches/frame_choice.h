// SPDX-License-Identifier: Apache-2.0
// Chooses the axis of a cell's patches by the normals of the surface in it.
#pragma once

#include <cstdint>
#include <span>

#include "bake/patches/cell_columns.h"

namespace relief {

struct FrameChoice {
    std::uint8_t index = 0;  ///< index into patchFrames()
    bool two_sides = false;  ///< surface is visible both from above and from below
};

/// Returns the frame that sees most of the surface from above and below together, if the cell has surface facing both
/// ways. Sampling lines parallel to a thin wall would miss it and detect no errors. Otherwise, returns the frame that
/// sees most from one side.
[[nodiscard]] FrameChoice chooseFrame(std::span<const ClippedTriangle> pieces);

}  // namespace relief
