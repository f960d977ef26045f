// SPDX-License-Identifier: Apache-2.0
// Points beside the surface in a cell, which tell whether a patch holds it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "bake/patches/cell_columns.h"
#include "formats/patch_tree.h"

namespace relief {

/// Lines miss what is thinner than their distance; no triangle is without points.
class SurfaceProbe {
  public:
    /// \param query  borrowed, as the cell.
    /// \param triangles  of unitTriangles(), wound outwards.
    /// \param within  how far from the surface the points lie, in cells.
    SurfaceProbe(const MeshQuery& query, const MeshCell& cell, std::span<const UnitTriangle> triangles,
                 double within);

    /// All points are inside, or outside.
    [[nodiscard]] bool agreesWithAll(bool inside);
    /// They are inside where a single surface has them.
    [[nodiscard]] bool agreesWith(const PatchFrame& frame, const PatchHeights& heights, bool outside_below);
    /// The same of two surfaces, the lower one first. \param walls  inside is between.
    [[nodiscard]] bool agreesWith(const PatchFrame& frame, const std::array<PatchHeights, 2>& heights,
                                  bool walls);

  private:
    struct Point {
        glm::dvec3 at;  // unit cube
        bool inside;    // by its triangle alone, until it is known
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
