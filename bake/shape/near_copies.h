// SPDX-License-Identifier: Apache-2.0
// Finds closed parts that almost coincide with another part, as in an export of two copies, one enlarged by a
// millionth. The gap between them is thinner than any wall of a collider and would make the solid hollow.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/shape/parts.h"

namespace relief {

/// Maximum distance of near copies, in units of the longer part's longest side: the thickness of the thinnest shell.
inline constexpr double kCopyReach = 1e-4;

struct NearCopies {
    std::vector<std::uint32_t> triangles;  ///< of all parts except the largest of each group, ascending
    std::uint64_t parts = 0;               ///< number of parts of these triangles
    /// Largest distance from a corner to the nearest corner of the kept part, object units.
    double farthest = 0.0;

    /// Returns the warning: "2 closed parts lie within 1e-06 of another …".
    [[nodiscard]] std::string text() const;
};

/// Finds near copies: two parts in which every corner has a corner of the other part within kCopyReach of their longest
/// side.
/// \param solids  closed, not flat; borrowed.
[[nodiscard]] NearCopies nearCopies(const TriangleMesh& mesh, std::span<const Part* const> solids);

}  // namespace relief
