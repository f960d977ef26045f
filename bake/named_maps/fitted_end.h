// SPDX-License-Identifier: Apache-2.0
// Converts rays and planes between a RayEnd of a view and plane fits (plane_fit.h), where rays start at the viewer.
#pragma once

#include <algorithm>
#include <cstdint>

#include "bake/named_maps/plane_fit.h"
#include "bake/views/view.h"
#include "formats/depth_map.h"
#include "formats/texel.h"

namespace relief {

struct FittedMapOptions {
    /// Rays along each side of a texel's footprint, at the centres of equal parts.
    std::uint32_t samples = 4;
    int refinements = 3;  ///< rounds of search among neighbouring normals
    /// Object units. Free space behind a plane counts only up to this length along a ray, because other texels usually
    /// decide points that are farther away.
    double reach = 1.0;
    /// Object units: a plane with less mean free space behind it is not improved further.
    double good_enough = 0.0;
    /// If true, surface points up to half a sample beyond the texel may not lie in front of its plane either. This
    /// halves the number of points that are wrongly outside, and increases the number that are wrongly inside by half.
    bool cautious = false;
    double inward_shift = 0.0;  ///< PlaneFitOptions::inward_shift
};

/// Returns whether a texel is in the border of an orthographic map, which stays empty (depth_map.h).
[[nodiscard]] inline bool isBorder(const View& view, std::uint32_t x, std::uint32_t y) {
    return view.projection() == Projection::kOrthographic &&
           (x == 0 || y == 0 || x + 1 == view.width || y + 1 == view.height);
}

/// Derives the settings of fits from a view and the options of its map.
[[nodiscard]] inline PlaneFitOptions fitOptions(const View& view, const FittedMapOptions& map) {
    const double unit = view.depthUnit();
    PlaneFitOptions fit;
    fit.u_max = view.projection() == Projection::kCube ? double{kCubeDepthMax} : 1.0;
    const glm::vec3& s = view.object_per_map;
    fit.span = view.projection() == Projection::kCube
                   ? 2.0F * (s.x + s.y + s.z) / static_cast<float>(view.width)
                   : s.x / static_cast<float>(view.width) + s.y / static_cast<float>(view.height);
    fit.reach = map.reach / unit;
    fit.pixel_cost = map.good_enough / unit;
    fit.refinements = map.refinements;
    fit.inward_shift = map.inward_shift;
    return fit;
}

/// Maps depths to u, which grows away from the viewer.
class EndView {
  public:
    EndView(const View& view, RayEnd end)
        : far_(end == RayEnd::kFar),
          u_max_(view.projection() == Projection::kCube ? double{kCubeDepthMax} : 1.0) {}

    /// Converts a texel's ray to a ray from the viewer, without a hit.
    [[nodiscard]] FootprintRay fromViewer(const TexelRay& ray) const {
        return far_ ? FootprintRay{ray.origin + u_max_ * ray.direction, -ray.direction, -1.0, glm::dvec3(0.0)}
                    : FootprintRay{ray.origin, ray.direction, -1.0, glm::dvec3(0.0)};
    }
    [[nodiscard]] double uOf(double depth) const { return far_ ? u_max_ - depth : depth; }

    /// Returns the plane as a texel stores it; half-float depths are rounded towards the viewer.
    [[nodiscard]] Surface surfaceOf(const FittedPlane& plane, MapFormat format) const {
        // Exact in double precision: the plane's code and 16-bit depths use the same 65534 steps.
        constexpr double kCodes = kDepthSteps;
        const double code = plane.code;
        const double depth = (far_ ? kCodes - code : code) / kCodes * u_max_;
        return {format == MapFormat::kFrontBackHalf ? outwardHalf(depth, !far_) : static_cast<float>(depth),
                glm::vec3(plane.normal)};
    }

  private:
    static float outwardHalf(double depth, bool outwards_is_less) {
        const std::uint16_t nearest = encodeHalfDepth(static_cast<float>(depth));
        const double decoded = decodeHalfDepth(nearest);
        if (outwards_is_less && decoded > depth) {
            return decodeHalfDepth(std::max<std::uint16_t>(nearest - 1, encodeHalfDepth(0.0F)));
        }
        if (!outwards_is_less && decoded < depth) {
            return decodeHalfDepth(std::min<std::uint16_t>(nearest + 1, encodeHalfDepth(1.0F)));
        }
        return static_cast<float>(decoded);
    }

    bool far_;
    double u_max_;
};

}  // namespace relief
