// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/surface_sampler.h"

#include <algorithm>

namespace relief {

AreaTable::AreaTable(const TriangleMesh& mesh) {
    up_to_.reserve(mesh.surfaceTriangles());
    double sum = 0.0;
    for (std::uint32_t i = 0; i < mesh.surfaceTriangles(); ++i) {
        sum += length(planeOf(mesh, i).normal);
        up_to_.push_back(sum);
    }
}

std::uint32_t AreaTable::triangleAt(double fraction) const {
    const auto found = std::upper_bound(up_to_.begin(), up_to_.end() - 1, fraction * up_to_.back());
    return static_cast<std::uint32_t>(found - up_to_.begin());
}

glm::dvec3 pointOn(const TriangleMesh& mesh, std::uint32_t triangle, double u, double v) {
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    const auto corners = cornersOf(mesh, triangle);
    const glm::dvec3 a = corners[0];
    return a + u * (glm::dvec3(corners[1]) - a) + v * (glm::dvec3(corners[2]) - a);
}

SurfaceDraw drawOnSurface(const TriangleMesh& mesh, const AreaTable& areas, double at,
                          MersenneRandom& random) {
    return drawOnTriangle(mesh, areas.triangleAt(at), random);
}

SurfaceDraw drawOnTriangle(const TriangleMesh& mesh, std::uint32_t triangle, MersenneRandom& random) {
    const double root = std::sqrt(random.uniform());
    const double along = random.uniform();
    const auto corners = cornersOf(mesh, triangle);
    return {(1.0 - root) * glm::dvec3(corners[0]) + root * (1.0 - along) * glm::dvec3(corners[1]) +
                root * along * glm::dvec3(corners[2]),
            unitNormal(mesh, triangle)};
}

}  // namespace relief
