// SPDX-License-Identifier: Apache-2.0
#include "bake/named_maps/projected_plane.h"

#include <algorithm>
#include <cmath>

#include "bake/mesh/mesh_query.h"
#include "formats/depth_map.h"

namespace relief {
namespace {

/// Whether the triangle is seen so nearly edge-on that the depth of its plane may leave the depth range of the
/// triangle.
bool isGrazing(const glm::dvec3& normal, const glm::dvec3& direction, double along) {
    return !(along * along >
             kGrazingCosine * kGrazingCosine * dot(normal, normal) * dot(direction, direction));
}

/// Returns the depth on a triangle seen almost edge-on, clamped to the depths of its corners.
double insideTriangle(const TriangleMesh& mesh, std::uint32_t triangle, const TexelRay& ray, double depth) {
    const LineSpan corners = cornerSpan(mesh, triangle, ray.origin, ray.direction);
    return depth >= corners.begin ? std::min(depth, corners.end) : corners.begin;  // NaN becomes `begin`
}

}  // namespace

ProjectedPlanes::ProjectedPlanes(const TriangleMesh& mesh, const View& view)
    : mesh_(mesh),
      view_(view),
      orthographic_(view.projection() == Projection::kOrthographic),
      first_ray_(view.ray(0, 0, 0)),
      column_step_(view.axis[0] / static_cast<double>(view.width)),
      row_step_(view.axis[1] / static_cast<double>(view.height)) {}

ProjectedPlane ProjectedPlanes::of(std::uint32_t triangle) const {
    const TrianglePlane plane = planeOf(mesh_, triangle);
    ProjectedPlane seen;
    seen.triangle = triangle;
    seen.normal = plane.normal;
    seen.ahead = dot(plane.normal, plane.point - first_ray_.origin);
    if (orthographic_) {
        seen.along = dot(plane.normal, first_ray_.direction);
        seen.grazing = isGrazing(plane.normal, first_ray_.direction, seen.along);
        const double per_along = 1.0 / seen.along;
        seen.base = seen.ahead * per_along;
        seen.per_column = -dot(plane.normal, column_step_) * per_along;
        seen.per_row = -dot(plane.normal, row_step_) * per_along;
    }
    return seen;
}

PlaneHit ProjectedPlanes::atAnyRay(const ProjectedPlane& plane, std::uint32_t face, std::uint32_t x,
                                   std::uint32_t y) const {
    if (orthographic_) {
        return {insideTriangle(mesh_, plane.triangle, view_.ray(face, x, y), depthAt(plane, x, y)),
                plane.along};
    }
    const TexelRay ray = view_.ray(face, x, y);
    const double along = dot(plane.normal, ray.direction);
    const double depth = plane.ahead / along;
    const bool grazing = isGrazing(plane.normal, ray.direction, along);
    return {grazing ? insideTriangle(mesh_, plane.triangle, ray, depth) : depth, along};
}

double facingScore(const TriangleMesh& mesh, std::uint32_t triangle, double winding,
                   const glm::dvec3& direction) {
    const TrianglePlane plane = planeOf(mesh, triangle);
    const double length = std::sqrt(dot(plane.normal, plane.normal) * dot(direction, direction));
    const double facing = -winding * dot(plane.normal, direction) / length;
    return facing > 0.0 ? facing : -1.0 - facing;
}

}  // namespace relief
