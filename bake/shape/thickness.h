// SPDX-License-Identifier: Apache-2.0
// The thickness of shells.
#pragma once

#include <cstdint>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// The largest --thickness, in units of the mesh's longest side.
inline constexpr double kThicknessMax = 0.5;

/// One and a half texels of a bake of this box, for walls that fill their texels; at most 4 % of its longest side.
/// \param budget_bytes  of all texels.
[[nodiscard]] double defaultThickness(const Bounds& bounds, std::uint64_t budget_bytes);
/// The same of a texel that is given.
[[nodiscard]] double thicknessOfTexel(const Bounds& bounds, double texel);
/// The same for a part of that box: 0.4 to 25 % of its own longest side; by a given texel also less.
[[nodiscard]] double partThickness(double default_thickness, double part_size, bool by_texel = false);
/// How much of a default thickness still counts as the part: a tenth of its longest side.
[[nodiscard]] double rightThickness(double thickness, double part_size);

/// Errors: kUsage, if shells would be thinner than 1e-4 of the smallest sheet's longest side or than floats resolve.
[[nodiscard]] Result<void> checkShellThickness(double thickness, double smallest_sheet,
                                               const TriangleMesh& mesh);

}  // namespace relief
