// A view and a mesh make samples: which triangle each texel's ray meets, and at what depth.
#pragma once

#include <optional>
#include <span>

#include "bake/plan/view.h"
#include "bake/texels/ray_scene.h"
#include "bake/texels/scan_convert.h"

namespace relief {

/// Rays of this end that meet an inner side have started in the solid, although the view's empty texels are free.
[[nodiscard]] inline bool mayStartInside(const RayScene& scene, const View& view, RayEnd end) {
    return view.centre_on_surface && end == RayEnd::kNear && scene.closed();
}

/// Follows one ray a texel, for the ends that a view keeps. Cubes by Embree, one ray after the other; orthographic views
/// by scan conversion (scan_convert.h), of all triangles at once.
///
/// The depth is that of the triangle's plane in double precision. A ray that meets an edge takes, of the triangles that
/// share it, one that faces it, of those the one that faces it most, and of equals the one of the lowest index: results
/// depend neither on the number of threads nor on the order in which a structure was built.
class ViewTracer {
  public:
    /// \param scene, view  borrowed; must outlive it.
    ViewTracer(const RayScene& scene, const View& view);

    /// On all cores of the current arena.
    /// \param near, far  (end − begin) · width, row by row; empty where the end is not wanted.
    void trace(const RowRange& rows, std::span<Hit> near, std::span<Hit> far) const;
    /// The same on the calling thread alone.
    void traceAlone(const RowRange& rows, std::span<Hit> near, std::span<Hit> far) const;

  private:
    const RayScene& scene_;
    const View& view_;
    std::optional<ScanConverter> scan_;
};

}  // namespace relief
