// SPDX-License-Identifier: Apache-2.0
// A trajectory through the world: keyed poses with linear interpolation of positions and constant-speed rotation.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "formats/world/pose.h"

namespace relief {

struct PoseKey {
    double time = 0.0;  ///< seconds
    Pose pose;          ///< all keys have the same scale
    friend bool operator==(const PoseKey&, const PoseKey&) = default;
};

/// The motion of a rigid body: a point q of the body moves at velocity + turn × (q − position of the pose).
struct Motion {
    glm::vec3 velocity{0.0F};  ///< of the pose's position, world units/s
    glm::vec3 turn{0.0F};      ///< angular velocity, right-handed, rad/s
};

/// Returns the pose at a time; constant before the first key and after the last. Rotations take the shorter arc. For
/// half turns, the keys' quaternions decide: 0 to 180 degrees about an axis is right-handed, 0 to -180 left-handed.
/// \param keys  at least one, in ascending order of time.
[[nodiscard]] Pose poseAt(std::span<const PoseKey> keys, double time);
/// Returns the motion at a time; at a key, that of the following segment.
[[nodiscard]] Motion motionAt(std::span<const PoseKey> keys, double time);

}  // namespace relief
