// The points that a plan is judged by, and how well a view serves one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/mesh/mesh_query.h"

namespace relief {

/// A point of free space near the surface.
struct PlanPoint {
    glm::dvec3 position;
    glm::dvec3 normal;  ///< of the surface, towards the point
};

/// Spread over the area, a little off it. The same for any number of threads.
[[nodiscard]] std::vector<PlanPoint> drawPlanPoints(const MeshQuery& query, std::uint64_t seed);

/// How well a point is served by a view that sees it under this cosine, 0 to 1: hardly, edge-on.
[[nodiscard]] float service(double cosine);

/// The first of somePoints(), this part, tell what is clearly worse than the rest.
inline constexpr std::size_t kSomeParts = 8;

/// Some hundred of these indices, in an order in which the first are from everywhere too.
[[nodiscard]] std::vector<std::size_t> somePoints(const std::vector<std::size_t>& points);

}  // namespace relief
