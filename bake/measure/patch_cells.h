// SPDX-License-Identifier: Apache-2.0
// Measures the local resolution of a map of patches. The size of the finest cell is not representative, because cells
// are larger where the surface is simple.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "formats/depth_map.h"

namespace relief {

/// Counts the leaves that store heights; 0 if the map contains no surface.
[[nodiscard]] std::uint32_t patchCount(const DepthMap& map);

/// Returns the spacing of heights in the leaf at a point (for a pair, of the first patch), in object units; the side of
/// the leaf if it stores no heights.
/// \param p  object space. Outside the roots, the nearest root is used.
[[nodiscard]] double patchSpacingAt(const DepthMap& map, const glm::vec3& p);

}  // namespace relief
