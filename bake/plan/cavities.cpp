// SPDX-License-Identifier: Apache-2.0
#include "bake/plan/cavities.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "bake/mesh/surface_sampler.h"
#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

/// Cubes reach this far at most, in units of the longest side.
constexpr double kReach = 0.65;
/// Texels of a cube across the mean width of its volume: its faces are nearer to the centre than its corners.
constexpr double kCubeDensity = 0.775;

/// A place in free space near a badly served point.
glm::dvec3 placeWithin(const MeshQuery& query, const std::vector<PlanPoint>& points,
                       const std::vector<std::size_t>& unserved, std::uint64_t seed) {
    MersenneRandom random(seed);
    const glm::dvec3 from = points[unserved[random.below(unserved.size())]].position;
    const glm::dvec3 direction = random.direction();
    double free_length = kReach * query.mesh().bounds.longestSide();
    if (const auto hit = query.firstHit(from, direction); hit && hit->along < free_length) {
        free_length = hit->along;
    }
    return from + (0.2 + 0.6 * random.uniform()) * free_length * direction;
}

/// The cube at a place, and its service to some points.
Cavity lookFromWithin(const MeshQuery& query, const std::vector<PlanPoint>& points,
                      const std::vector<std::size_t>& some, const std::vector<float>& served,
                      const glm::dvec3& center) {
    const double side = query.mesh().bounds.longestSide();
    Cavity cavity;
    cavity.center = center;
    for (const std::size_t i : some) {
        const glm::dvec3 offset = points[i].position - cavity.center;
        const double distance = length(offset);
        if (distance > kReach * side || !(distance > 0.0) ||
            !query.segmentIsFree(cavity.center, points[i].position)) {
            continue;
        }
        const float value = service(-dot(points[i].normal, offset) / distance);
        cavity.service.emplace_back(i, value);
        cavity.gain += std::max(0.0F, value - served[i]);
        for (int axis = 0; axis < 3; ++axis) {
            cavity.half[axis] = std::max(cavity.half[axis], std::abs(offset[axis]));
        }
    }
    cavity.half = 1.1 * cavity.half + glm::dvec3(1e-3 * side);
    cavity.area = 24.0 * cavity.width() * cavity.width();
    return cavity;
}

}  // namespace

double Cavity::width() const {
    return 2.0 * kCubeDensity * std::max({half.x, half.y, half.z});
}

std::optional<Cavity> bestCavity(const MeshQuery& query, const std::vector<PlanPoint>& points,
                                 const std::vector<std::size_t>& unserved, const std::vector<float>& served,
                                 double others_area, std::uint64_t seed) {
    if (unserved.empty()) {
        return std::nullopt;
    }
    const std::vector<std::size_t> some = somePoints(unserved);
    std::vector<Cavity> candidates(kCavityCandidates);
    tbb::parallel_for(std::size_t{0}, kCavityCandidates, [&](std::size_t k) {
        const glm::dvec3 center = placeWithin(query, points, unserved, seed + k);
        candidates[k] = lookFromWithin(query, points, some, served, center);
    });
    const Cavity* best = nullptr;
    double best_score = 0.0;
    for (const Cavity& candidate : candidates) {
        const double score = candidate.gain / (candidate.area + 0.02 * others_area);
        if (score > best_score) {
            best = &candidate;
            best_score = score;
        }
    }
    return best == nullptr ? std::nullopt
                           : std::optional(lookFromWithin(query, points, unserved, served, best->center));
}

}  // namespace relief
