// SPDX-License-Identifier: Apache-2.0
// Builds the ground below terrains.
//
//           surface
//       __/\_____/\___
//      │              │ walls
//      └──────────────┘ bottom
#pragma once

#include "bake/shape/sheet.h"
#include "bake/shape/solid_part.h"

namespace relief {

/// Builds the ground below a height field: walls below its border, and a flat bottom.
/// \param axis    0, 1 or 2: the up axis.
/// \param bottom  coordinate of the bottom along the axis, object units.
[[nodiscard]] SolidPart extruded(const Sheet& sheet, int axis, float bottom);

}  // namespace relief
