// SPDX-License-Identifier: Apache-2.0
// Selects triangles and points of a mesh by area.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/mesh/mesh.h"

namespace relief {

/// Finds triangles by cumulative area, excluding caps (TriangleMesh::cap_triangles).
class AreaTable {
  public:
    explicit AreaTable(const TriangleMesh& mesh);
    /// Returns the triangle at a fraction of the total area. \param share  in [0, 1].
    [[nodiscard]] std::uint32_t triangleAt(double share) const;

  private:
    std::vector<double> up_to_;  // per triangle, twice the cumulative area, including the triangle
};

/// Maps (u, v) to a point on the triangle; uniform if u and v are uniform in [0, 1].
[[nodiscard]] glm::dvec3 pointOn(const TriangleMesh& mesh, std::uint32_t triangle, double u, double v);

}  // namespace relief
