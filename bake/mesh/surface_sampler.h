// Random points on and about a mesh, for work that must give the same bytes everywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/mesh/area_table.h"
#include "bake/mesh/mersenne.h"
#include "bake/mesh/mesh.h"
#include "bake/mesh/mesh_query.h"

namespace relief {

/// Surface points are moved outwards by this much, in units of the longest side, to tell the sides of the
/// surface apart and to look for them from the maps. Half of the free space round a tight map.
inline constexpr double kSurfaceStep = 5e-5;

/// Uniform numbers with the same bits everywhere: no library distribution, no libm.
class MersenneRandom {
  public:
    explicit MersenneRandom(std::uint64_t seed) : engine_(seed) {}
    /// In [0, 1).
    double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
    std::size_t below(std::size_t count) {
        return std::min(static_cast<std::size_t>(uniform() * static_cast<double>(count)), count - 1);
    }
    /// About normal, of mean 0 and deviation 1: the sum of twelve uniform numbers of 16 bits, four of each draw.
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
            // In braces: the arguments of a call are evaluated in an order that the compiler chooses.
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

/// A point on the surface.
struct SurfaceDraw {
    glm::dvec3 position;
    glm::dvec3 normal;  ///< unit length, by the triangle's winding
};

/// Anywhere on a triangle.
[[nodiscard]] SurfaceDraw drawOnTriangle(const TriangleMesh& mesh, std::uint32_t triangle,
                                         MersenneRandom& random);

/// \param at  in [0, 1]: the share of the area that lies before the point's triangle; stratify over it.
[[nodiscard]] SurfaceDraw drawOnSurface(const TriangleMesh& mesh, const AreaTable& areas, double at,
                                        MersenneRandom& random);

/// A point near the surface, of which it is known whether it is inside.
struct LabelledPoint {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0.0F};  ///< of the surface beside it, outwards
    bool inside = false;
};

/// Points at a normally distributed offset along the surface's normal.
/// \param sigma  standard deviation, object units
/// The same for any number of threads. Where the mesh is not closed or its winding cannot be trusted, every
/// point is asked for by rays, which takes ten times as long: `count` is divided by 4 then.
[[nodiscard]] std::vector<LabelledPoint> drawNearSurface(const MeshQuery& query, std::size_t count,
                                                         double sigma, std::uint64_t seed);

}  // namespace relief
