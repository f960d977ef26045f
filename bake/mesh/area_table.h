// SPDX-License-Identifier: Apache-2.0
// Choosing triangles and points of a mesh by area.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/mesh/mesh.h"

namespace relief {

/// Finds triangles by cumulative area, without caps (TriangleMesh::cap_triangles).
class AreaTable {
  public:
    explicit AreaTable(const TriangleMesh& mesh);
    /// \param share  in [0, 1]: of the area before the wanted point.
    [[nodiscard]] std::uint32_t triangleAt(double share) const;

  private:
    std::vector<double> up_to_;  // twice the area, up to and including each triangle
};

/// Uniform over the triangle if u and v are uniform in [0, 1].
[[nodiscard]] glm::dvec3 pointOn(const TriangleMesh& mesh, std::uint32_t triangle, double u, double v);

}  // namespace relief
