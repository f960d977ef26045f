// SPDX-License-Identifier: Apache-2.0
// The ray of a texel in object space, in double precision.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "formats/depth_map.h"

namespace relief {

/// The ray through the centre of a texel, in object space: the surface point of a depth, of any compare and
/// of either end, is origin + depth · direction. direction is not of unit length.
struct TexelRay {
    glm::dvec3 origin;     ///< at depth 0: on the near plane; of a cube its centre
    glm::dvec3 direction;  ///< object units for one unit of depth

    [[nodiscard]] glm::dvec3 at(double depth) const { return origin + depth * direction; }
};

/// \param map   a valid frame (validate.h); texels may be missing.
/// \param face  0 for an orthographic map.
[[nodiscard]] TexelRay texelRay(const DepthMap& map, std::uint32_t face, std::uint32_t x, std::uint32_t y);

/// The same through any place of a face. \param x, y  in texels: the centre of texel (i, j) is (i + ½, j + ½).
[[nodiscard]] TexelRay rayThrough(const DepthMap& map, std::uint32_t face, double x, double y);

}  // namespace relief
