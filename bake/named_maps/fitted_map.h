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

/// Returns the unit normals of all triangles.
[[nodiscard]] std::vector<glm::dvec3> unitNormals(const TriangleMesh& mesh);

/// Bakes a map with Decode::kPlane on all threads of the current TBB arena. The result does not depend on their number.
/// \param normals   from unitNormals(); shared by all maps.
/// \param rowsDone  called with the number of newly finished texel rows, from several threads at once.
/// \param covered   receives the number of texels with a surface.
[[nodiscard]] DepthMap bakeFittedMap(const RayScene& scene, const std::vector<glm::dvec3>& normals,
                                     const View& view, const FittedMapOptions& options,
                                     std::uint64_t& covered,
                                     const std::function<void(std::uint32_t)>& rowsDone);

}  // namespace relief
