// SPDX-License-Identifier: Apache-2.0
// A bake from the request to the collider: import, repair, solid, maps, measurement and warnings. The command line,
// Python, recipes, advice and benchmarks call this.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/director/bake_request.h"
#include "bake/materials/material_tree.h"
#include "bake/mesh/mesh_query.h"
#include "bake/recipe/depfile.h"
#include "bake/report/bake_report.h"
#include "formats/animation/animated_mesh.h"
#include "formats/base/file_guard.h"
#include "formats/base/result.h"

namespace relief {

/// Follows a bake. Each function may be empty, and may throw: what it throws comes out of bake(), and ends it.
struct BakeWatcher {
    std::function<void(const char* stage)> begin;  ///< "baking the maps"
    std::function<void(double share)> progress;    ///< of the stage, in [0, 1]; any thread calls it
    std::function<void()> checkpoint;              ///< within a stage without shares; any thread calls it
    std::function<void(const BudgetTry&)> tried;   ///< of a search for the least budget
    std::function<void(const TriangleMesh&)> imported;  ///< as it came
    FileGuard* files = nullptr;  ///< gets the inputs that are known only after the import
};

/// The collider, and what the stages found out.
struct BakeResult {
    BakeRequest request;
    BakeSettings settings;              ///< in effect
    std::uint64_t unused_vertices = 0;  ///< of the mesh file; repair discards this count
    RepairedMesh mesh;                  ///< the solid that was baked
    ShapeReport shape;
    SurfaceParts parts;
    std::shared_ptr<MaterialSource> materials;  ///< null: none are kept
    Baked baked;
    std::optional<PatchesReport> patches;
    std::optional<WrongShare> wrong;             ///< near the surface; not of named maps
    std::optional<PartsAccuracy> part_accuracy;  ///< of several parts; not of named maps
    std::vector<std::string> notices;            ///< one line each; ready to be shown
    std::vector<InputFile> inputs;               ///< the mesh, the files that it refers to
    BakeTimes times;
    std::optional<AnimatedMesh> animated;  ///< of the collider, with --animated

    /// Nothing if it is not measured.
    [[nodiscard]] std::optional<Verdict> verdict() const;
    /// For bakeText. Valid as long as the result.
    [[nodiscard]] BakeSummary summary(bool verbose) const;
    /// --threads, or those of the machine.
    [[nodiscard]] int threads() const;
};

/// Writes nothing. Warnings are in baked.report.
/// \param mesh  as finishMesh leaves it: instead of a file.
/// Errors: those of settingsOf, importMeshInWorker, repairMesh, shapeMesh, bakeForError, bakePatchesWithin and bake; kUsage: an option that needs the mesh's file.
[[nodiscard]] Result<BakeResult> bake(const BakeRequest& request, const BakeWatcher& watcher = {},
                                      std::optional<TriangleMesh> mesh = {});

/// A mesh that is ready to be baked. Copies share it.
struct SolidMesh {
    std::uint64_t unused_vertices = 0;
    RepairedMesh mesh;
    ShapeReport shape;
    SurfaceParts parts;
    std::shared_ptr<MaterialSource> materials;  ///< null: none are kept

    /// It is the same with any budget: it has no shells.
    [[nodiscard]] bool suitsAnyBudget() const { return shape.sheets == 0; }
};

/// Errors: as bake().
[[nodiscard]] Result<SolidMesh> prepareSolid(const BakeRequest& request, TriangleMesh mesh);

/// The same as bake() of the mesh that prepareSolid() had, with that request or one of another budget that it suits.
[[nodiscard]] Result<BakeResult> bake(const BakeRequest& request, const SolidMesh& solid);

/// The mistakes of its tree of patches against the bytes (bake/patches/patch_planner.h).
/// \param request  of patches. \param bytes  of the largest tree.
/// Errors: as bake().
[[nodiscard]] Result<MistakeCurve> planMistakes(const BakeRequest& request, const SolidMesh& solid,
                                                std::uint64_t bytes);

/// The solid of a mesh that has been wound outwards: the mesh itself with --holes keep.
/// Errors: those of parseShapeOptions and shapeMesh.
[[nodiscard]] Result<ShapedMesh> makeSolid(const BakeRequest& request, const PreparedMesh& mesh);

/// The maps of a solid, by their names, or patches for its budget (not for an error). Errors: as bake.
[[nodiscard]] Result<Baked> bakeSolid(const BakeRequest& request, const PreparedMesh& solid);

}  // namespace relief
