// SPDX-License-Identifier: Apache-2.0
// Vectors that hold a number in every component.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace relief {

/// Neither infinite nor NaN in any component.
[[nodiscard]] inline bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace relief
