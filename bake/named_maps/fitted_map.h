// SPDX-License-Identifier: Apache-2.0
// Bakes a map of supporting planes (plane_fit.h): traces rays in each texel's footprint and fits a plane to their hits.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/named_maps/fitted_end.h"
#include "bake/named_maps/ray_scene.h"
#include "bake/views/view.h"
#include "formats/depth_map.h"

namespace relief {

/// The unit normals of all triangles, shared by the fits of all maps.
class TriangleNormals {
  public:
    explicit TriangleNormals(const TriangleMesh& mesh);
    [[nodiscard]] const glm::dvec3& operator[](std::uint32_t triangle) const { return normals_[triangle]; }

  private:
    std::vector<glm::dvec3> normals_;
};

/// Bakes a map with Decode::kPlane on all threads of the current TBB arena. The result does not depend on their number.
/// \param rowsDone  called with the number of newly finished texel rows, from several threads at once.
/// \param covered   receives the number of texels with a surface.
[[nodiscard]] DepthMap bakeFittedMap(const RayScene& scene, const TriangleNormals& normals, const View& view,
                                     const FittedMapOptions& options, std::uint64_t& covered,
                                     const std::function<void(std::uint32_t)>& rowsDone);

}  // namespace relief
