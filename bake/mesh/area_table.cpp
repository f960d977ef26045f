#include "bake/mesh/area_table.h"

#include <algorithm>
#include <cmath>

#include "bake/mesh/triangle_plane.h"

namespace relief {

AreaTable::AreaTable(const TriangleMesh& mesh) {
    up_to_.reserve(mesh.surfaceTriangles());
    double sum = 0.0;
    for (std::uint32_t i = 0; i < mesh.surfaceTriangles(); ++i) {
        const glm::dvec3 normal = planeOf(mesh, i).normal;
        sum += std::sqrt(dot(normal, normal));
        up_to_.push_back(sum);
    }
}

std::uint32_t AreaTable::triangleAt(double share, std::uint32_t from) const {
    const double area = share * up_to_.back();
    const auto last = up_to_.end() - 1;
    auto begin = up_to_.begin() + from;
    std::ptrdiff_t step = from == 0 ? last - begin : 1;
    while (last - begin > step && begin[step] <= area) {
        begin += step;
        step *= 2;
    }
    const auto found = std::upper_bound(begin, begin + std::min(step, last - begin), area);
    return static_cast<std::uint32_t>(found - up_to_.begin());
}

glm::dvec3 pointOn(const TriangleMesh& mesh, std::uint32_t triangle, double u, double v) {
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    const glm::uvec3& t = mesh.triangles[triangle];
    const glm::dvec3 a = mesh.positions[t.x];
    return a + u * (glm::dvec3(mesh.positions[t.y]) - a) + v * (glm::dvec3(mesh.positions[t.z]) - a);
}

}  // namespace relief
