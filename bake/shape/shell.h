// SPDX-License-Identifier: Apache-2.0
// Builds shells around sheets.
//
//            top: + thickness/2
//      ┌──────────────────────────┐
//      │· · · · · sheet · · · · · │
//      └──────────────────────────┘
//            bottom: − thickness/2
#pragma once

#include "bake/mesh/mesh_query.h"
#include "bake/shape/sheet.h"
#include "bake/shape/solid_part.h"

namespace relief {

/// Builds the shell within half the thickness along the sheet's normals. Edges have mitres, the border has flat ends,
/// and corners have bevels if a common mitre would leave a side thin. Each patch of joined triangles becomes one closed
/// surface. A region that is thinner than the shell, such as a rod, is filled; its offset surface would turn inside out
/// and is omitted.
/// \param query      for the sheet's triangles.
/// \param thickness  object units, above 0.
[[nodiscard]] SolidPart thickened(Sheet sheet, const MeshQuery& query, double thickness);

}  // namespace relief
