// SPDX-License-Identifier: Apache-2.0
// Builds the materials of a collider (formats/materials.h) from the triangles as imported. Caps, rims and unions are
// not part of the source's surface and get the nearest material.
#pragma once

#include <cstddef>

#include "bake/materials/material_source.h"
#include "formats/collider.h"
#include "formats/materials.h"

namespace relief {

/// Maximum size of the materials, as a fraction of the maps' bytes.
inline constexpr double kMaterialsFractionMax = 0.06;
/// Minimum allowance for a small collider: patches of flat surfaces use few bytes, regardless of their materials.
inline constexpr std::size_t kMaterialsBytesMin = 4096;

/// Builds the materials of a collider; none if `source` is null. Their budget is the larger of kMaterialsBytesMin and
/// kMaterialsFractionMax times the maps' bytes. If it does not suffice, minimizes the area with a wrong material. The
/// result does not depend on the number of threads.
[[nodiscard]] Materials materialsFor(const Collider& collider, const MaterialSource* source);

}  // namespace relief
