// SPDX-License-Identifier: Apache-2.0
#include "runtime/stream/stream_plan.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

namespace relief {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// Returns the distance from a body's box in world units; 0 inside.
float distanceTo(const StreamBody& body, const glm::vec3& point) {
    const glm::vec3 at = toObject(body.pose, point);
    return body.pose.scale * glm::distance(at, glm::clamp(at, body.box.min, body.box.max));
}

}  // namespace

StreamPlan::StreamPlan(std::vector<StreamBody> bodies, std::size_t colliders)
    : bodies_(std::move(bodies)), nearest_(colliders, kFar) {}

void StreamPlan::begin(std::span<const PointOfInterest> points) {
    points_.assign(points.begin(), points.end());
    next_ = 0;
    std::fill(nearest_.begin(), nearest_.end(), kFar);
}

bool StreamPlan::advance(std::size_t pairs) {
    const std::size_t each = std::max<std::size_t>(points_.size(), 1);
    const std::size_t end = next_ + std::min(bodies_.size() - next_, std::max<std::size_t>(pairs / each, 1));
    for (; next_ < end; ++next_) {
        const StreamBody& body = bodies_[next_];
        float& nearest = nearest_[body.collider];
        for (const PointOfInterest& point : points_) {
            nearest = std::min(nearest, distanceTo(body, point.position) / point.radius);
        }
    }
    if (next_ < bodies_.size()) {
        return false;
    }
    wanted_.clear();
    for (std::uint32_t i = 0; i < nearest_.size(); ++i) {
        if (nearest_[i] <= 1.0F) {
            wanted_.push_back(i);
        }
    }
    std::sort(wanted_.begin(), wanted_.end(), [this](std::uint32_t a, std::uint32_t b) {
        return std::pair(nearest_[a], a) < std::pair(nearest_[b], b);
    });
    return true;
}

bool StreamPlan::measureSome(std::span<const PointOfInterest> points, std::size_t pairs) {
    if (next_ == 0 || next_ == bodies_.size()) {
        begin(points);
    }
    return advance(pairs);
}

void StreamPlan::measureAll(std::span<const PointOfInterest> points) {
    begin(points);
    static_cast<void>(advance(std::numeric_limits<std::size_t>::max()));
}

}  // namespace relief
