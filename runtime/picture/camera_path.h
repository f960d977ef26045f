// SPDX-License-Identifier: Apache-2.0
// Camera animation by keyframes.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "runtime/picture/camera.h"

namespace relief {

struct CameraKey {
    double time = 0.0;  ///< seconds from the beginning
    glm::vec3 eye{0.0F};
    glm::vec3 target{0.0F};
    float fov = 30.0F;  ///< degrees
    friend bool operator==(const CameraKey&, const CameraKey&) = default;
};

/// Interpolates eye, target and fov by a cubic Catmull-Rom spline with non-uniform times: the slope at a key is the
/// slope of the line between its neighbours (for the first and last key, between the key and its neighbour). The camera
/// rests before the first key and after the last one. fov is clamped to 1…170. An eye at its target, or directly above
/// or below it, is moved slightly towards +z, so that the up direction is defined. Clip planes keep their defaults.
/// \param keys  at least one, with ascending times.
[[nodiscard]] Camera cameraAt(std::span<const CameraKey> keys, double time);

}  // namespace relief
