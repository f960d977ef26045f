// SPDX-License-Identifier: Apache-2.0
// Tests whether a patch represents the surface in a cell, at points near that surface.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "bake/patches/cell_columns.h"
#include "formats/patch_tree.h"

namespace relief {

/// Tests patches against points beside each triangle. The planner's sampling lines can miss features
/// thinner than their spacing; these points cannot.
class SurfaceProbe {
  public:
    /// \param query, cell  borrowed.
    /// \param triangles  from unitTriangles(), wound outwards.
    /// \param within  distance of the points from the surface, in cells.
    SurfaceProbe(const MeshQuery& query, const MeshCell& cell, std::span<const UnitTriangle> triangles,
                 double within);

    /// Whether every point is on the given side.
    [[nodiscard]] bool agreesWithAll(bool inside);
    /// Whether a single surface classifies all points correctly.
    [[nodiscard]] bool agreesWith(const PatchFrame& frame, const PatchHeights& heights, bool outside_below);
    /// The same for two surfaces, the lower one first. \param walls  the inside is between them.
    [[nodiscard]] bool agreesWith(const PatchFrame& frame, const std::array<PatchHeights, 2>& heights,
                                  bool walls);

  private:
    struct Point {
        glm::dvec3 at;  // unit cube
        bool inside;    // assumed from the winding of its triangle, unless `known`
        bool known;
    };
    void add(const glm::dvec3& at, const glm::dvec3& normal, double within);
    template <class IsInside>
    [[nodiscard]] bool agrees(const IsInside& is_inside);

    const MeshQuery& query_;
    const MeshCell& cell_;
    std::vector<Point> points_;
};

}  // namespace relief
