// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

namespace relief::test {

/// A rotation by `degrees` about an axis of any length.
[[nodiscard]] inline glm::dmat3 rotation(const glm::dvec3& axis, double degrees) {
    return glm::mat3_cast(glm::angleAxis(glm::radians(degrees), glm::normalize(axis)));
}

}  // namespace relief::test
