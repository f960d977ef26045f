// SPDX-License-Identifier: Apache-2.0
// Random points on a mesh, with the same bits everywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/mesh/area_table.h"
#include "bake/mesh/mersenne.h"
#include "bake/mesh/mesh.h"

namespace relief {

/// Offset of points from the surface, in units of the longest side, to tell its sides apart and for lines of sight to it.
/// Half of the free space round a tight map.
inline constexpr double kSurfaceStep = 5e-5;

/// Random numbers with the same bits everywhere: no library distribution, no libm.
class MersenneRandom {
  public:
    explicit MersenneRandom(std::uint64_t seed) : engine_(seed) {}
    /// The generator of the i-th sample, so that samples can be drawn in any order.
    MersenneRandom(std::uint64_t seed, std::uint64_t i) : engine_(seed * 0x9e3779b97f4a7c15U + i) {}
    /// In [0, 1).
    double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
    std::size_t below(std::size_t count) {
        return std::min(static_cast<std::size_t>(uniform() * static_cast<double>(count)), count - 1);
    }
    /// Nearly normal, of mean 0 and deviation 1: the sum of twelve uniform 16-bit numbers, four from each draw.
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
            // Braces, as compilers choose the order of a call's arguments.
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

struct SurfaceDraw {
    glm::dvec3 position;
    glm::dvec3 normal;  ///< unit length, by the triangle's winding
};

/// Uniform on a triangle.
[[nodiscard]] SurfaceDraw drawOnTriangle(const TriangleMesh& mesh, std::uint32_t triangle,
                                         MersenneRandom& random);

/// \param at  in [0, 1]: as AreaTable::triangleAt has it; stratify over it.
[[nodiscard]] SurfaceDraw drawOnSurface(const TriangleMesh& mesh, const AreaTable& areas, double at,
                                        MersenneRandom& random);

}  // namespace relief
