// SPDX-License-Identifier: Apache-2.0
// What a writer of maps with Decode::kPlane needs: where a texel's ray runs in object space, and which planes
// keep their promise at grazing texels. All in double; pure functions.
//
//          n   S = origin + depth · direction          f(P) = n·(P − S): positive on the side n points to
//           \  |
//     origin ●─┼──▶ direction       A plane (nearly) along the ray tells nothing of depth: f stays small
//              |\                   however deep P lies. No plane is stored whose |cosine| with the ray
//                                  is below kPlaneCosineMin (depth_map.h).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "formats/depth_map.h"

namespace relief {

/// The farthest that encodeNormal turns a normal, in radians: 0.65°, rounded up.
inline constexpr double kNormalIndexError = 0.01135;

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

/// The depth at which a ray meets the plane through `point`. Infinite or NaN where they are parallel; may lie
/// outside of what a texel holds.
[[nodiscard]] double planeDepth(const TexelRay& ray, const glm::dvec3& normal, const glm::dvec3& point);

/// The unit normal nearest to `normal` whose cosine with `viewer` is at least kPlaneCosineMin with room for
/// encodeNormal, so that it may be stored: `normal` itself unless that is grazing or turned away. (A plane
/// that was turned is no longer the surface's tangent: the caller pushes it outwards.)
/// \param normal, viewer  not zero; viewer is −direction for the nearest surface, +direction for the farthest.
[[nodiscard]] glm::dvec3 turnedToViewer(const glm::dvec3& normal, const glm::dvec3& viewer);

}  // namespace relief
