// SPDX-License-Identifier: Apache-2.0
// Computes the plane of a triangle in double precision. All depths and normals derive from it, so they do not depend on
// the processor or on the ray tracer's arithmetic.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <vector>

namespace relief {

[[nodiscard]] inline double dot(const glm::dvec3& a, const glm::dvec3& b) {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}
[[nodiscard]] inline glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

[[nodiscard]] inline double length(const glm::dvec3& v) {
    return std::sqrt(dot(v, v));
}
[[nodiscard]] inline glm::dvec3 unit(const glm::dvec3& v) {
    return v / length(v);
}

struct TrianglePlane {
    glm::dvec3 point;  ///< first corner, object space
    /// Length is twice the triangle's area, direction by the right-hand rule; zero unless hasArea().
    glm::dvec3 normal;
};

[[nodiscard]] inline TrianglePlane planeOf(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return {a, cross(b - a, c - a)};
}
[[nodiscard]] inline TrianglePlane planeOf(const std::vector<glm::vec3>& positions, const glm::uvec3& t) {
    return planeOf(positions[t.x], positions[t.y], positions[t.z]);
}

/// Whether the corners span a plane, so that its unit normal exists.
[[nodiscard]] inline bool hasArea(const TrianglePlane& plane) {
    return plane.normal != glm::dvec3(0.0);
}

}  // namespace relief
