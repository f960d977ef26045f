// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/ray_cost.h"

#include <algorithm>

namespace relief {
namespace {

constexpr double kOrdinaryBoxes = 32.0;

double halfArea(const Bounds& box) {
    const glm::dvec3 size = box.size();
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

}  // namespace

double boxesOnLine(const TriangleMesh& mesh) {
    // Cauchy: a line through a convex body meets another body inside it with a probability equal to the ratio of their
    // areas.
    double sum = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        Bounds box;
        addTriangle(box, mesh, i);
        sum += halfArea(box);
    }
    const double whole = halfArea(mesh.bounds);
    return whole > 0.0 ? sum / whole : static_cast<double>(mesh.triangles.size());
}

double affordableRays(const TriangleMesh& mesh) {
    return std::min(1.0, kOrdinaryBoxes / std::max(boxesOnLine(mesh), 1.0));
}

}  // namespace relief
