// SPDX-License-Identifier: Apache-2.0
#include "bake/patches/surface_probe.h"

#include <algorithm>

namespace relief {
namespace {

/// A piece of a triangle gets only one point on each side up to this area, in cell sides squared, because 5² heights
/// are a quarter of the cell apart.
constexpr double kSmallArea = 1.0 / 256.0;
/// Fractions of the way from the center of a piece to its corners.
constexpr double kNearCorner = 0.97;
constexpr double kHalfway = 0.5;

/// Bilinear interpolation of heights over (u, v).
class PatchSurface {
  public:
    explicit PatchSurface(const PatchHeights& heights) : side_(heights.side) { heights.decode(heights_); }

    [[nodiscard]] double at(double u, double v) const {
        const double squares = side_ - 1;
        const double x = std::clamp(u, 0.0, 1.0) * squares;
        const double y = std::clamp(v, 0.0, 1.0) * squares;
        const auto column = std::min(static_cast<std::uint32_t>(x), side_ - 2);
        const auto row = std::min(static_cast<std::uint32_t>(y), side_ - 2);
        const double* const low = &heights_[row * side_ + column];
        const double* const high = low + side_;
        const double s = x - column;
        const double below = low[0] + s * (low[1] - low[0]);
        return below + (y - row) * (high[0] + s * (high[1] - high[0]) - below);
    }

  private:
    std::uint32_t side_;
    std::array<double, kPatchSideMax * kPatchSideMax> heights_{};
};

}  // namespace

SurfaceProbe::SurfaceProbe(const MeshQuery& query, const MeshCell& cell,
                           std::span<const UnitTriangle> triangles, double within)
    : query_(query), cell_(cell) {
    for (const UnitTriangle& triangle : triangles) {
        ClippedPolygon polygon;
        const ClippedTriangle piece = clipToUnitCube(triangle, &polygon);
        if (!(piece.area > 0.0)) {
            continue;
        }
        add(piece.center, piece.normal, within);
        for (unsigned i = 0; piece.area > kSmallArea && i < polygon.count; ++i) {
            const glm::dvec3 way = polygon.corners[i] - piece.center;
            add(piece.center + kHalfway * way, piece.normal, within);
            add(piece.center + kNearCorner * way, piece.normal, within);
        }
    }
}

void SurfaceProbe::add(const glm::dvec3& at, const glm::dvec3& normal, double within) {
    for (const bool inside : {false, true}) {
        const glm::dvec3 point = at + (inside ? -within : within) * normal;
        if (glm::all(glm::greaterThanEqual(point, glm::dvec3(0.0))) &&
            glm::all(glm::lessThanEqual(point, glm::dvec3(1.0)))) {
            points_.push_back({point, inside, false});
        }
    }
}

/// A point is usually on the side that its triangle implies, except behind a thin wall, in a narrow gap or in another
/// solid. A ray query decides, but only if the patch disagrees.
template <class IsInside>
bool SurfaceProbe::agrees(const IsInside& is_inside) {
    return std::all_of(points_.begin(), points_.end(), [&](Point& point) {
        const bool inside = is_inside(point.at);
        if (inside != point.inside && !point.known) {
            point.inside = query_.inside(glm::vec3(cell_.low + cell_.size * point.at));
            point.known = true;
        }
        return inside == point.inside;
    });
}

bool SurfaceProbe::agreesWithAll(bool inside) {
    return agrees([&](const glm::dvec3&) { return inside; });
}

bool SurfaceProbe::agreesWith(const PatchFrame& frame, const PatchHeights& heights, bool outside_below) {
    const PatchSurface surface(heights);
    return agrees([&](const glm::dvec3& p) {
        const glm::dvec3 across = frame.across(p);
        return (across.z < surface.at(across.x, across.y)) != outside_below;
    });
}

bool SurfaceProbe::agreesWith(const PatchFrame& frame, const std::array<PatchHeights, 2>& heights,
                              bool walls) {
    const PatchSurface low(heights[0]);
    const PatchSurface high(heights[1]);
    return agrees([&](const glm::dvec3& p) {
        const glm::dvec3 across = frame.across(p);
        const bool between = across.z >= low.at(across.x, across.y) && across.z < high.at(across.x, across.y);
        return between == walls;
    });
}

}  // namespace relief
