// SPDX-License-Identifier: Apache-2.0
// Computes the ray of a texel in object space, in double precision.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "formats/depth_map.h"

namespace relief {

/// The ray through the centre of a texel, in object space. A surface point is origin + depth · direction, for the
/// nearest and the farthest surface. The direction is not normalized.
struct TexelRay {
    glm::dvec3 origin;     ///< point at depth 0: on the near plane; for a cube, its centre
    glm::dvec3 direction;  ///< object units per unit of depth

    [[nodiscard]] glm::dvec3 at(double depth) const { return origin + depth * direction; }
};

/// Returns the ray through the centre of a texel.
/// \param map   must pass validateFrame(); `texels` may be empty.
/// \param face  0 for an orthographic map.
[[nodiscard]] TexelRay texelRay(const DepthMap& map, std::uint32_t face, std::uint32_t x, std::uint32_t y);

/// Returns the ray through any position on a face.
/// \param x, y  in texels: the centre of texel (i, j) is (i + ½, j + ½).
[[nodiscard]] TexelRay rayThrough(const DepthMap& map, std::uint32_t face, double x, double y);

}  // namespace relief
