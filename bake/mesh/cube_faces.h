// SPDX-License-Identifier: Apache-2.0
// Lists the faces of a cube map in OpenGL's order.
#pragma once

#include <glm/vec3.hpp>

namespace relief {

/// The axes of a cube face as sign · component: OpenGL 3.3, table 3.21.
struct CubeFaceAxes {
    struct Axis {
        int component;
        double sign;
        [[nodiscard]] double of(const glm::dvec3& v) const { return sign * v[component]; }
    };
    Axis s;
    Axis t;
    Axis major;
};
inline constexpr CubeFaceAxes kCubeFaces[6] = {
    {{2, -1.0}, {1, -1.0}, {0, 1.0}}, {{2, 1.0}, {1, -1.0}, {0, -1.0}}, {{0, 1.0}, {2, 1.0}, {1, 1.0}},
    {{0, 1.0}, {2, -1.0}, {1, -1.0}}, {{0, 1.0}, {1, -1.0}, {2, 1.0}},  {{0, -1.0}, {1, -1.0}, {2, -1.0}}};

}  // namespace relief
