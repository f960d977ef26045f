// SPDX-License-Identifier: Apache-2.0
#include "bake/world/budget_share.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "bake/world/worth_curve.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

/// 2^(k/8) for k = 0…7.
constexpr std::array<double, 8> kEighths = {1.0,
                                            1.0905077326652577,
                                            1.189207115002721,
                                            1.2968395546510096,
                                            1.4142135623730951,
                                            1.5422108254079407,
                                            1.681792830507429,
                                            1.8340080864093424};

/// A curve is planned again if its share grows by at least this factor, because the power law becomes inaccurate
/// beyond.
constexpr std::uint64_t kReach = 2;
/// The minimum share, as a fraction of an even share.
constexpr double kEvenShare = 0.125;
/// Range of the natural logarithm of a byte's worth, and number of bisections.
constexpr double kLogWorthMost = 700.0;
constexpr int kBisections = 64;

Result<void> checkBudget(std::uint64_t budget, std::size_t shares) {
    if (budget / 2 / shares < kShareMin) {
        return fail(ErrorCode::kUsage, "--budget is " + std::to_string(budget) + " bytes, too few for " +
                                           std::to_string(shares) + " colliders; give at least " +
                                           std::to_string(2 * kShareMin * shares));
    }
    return {};
}

/// Returns the bytes, a power of two, used to plan a share.
std::uint64_t plannedOf(std::uint64_t share) {
    return std::bit_floor(std::clamp(share / kSharePerPlan, kPatchBytesMin, kPatchBytesMax));
}

class Sharer {
  public:
    Sharer(std::uint64_t budget, std::span<BudgetShare> shares, const PlanErrors& plan)
        : budget_(budget), shares_(shares), plan_(plan), planned_(shares.size()), curves_(shares.size()) {}

    void run() {
        for (BudgetShare& share : shares_) {
            share.bytes = budget_ / shares_.size();
        }
        std::vector<std::size_t> todo(shares_.size());
        std::iota(todo.begin(), todo.end(), std::size_t{0});
        while (!todo.empty()) {
            tbb::parallel_for(std::size_t{0}, todo.size(), [&](std::size_t k) {
                // Isolate, because a thread that waits in one plan could otherwise start another inside it.
                tbb::this_task_arena::isolate([&] { plan(todo[k]); });
            });
            share();
            todo.clear();
            for (std::size_t i = 0; i < shares_.size(); ++i) {
                if (curves_[i] && plannedOf(shares_[i].bytes) >= kReach * planned_[i]) {
                    todo.push_back(i);
                }
            }
        }
        for (BudgetShare& share : shares_) {
            share.bytes = roundDownToEighth(share.bytes);
        }
    }

  private:
    void plan(std::size_t i) {
        planned_[i] = plannedOf(shares_[i].bytes);
        const Result<ErrorCurve> curve = plan_(i, planned_[i]);
        curves_[i].reset();
        if (curve && !curve->empty()) {
            curves_[i].emplace(*curve, shares_[i].weight);
        }
    }

    [[nodiscard]] double bytesOf(std::size_t i, double log_worth) const {
        const double even = static_cast<double>(budget_) / static_cast<double>(shares_.size());
        const double least = std::max(static_cast<double>(kShareMin), kEvenShare * even);
        const double most = std::max(least, static_cast<double>(kPatchBytesMax));
        return curves_[i] ? std::clamp(curves_[i]->bytesAt(log_worth), least, most) : even;
    }

    /// Uses the lowest worth of a byte for which all shares fit.
    void share() {
        double dear = kLogWorthMost;
        double cheap = -kLogWorthMost;
        for (int step = 0; step < kBisections; ++step) {
            const double middle = 0.5 * (dear + cheap);
            double sum = 0.0;
            for (std::size_t i = 0; i < shares_.size(); ++i) {
                sum += bytesOf(i, middle);
            }
            (sum > static_cast<double>(budget_) ? cheap : dear) = middle;
        }
        for (std::size_t i = 0; i < shares_.size(); ++i) {
            shares_[i].bytes = static_cast<std::uint64_t>(bytesOf(i, dear));
        }
    }

    std::uint64_t budget_;
    std::span<BudgetShare> shares_;
    const PlanErrors& plan_;
    std::vector<std::uint64_t> planned_;  // bytes
    std::vector<std::optional<WorthCurve>> curves_;
};

}  // namespace

std::uint64_t roundDownToEighth(std::uint64_t bytes) {
    const std::uint64_t octave = std::bit_floor(bytes);
    std::uint64_t best = octave;
    for (const double eighth : kEighths) {
        const auto step = static_cast<std::uint64_t>(static_cast<double>(octave) * eighth);
        best = step <= bytes ? std::max(best, step) : best;
    }
    return best;
}

Result<void> shareByErrors(std::uint64_t budget, std::span<BudgetShare> shares, const PlanErrors& plan) {
    RELIEF_TRY(checkBudget(budget, shares.size()));
    if (shares.size() == 1) {
        shares[0].bytes = roundDownToEighth(budget);
    } else {
        Sharer(budget, shares, plan).run();
    }
    return {};
}

Result<void> shareByArea(std::uint64_t budget, std::span<BudgetShare> shares) {
    RELIEF_TRY(checkBudget(budget, shares.size()));
    double sum = 0.0;
    for (const BudgetShare& share : shares) {
        sum += share.weight;
    }
    const double half = 0.5 * static_cast<double>(budget);
    for (BudgetShare& share : shares) {
        const double part = sum > 0.0 ? share.weight / sum : 0.0;
        const double bytes = half * (1.0 / static_cast<double>(shares.size()) + part);
        share.bytes = roundDownToEighth(static_cast<std::uint64_t>(std::max(bytes, 1.0)));
    }
    return {};
}

}  // namespace relief
