// SPDX-License-Identifier: Apache-2.0
#include "bake/maps/budget_search.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "bake/measure/truth.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

constexpr std::uint64_t kGrowth = 4;
constexpr int kBisections = 4;

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

/// Whether a bake may have failed because the budget was too small.
bool mayBeTooSmall(const Error& error) {
    return error.code == ErrorCode::kUsage || error.code == ErrorCode::kFailure;
}

class Search {
  public:
    Search(const MeshQuery& query, const MeshQuery& truth, const BudgetSearchOptions& options)
        : query_(query), options_(options), truth_(sampleTruth(truth, options.accuracy)) {}

    Result<BudgetSearchResult> run() {
        const std::uint64_t most = options_.budget_max;
        std::uint64_t failed = 0;
        for (std::uint64_t budget = std::min(options_.budget_min, most);;
             budget = std::min(budget * kGrowth, most)) {
            const Result<bool> met = meetsLimit(budget);
            const bool too_small = !met && mayBeTooSmall(met.error()) && budget < most;
            if (!met && !too_small) {
                return forward(met);
            }
            if (met && *met) {
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
            const Result<bool> met = meetsLimit(middle);
            if (!met && !mayBeTooSmall(met.error())) {
                return forward(met);
            }
            if (!met || !*met) {
                failed = middle;
            }
        }
        best_->tries = std::move(tries_);
        return std::move(*best_);
    }

  private:
    /// Bakes with this budget. Stores the result as the best so far if it meets the error limit.
    Result<bool> meetsLimit(std::uint64_t budget) {
        Baked baked = RELIEF_TRY(bakePatchesWithin(query_, budget, options_.bake));
        const double wrong = measureField(truth_, fieldOf(baked.collider)).near.total();
        const BudgetTrial attempt{budget, baked.collider.texelBytes(), wrong};
        tries_.push_back(attempt);
        if (options_.tried) {
            options_.tried(attempt);
        }
        if (!(wrong <= options_.max_error_percent)) {
            return false;
        }
        best_ = BudgetSearchResult{std::move(baked), attempt, {}};
        return true;
    }

    [[nodiscard]] tl::unexpected<Error> notReached() const {
        const auto best = std::min_element(
            tries_.begin(), tries_.end(),
            [](const BudgetTrial& a, const BudgetTrial& b) { return a.wrong_percent < b.wrong_percent; });
        return fail(ErrorCode::kDifference,
                    query_.mesh().name + ": --max-error " + percentText(options_.max_error_percent) +
                        " is not reached within " + megabytes(options_.budget_max) + "; the best is " +
                        percentText(best->wrong_percent) + " with " + megabytes(best->bytes) + " (" +
                        std::to_string(best->bytes) + " bytes); raise --max-error or --budget");
    }

    const MeshQuery& query_;
    const BudgetSearchOptions& options_;
    TruthSamples truth_;
    std::vector<BudgetTrial> tries_;
    std::optional<BudgetSearchResult> best_;
};

}  // namespace

Result<Baked> bakePatchesWithin(const MeshQuery& query, std::uint64_t budget_bytes, BakeOptions options) {
    if (budget_bytes > 0 && budget_bytes < kBudgetMin) {
        return fail(ErrorCode::kUsage, "a budget of " + std::to_string(budget_bytes) +
                                           " bytes is below the minimum of " + std::to_string(kBudgetMin));
    }
    MapSpec spec;
    spec.format = MapFormat::kPatches;
    spec.bytes = std::min(budget_bytes, kPatchBytesMax);
    spec.texel = options.texel;
    options.maps = {spec};
    options.budget = budget_bytes;
    return bake(query.prepared(), options);
}

Result<BudgetSearchResult> bakeForError(const MeshQuery& query, const MeshQuery& truth,
                                        const BudgetSearchOptions& options) {
    return Search(query, truth, options).run();
}

void fields(FieldVisitor& visit, const BudgetTrial& attempt) {
    visit("budget", attempt.budget, {"Maximum bytes of texels"});
    visit("bytes", attempt.bytes, {"Actual bytes of texels"});
    visit("wrong_percent", attempt.wrong_percent,
          {"Points near the surface that are on the wrong side", "%", kPercentRange});
}

}  // namespace relief
