// SPDX-License-Identifier: Apache-2.0
#include "bake/maps/budget_search.h"
#include "bake/pipeline/stages.h"
#include "bake/verdict/report_text.h"
#include "formats/base/stopwatch.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

BakeOptions watched(const BakeSettings& settings, const BakeWatcher& watcher) {
    notify(watcher.begin, "baking the maps");
    BakeOptions options = settings.bake;
    options.progress = watcher.progress;
    return options;
}

/// Returns the budget for --texel and --budget; nullopt if only the texel limits the bytes.
std::optional<std::uint64_t> budgetOf(const BakeRequest& request) {
    return request.texel ? request.budget : request.budget.value_or(kBudgetDefault);
}

/// Finds the smallest budget that meets --max-error.
/// \param query  of the solid.
/// \param truth  of the mesh to measure against: the imported mesh if the mesh was repaired.
Result<BudgetSearchResult> searchBudget(const BakeRequest& request, const BakeSettings& settings,
                                        const SolidMesh& solid, const MeshQuery& query,
                                        const MeshQuery& truth, const BakeWatcher& watcher) {
    notify(watcher.begin, "searching for the smallest budget");
    BudgetSearchOptions options;
    options.max_error_percent = double{*request.max_error};
    if (const double floats = wrongByFloats(truth.mesh()); floats > 2.0 * options.max_error_percent) {
        return fail(ErrorCode::kDifference,
                    truth.mesh().name + ": --max-error is " + percentText(options.max_error_percent) +
                        ", but floats this far from the origin make about " + percentText(floats) +
                        " of the points wrong; move the mesh to the origin");
    }
    options.budget_max = request.budget.value_or(options.budget_max);
    options.bake = settings.bake;
    options.bake.progress = [&watcher](double) { notify(watcher.checkpoint); };
    options.tried = watcher.tried;
    return bakeForError(query, truth, solid.parts, options);
}

Result<BakedMaps> bakePatches(const BakeRequest& request, const BakeSettings& settings,
                              const SolidMesh& solid, const BakeWatcher& watcher) {
    const Stopwatch watch;
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(solid.mesh.mesh));
    const double tree_ms = watch.ms();
    BakedMaps made;
    PatchesReport report;
    report.requested_texel = request.texel;
    if (request.max_error) {
        const MeshQuery truth = solid.imported ? RELIEF_TRY(MeshQuery::build(*solid.imported)) : query;
        BudgetSearchResult found = RELIEF_TRY(searchBudget(request, settings, solid, query, truth, watcher));
        report.budget = found.chosen.budget;
        report.max_error = double{*request.max_error};
        report.wrong_percent = found.chosen.wrong_percent;
        report.tries = std::move(found.tries);
        made.baked = std::move(found.baked);
        made.search_ms = watch.ms();
    } else {
        report.budget = budgetOf(request);
        made.baked =
            RELIEF_TRY(bakePatchesWithin(query, report.budget.value_or(0), watched(settings, watcher)));
        made.baked.report.build_ms += tree_ms;
    }
    const DepthMap& tree = made.baked.collider.maps.front();
    report.bytes = made.baked.collider.texelBytes();
    report.texel = patchSpacing(tree.texels) * double{tree.object_per_map.x};
    made.patches = std::move(report);
    return made;
}

}  // namespace

Result<BakedMaps> bakeMaps(const BakeRequest& request, const BakeSettings& settings, const SolidMesh& solid,
                           const BakeWatcher& watcher) {
    if (settings.source == MapSource::kPatches) {
        return bakePatches(request, settings, solid, watcher);
    }
    return BakedMaps{RELIEF_TRY(bake(solid.mesh.mesh, watched(settings, watcher)))};
}

Result<Baked> bakeSolid(const BakeRequest& request, const PreparedMesh& solid) {
    const BakeSettings settings = RELIEF_TRY(settingsOf(request));
    if (settings.source != MapSource::kPatches) {
        return bake(solid, settings.bake);
    }
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(solid));
    return bakePatchesWithin(query, budgetOf(request).value_or(0), settings.bake);
}

}  // namespace relief
