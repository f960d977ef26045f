// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/area_table.h"

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

std::uint32_t AreaTable::triangleAt(double share) const {
    const auto found = std::upper_bound(up_to_.begin(), up_to_.end() - 1, share * up_to_.back());
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

}  // namespace relief
