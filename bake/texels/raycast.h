// A view and a mesh make samples: which triangle each texel's ray meets, and at what depth. By Embree.
#pragma once

#include <cstdint>
#include <span>

#include "bake/plan/view.h"
#include "bake/texels/ray_scene.h"

namespace relief {

/// Rows of one face of a view, in the order of a map's texels.
struct RowRange {
    std::uint32_t face = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  ///< one behind the last
};

/// Rays of this end that meet an inner side have started in the solid, although the view's empty texels are free.
[[nodiscard]] inline bool mayStartInside(const RayScene& scene, const View& view, RayEnd end) {
    return view.centre_on_surface && end == RayEnd::kNear && scene.closed();
}

/// Traces one ray a texel for one end of a view, on all cores of the current arena.
///
/// Embree decides which triangle is met; the depth is that of the triangle's plane in double precision. A
/// ray that meets an edge takes, of the triangles that share it, one that faces it, of those the one that
/// faces it most, and of equals the one of the lowest index: results depend neither on the number of
/// threads nor on the order in which the structure was built.
/// \param hits  (end − begin) · width, row by row.
void traceRows(const RayScene& scene, const View& view, RayEnd end, const RowRange& rows,
               std::span<Hit> hits);
/// The same on the calling thread alone.
void traceRowsAlone(const RayScene& scene, const View& view, RayEnd end, const RowRange& rows,
                    std::span<Hit> hits);

}  // namespace relief
