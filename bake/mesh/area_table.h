// Points spread evenly over the area of a mesh.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/mesh/mesh.h"

namespace relief {

/// Finds triangles by their share of the area. Caps have no part in it (TriangleMesh::cap_triangles).
class AreaTable {
  public:
    explicit AreaTable(const TriangleMesh& mesh);
    /// \param share  in [0, 1]: of the area, how much lies before the point that is looked for.
    /// \param from   what a lower share gave: looked for from there on, which is soon found where shares grow by little.
    [[nodiscard]] std::uint32_t triangleAt(double share, std::uint32_t from = 0) const;

  private:
    std::vector<double> up_to_;  // twice the area, up to and including each triangle
};

/// A point of a triangle, as likely anywhere on it if u and v are anywhere in [0, 1].
[[nodiscard]] glm::dvec3 pointOn(const TriangleMesh& mesh, std::uint32_t triangle, double u, double v);

}  // namespace relief
