// SPDX-License-Identifier: Apache-2.0
// Fits what a leaf may hold to its cell.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "bake/patches/patch_fit.h"
#include "bake/patches/patch_node.h"

namespace relief {

/// Lines along each side of a cell, multiples of 4.
struct LeafLines {
    unsigned choose = 12;  ///< to choose by
    unsigned keep = 20;    ///< for the 5² heights that are kept
};

[[nodiscard]] std::vector<ClippedTriangle> clippedTriangles(std::span<const UnitTriangle> triangles);

/// All functions are thread-safe for different nodes.
class LeafFitter {
  public:
    /// \param query  borrowed.
    LeafFitter(const MeshQuery& query, const ErrorCosts& costs, const LeafLines& lines);

    /// Tries what may pay where a byte is worth so much wrong volume.
    void tryWorth(PatchNode& node, double byte) const;
    /// Takes the first that holds the surface, in the order of their bytes but for pairs, which come last: points that lie by
    /// `within` beside it are on their side, and no more is on the wrong one than half of that on average over a side of
    /// the cell. If none does, takes the cheapest where a byte is worth so much.
    /// \param within  object units.
    /// \return whether the node's leaf holds the surface; one without triangles does.
    bool hold(PatchNode& node, double within, double byte) const;

    /// The texels of a leaf with a single surface, or with two.
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
