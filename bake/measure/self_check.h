// SPDX-License-Identifier: Apache-2.0
// Measures the result of a bake as part of the bake.
#pragma once

#include <optional>

#include "bake/measure/accuracy.h"
#include "bake/measure/part_accuracy.h"
#include "bake/mesh/prepared_mesh.h"
#include "bake/mesh/surface_parts.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

struct SelfCheck {
    WrongPercent wrong;                  ///< near the surface
    std::optional<PartsAccuracy> parts;  ///< set if there are several parts
};

/// Measures with 4000 points near the surface, and at most 64 near each of the 1024 largest parts.
/// \param mesh   the solid of `parts`.
/// \param scale  the object's largest scale in its world.
/// Errors: those of MeshQuery::build.
[[nodiscard]] Result<SelfCheck> selfCheck(const PreparedMesh& mesh, const SurfaceParts& parts,
                                          const Collider& collider, double scale = 1.0);

}  // namespace relief
