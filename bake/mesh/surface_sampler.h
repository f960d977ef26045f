// SPDX-License-Identifier: Apache-2.0
// Selects triangles and points of a mesh by area, and draws random points, bit-identical on all platforms.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/mesh/mersenne.h"
#include "bake/mesh/mesh.h"

namespace relief {

/// Offset of points from the surface, in units of the longest side. Separates the two sides of a surface, and keeps
/// lines of sight off it. Half of the margin of a volume that fits the mesh (bake/views/view.h).
inline constexpr double kSurfaceStep = 5e-5;

/// A portable random generator: uses no library distribution and no libm.
class MersenneRandom {
  public:
    explicit MersenneRandom(std::uint64_t seed) : engine_(seed) {}
    /// The generator of sample i, so that samples can be drawn in any order.
    MersenneRandom(std::uint64_t seed, std::uint64_t i) : engine_(seed * 0x9e3779b97f4a7c15U + i) {}
    /// Uniform in [0, 1).
    double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
    std::size_t below(std::size_t count) {
        return std::min(static_cast<std::size_t>(uniform() * static_cast<double>(count)), count - 1);
    }
    /// Approximately normal, with mean 0 and deviation 1: the sum of twelve uniform 16-bit numbers, four per draw.
    double normal() {
        std::uint64_t sum = 0;
        for (int i = 0; i < 3; ++i) {
            const std::uint64_t bits = engine_();
            sum += (bits & 0xffffU) + (bits >> 16U & 0xffffU) + (bits >> 32U & 0xffffU) + (bits >> 48U);
        }
        return (static_cast<double>(sum) + 6.0) * 0x1p-16 - 6.0;
    }
    glm::dvec3 direction() {
        for (;;) {
            // Braces fix the order of evaluation.
            const glm::dvec3 v{2.0 * uniform() - 1.0, 2.0 * uniform() - 1.0, 2.0 * uniform() - 1.0};
            const double square = v.x * v.x + (v.y * v.y + v.z * v.z);
            if (square <= 1.0 && square > 1e-4) {
                return v / std::sqrt(square);
            }
        }
    }

  private:
    Mersenne64 engine_;
};

/// Finds triangles by cumulative area, excluding caps (TriangleMesh::cap_triangles).
class AreaTable {
  public:
    explicit AreaTable(const TriangleMesh& mesh);
    /// Returns the triangle at a fraction of the total area. \param fraction  in [0, 1].
    [[nodiscard]] std::uint32_t triangleAt(double fraction) const;

  private:
    std::vector<double> up_to_;  // per triangle, twice the cumulative area, including the triangle
};

/// Maps (u, v) to a point on the triangle; uniform if u and v are uniform in [0, 1].
[[nodiscard]] glm::dvec3 pointOn(const TriangleMesh& mesh, std::uint32_t triangle, double u, double v);

struct SurfaceDraw {
    glm::dvec3 position;
    glm::dvec3 normal;  ///< unit length, following the triangle's winding
};

/// Draws uniformly on a triangle.
[[nodiscard]] SurfaceDraw drawOnTriangle(const TriangleMesh& mesh, std::uint32_t triangle,
                                         MersenneRandom& random);

/// Draws on the surface. \param at  the argument of AreaTable::triangleAt, in [0, 1]; stratify over it.
[[nodiscard]] SurfaceDraw drawOnSurface(const TriangleMesh& mesh, const AreaTable& areas, double at,
                                        MersenneRandom& random);

}  // namespace relief
