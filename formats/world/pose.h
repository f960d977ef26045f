// SPDX-License-Identifier: Apache-2.0
// The pose of a body: a rigid transform with a uniform scale.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "formats/collider.h"

namespace relief {

/// world = position + scale · rotation · object
struct Pose {
    glm::vec3 position{0.0F};                    ///< world units
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};  ///< unit length
    float scale = 1.0F;                          ///< world units per object unit, > 0
    friend bool operator==(const Pose&, const Pose&) = default;
};

[[nodiscard]] inline glm::vec3 toWorld(const Pose& pose, const glm::vec3& p) {
    return pose.position + pose.scale * (pose.rotation * p);
}

/// Returns the axis-aligned box in world space that encloses an object-space box.
[[nodiscard]] inline Bounds toWorld(const Pose& pose, const Bounds& box) {
    Bounds world;
    for (unsigned i = 0; i < 8; ++i) {
        world.add(toWorld(pose, box.corner(i)));
    }
    return world;
}

/// Converts a row of an object-to-map transform to the same row of the world-to-map transform. Computes in double,
/// because a world may be large.
[[nodiscard]] inline glm::vec4 fromWorld(const Pose& pose, const glm::vec4& row) {
    const glm::dvec3 turned =
        glm::mat3_cast(glm::dquat(pose.rotation)) * glm::dvec3(row) / double{pose.scale};
    return {glm::vec3(turned),
            static_cast<float>(double{row.w} - glm::dot(turned, glm::dvec3(pose.position)))};
}

[[nodiscard]] inline glm::vec3 toObject(const Pose& pose, const glm::vec3& p) {
    return (glm::conjugate(pose.rotation) * (p - pose.position)) / pose.scale;
}

}  // namespace relief
