// SPDX-License-Identifier: Apache-2.0
// Computes the depths at which the rays of a view meet the plane of a triangle.
#pragma once

#include <cstdint>

#include "bake/mesh/mesh.h"
#include "bake/views/view.h"

namespace relief {

struct ProjectedPlane {
    std::uint32_t triangle = 0xffffffff;
    glm::dvec3 normal{0.0};
    // Orthographic, with parallel rays: the depth at texel (x, y) is base + x · per_column + y · per_row.
    double base = 0.0;
    double per_column = 0.0;
    double per_row = 0.0;
    double along = 0.0;  ///< dot(normal, direction of growing depth)
    bool grazing = false;
    double ahead = 0.0;  ///< dot(normal, point of the plane − origin of the rays)
};

struct PlaneHit {
    double depth;
    double along;  ///< dot(normal, direction of growing depth)
};

/// Makes the planes of a view.
class ProjectedPlanes {
  public:
    /// \param mesh, view  borrowed; must outlive this object.
    ProjectedPlanes(const TriangleMesh& mesh, const View& view);

    [[nodiscard]] ProjectedPlane of(std::uint32_t triangle) const;

    /// The hit of a texel's ray, clamped to the triangle's depths if the plane is seen almost edge-on.
    [[nodiscard]] PlaneHit at(const ProjectedPlane& plane, std::uint32_t face, std::uint32_t x,
                              std::uint32_t y) const {
        if (orthographic_ && !plane.grazing) {  // the common case; inline for millions of calls per bake
            return {depthAt(plane, x, y), plane.along};
        }
        return atAnyRay(plane, face, x, y);
    }

  private:
    static double depthAt(const ProjectedPlane& plane, std::uint32_t x, std::uint32_t y) {
        return plane.base + static_cast<double>(x) * plane.per_column +
               static_cast<double>(y) * plane.per_row;
    }
    [[nodiscard]] PlaneHit atAnyRay(const ProjectedPlane& plane, std::uint32_t face, std::uint32_t x,
                                    std::uint32_t y) const;

    const TriangleMesh& mesh_;
    const View& view_;
    bool orthographic_;
    TexelRay first_ray_;
    glm::dvec3 column_step_;
    glm::dvec3 row_step_;
};

/// Returns the score of a triangle. If several surfaces meet on a ray, the one with the highest score counts. Facing
/// the ray always beats facing away.
/// \param winding  orientation() of the mesh.
[[nodiscard]] double facingScore(const TriangleMesh& mesh, std::uint32_t triangle, double winding,
                                 const glm::dvec3& direction);

}  // namespace relief
