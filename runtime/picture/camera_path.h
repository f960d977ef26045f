// SPDX-License-Identifier: Apache-2.0
// A camera that moves: where it is at a time, from keys.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "runtime/picture/camera.h"

namespace relief {

struct CameraKey {
    double time = 0.0;  ///< seconds since the beginning
    glm::vec3 eye{0.0F};
    glm::vec3 target{0.0F};
    float fov = 30.0F;  ///< degrees
    friend bool operator==(const CameraKey&, const CameraKey&) = default;
};

/// Eye, target and fov at a time, by Catmull-Rom: cubic, the speed at a key that of the straight line between the keys
/// around it (at the ends, between the last two), so that uneven times are no jolts. Before the first key and after the
/// last the camera stands still. fov is kept within 1…170; an eye that comes to lie straight above or below its target, or
/// in it, is moved a little towards +z, where the picture still has an upper side. Clip planes are left at their defaults.
/// \param keys  one at least, their times rising.
[[nodiscard]] Camera cameraAt(std::span<const CameraKey> keys, double time);

}  // namespace relief
