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
    bool check_intersections = false;
    std::string method;   ///< "wrap", "wrap=ALPHA", "orient" or "holes"; empty: none
    bool examine = true;  ///< count faults even where no other option needs that
};

template <class Visitor, FieldsOf<RepairOptions> Options>
void fields(Visitor& visit, Options& options) {
    visit(
        "strict", options.strict,
        {.help = "Refuse a mesh that is not a closed solid wound outwards, with exit code 3; with --repair, "
                 "a repaired one that is still open"});
    visit("check_intersections", options.check_intersections,
          {.help = "Also count the pairs of triangles that intersect, for the report and --strict"});
    visit("repair", options.method,
          {.help = "Bake another surface: wrap[=ALPHA] (a closed one shrunk round the mesh, spanning gaps of "
                   "ALPHA longest sides, 0.01 by default), orient (taken apart where it is not manifold, and "
                   "wound outwards) or holes (the same with every hole filled)",
           .value = "WORD",
           .recorded = true});
}

/// Errors: kUsage: the method is unknown, or its alpha out of range.
[[nodiscard]] Result<void> checkRepair(const std::string& method);
/// The ALPHA of a wrap, in units of the longest side; 0 for other methods.
[[nodiscard]] double wrapAlpha(const std::string& method);

struct RepairReport {
    std::optional<MeshHealth> health;    ///< of the mesh as it came
    std::string repair;                  ///< "wrap=0.01", "orient", "holes", or ""
    std::optional<MeshHealth> repaired;  ///< after the repair
    std::uint64_t filled_holes = 0;      ///< by --repair holes, as is the next
    std::uint64_t holes_left = 0;
    std::uint64_t turned = 0;  ///< triangles, to face outwards
};

struct RepairedMesh {
    PreparedMesh mesh{TriangleMesh()};
    RepairReport report;
};

/// Errors: as checkRepair; kInvalidInput (--strict, and those of fillHoles), kFailure (a repair failed), kLimit.
[[nodiscard]] Result<RepairedMesh> repairMesh(PreparedMesh mesh, const RepairOptions& options);

}  // namespace relief
