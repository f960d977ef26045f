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
    // Of the lines through a convex body, those through another within it are as many as its share of the area (Cauchy).
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        Bounds box;
        for (const std::uint32_t corner : {t.x, t.y, t.z}) {
            box.add(mesh.positions[corner]);
        }
        sum += halfArea(box);
    }
    const double whole = halfArea(mesh.bounds);
    return whole > 0.0 ? sum / whole : static_cast<double>(mesh.triangles.size());
}

double affordableRays(const TriangleMesh& mesh) {
    return std::min(1.0, kOrdinaryBoxes / std::max(boxesOnLine(mesh), 1.0));
}

}  // namespace relief
