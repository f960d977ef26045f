// What `relief bake` does with a mesh between reading and baking it: counts what is wrong with it, refuses or
// repairs it if asked to, and winds it outwards.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "bake/mesh/prepared_mesh.h"
#include "bake/repair/mesh_health.h"
#include "formats/base/result.h"

namespace relief {

struct MeshCareOptions {
    bool strict = false;
    bool check_intersections = false;
    std::string repair;  ///< as on the command line; empty: none
    bool report = true;  ///< count what is wrong though no other option asks for it
};

/// Whether --repair can be understood. Errors: kUsage.
[[nodiscard]] Result<void> checkMeshCare(const MeshCareOptions& options);

struct MeshCare {
    std::optional<MeshHealth> health;    ///< of the mesh as it came
    std::string repair;                  ///< "wrap=0.01", "orient", "holes", or ""
    std::optional<MeshHealth> repaired;  ///< after the repair
    std::uint64_t filled_holes = 0;      ///< by --repair holes, as is the next
    std::uint64_t holes_left = 0;
    std::uint64_t turned = 0;  ///< triangles, to look outwards
};

struct CaredMesh {
    PreparedMesh mesh{TriangleMesh()};
    MeshCare care;
};

/// Errors: as checkMeshCare; kInvalidInput (--strict, and those of fillHoles), kFailure (a repair failed),
/// kLimit.
[[nodiscard]] Result<CaredMesh> careFor(PreparedMesh mesh, const MeshCareOptions& options);

/// " --repair wrap=0.01", or "": for the options that a container records.
[[nodiscard]] std::string careOptionsText(const MeshCare& care);
/// How far, in units of the longest side, a repair that a container records may have moved the bounds.
[[nodiscard]] double repairReach(const std::string& container_options);

}  // namespace relief
