#include "bake/plan/plan_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "bake/mesh/ray_cost.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

constexpr std::size_t kPoints = 8'000;
constexpr std::size_t kPointsMin = 500;  // where rays cost more than those of ordinary meshes
/// Spread of the points off the surface, in units of the longest side: where particles are looked up.
constexpr double kSpread = 0.005;
/// Cosine of incidence from which on a point is served in full.
constexpr double kFullCosine = 0.7;
/// Service under the flattest angle that is not edge-on.
constexpr double kLeastService = 0.15;
constexpr double kEdgeOn = 0.05;
constexpr float kEdgeOnService = 0.01F;
/// Points served badly that directions are tried with for maps of gaps, and places for cubes; the one that is taken is
/// asked about all.
constexpr std::size_t kSomePoints = 400;

std::vector<PlanPoint> drawPlanPoints(const MeshQuery& query, std::uint64_t seed, std::size_t count) {
    const TriangleMesh& mesh = query.mesh();
    const AreaTable& areas = query.prepared().areas();
    struct Draw {
        PlanPoint point;
        bool free = false;
    };
    std::vector<Draw> draws(count);
    const double side = mesh.bounds.longestSide();
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        MersenneRandom random(seed * 0x9e3779b97f4a7c15ULL + i);
        // Stratified over the area.
        const double at = (static_cast<double>(i) + random.uniform()) / static_cast<double>(count);
        const auto [surface, normal] = drawOnSurface(mesh, areas, at, random);
        const double offset = side * std::max(5e-5, kSpread * std::abs(random.normal()));
        // Winding is not trusted: the free side is the one that is not inside; of two free sides, the front.
        for (const double sign : {1.0, -1.0}) {
            const glm::dvec3 position = surface + sign * offset * normal;
            if (!query.inside(glm::vec3(position))) {
                draws[i] = {{position, sign * normal}, true};
                return;
            }
        }
    });
    std::vector<PlanPoint> points;
    for (const Draw& draw : draws) {
        if (draw.free) {
            points.push_back(draw.point);
        }
    }
    return points;
}

}  // namespace

std::vector<PlanPoint> drawPlanPoints(const MeshQuery& query, std::uint64_t seed) {
    auto count = std::max(
        kPointsMin, static_cast<std::size_t>(affordableRays(query.mesh()) * static_cast<double>(kPoints)));
    std::vector<PlanPoint> points = drawPlanPoints(query, seed, count);
    while (points.size() < kPointsMin / 4 && count < kPoints) {  // most of the surface lies within solids
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
