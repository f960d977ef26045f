// A map of supporting planes (plane_fit.h): traces the footprint of every texel and fits a plane to it.
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
    std::uint32_t samples =
        4;                ///< rays along each side of a texel's footprint, at the centres of as many parts
    int refinements = 3;  ///< rounds of search among neighbouring normals
    /// Object units. Free space behind a plane counts up to this length along a ray; a point farther off is hardly ever
    /// looked up in this texel alone.
    double reach = 1.0;
    double good_enough =
        0.0;  ///< mean free space behind a plane that is not improved any further, object units
    /// Surface points half a sample beyond the texel may not lie in front of its plane either: half as many points are
    /// outside by mistake, and half as many again inside.
    bool cautious = false;
    double let_back = 0.0;  ///< as PlaneFitOptions::let_back
};

/// The unit normals of all triangles, for the fits of all maps.
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
