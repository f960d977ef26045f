#include "bake/mesh/triangle_plane.h"

#include <cmath>

namespace relief {

double orientation(const TriangleMesh& mesh) {
    const glm::dvec3 center = mesh.bounds.center();
    glm::dvec3 area_vector(0.0);
    double area = 0.0;
    double volume = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const TrianglePlane plane = planeOf(mesh, i);
        area_vector += plane.normal;
        area += std::sqrt(dot(plane.normal, plane.normal));
        volume += dot(plane.point - center, plane.normal);
    }
    const bool closed = std::sqrt(dot(area_vector, area_vector)) <= 1e-5 * area;
    return closed && volume < 0.0 ? -1.0 : 1.0;
}

}  // namespace relief
