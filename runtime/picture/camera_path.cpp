// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/camera_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace relief {
namespace {

constexpr float kFovMin = 1.0F;
constexpr float kFovMax = 170.0F;
// Minimum horizontal offset of a camera that looks down, relative to its distance from the target.
constexpr float kAsideMin = 1e-3F;

/// Returns the slope of a value at key i: the slope of the line between the neighbours of the key.
template <class T, class Get>
T slopeAt(std::span<const CameraKey> keys, std::size_t i, Get get) {
    const CameraKey& before = keys[i == 0 ? 0 : i - 1];
    const CameraKey& after = keys[std::min(i + 1, keys.size() - 1)];
    return (get(after) - get(before)) / static_cast<float>(after.time - before.time);
}

/// Interpolates between keys i and i + 1. \param s  fraction of the time between them.
template <class T, class Get>
T between(std::span<const CameraKey> keys, std::size_t i, float s, Get get) {
    const T from = get(keys[i]);
    const T to = get(keys[i + 1]);
    const auto seconds = static_cast<float>(keys[i + 1].time - keys[i].time);
    const T leaving = seconds * slopeAt<T>(keys, i, get);
    const T arriving = seconds * slopeAt<T>(keys, i + 1, get);
    const float rest = 1.0F - s;
    // Cubic Hermite polynomial, exact at the ends.
    return (1.0F + 2.0F * s) * rest * rest * from + s * s * (3.0F - 2.0F * s) * to +
           s * rest * rest * leaving - s * s * rest * arriving;
}

}  // namespace

Camera cameraAt(std::span<const CameraKey> keys, double time) {
    std::size_t i = 0;
    while (i + 1 < keys.size() && keys[i + 1].time <= time) {
        ++i;
    }
    Camera camera;
    if (i + 1 == keys.size() || time <= keys.front().time) {
        const CameraKey& still = i + 1 == keys.size() ? keys.back() : keys.front();
        camera = {still.eye, still.target, still.fov};
    } else {
        const auto s = static_cast<float>((time - keys[i].time) / (keys[i + 1].time - keys[i].time));
        camera.eye = between<glm::vec3>(keys, i, s, [](const CameraKey& k) { return k.eye; });
        camera.target = between<glm::vec3>(keys, i, s, [](const CameraKey& k) { return k.target; });
        camera.fov = between<float>(keys, i, s, [](const CameraKey& k) { return k.fov; });
    }
    camera.fov = std::clamp(camera.fov, kFovMin, kFovMax);
    const glm::vec3 d = camera.eye - camera.target;
    const float aside = kAsideMin * std::max(std::abs(d.y), 1e-3F);
    if (std::hypot(d.x, d.z) < aside) {
        camera.eye.z = camera.target.z + aside;
    }
    return camera;
}

}  // namespace relief
