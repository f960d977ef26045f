// The depth of a triangle's plane at the rays of an orthographic view, which all run the same way.
#pragma once

#include <cstdint>

#include "bake/mesh/mesh.h"
#include "bake/plan/view.h"

namespace relief {

/// At the ray of texel (x, y) it is base + x · per_column + y · per_row.
struct PlaneDepth {
    double base = 0.0;
    double per_column = 0.0;
    double per_row = 0.0;
    double along = 0.0;  ///< dot(normal, direction of growing depth)
    bool grazing = false;

    /// Before it is held within the triangle, if it is grazing.
    [[nodiscard]] double at(std::uint32_t x, std::uint32_t y) const {
        return base + static_cast<double>(x) * per_column + static_cast<double>(y) * per_row;
    }
};

/// What is the same for all triangles of a view.
class PlaneDepths {
  public:
    /// \param mesh  borrowed; must outlive it.
    PlaneDepths(const TriangleMesh& mesh, const View& view);

    [[nodiscard]] PlaneDepth of(std::uint32_t triangle) const;

  private:
    const TriangleMesh& mesh_;
    TexelRay first_ray_;
    glm::dvec3 column_step_;
    glm::dvec3 row_step_;
};

/// The plane is seen so nearly edge-on that its depth may leave the triangle's.
[[nodiscard]] bool isGrazing(const glm::dvec3& normal, const glm::dvec3& direction, double along);

/// A depth on a triangle seen almost edge-on, held between the depths of its corners.
[[nodiscard]] double insideTriangle(const TriangleMesh& mesh, std::uint32_t triangle, const TexelRay& ray,
                                    double depth);

/// How a surface that a ray meets faces it: of surfaces that meet there, the one of the highest score counts. One that
/// faces the ray always beats one that does not.
/// \param winding  orientation() of the mesh.
[[nodiscard]] double facingScore(const TriangleMesh& mesh, std::uint32_t triangle, double winding,
                                 const glm::dvec3& direction);

}  // namespace relief
