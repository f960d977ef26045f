// SPDX-License-Identifier: Apache-2.0
// Chosen views, baked for a budget of bytes, and the least budget that keeps a promise: bakes at growing numbers of bytes until few enough points near the
// surface are on the wrong side, then narrows the last step down.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/mesh/mesh_query.h"
#include "bake/pipeline/bake.h"
#include "bake/plan/view_planner.h"
#include "formats/base/result.h"

namespace relief {

/// The views of a layout; nullopt of patches, which have none. Errors: those of chooseViews.
[[nodiscard]] Result<std::optional<ViewChoice>> viewsFor(const MeshQuery& query, Layout layout, Prefer prefer,
                                                         std::uint32_t max_maps);

struct PlannedBake {
    Plan plan;  ///< its bytes are those of the baked maps
    Baked baked;
};

/// The size of a map of gaps is known to some per cent before it is baked: where all maps together take more
/// than the budget, they are baked again with larger texels.
/// \param query    of the mesh that the views were chosen for
/// \param views    nullopt: a tree of patches
/// \param budget_bytes  0: none, where options.planned_texel decides
/// \param options  its maps and planned_budget do not count
/// Errors: those of planSizes and bake.
[[nodiscard]] Result<PlannedBake> bakePlanned(const MeshQuery& query, const std::optional<ViewChoice>& views,
                                              std::uint64_t budget_bytes, BakeOptions options);

struct BudgetTry {
    std::uint64_t budget = 0;    ///< bytes
    std::uint64_t bytes = 0;     ///< on the GPU, at most the budget
    double wrong_percent = 0.0;  ///< of the points near the surface (FieldAccuracy::near)
};

void fields(FieldVisitor& visit, const BudgetTry& made);

struct BudgetSearchOptions {
    double max_error_percent = 1.0;
    std::uint64_t budget_min = 32'000;      ///< bytes; lowered to budget_max
    std::uint64_t budget_max = 64'000'000;  ///< bytes
    BakeOptions bake;                       ///< its maps do not count
    Layout layout = Layout::kPatches;
    std::uint32_t max_maps = kPlannedMapsMax;  ///< of views
    /// Fewer samples than `relief check` takes, whose noise (0.04 percent of deviation where 1 % is wrong) is
    /// below what one more step would tell apart.
    AccuracyOptions accuracy{.samples = 50'000};
    /// Called after each try.
    std::function<void(const BudgetTry&)> tried;
};

struct BudgetSearchResult {
    Plan plan;
    Baked baked;
    BudgetTry chosen;
    std::vector<BudgetTry> tries;  ///< in the order they were made
};

/// Budgets grow fourfold; four bisections of the last step's logarithm then leave the budget at most 1.1
/// times what the promise needs (as far as more bytes mean fewer wrong points). Views are
/// chosen and truth is sampled once. The same for any number of threads. Errors: kDifference (not reached: the message names the best), those of
/// chooseViews, planSizes and bake.
/// \param query  of the mesh that is baked, its holes closed or not.
/// \param truth  of the mesh that the points are measured against, as `relief check` does: with its holes.
[[nodiscard]] Result<BudgetSearchResult> bakeForError(const MeshQuery& query, const MeshQuery& truth,
                                                      const BudgetSearchOptions& options);

}  // namespace relief
