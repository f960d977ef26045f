// SPDX-License-Identifier: Apache-2.0
// Draws orthographic views of a collider's field, for `relief export` of patches, which have no view of their own.
//
// Rays sample the field that particles collide with, within a box around the bounds and the inside of the collider
// (solidBox). Channels of 32-bit floats:
//
//     depth.front    object units along the view, from the near face of the bounds to the first surface
//     depth.back     object units along the view, from the near face of the bounds to the last surface
//     normal.X/Y/Z   of the field at the first surface: unit length, object space, outwards
//
// Depths are +inf and the normal is zero if the ray hits no surface. A depth is negative if the surface lies in front of
// the near face. Images are oriented as in axis_grid.h, top row first. If the inside extends to the end of the box, the
// face of the box counts as the surface, with a normal towards the viewer.
#pragma once

#include <cstdint>
#include <string>

#include "bake/images/exr.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

inline constexpr std::uint32_t kViewSizeMin = 2;
inline constexpr std::uint32_t kViewSizeMax = 4096;

/// "view_+x.exr"
[[nodiscard]] std::string viewImageName(int view);

/// Draws a view of the bounds. Depths are exact to 1/1024 of a ray step; near a surface, a step is at most one cell of
/// a patch.
///
/// A wall or a gap may be missed if its thickness along the ray is below 1/64 of its cell, plus the longer of 1/8 of
/// the finest texel (finestTexel()) and 1/16384 of the ray. The limit is larger by 1/4 of the cell in a leaf with a
/// pair of patches, and by one finest texel if the collider has several maps.
///
/// The result does not depend on the number of threads.
/// \param view  index of kDirectionNames. \param size  texels along the longer side; kViewSizeMin to kViewSizeMax.
/// Errors: kInvalidInput (bounds or maps too large for floats), kLimit (out of memory).
[[nodiscard]] Result<ExrImage> viewImage(const Collider& collider, int view, std::uint32_t size);

}  // namespace relief
