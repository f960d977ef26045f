// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/surface_sampler.h"

namespace relief {
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
