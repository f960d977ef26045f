// SPDX-License-Identifier: Apache-2.0
// The stage between reading a mesh and baking it: counts its faults, refuses or repairs it on request, and winds it outwards.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "bake/mesh/prepared_mesh.h"
#include "bake/repair/mesh_health.h"
#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

struct RepairOptions {
    bool strict = false;
    std::string method;   ///< "wrap" or "wrap=ALPHA"; empty: none
    bool examine = true;  ///< count faults even where no other option needs that
};

void fields(FieldVisitor& visit, RepairOptions& options);

/// The ALPHA of a repair method, in units of the longest side; 0 for an empty one. Errors: kUsage.
[[nodiscard]] Result<double> wrapAlpha(const std::string& method);

struct RepairReport {
    std::optional<MeshHealth> health;    ///< of the mesh as it came
    std::string repair;                  ///< "wrap=0.01", or ""
    std::optional<MeshHealth> repaired;  ///< after the repair
    std::uint64_t turned = 0;            ///< triangles, to face outwards
};

struct RepairedMesh {
    PreparedMesh mesh{TriangleMesh()};
    RepairReport report;
};

/// Errors: kUsage (the method), kInvalidInput (--strict), kFailure (the wrap failed), kLimit.
[[nodiscard]] Result<RepairedMesh> repairMesh(PreparedMesh mesh, const RepairOptions& options);

}  // namespace relief
