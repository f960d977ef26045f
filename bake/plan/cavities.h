// SPDX-License-Identifier: Apache-2.0
// Places within a mesh for cube maps, which see what no view from outside does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "bake/plan/plan_points.h"

namespace relief {

/// A cube in free space and the points that it would serve.
struct Cavity {
    glm::dvec3 center{0.0};
    glm::dvec3 half{0.0};                                ///< of the volume
    std::vector<std::pair<std::size_t, float>> service;  ///< point index and service
    double gain = 0.0;                                   ///< in the service of all points
    double area = 0.0;                                   ///< bytes for texels of side 1

    /// Of a face's image, object units; its texels are as large on the surface as those of other maps.
    [[nodiscard]] double width() const;
};

/// Places that bestCavity() tries, with seeds from `seed` on.
inline constexpr std::size_t kCavityCandidates = 100;

/// The best of some places near badly served points.
/// \param points    of the plan
/// \param unserved  the indices of the badly served ones
/// \param served    the service of all points so far
/// \param others_area  bytes for texels of side 1 of the views from outside, part of the price of a place
[[nodiscard]] std::optional<Cavity> bestCavity(const MeshQuery& query, const std::vector<PlanPoint>& points,
                                               const std::vector<std::size_t>& unserved,
                                               const std::vector<float>& served, double others_area,
                                               std::uint64_t seed);

}  // namespace relief
