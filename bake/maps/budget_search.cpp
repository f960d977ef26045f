// SPDX-License-Identifier: Apache-2.0
#include "bake/maps/budget_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bake/measure/accuracy.h"
#include "bake/measure/part_accuracy.h"
#include "formats/base/text.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

constexpr std::uint64_t kGrowth = 4;
constexpr int kBisections = 4;

std::string megabytes(std::uint64_t bytes) {
    return formatted("%.3g MB", static_cast<double>(bytes) / 1e6);
}

std::string percentText(double percent) {
    return formatted("%.3g %%", percent);
}

/// Whether a bake may have failed because the budget was too small.
bool mayBeTooSmall(const Error& error) {
    return error.code == ErrorCode::kUsage || error.code == ErrorCode::kFailure;
}

class Search {
  public:
    Search(const MeshQuery& query, const MeshQuery& truth, const SurfaceParts& parts,
           const BudgetSearchOptions& options)
        : query_(query), parts_(parts), options_(options), near_(sampleNear(truth, options.accuracy)) {}

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
        const Field field = fieldOf(baked.collider);
        BudgetTrial attempt{budget, baked.collider.texelBytes(), measureNear(near_, field).total()};
        const bool accurate = attempt.wrong_percent <= options_.max_error_percent;
        if (accurate) {
            const PartOptions options{.points_all = options_.accuracy.samples,
                                      .seed = options_.accuracy.seed};
            attempt.lost_parts = measureParts(query_, parts_, field, options).countOf(PartVerdict::kLost);
        }
        tries_.push_back(attempt);
        if (options_.tried) {
            options_.tried(attempt);
        }
        if (!accurate || attempt.lost_parts > 0) {
            return false;
        }
        best_ = BudgetSearchResult{std::move(baked), attempt, {}};
        return true;
    }

    [[nodiscard]] tl::unexpected<Error> notReached() const {
        const auto best = std::ranges::min_element(tries_, {}, &BudgetTrial::wrong_percent);
        return fail(ErrorCode::kDifference,
                    query_.mesh().name + ": --max-error " + percentText(options_.max_error_percent) +
                        " is not reached within " + megabytes(options_.budget_max) + "; the best is " +
                        percentText(best->wrong_percent) + " with " + megabytes(best->bytes) + " (" +
                        std::to_string(best->bytes) + " bytes)" +
                        (best->lost_parts == 0 ? "; raise --max-error or --budget"
                                               : ", but " + std::to_string(best->lost_parts) +
                                                     (best->lost_parts == 1 ? " part is" : " parts are") +
                                                     " lost; raise --budget, or remove --max-error"));
    }

    const MeshQuery& query_;
    const SurfaceParts& parts_;
    const BudgetSearchOptions& options_;
    std::vector<TruthPoint> near_;
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
    Baked baked = RELIEF_TRY(bake(query.prepared(), options));
    std::vector<RecordedOption>& recorded = baked.collider.provenance.options;
    // `relief bake` rejects --map with --budget or --texel.
    std::erase_if(recorded, [](const RecordedOption& option) { return option.name == "map"; });
    if (budget_bytes > 0) {
        recorded.push_back({"budget", std::to_string(budget_bytes)});
    }
    return baked;
}

Result<BudgetSearchResult> bakeForError(const MeshQuery& query, const MeshQuery& truth,
                                        const SurfaceParts& parts, const BudgetSearchOptions& options) {
    return Search(query, truth, parts, options).run();
}

void fields(FieldVisitor& visit, const BudgetTrial& attempt) {
    visit("budget", attempt.budget, {"Maximum bytes of texels"});
    visit("bytes", attempt.bytes, {"Actual bytes of texels"});
    visit("wrong_percent", attempt.wrong_percent,
          {"Points near the surface that are on the wrong side", "%", kPercentRange});
    visit("lost_parts", attempt.lost_parts,
          {"Lost parts of the mesh; counted only if wrong_percent is within the limit"});
}

}  // namespace relief
