// One map of gaps between solids (Compare::kGap): insides of cupboards, what lies between shelves, leaves and rails, where
// rays from outside meet something first.
//
//     viewer ──▶   ██      ████             ██     The ray of a texel's centre crosses gaps. Each counts by its length as
//                    ╰────╯    ╰───────────╯       far as no map before this one says that it is outside; the one that
//                      gap     the longest gap     counts most is kept.
//
// From the middle of that gap the texel's rays look both ways, and a plane is fitted to what they meet at either end, as to
// the outer surfaces (plane_fit.h). Rays whose middle is not free do not count; where they are many, the texel stays
// empty. No plane stands along the rays: a gap has an end.
#pragma once

#include <cstdint>
#include <functional>

#include "bake/mesh/mesh_query.h"
#include "bake/plan/view.h"
#include "bake/texels/fitted_map.h"
#include "formats/depth_map.h"

namespace relief {

/// Says of a point of free space, in object space, whether another map knows that it is outside. Called from many threads.
using IsKnown = std::function<bool(const glm::vec3&)>;

/// How much of a gap counts: object units. \param direction  of a unit of the gap's parameter.
[[nodiscard]] double unknownLength(const LineGap& gap, const glm::dvec3& origin, const glm::dvec3& direction,
                                   const IsKnown& is_known);

/// Bakes one map of gaps, on all cores of the current arena; the same for any number of them.
/// \param view      orthographic, of Compare::kGap
/// \param rowsDone  called with the number of texel rows finished, from the calling thread.
/// \param covered   out: texels with a gap.
[[nodiscard]] DepthMap bakeGapMap(const MeshQuery& query, const TriangleNormals& normals, const View& view,
                                  const FittedMapOptions& options, const IsKnown& is_known,
                                  std::uint64_t& covered, const std::function<void(std::uint32_t)>& rowsDone);

}  // namespace relief
