// SPDX-License-Identifier: Apache-2.0
// The shader constants of a map of patches.
#pragma once

#include <cstddef>
#include <glm/vec4.hpp>

#include "formats/depth_map.h"

namespace relief {

/// `ReliefCollider` of shaders/engines/relief.glsl, laid out as std140.
struct PatchConstants {
    glm::vec4 row[3] = {};  ///< object space to map space
    glm::vec4 size{0.0F};   ///< edge of a root cell; number of root cells along x, y and z
    glm::ivec4 place{0};    ///< first texel; stride of roots along y and z, texels; levels below the roots
};
static_assert(sizeof(PatchConstants) == 80);

/// \param map    of valid patches.
/// \param first  index of its first texel in the texture.
[[nodiscard]] PatchConstants patchConstants(const DepthMap& map, std::size_t first = 0);

}  // namespace relief
