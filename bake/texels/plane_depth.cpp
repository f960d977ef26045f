#include "bake/texels/plane_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/mesh/triangle_plane.h"
#include "formats/depth_map.h"

namespace relief {

PlaneDepths::PlaneDepths(const TriangleMesh& mesh, const View& view)
    : mesh_(mesh),
      first_ray_(view.ray(0, 0, 0)),
      column_step_(view.axis[0] / static_cast<double>(view.width)),
      row_step_(view.axis[1] / static_cast<double>(view.height)) {}

PlaneDepth PlaneDepths::of(std::uint32_t triangle) const {
    const TrianglePlane plane = planeOf(mesh_, triangle);
    PlaneDepth depth;
    depth.along = dot(plane.normal, first_ray_.direction);
    const double per_along = 1.0 / depth.along;
    depth.grazing = isGrazing(plane.normal, first_ray_.direction, depth.along);
    depth.base = dot(plane.normal, plane.point - first_ray_.origin) * per_along;
    depth.per_column = -dot(plane.normal, column_step_) * per_along;
    depth.per_row = -dot(plane.normal, row_step_) * per_along;
    return depth;
}

bool isGrazing(const glm::dvec3& normal, const glm::dvec3& direction, double along) {
    return !(along * along >
             kGrazingCosine * kGrazingCosine * dot(normal, normal) * dot(direction, direction));
}

double insideTriangle(const TriangleMesh& mesh, std::uint32_t triangle, const TexelRay& ray, double depth) {
    const glm::uvec3& t = mesh.triangles[triangle];
    const double per_depth = dot(ray.direction, ray.direction);
    double low = std::numeric_limits<double>::max();
    double high = -low;
    for (const std::uint32_t corner : {t.x, t.y, t.z}) {
        const double at = dot(glm::dvec3(mesh.positions[corner]) - ray.origin, ray.direction) / per_depth;
        low = std::min(low, at);
        high = std::max(high, at);
    }
    return depth >= low && depth <= high ? depth : std::isnan(depth) || depth < low ? low : high;
}

double facingScore(const TriangleMesh& mesh, std::uint32_t triangle, double winding,
                   const glm::dvec3& direction) {
    const TrianglePlane plane = planeOf(mesh, triangle);
    const double length = std::sqrt(dot(plane.normal, plane.normal) * dot(direction, direction));
    const double facing = -winding * dot(plane.normal, direction) / length;
    return facing > 0.0 ? facing : -1.0 - facing;
}

}  // namespace relief
