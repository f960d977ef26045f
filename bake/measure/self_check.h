// SPDX-License-Identifier: Apache-2.0
// The measurement that a bake makes of its own result.
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
    WrongShare wrong;                    ///< near the surface
    std::optional<PartsAccuracy> parts;  ///< if there are several
};

/// By 4000 points near the surface, and at most 64 near each of the 1024 largest parts.
/// \param mesh   the solid of `parts`.
/// \param scale  of the object in its world, at most.
/// Errors: those of MeshQuery::build.
[[nodiscard]] Result<SelfCheck> selfCheck(const PreparedMesh& mesh, const SurfaceParts& parts,
                                          const Collider& collider, double scale = 1.0);

}  // namespace relief
