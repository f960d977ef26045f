// SPDX-License-Identifier: Apache-2.0
// A map of gaps between solids (Compare::kGap): insides of cupboards, and the space between shelves, leaves and rails, which
// rays from outside do not reach.
//
//     viewer ──▶   ██      ████             ██     The ray of a texel's centre crosses gaps. A gap's weight is its length
//                    ╰────╯    ╰───────────╯       that no earlier map has outside; the one of the greatest weight is kept.
//                      gap     the longest gap
//
// From the middle of that gap the texel's rays are traced both ways, and a plane is fitted to the hits at either end, as to
// outer surfaces (plane_fit.h). Rays whose middle is not free do not count; where they are many, the texel stays empty. No
// plane stands along the rays, since a gap is bounded.
#pragma once

#include <cstdint>
#include <functional>

#include "bake/mesh/mesh_query.h"
#include "bake/plan/view.h"
#include "bake/texels/fitted_map.h"
#include "formats/depth_map.h"

namespace relief {

/// True of points of free space, in object space, that another map has outside. Called from many threads.
using IsKnown = std::function<bool(const glm::vec3&)>;

/// Bakes a map of gaps, on all cores of the current arena; the same for any number of them.
/// \param view      orthographic, of Compare::kGap
/// \param covered   receives the number of texels with a gap.
/// \param rowsDone  called with the number of texel rows finished, from the calling thread.
[[nodiscard]] DepthMap bakeGapMap(const MeshQuery& query, const TriangleNormals& normals, const View& view,
                                  const FittedMapOptions& options, const IsKnown& is_known,
                                  std::uint64_t& covered, const std::function<void(std::uint32_t)>& rowsDone);

}  // namespace relief
