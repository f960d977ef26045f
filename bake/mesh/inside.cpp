#include "bake/mesh/inside.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

constexpr std::size_t kDirections = kParityDirections.size();

struct Crossings {
    std::array<std::uint64_t, kDirections> count{};
    std::array<std::int64_t, kDirections> winding{};
};

/// Moeller and Trumbore (1997), for the ray from the origin. \return 0 for a miss, else the side that it crosses to: ±1.
int crosses(const glm::dvec3& a, const glm::dvec3& edge1, const glm::dvec3& edge2,
            const glm::dvec3& direction) {
    const glm::dvec3 p = cross(direction, edge2);
    const double determinant = dot(edge1, p);
    if (determinant == 0.0) {
        return 0;
    }
    const glm::dvec3 from_corner = -a;
    const double u = dot(from_corner, p) / determinant;
    if (u < 0.0 || u > 1.0) {
        return 0;
    }
    const glm::dvec3 q = cross(from_corner, edge1);
    const double v = dot(direction, q) / determinant;
    const bool met = v >= 0.0 && u + v <= 1.0 && dot(edge2, q) / determinant > 0.0;
    return !met ? 0 : determinant > 0.0 ? 1 : -1;
}

}  // namespace

bool insideByParity(const PreparedMesh& prepared, const glm::vec3& point) {
    const TriangleMesh& mesh = *prepared;
    const glm::dvec3 origin = point;
    const auto count = [&](const tbb::blocked_range<std::size_t>& range, Crossings crossings) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const auto corners = cornersOf(mesh, static_cast<std::uint32_t>(i));
            const glm::dvec3 a = glm::dvec3(corners[0]) - origin;
            const glm::dvec3 edge1 = glm::dvec3(corners[1]) - origin - a;
            const glm::dvec3 edge2 = glm::dvec3(corners[2]) - origin - a;
            for (std::size_t d = 0; d < kDirections; ++d) {
                const int side = crosses(a, edge1, edge2, kParityDirections[d]);
                crossings.count[d] += side != 0 ? 1 : 0;
                crossings.winding[d] += side;
            }
        }
        return crossings;
    };
    const auto sum = [](Crossings a, const Crossings& b) {
        for (std::size_t d = 0; d < kDirections; ++d) {
            a.count[d] += b.count[d];
            a.winding[d] += b.winding[d];
        }
        return a;
    };
    const Crossings crossings = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 4096), Crossings{}, count, sum);
    std::size_t by_parity = 0;
    std::size_t by_winding = 0;
    for (std::size_t d = 0; d < kDirections; ++d) {
        by_parity += crossings.count[d] % 2;
        by_winding += crossings.winding[d] != 0 ? 1 : 0;
    }
    const bool odd = by_parity > kDirections / 2;
    const bool wound = by_winding > kDirections / 2;
    // woundShells() is expensive: only where the two disagree.
    return odd == wound || !prepared.woundShells() ? odd : wound;
}

}  // namespace relief
