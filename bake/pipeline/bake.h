// SPDX-License-Identifier: Apache-2.0
// A bake from the request to the collider: import, repair, solid, maps, measurement and warnings. The command line,
// Python, recipes, advice and benchmarks call this.
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
    double search_ms = 0.0;  ///< of --max-error: all its bakes and measurements
    double check_ms = 0.0;   ///< of a bake that measures itself
    double write_ms = 0.0;
    double total_ms = 0.0;
};

/// The solid that was baked, the collider, and the results of the stages.
struct BakeResult : SolidMesh {
    BakeRequest request;
    BakeSettings settings;  ///< in effect
    Baked baked;
    std::optional<PatchesReport> patches;
    std::optional<WrongShare> wrong;             ///< near the surface; not of named maps
    std::optional<PartsAccuracy> part_accuracy;  ///< of several parts; not of named maps
    std::vector<std::string> notices;            ///< one line each; ready to be shown
    std::vector<InputFile> inputs;               ///< the mesh, the files that it refers to
    BakeTimes times;

    /// Nothing if it is not measured.
    [[nodiscard]] std::optional<Verdict> verdict() const;
    /// --threads, or those of the machine.
    [[nodiscard]] int threads() const;
};

/// Writes nothing. Warnings are in baked.report.
/// \param mesh  as finishMesh leaves it: instead of a file.
/// Errors: those of settingsOf, importMeshInWorker, repairMesh, shapeMesh, bakeForError, bakePatchesWithin and bake; kUsage: an option that needs the mesh's file.
[[nodiscard]] Result<BakeResult> bake(const BakeRequest& request, const BakeWatcher& watcher = {},
                                      std::optional<TriangleMesh> mesh = {});

/// Errors: as bake().
[[nodiscard]] Result<SolidMesh> prepareSolid(const BakeRequest& request, TriangleMesh mesh);

/// The same as bake() of the mesh that prepareSolid() had, with that request or one of another budget that it suits.
[[nodiscard]] Result<BakeResult> bake(const BakeRequest& request, const SolidMesh& solid);

/// The errors of its tree of patches against the bytes (bake/patches/patch_planner.h).
/// \param request  of patches. \param bytes  of the largest tree.
/// Errors: as bake().
[[nodiscard]] Result<ErrorCurve> planErrors(const BakeRequest& request, const SolidMesh& solid,
                                            std::uint64_t bytes);

}  // namespace relief
