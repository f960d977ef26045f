// SPDX-License-Identifier: Apache-2.0
// The sample points of a plan, and the service of a view to a point.
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

/// Stratified over the area, a little off the surface. The same for any number of threads.
[[nodiscard]] std::vector<PlanPoint> drawPlanPoints(const MeshQuery& query, std::uint64_t seed);

/// The service, 0 to 1, of a view that sees a point at this cosine of incidence; little when edge-on.
[[nodiscard]] float service(double cosine);

/// The first of so many parts of somePoints() finds candidates that are clearly worse.
inline constexpr std::size_t kSomeParts = 8;

/// Some hundred of these indices, in an order whose beginning is spread as evenly.
[[nodiscard]] std::vector<std::size_t> somePoints(const std::vector<std::size_t>& points);

}  // namespace relief
