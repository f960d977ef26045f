// SPDX-License-Identifier: Apache-2.0
// Perspective cameras.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "formats/collider.h"

namespace relief {

/// A perspective camera without roll.
struct Camera {
    glm::vec3 eye{0.0F, 0.0F, 1.0F};  ///< object space; not at target, nor directly above or below it
    glm::vec3 target{0.0F};
    float fov = 30.0F;        ///< vertical field of view in degrees, in (0, 180)
    float near_plane = 0.1F;  ///< distances along the viewing direction
    float far_plane = 100.0F;

    [[nodiscard]] glm::vec3 forward() const { return glm::normalize(target - eye); }
    [[nodiscard]] glm::vec3 right() const {
        return glm::normalize(glm::cross(forward(), glm::vec3(0.0F, 1.0F, 0.0F)));
    }
    [[nodiscard]] glm::vec3 up() const { return glm::cross(right(), forward()); }
    /// Returns half the height of the picture at distance 1.
    [[nodiscard]] float tanHalfFov() const { return std::tan(0.5F * glm::radians(fov)); }
    [[nodiscard]] glm::mat4 view() const { return glm::lookAt(eye, target, glm::vec3(0.0F, 1.0F, 0.0F)); }
    [[nodiscard]] glm::mat4 projection(float aspect) const {
        return glm::perspective(glm::radians(fov), aspect, near_plane, far_plane);
    }
    /// Returns (x, y) such that the window depth at view distance t is x + y / t.
    [[nodiscard]] glm::vec2 depthOfDistance() const {
        const float depth = far_plane - near_plane;
        return {far_plane / depth, -far_plane * near_plane / depth};
    }
    friend bool operator==(const Camera&, const Camera&) = default;
};

/// A camera as two matrices.
struct CameraMatrices {
    glm::mat4 view{1.0F};  ///< object to view space: rotation and translation; the camera looks along -z
    glm::mat4 projection{1.0F};  ///< perspective, view space to OpenGL clip space

    CameraMatrices(const glm::mat4& view_matrix, const glm::mat4& projection_matrix)
        : view(view_matrix), projection(projection_matrix) {}
    CameraMatrices(const Camera& camera, float aspect)
        : view(camera.view()), projection(camera.projection(aspect)) {}

    [[nodiscard]] float tanHalfFov() const { return 1.0F / projection[1][1]; }
    /// Like Camera::depthOfDistance().
    [[nodiscard]] glm::vec2 depthOfDistance() const {
        return {0.5F - 0.5F * projection[2][2], 0.5F * projection[3][2]};
    }
    [[nodiscard]] glm::vec3 eye() const { return -glm::transpose(glm::mat3(view)) * glm::vec3(view[3]); }
};

/// Returns an eye in front of a box (+z, the front in glTF), slightly to the right and above, such that the bounding
/// sphere fills about 4/5 of the picture height.
/// \param radius  of the bounding sphere, > 0.
[[nodiscard]] inline glm::vec3 defaultEye(const glm::vec3& target, float radius, float fov) {
    const float distance = 1.18F * radius / std::sin(0.5F * glm::radians(fov));
    return target + distance * glm::normalize(glm::vec3(0.42F, 0.36F, 1.0F));
}

/// Returns an eye in front of and above a level, such that its bounds fill about 9/10 of the picture.
/// \param bounds  not a point; contains the target. \param aspect  width / height of the picture.
[[nodiscard]] inline glm::vec3 levelEye(const glm::vec3& target, const Bounds& bounds, float fov,
                                        float aspect) {
    const glm::vec3 back = glm::normalize(glm::vec3(0.42F, 0.66F, 1.0F));
    const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0.0F, 1.0F, 0.0F), back));
    const glm::vec3 up = glm::cross(back, right);
    const float reach = 0.9F * std::tan(0.5F * glm::radians(fov));
    float distance = 0.0F;
    for (unsigned i = 0; i < 8; ++i) {
        const glm::vec3 corner = bounds.corner(i) - target;
        const float across =
            std::fmax(std::abs(glm::dot(corner, right)) / aspect, std::abs(glm::dot(corner, up)));
        distance = std::fmax(distance, glm::dot(corner, back) + across / reach);
    }
    return target + distance * back;
}

/// Sets the near and far planes around a scene with these bounds.
inline void setClipPlanes(Camera& camera, const Bounds& bounds) {
    const float distance = glm::length(camera.eye - bounds.center());
    const float radius = 0.5F * glm::length(bounds.size());
    camera.near_plane = 0.01F * std::fmax(std::fmax(distance, radius), 1e-6F);
    camera.far_plane = 2.0F * distance + 40.0F * radius + 1e-3F;
}

}  // namespace relief
