// SPDX-License-Identifier: Apache-2.0
// Finds the plane that lies below all points of a set and has the highest mean over them. This is the supporting plane
// of a texel (plane_fit.h) whose rays are parallel and all hit a surface.
//
// The lower convex hull of the points has a facet on the vertical line through their mean, the origin. The plane
// contains this facet. The search starts from three points whose triangle contains the origin. While some point is
// below their plane, the lowest such point replaces one of the three (the dual simplex method):
//
//      ·       ·
//        \   ·          · points, heights upwards
//     ·   \·____·       the facet; | is the origin
//          |
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

namespace relief {

/// \param points  (x, y, height); the means of x and y must be 0.
/// \return the slopes of the plane along x and y; nullopt if the points are collinear.
[[nodiscard]] std::optional<glm::dvec2> highestBelow(std::span<const glm::dvec3> points);

}  // namespace relief
