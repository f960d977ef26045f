// SPDX-License-Identifier: Apache-2.0
// Bakes a request into a collider: import, repair, solid, maps, measurement and warnings. Used by the command line,
// Python, recipes, advice and benchmarks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "bake/pipeline/bake_request.h"
#include "bake/pipeline/stages.h"
#include "bake/recipe/depfile.h"
#include "bake/verdict/parts_report.h"
#include "formats/base/result.h"

namespace relief {

struct BakeTimes {
    double import_ms = 0.0;
    double search_ms = 0.0;  ///< of --max-error: all bakes and measurements of the search
    double check_ms = 0.0;   ///< measurement of the collider, unless --no-check
    double write_ms = 0.0;
    double total_ms = 0.0;
};

/// The baked solid, the collider, and the results of the stages.
struct BakeResult : SolidMesh {
    BakeRequest request;
    BakeSettings settings;  ///< in effect
    Baked baked;
    std::optional<PatchesReport> patches;
    std::optional<WrongPercent> wrong;           ///< near the surface; not for named maps
    std::optional<PartsAccuracy> part_accuracy;  ///< if there are several parts; not for named maps
    std::vector<std::string> notices;            ///< one line each, for display
    std::vector<InputFile> inputs;               ///< the mesh, and the files it references
    BakeTimes times;

    /// Returns nullopt if the collider was not measured.
    [[nodiscard]] std::optional<Verdict> verdict() const;
    /// Returns --threads, or the number of the machine's threads.
    [[nodiscard]] int threads() const;
};

/// Bakes a mesh in memory; writes no files. Warnings are in baked.report.
/// \param mesh  from finishMesh; used instead of the request's file.
/// Errors: those of settingsOf, importSource, solidOf, bakeMaps and selfCheck; kUsage (an option that requires the mesh
/// file).
[[nodiscard]] Result<BakeResult> bake(const BakeRequest& request, const BakeWatcher& watcher = {},
                                      std::optional<TriangleMesh> mesh = {});

/// Prepares the solid of a mesh. Errors: those of bake().
[[nodiscard]] Result<SolidMesh> prepareSolid(const BakeRequest& request, TriangleMesh mesh);

/// Bakes a prepared solid.
/// \param request  as passed to prepareSolid(); its budget may differ if solid.isBudgetIndependent().
[[nodiscard]] Result<BakeResult> bake(const BakeRequest& request, const SolidMesh& solid);

/// Returns the error curve of a solid's patch trees (bake/patches/patch_planner.h).
/// \param request  for patches. \param bytes  size of the largest tree.
/// Errors: those of bake().
[[nodiscard]] Result<ErrorCurve> planErrors(const BakeRequest& request, const SolidMesh& solid,
                                            std::uint64_t bytes);

}  // namespace relief
