// SPDX-License-Identifier: Apache-2.0
#include "bake/pipeline/budget_search.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "bake/measure/sight.h"
#include "bake/measure/truth.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

constexpr std::uint64_t kGrowth = 4;
constexpr int kBisections = 4;
/// Points on the surface, to say how much of it no map sees.
constexpr std::uint32_t kSurfacePoints = 4'000;
/// Of the bytes that a second bake aims at: its texels are others.
constexpr double kSecondShare = 0.99;

std::string megabytes(std::uint64_t bytes) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g MB", static_cast<double>(bytes) / 1e6);
    return text;
}

std::string percentText(double percent) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g %%", percent);
    return text;
}

/// Too few bytes for the maps that the mesh needs, or to see any of it: no answer yet.
bool isTooFew(const Error& error) {
    return error.code == ErrorCode::kUsage || error.code == ErrorCode::kFailure;
}

class Search {
  public:
    Search(const MeshQuery& query, const MeshQuery& truth, std::optional<ViewChoice> views,
           const BudgetSearchOptions& options)
        : query_(query),
          options_(options),
          views_(std::move(views)),
          truth_(sampleTruth(truth, options.accuracy)) {}

    Result<BudgetSearchResult> run() {
        const std::uint64_t most = options_.budget_max;
        std::uint64_t failed = 0;
        for (std::uint64_t budget = std::min(options_.budget_min, most);;
             budget = std::min(budget * kGrowth, most)) {
            const Result<bool> kept = keeps(budget);
            const bool too_few = !kept && isTooFew(kept.error()) && budget < most;
            if (!kept && !too_few) {
                return forward(kept);
            }
            if (kept && *kept) {
                break;
            }
            if (budget == most) {
                return notReached();
            }
            failed = budget;
        }
        for (int i = 0; i < kBisections && failed > 0; ++i) {
            const auto middle = static_cast<std::uint64_t>(
                std::sqrt(static_cast<double>(failed) * static_cast<double>(best_->chosen.budget)));
            const Result<bool> kept = keeps(middle);
            if (!kept && !isTooFew(kept.error())) {
                return forward(kept);
            }
            if (!kept || !*kept) {
                failed = middle;
            }
        }
        best_->tries = std::move(tries_);
        return std::move(*best_);
    }

  private:
    /// Bakes with this budget; what keeps the promise is kept as the best so far.
    Result<bool> keeps(std::uint64_t budget) {
        auto [plan, baked] = RELIEF_TRY(bakePlanned(query_, views_, budget, options_.bake));
        const double wrong = measureField(truth_, fieldOf(baked.collider)).near.total();
        const BudgetTry made{budget, plan.bytes, wrong};
        tries_.push_back(made);
        if (options_.tried) {
            options_.tried(made);
        }
        if (!(wrong <= options_.max_error_percent)) {
            return false;
        }
        best_ = BudgetSearchResult{std::move(plan), std::move(baked), made, {}};
        return true;
    }

    [[nodiscard]] tl::unexpected<Error> notReached() const {
        const auto best = std::min_element(
            tries_.begin(), tries_.end(),
            [](const BudgetTry& a, const BudgetTry& b) { return a.wrong_percent < b.wrong_percent; });
        return fail(ErrorCode::kDifference,
                    query_.mesh().name + ": --max-error " + percentText(options_.max_error_percent) +
                        " is not reached within " + megabytes(options_.budget_max) + "; the best is " +
                        percentText(best->wrong_percent) + " with " + megabytes(best->bytes) + " (" +
                        std::to_string(best->bytes) + " bytes); raise --max-error or --budget");
    }

    const MeshQuery& query_;
    const BudgetSearchOptions& options_;
    std::optional<ViewChoice> views_;
    TruthSamples truth_;
    std::vector<BudgetTry> tries_;
    std::optional<BudgetSearchResult> best_;
};

Result<PlannedBake> bakeTreePlanned(const MeshQuery& query, std::uint64_t budget_bytes, BakeOptions options) {
    if (budget_bytes > 0) {
        RELIEF_TRY(checkPlanBudget(budget_bytes));
    }
    MapSpec spec;
    spec.format = MapFormat::kPatches;
    spec.bytes = std::min(budget_bytes, kPatchBytesMax);
    spec.texel = options.planned_texel;
    options.maps = {spec};
    Baked baked = RELIEF_TRY(bake(query.prepared(), options));
    const DepthMap& tree = baked.collider.maps.front();
    Plan plan;
    plan.maps = {{spec, 1.0, "small depth maps in an octree, each along the axis that sees its piece best"}};
    plan.texel = patchSpacing(tree.texels) * double{tree.object_per_map.x};
    plan.bytes = baked.collider.gpuBytes();
    return PlannedBake{std::move(plan), std::move(baked)};
}

}  // namespace

Result<std::optional<ViewChoice>> viewsFor(const MeshQuery& query, Layout layout, Prefer prefer,
                                           std::uint32_t max_maps) {
    if (layout == Layout::kPatches) {
        return std::nullopt;
    }
    ViewOptions options;
    options.prefer = prefer;
    options.max_maps = max_maps;
    return RELIEF_TRY(chooseViews(query, options));
}

Result<PlannedBake> bakePlanned(const MeshQuery& query, const std::optional<ViewChoice>& choice,
                                std::uint64_t budget_bytes, BakeOptions options) {
    options.planned_budget = budget_bytes;
    if (!choice) {
        return bakeTreePlanned(query, budget_bytes, std::move(options));
    }
    const ViewChoice& views = *choice;
    Plan plan = RELIEF_TRY(planSizes(views, budget_bytes));
    for (auto aim = static_cast<double>(budget_bytes);;) {
        options.maps = specsOf(plan);
        Baked baked = RELIEF_TRY(bake(query.prepared(), options));
        plan.bytes = baked.collider.gpuBytes();
        if (plan.bytes <= budget_bytes) {
            plan.unseen_percent = Sights(baked.collider.maps, query)
                                      .unseenPercent(sampleSurface(query, {.samples = kSurfacePoints}));
            return PlannedBake{std::move(plan), std::move(baked)};
        }
        aim *= kSecondShare * static_cast<double>(budget_bytes) / static_cast<double>(plan.bytes);
        std::optional<Plan> smaller = sizesWithin(views, static_cast<std::uint64_t>(aim));
        if (!smaller) {
            return tl::unexpected<Error>(budgetTooSmall(views, budget_bytes));
        }
        plan = std::move(*smaller);
    }
}

Result<BudgetSearchResult> bakeForError(const MeshQuery& query, const MeshQuery& truth,
                                        const BudgetSearchOptions& options) {
    std::optional<ViewChoice> views =
        RELIEF_TRY(viewsFor(query, options.layout, options.bake.prefer, options.max_maps));
    return Search(query, truth, std::move(views), options).run();
}

void fields(FieldVisitor& visit, const BudgetTry& made) {
    visit("budget", made.budget, {"Bytes of texels planned for"});
    visit("bytes", made.bytes, {"Bytes of texels planned"});
    visit("wrong_percent", made.wrong_percent,
          {"Share of the points near the surface that are on the wrong side", "%", kPercentRange});
}

}  // namespace relief
