// SPDX-License-Identifier: Apache-2.0
// Closed parts that coincide with another one but for rounding, as in an export of two copies, one grown by a millionth. The
// space between them is thinner than any wall of a collider, and would make the solid hollow.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/shape/parts.h"

namespace relief {

/// In units of the longer part's longest side: the thickness of the thinnest shell.
inline constexpr double kCopyReach = 1e-4;

struct NearCopies {
    std::vector<std::uint32_t> triangles;  ///< of all parts but the largest of each group, ascending
    std::uint64_t parts = 0;               ///< number of parts of these triangles
    double farthest = 0.0;                 ///< from a corner to the nearest of the kept part, object units

    /// "2 closed parts lie within 1e-06 of another …"
    [[nodiscard]] std::string text() const;
};

/// Two parts are near copies if every corner of each has one of the other within kCopyReach of their longest side.
/// \param solids  closed, not flat; borrowed.
[[nodiscard]] NearCopies nearCopies(const TriangleMesh& mesh, std::span<const Part* const> solids);

}  // namespace relief
