// SPDX-License-Identifier: Apache-2.0
// Solids of unit cubes on integer coordinates: every vertex, edge and face lies on a plane that axis-aligned rays run
// along, and inside and distance are known exactly.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "bake/mesh/mesh.h"

namespace relief::test {

class VoxelGrid {
  public:
    /// All empty.
    explicit VoxelGrid(const glm::ivec3& size);

    /// Seeded: a share of full cells, made smoother or not; never all empty.
    [[nodiscard]] static VoxelGrid random(std::uint32_t seed);

    [[nodiscard]] const glm::ivec3& size() const { return size_; }
    /// Cells beyond the grid are empty.
    [[nodiscard]] bool full(const glm::ivec3& cell) const;
    void set(const glm::ivec3& cell, bool full);

    /// Two triangles for each face between a full and an empty cell, outwards; vertices are shared, so that edges of
    /// four triangles and pinched vertices occur. \param origin, scale  of the grid in object space.
    [[nodiscard]] TriangleMesh mesh(const glm::dvec3& origin = glm::dvec3(0.0), double scale = 1.0) const;

    /// Distance from a point, in grid units, to the nearest cell of the other kind: to the surface. At most `reach`,
    /// an integer, which is all that is looked at.
    [[nodiscard]] double distance(const glm::dvec3& p, int reach) const;
    [[nodiscard]] bool inside(const glm::dvec3& p) const;

  private:
    [[nodiscard]] std::size_t indexOf(const glm::ivec3& cell) const;

    glm::ivec3 size_;
    std::vector<bool> full_;
};

}  // namespace relief::test
