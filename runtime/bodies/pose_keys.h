// SPDX-License-Identifier: Apache-2.0
// A trajectory through the world: poses at times, with straight lines and even turns between them.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "formats/world/pose.h"

namespace relief {

struct PoseKey {
    double time = 0.0;  ///< seconds since the beginning
    Pose pose;          ///< its scale is that of every other key
    friend bool operator==(const PoseKey&, const PoseKey&) = default;
};

/// The motion of a rigid body: a point q of it goes with velocity + turn × (q − position of the pose).
struct Motion {
    glm::vec3 velocity{0.0F};  ///< of the pose's position, world units a second
    glm::vec3 turn{0.0F};      ///< right-handed, radians a second
};

/// The pose at a time; before the first key and after the last it rests. Between two keys it turns the shorter way
/// round; half a turn goes as the keys' quaternions have it: from 0 to 180 degrees about an axis right-handed, from 0 to
/// -180 left-handed.
/// \param keys  at least one, their times rising.
[[nodiscard]] Pose poseAt(std::span<const PoseKey> keys, double time);
/// The motion at a time; at a key that of the piece after it.
[[nodiscard]] Motion motionAt(std::span<const PoseKey> keys, double time);

}  // namespace relief
