// SPDX-License-Identifier: Apache-2.0
// Implements the stage between import and bake: counts faults, rejects or repairs the mesh on request, and winds it
// outwards.
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
    std::string method;   ///< "wrap" or "wrap=ALPHA"; empty: no repair
    bool examine = true;  ///< count faults even if no other option requires it
};

void fields(FieldVisitor& visit, RepairOptions& options);

/// Parses ALPHA from a repair method, in units of the longest side; 0 for an empty method. Errors: kUsage.
[[nodiscard]] Result<double> wrapAlpha(const std::string& method);

struct RepairReport {
    std::optional<MeshHealth> health;    ///< of the imported mesh
    std::string repair;                  ///< "wrap=0.01", or ""
    std::optional<MeshHealth> repaired;  ///< after the repair
    std::uint64_t turned = 0;            ///< triangles flipped to face outwards
};

struct RepairedMesh {
    PreparedMesh mesh{TriangleMesh()};
    RepairReport report;
};

/// Counts the faults of a mesh, repairs it on request, and winds it outwards.
/// Errors: kUsage (the method), kInvalidInput (--strict), kFailure (the wrap failed), kLimit.
[[nodiscard]] Result<RepairedMesh> repairMesh(PreparedMesh mesh, const RepairOptions& options);

}  // namespace relief
