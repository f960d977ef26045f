// The plane that lies below all of some points, and highest on average: what a supporting plane of a texel comes to
// (plane_fit.h) where all its rays run side by side and meet a surface.
//
// Below all points means below their lower convex hull, and on average over points that lie about the origin a plane is
// as high as over the origin. So it is the hull's facet there. Three points whose triangle holds the origin span a plane;
// as long as some point is below it, the lowest takes the place of one of the three (the dual simplex method):
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
