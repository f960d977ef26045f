// SPDX-License-Identifier: Apache-2.0
#include "bake/plan/plan_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bake/mesh/ray_cost.h"
#include "bake/mesh/surface_sampler.h"

namespace relief {
namespace {

constexpr std::size_t kPoints = 8'000;
constexpr std::size_t kPointsMin = 500;  // where rays are expensive
/// Standard deviation of the distance from the surface, in units of the longest side: where particles are.
constexpr double kSpread = 0.005;
/// Cosine of incidence for full service.
constexpr double kFullCosine = 0.7;
/// Service at the flattest angle that is not edge-on.
constexpr double kLeastService = 0.15;
constexpr double kEdgeOn = 0.05;
constexpr float kEdgeOnService = 0.01F;
/// Badly served points for the comparison of directions of gaps and of places for cubes.
constexpr std::size_t kSomePoints = 400;

std::vector<PlanPoint> drawPlanPoints(const MeshQuery& query, std::uint64_t seed, std::size_t count) {
    const TriangleMesh& mesh = query.mesh();
    const AreaTable& areas = query.prepared().areas();
    std::vector<std::optional<PlanPoint>> draws(count);
    const double side = mesh.bounds.longestSide();
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        MersenneRandom random(seed, i);
        const double at = (static_cast<double>(i) + random.uniform()) / static_cast<double>(count);
        const auto [surface, normal] = drawOnSurface(mesh, areas, at, random);
        const double offset = side * std::max(5e-5, kSpread * std::abs(random.normal()));
        // The winding is not trusted: take the side that is not inside; of two such, the front.
        for (const double sign : {1.0, -1.0}) {
            const glm::dvec3 position = surface + sign * offset * normal;
            if (!query.inside(glm::vec3(position))) {
                draws[i] = {position, sign * normal};
                return;
            }
        }
    });
    std::vector<PlanPoint> points;
    for (const std::optional<PlanPoint>& draw : draws) {
        if (draw) {
            points.push_back(*draw);
        }
    }
    return points;
}

}  // namespace

std::vector<PlanPoint> drawPlanPoints(const MeshQuery& query, std::uint64_t seed) {
    auto count = std::max(
        kPointsMin, static_cast<std::size_t>(affordableRays(query.mesh()) * static_cast<double>(kPoints)));
    std::vector<PlanPoint> points = drawPlanPoints(query, seed, count);
    while (points.size() < kPointsMin / 4 && count < kPoints) {  // most of the surface is buried
        count = std::min(4 * count, kPoints);
        points = drawPlanPoints(query, seed, count);
    }
    return points;
}

float service(double cosine) {
    return cosine < kEdgeOn ? kEdgeOnService
                            : static_cast<float>(std::min(
                                  1.0, kLeastService + (1.0 - kLeastService) * cosine / kFullCosine));
}

std::vector<std::size_t> somePoints(const std::vector<std::size_t>& points) {
    const std::size_t stride = (points.size() + kSomePoints - 1) / kSomePoints;
    std::vector<std::size_t> some;
    for (std::size_t first = 0; first < kSomeParts; ++first) {
        for (std::size_t k = first * stride; k < points.size(); k += kSomeParts * stride) {
            some.push_back(points[k]);
        }
    }
    return some;
}

}  // namespace relief
