// SPDX-License-Identifier: Apache-2.0
// Fits the possible contents of a leaf to its cell.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "bake/patches/patch_fit.h"
#include "bake/patches/patch_node.h"

namespace relief {

/// Number of sampling lines along each side of a cell; multiples of 4.
struct LeafLines {
    unsigned choose = 12;  ///< to choose a shape
    unsigned keep = 20;    ///< to fit the 5² heights that are kept
};

[[nodiscard]] std::vector<ClippedTriangle> clippedTriangles(std::span<const UnitTriangle> triangles);

/// All functions are thread-safe for different nodes.
class LeafFitter {
  public:
    /// \param query  borrowed.
    LeafFitter(const MeshQuery& query, const ErrorCosts& costs, const LeafLines& lines);

    /// Tries the shapes that may pay off if a byte is worth `byte` of misclassified volume, object units cubed.
    void tryWorth(PatchNode& node, double byte) const;
    /// Chooses the first shape that represents the surface, in ascending order of bytes, pairs last. A shape represents
    /// the surface if the points at distance `within` from the surface are on their correct side, and the misclassified
    /// volume is at most half of `within` times the area of a side of the cell. If no shape does, chooses the shape
    /// with the lowest misclassified volume plus `byte` times its bytes.
    /// \param within  object units.
    /// \return whether the leaf represents the surface; true for a node without triangles.
    bool hold(PatchNode& node, double within, double byte) const;

    /// Returns the heights of a leaf with a single surface; pair() returns those of a leaf with two.
    [[nodiscard]] PatchHeights heights(const PatchNode& node) const;
    [[nodiscard]] std::array<PatchHeights, 2> pair(const PatchNode& node) const;

  private:
    [[nodiscard]] bool tryEmpty(PatchNode& node) const;
    [[nodiscard]] CellColumns keptColumns(const PatchNode& node) const;

    const MeshQuery& query_;
    ErrorCosts costs_;
    std::vector<LineGrid> grids_;  // by frame
    std::vector<LineGrid> kept_grids_;
};

}  // namespace relief
