// Closed parts that lie where another one does, but for rounding: an export of two copies, one grown by a millionth. What
// is between them is thinner than any wall that a collider can have, and would make the solid a hollow.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/shape/parts.h"

namespace relief {

/// In units of the longer part's longest side: no shell is thinner, so nothing fits between.
inline constexpr double kCopyReach = 1e-4;

struct NearCopies {
    std::vector<std::uint32_t> triangles;  ///< of all parts but the largest of each group, ascending
    std::uint64_t parts = 0;               ///< whose triangles these are
    double farthest = 0.0;  ///< of them, from a corner to the nearest of the part that counts: object units

    /// "2 closed parts lie within 1e-06 of another …"
    [[nodiscard]] std::string text() const;
};

/// Two parts are near copies if every corner of each has one of the other within kCopyReach of their longest side.
/// \param solids  closed, not flat; borrowed.
[[nodiscard]] NearCopies nearCopies(const TriangleMesh& mesh, std::span<const Part* const> solids);

}  // namespace relief
