// SPDX-License-Identifier: Apache-2.0
// The materials of a mesh as a collider keeps them (formats/materials.h): made from the triangles as they were imported, so that
// caps, rims and unions, which are no surface of the source, have the material of the nearest that is.
#pragma once

#include <cstddef>

#include "bake/materials/material_source.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/materials.h"

namespace relief {

/// Of the bytes of the maps: what materials may take.
inline constexpr double kMaterialsShare = 0.06;
/// Of a small collider: patches of flat surfaces take few bytes, whatever the materials on them.
inline constexpr std::size_t kMaterialsBytesMin = 4096;

/// The materials of an imported mesh, those with the same name as one; none where they all have one name.
/// \param mesh    whose labels are still the source's.
/// \param single  keeps a single one, too, if it has a name.
/// Errors, naming the mesh: kLimit (more than kMaterialsMax), kInvalidInput (one name with two responses).
[[nodiscard]] Result<MaterialSource> materialSource(const TriangleMesh& mesh, bool single);

/// The materials of a collider, within kMaterialsShare of its maps or kMaterialsBytesMin; none of a null source. Where these bytes do
/// not do, as little of its surface as they allow is wrong. The same for any number of threads.
[[nodiscard]] Materials materialsFor(const Collider& collider, const MaterialSource* source);

}  // namespace relief
