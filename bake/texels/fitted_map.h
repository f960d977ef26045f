// One map of supporting planes (plane_fit.h): traces the footprint of every texel, and fits a plane to it.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/plan/view.h"
#include "bake/texels/ray_scene.h"
#include "formats/depth_map.h"

namespace relief {

struct FittedMapOptions {
    /// Rays along each side of a texel's footprint: samples · samples in all, at the centres of as many
    /// parts.
    std::uint32_t samples = 4;
    /// Rounds of search among neighbouring normals.
    int refinements = 3;
    /// Object units. Free space behind a plane counts up to this length along a ray: beyond it a point is
    /// hardly ever looked up in this texel alone.
    double reach = 1.0;
    /// Object units. A plane that leaves less free space than this, on average, is not improved any further.
    double good_enough = 0.0;
    /// Surface points half a sample beyond the texel may not lie in front of its plane either: half as many
    /// points are called outside wrongly, and half as many again inside.
    bool cautious = false;
    /// As PlaneFitOptions::let_back.
    double let_back = 0.0;
};

/// What the fits of all maps share: the unit normal of every triangle.
class TriangleNormals {
  public:
    explicit TriangleNormals(const TriangleMesh& mesh);
    [[nodiscard]] const glm::dvec3& operator[](std::uint32_t triangle) const { return normals_[triangle]; }

  private:
    std::vector<glm::dvec3> normals_;
};

/// Bakes one map with Decode::kPlane, on all cores of the current arena; the same for any number of them.
/// \param rowsDone  called with the number of texel rows finished, from several threads at once.
/// \param covered   out: texels with a surface.
[[nodiscard]] DepthMap bakeFittedMap(const RayScene& scene, const TriangleNormals& normals, const View& view,
                                     const FittedMapOptions& options, std::uint64_t& covered,
                                     const std::function<void(std::uint32_t)>& rowsDone);

}  // namespace relief
