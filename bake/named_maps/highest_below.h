// SPDX-License-Identifier: Apache-2.0
// The highest plane, on average, below all of some points: the supporting plane of a texel (plane_fit.h) whose rays are
// parallel and all meet a surface.
//
// With the points centred on the origin, that is the facet of their lower convex hull over the origin. Start from three
// points whose triangle holds the origin; while some point is below their plane, the lowest one replaces one of the three
// (the dual simplex method):
//
//      ·       ·
//        \   ·          · points, heights upwards
//     ·   \·____·       the facet over the origin, |
//          |
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

namespace relief {

/// \param points  (x, y, height); the mean of x and of y is 0
/// \return the plane's slopes along x and y; nullopt where the points span no area.
[[nodiscard]] std::optional<glm::dvec2> highestBelow(std::span<const glm::dvec3> points);

}  // namespace relief
