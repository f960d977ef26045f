// The plane of a triangle, in double precision: the one source of depths and normals, so that both are the
// same on every processor, whatever the ray tracer's own arithmetic is.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "bake/mesh/mesh.h"

namespace relief {

[[nodiscard]] inline double dot(const glm::dvec3& a, const glm::dvec3& b) {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}
[[nodiscard]] inline glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct TrianglePlane {
    glm::dvec3 point;   ///< first corner, object space
    glm::dvec3 normal;  ///< of length twice the triangle's area, by the right-hand rule; never zero
};

/// \param triangle  index into mesh.triangles.
[[nodiscard]] inline TrianglePlane planeOf(const TriangleMesh& mesh, std::uint32_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    const glm::dvec3 a = mesh.positions[t.x];
    return {a, cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a)};
}

}  // namespace relief
