// SPDX-License-Identifier: Apache-2.0
// The broad phase of an exported level: a uniform grid as plain data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/engines/engine_constants.h"

namespace relief {

/// A body of a level: 7 texels of RGBA32F.
struct EngineBody {
    PatchConstants constants;                ///< in world space
    std::array<float, 4> min_restitution{};  ///< minimum of the world-space box; restitution factor
    std::array<float, 4> max_friction{};     ///< maximum of the box; friction of the body
};
static_assert(sizeof(EngineBody) == 112);

/// Number of bodies per row of the body texture.
inline constexpr std::size_t kBodiesPerRow = 256;

/// Returns a grid over the boxes of the bodies. Each cell lists the bodies whose boxes are within half a cell of it.
/// The grid consists of 32-bit words:
/// - the numbers of cells along x, y and z; the number of entries;
/// - as floats, the minimum corner of the grid, and the edge length of a cell;
/// - the index of each cell's first entry, x fastest, then the index after the last entry;
/// - the entries, which are indices of bodies in ascending order within a cell.
[[nodiscard]] std::vector<std::uint32_t> bodyCells(std::span<const EngineBody> bodies);

}  // namespace relief
