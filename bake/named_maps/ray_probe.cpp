// SPDX-License-Identifier: Apache-2.0
#include "bake/named_maps/ray_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "formats/depth_map.h"

namespace relief {
namespace {

/// Offset of the rays beside a ray that may have slipped through, and the maximum distance from that ray at which a
/// triangle counts as hit. In Embree's units, in which the mesh is one to two long and floats are 6e-8 apart.
constexpr double kBeside = 0x1p-17;
constexpr double kTouching = 1e-6;
constexpr int kBesideRays = 8;

/// Sines and cosines of the directions to these rays. The first two are opposite; none is along an edge of a grid.
constexpr std::array<std::array<double, 2>, kBesideRays> kBesideDirections = {{{0.1951, 0.9808},
                                                                               {-0.2588, -0.9659},
                                                                               {0.9877, -0.1564},
                                                                               {0.6018, -0.7986},
                                                                               {0.8090, 0.5878},
                                                                               {-0.7660, -0.6428},
                                                                               {-0.9945, 0.1045},
                                                                               {-0.6428, 0.7660}}};

}  // namespace

RayProbe::RayProbe(const RayScene& scene, const View& view, RayEnd end)
    : scene_(scene),
      view_(view),
      end_(end),
      may_start_inside_(mayStartInSolid(scene, view, end)),
      planes_(scene.mesh(), view) {}

RayProbe::Segment RayProbe::segmentOf(const TexelRay& ray) const {
    const double depth_max = view_.depthMax(ray);
    const bool from_point = view_.projection() == Projection::kCube && end_ == RayEnd::kNear;
    const double slack = from_point ? 0.0 : kDepthSlack;
    if (end_ == RayEnd::kNear) {
        return {ray.origin - slack * ray.direction, ray.direction, depth_max + 2.0 * slack};
    }
    const double back = view_.projection() == Projection::kCube ? 0.0 : slack;
    return {ray.origin + (depth_max + slack) * ray.direction, -ray.direction, depth_max + slack + back};
}

Hit RayProbe::hitOf(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::uint32_t triangle) {
    ProjectedPlane& plane = known_planes_[triangle % kStoredPlanes];
    if (plane.triangle != triangle) {
        plane = planes_.of(triangle);
    }
    const auto [depth, along] = planes_.at(plane, face, x, y);
    const double most = view_.projection() == Projection::kCube ? double{kCubeDepthMax} : 1.0;
    const bool from_behind = end_ == RayEnd::kNear ? along > 0.0 : along < 0.0;
    return {static_cast<float>(std::clamp(depth, 0.0, most)), triangle, from_behind};
}

Hit RayProbe::trace(std::uint32_t face, std::uint32_t x, std::uint32_t y) {
    const RTCRayHit query = traced(segmentOf(view_.ray(face, x, y)));
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return {};
    }
    const Hit hit = hitOf(face, x, y, query.hit.primID);
    // Only a hit on the inner side of a closed mesh is doubtful: no ray from free space can reach it.
    return scene_.closed() && hit.fromBehind() != scene_.insideOut() ? traceBeside(face, x, y, hit) : hit;
}

RTCRayHit RayProbe::traced(const Segment& segment) const {
    RTCRayHit query = rayHit(scene_.tree().toLocal(segment.origin), segment.direction * scene_.tree().scale,
                             static_cast<float>(segment.length));
    RayQuery().intersect(scene_.tree().scene.get(), query);
    return query;
}

Hit RayProbe::traceBeside(std::uint32_t face, std::uint32_t x, std::uint32_t y, const Hit& hit) {
    const Segment segment = segmentOf(view_.ray(face, x, y));
    const EmbreeMesh& tree = scene_.tree();
    const glm::dvec3 direction = segment.direction * tree.scale;
    const double length = relief::length(direction);
    const glm::dvec3 along = direction / length;
    const glm::dvec3 other = std::abs(along.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 right = unit(cross(along, other));
    const glm::dvec3 up = cross(right, along);

    // The nearest triangle that is touched, and all others hit at the same distance.
    std::array<std::uint32_t, kBesideRays> touched{};
    std::array<float, kBesideRays> where{};
    std::size_t count = 0;
    float nearest = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < kBesideDirections.size(); ++i) {
        if (i == 2 && count == 0) {
            return hit;  // beside a silhouette, like nearly all doubtful hits
        }
        const auto& [sine, cosine] = kBesideDirections[i];
        Segment shifted = segment;
        shifted.origin += (kBeside / tree.scale) * (cosine * right + sine * up);
        const RTCRayHit query = traced(shifted);
        if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID &&
            touches((segment.origin - tree.center) * tree.scale, right, up, query.hit.primID)) {
            touched[count] = query.hit.primID;
            where[count++] = query.ray.tfar;
            nearest = std::min(nearest, query.ray.tfar);
        }
    }
    if (count == 0) {
        return hit;
    }
    // Rays beside the original one hit triangles slightly earlier or later.
    const float tie = static_cast<float>(64.0 * kBeside / length);
    std::size_t as_near = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (where[i] <= nearest + tie) {
            touched[as_near++] = touched[i];
        }
    }
    // A ray that starts in the solid ends where it leaves the solid, at `hit`.
    if (may_start_inside_ &&
        scene_.inside(segment.origin + 0.5 * static_cast<double>(nearest) * segment.direction)) {
        return hit;
    }
    // The one that faces the ray most; of equal ones, the one with the lowest index.
    const auto rank = [&](std::uint32_t triangle) {
        return std::pair(-facingScore(scene_.mesh(), triangle, scene_.winding(), segment.direction),
                         triangle);
    };
    const Hit found = hitOf(face, x, y, std::ranges::min(std::span(touched).first(as_near), {}, rank));
    const bool before =
        hit.empty() || (end_ == RayEnd::kNear ? found.depth() < hit.depth() : found.depth() > hit.depth());
    return before ? found : hit;
}

bool RayProbe::touches(const glm::dvec3& origin, const glm::dvec3& right, const glm::dvec3& up,
                       std::uint32_t triangle) const {
    double x[3];
    double y[3];
    for (int i = 0; const glm::vec3& corner : cornersOf(scene_.mesh(), triangle)) {
        const glm::dvec3 p = scene_.tree().toLocal(corner) - origin;
        x[i] = dot(p, right);
        y[i++] = dot(p, up);
    }
    int sides = 0;
    double closest = std::numeric_limits<double>::max();
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const double ex = x[j] - x[i];
        const double ey = y[j] - y[i];
        const double side = ex * y[i] - ey * x[i];
        sides += side > 0.0 ? 1 : side < 0.0 ? -1 : 0;
        const double square = ex * ex + ey * ey;
        const double along = square > 0.0 ? std::clamp(-(x[i] * ex + y[i] * ey) / square, 0.0, 1.0) : 0.0;
        const double dx = x[i] + along * ex;
        const double dy = y[i] + along * ey;
        closest = std::min(closest, std::sqrt(dx * dx + dy * dy));
    }
    return std::abs(sides) == 3 || closest <= kTouching;
}

}  // namespace relief
