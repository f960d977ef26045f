// SPDX-License-Identifier: Apache-2.0
#include "runtime/bodies/pose_keys.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>

namespace relief {
namespace {

/// Half-angle cosine below which a rotation counts as a half turn: a rounding error of 0.0002 degrees.
constexpr float kHalfTurnCosine = 2e-6F;

/// Returns `to` or -to, two quaternions of the same rotation, whichever is nearer to `from`. Returns `to` for a half
/// turn, for which both are equally near.
glm::quat nearTo(const glm::quat& from, const glm::quat& to) {
    return glm::dot(from, to) < -kHalfTurnCosine ? -to : to;
}

/// Returns the index of the first key after a time, or the number of keys.
std::size_t after(std::span<const PoseKey> keys, double time) {
    const auto found = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](double at, const PoseKey& key) { return at < key.time; });
    return static_cast<std::size_t>(found - keys.begin());
}

}  // namespace

Pose poseAt(std::span<const PoseKey> keys, double time) {
    const std::size_t next = after(keys, time);
    if (next == 0 || next == keys.size()) {
        return next == 0 ? keys.front().pose : keys.back().pose;
    }
    const PoseKey& from = keys[next - 1];
    const PoseKey& to = keys[next];
    const auto fraction = static_cast<float>((time - from.time) / (to.time - from.time));
    Pose pose = from.pose;
    pose.position += fraction * (to.pose.position - from.pose.position);
    const glm::quat& rotation = from.pose.rotation;
    pose.rotation = glm::normalize(glm::mix(rotation, nearTo(rotation, to.pose.rotation), fraction));
    return pose;
}

Motion motionAt(std::span<const PoseKey> keys, double time) {
    const std::size_t next = after(keys, time);
    if (next == 0 || next == keys.size()) {
        return {};
    }
    const PoseKey& from = keys[next - 1];
    const PoseKey& to = keys[next];
    const auto seconds = static_cast<float>(to.time - from.time);
    const glm::quat turn = nearTo(from.pose.rotation, to.pose.rotation) * glm::conjugate(from.pose.rotation);
    const glm::vec3 axis(turn.x, turn.y, turn.z);
    const float sine = glm::length(axis);
    Motion motion;
    motion.velocity = (to.pose.position - from.pose.position) / seconds;
    if (sine > 0.0F) {
        motion.turn = (2.0F * std::atan2(sine, turn.w) / (sine * seconds)) * axis;
    }
    return motion;
}

}  // namespace relief
