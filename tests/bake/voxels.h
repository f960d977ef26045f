// SPDX-License-Identifier: Apache-2.0
// Solids of unit cubes on integer coordinates. All vertices, edges and faces are on planes along which axis-aligned
// rays run. Sides and distances are exact.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "bake/mesh/mesh.h"

namespace relief::test {

class VoxelGrid {
  public:
    /// An empty grid.
    explicit VoxelGrid(const glm::ivec3& size);

    /// A random grid with a random fraction of full cells, either independent or in blocks. Never empty.
    [[nodiscard]] static VoxelGrid random(std::uint32_t seed);

    [[nodiscard]] const glm::ivec3& size() const { return size_; }
    /// Cells beyond the grid are empty.
    [[nodiscard]] bool full(const glm::ivec3& cell) const;
    void set(const glm::ivec3& cell, bool full);

    /// Two triangles for each face between a full and an empty cell, wound outward. Vertices are shared, so edges with
    /// four triangles and pinched vertices occur. \param origin, scale  transform from the grid to object space
    [[nodiscard]] TriangleMesh mesh(const glm::dvec3& origin = glm::dvec3(0.0), double scale = 1.0) const;

    /// Distance in grid units from a point to the surface, limited to the integer `reach`.
    [[nodiscard]] double distance(const glm::dvec3& p, int reach) const;
    [[nodiscard]] bool inside(const glm::dvec3& p) const;

  private:
    [[nodiscard]] std::size_t indexOf(const glm::ivec3& cell) const;

    glm::ivec3 size_;
    std::vector<bool> full_;
};

}  // namespace relief::test
