// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace relief {

/// Returns whether no component is infinite or NaN.
[[nodiscard]] inline bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Returns whether a number is from 0 to 1; false for NaN.
[[nodiscard]] inline bool isFraction(float value) {
    return value >= 0.0F && value <= 1.0F;
}

}  // namespace relief
