// SPDX-License-Identifier: Apache-2.0
// How fine a map of patches is: by its finest cell alone nothing can be told of a place, for cells grow where little is to see.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "formats/depth_map.h"

namespace relief {

/// Leaves of a map of patches that hold heights. 0: it sees no surface.
[[nodiscard]] std::uint32_t patchCount(const DepthMap& map);

/// Between the heights of the leaf at a point, of a pair the first one's, object units; the side of the leaf where it holds none.
/// \param p  object space. Beyond the roots: of the nearest of them.
[[nodiscard]] double patchSpacingAt(const DepthMap& map, const glm::vec3& p);

}  // namespace relief
