// SPDX-License-Identifier: Apache-2.0
// Computes the thickness of shells.
#pragma once

#include <cstdint>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// Maximum --thickness, in units of the mesh's longest side.
inline constexpr double kThicknessMax = 0.5;

/// Returns 1.5 times the texel length of a bake of this box, because a thinner wall may not fill a texel; at most 4 %
/// of the box's longest side.
/// \param budget_bytes  for all texels.
[[nodiscard]] double defaultThickness(const Bounds& bounds, std::uint64_t budget_bytes);
/// Like defaultThickness(), for a given texel.
[[nodiscard]] double thicknessOfTexel(const Bounds& bounds, double texel);
/// Clamps a default to between 0.4 % and 25 % of a part's longest side. With `by_texel`, the lower limit is 0.01 %.
[[nodiscard]] double partThickness(double default_thickness, double part_size, bool by_texel = false);
/// Returns SurfacePart::right_thickness for a default thickness: at most a tenth of the part's longest side.
[[nodiscard]] double rightThickness(double thickness, double part_size);

/// Checks the thickness. Errors: kUsage, if shells would be thinner than 1e-4 of the smallest sheet's longest side, or
/// too thin for floats to resolve.
[[nodiscard]] Result<void> checkShellThickness(double thickness, double smallest_sheet,
                                               const TriangleMesh& mesh);

}  // namespace relief
