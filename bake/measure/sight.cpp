// SPDX-License-Identifier: Apache-2.0
#include "bake/measure/sight.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "bake/measure/percent.h"
#include "bake/mesh/loops.h"

namespace relief {

Sight::Sight(const DepthMap& map, const MeshQuery& query)
    : map_(map),
      query_(query),
      to_map_(map.object_to_map.linear()),
      to_object_(map.object_to_map.inverse()),
      offset_(map.object_to_map.row[0].w, map.object_to_map.row[1].w, map.object_to_map.row[2].w),
      side_(query.mesh().bounds.longestSide()) {}

glm::dvec3 Sight::inMap(const glm::dvec3& p) const {
    return to_map_ * p + offset_;
}

bool Sight::isInVolume(const glm::dvec3& in_map) const {
    if (map_.projection() == Projection::kLocal) {
        return true;
    }
    if (map_.projection() == Projection::kCube) {
        const double reach = std::max({std::abs(in_map.x), std::abs(in_map.y), std::abs(in_map.z)});
        return reach <= 1.0 && reach > 0.0;
    }
    const double x = in_map.x * map_.width;
    const double y = in_map.y * map_.height;
    return x >= 1.0 && y >= 1.0 && x < map_.width - 1.0 && y < map_.height - 1.0 && in_map.z >= 0.0 &&
           in_map.z <= 1.0;
}

Sight::Lines Sight::linesTo(const glm::dvec3& p, const glm::dvec3& in_map) const {
    Lines lines;
    const auto add = [&](const glm::dvec3& line) { lines.start[lines.count++] = p + line; };
    if (map_.projection() == Projection::kCube) {
        const double reach = std::max({std::abs(in_map.x), std::abs(in_map.y), std::abs(in_map.z)});
        // Starts at the centre, or at the volume's face behind p.
        const double share = map_.compare == Compare::kLess ? -1.0 : 1.0 / reach - 1.0;
        add(to_object_ * (share * in_map));
        return lines;
    }
    if (map_.compare != Compare::kGreater) {
        add(-in_map.z * to_object_[2]);
    }
    if (map_.compare != Compare::kLess) {
        add((1.0 - in_map.z) * to_object_[2]);
    }
    return lines;
}

bool Sight::sees(const SurfacePoint& point) const {
    const glm::dvec3 normal = point.normal;
    const glm::dvec3 position = point.position;
    const glm::dvec3 p = position + kSurfaceStep * side_ * normal;
    const glm::dvec3 in_map = inMap(p);
    if (!isInVolume(in_map)) {
        return false;
    }
    if (map_.projection() == Projection::kLocal) {
        return true;  // some patch sees it from above
    }
    const Lines lines = linesTo(p, in_map);
    for (std::size_t i = 0; i < lines.count; ++i) {
        const glm::dvec3& start = lines.start[i];
        if (glm::dot(start - p, normal) > 0.0 && query_.isSegmentFree(p, start)) {
            return true;
        }
    }
    return false;
}

std::optional<glm::dvec3> Sight::reaches(const glm::dvec3& p) const {
    const glm::dvec3 in_map = inMap(p);
    if (map_.projection() == Projection::kLocal) {
        return p;
    }
    if (!isInVolume(in_map)) {
        return map_.encloses ? std::optional(p) : std::nullopt;
    }
    const Lines lines = linesTo(p, in_map);
    for (std::size_t i = 0; i < lines.count; ++i) {
        if (query_.isSegmentFree(p, lines.start[i])) {
            return lines.start[i];
        }
    }
    return std::nullopt;
}

Sights::Sights(std::span<const DepthMap> maps, const MeshQuery& query) {
    for (const DepthMap& map : maps) {
        sights_.emplace_back(map, query);
    }
}

bool Sights::isVisible(const SurfacePoint& point) const {
    return std::ranges::any_of(sights_, [&](const Sight& sight) { return sight.sees(point); });
}

double Sights::unseenPercent(std::span<const SurfacePoint> points) const {
    std::vector<char> unseen(points.size(), 0);
    forEachIndex(0, points.size(), 256,
                 [&](std::size_t i) { unseen[i] = !points[i].buried && !isVisible(points[i]) ? 1 : 0; });
    return percent(static_cast<std::size_t>(std::ranges::count(unseen, 1)),
                   points.size() - buriedPoints(points));
}

}  // namespace relief
