// How thick the shell is that stands for a sheet.
#pragma once

#include <cstdint>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// The largest --thickness, in units of the mesh's longest side.
inline constexpr double kThicknessMax = 0.5;

/// A texel and a half of a planned bake of a box like this: a wall that fills its texels; at most 4 % of its longest side.
/// \param budget_bytes  of all texels.
[[nodiscard]] double defaultThickness(const Bounds& bounds, std::uint64_t budget_bytes);
/// The same for a part of that box: 0.4 to 25 % of its own longest side.
[[nodiscard]] double partThickness(double default_thickness, double part_size);
/// How much of a thickness that nobody asked for still counts as the part: a tenth of its longest side.
[[nodiscard]] double rightThickness(double thickness, double part_size);

/// Whether shells can be so thin: 1e-4 of the smallest sheet's longest side, and what floats resolve.
/// Errors: kUsage.
[[nodiscard]] Result<void> checkShellThickness(double thickness, double smallest_sheet,
                                               const TriangleMesh& mesh);

}  // namespace relief
