// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/flat_faces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "bake/mesh/mesh_edges.h"

namespace relief {
namespace {

constexpr double kFlat = 1e-4;
/// Rounding of coordinates, relative to the mesh's longest side: six decimals are common at unit size.
constexpr double kRounding = 1e-6;

/// Maximum rotation attributed to rounding, in radians; rounding may rotate slivers by any angle.
constexpr double kTurnMax = 0.01;

double longestEdge(const TriangleMesh& mesh, std::uint32_t triangle) {
    const auto [a, b, c] = cornersOf(mesh, triangle);
    return static_cast<double>(std::max({distance(a, b), distance(b, c), distance(c, a)}));
}

}  // namespace

std::vector<FlatFace> flatFacesOf(const TriangleMesh& mesh) {
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    const double rounding =
        std::max(kRounding * double{mesh.bounds.longestSide()},
                 double{std::numeric_limits<float>::epsilon()} * double{mesh.bounds.farthest()});
    // Maximum rotation of a triangle's normal by rounding; the normal's length is twice the area.
    const auto turnOf = [&](std::uint32_t triangle, const glm::dvec3& normal) {
        return 2.0 * rounding * longestEdge(mesh, triangle) / length(normal);
    };
    const TriangleNeighbours neighbours = neighboursOf(edgesOf(mesh).uses);
    std::vector<FlatFace> faces(count);
    std::vector<bool> seen(count);
    std::vector<std::uint32_t> face;
    for (std::uint32_t first = 0; first < count; ++first) {
        if (seen[first]) {
            continue;
        }
        const glm::dvec3 normal = planeOf(mesh, first).normal;
        const double turn = turnOf(first, normal);
        FlatFace whole;
        face.assign(1, first);
        seen[first] = true;
        for (std::size_t i = 0; i < face.size(); ++i) {
            whole.area += 0.5 * length(planeOf(mesh, face[i]).normal);
            whole.length = std::max(whole.length, longestEdge(mesh, face[i]));
            for (int side = 0; side < 3; ++side) {
                const std::uint32_t next = neighbours.across[face[i]][side];
                if (next == TriangleNeighbours::kNone || seen[next]) {
                    continue;
                }
                const glm::dvec3 other = planeOf(mesh, next).normal;
                const double both = length(normal) * length(other);
                if (dot(normal, other) > 0.0 &&
                    length(cross(normal, other)) <
                        std::max(kFlat, std::min(turn + turnOf(next, other), kTurnMax)) * both) {
                    seen[next] = true;
                    face.push_back(next);
                }
            }
        }
        whole.length = std::max(whole.length, std::sqrt(whole.area));
        for (const std::uint32_t triangle : face) {
            faces[triangle] = whole;
        }
    }
    return faces;
}

}  // namespace relief
