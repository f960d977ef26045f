// The pose of a body: a rigid transform with one scale for all axes.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace relief {

/// world = position + scale · rotation · object
struct Pose {
    glm::vec3 position{0.0F};                    ///< world units
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};  ///< of length 1
    float scale = 1.0F;                          ///< world units of an object unit, > 0
    friend bool operator==(const Pose&, const Pose&) = default;
};

[[nodiscard]] inline glm::vec3 toWorld(const Pose& pose, const glm::vec3& p) {
    return pose.position + pose.scale * (pose.rotation * p);
}

[[nodiscard]] inline glm::vec3 toObject(const Pose& pose, const glm::vec3& p) {
    return (glm::conjugate(pose.rotation) * (p - pose.position)) / pose.scale;
}

}  // namespace relief
