// SPDX-License-Identifier: Apache-2.0
#include "bake/world/budget_share.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "formats/base/portable_math.h"
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

/// A mesh is planned again if its share grows by at least this factor, because the power law becomes inaccurate.
constexpr std::uint64_t kReplanFactor = 2;
/// The minimum share, as a fraction of an even share.
constexpr double kEvenFractionMin = 0.125;
/// Range of the natural logarithm of a byte's worth, and number of bisections.
constexpr double kLogWorthMax = 700.0;
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

/// The exponent of the power law for typical meshes (bake/patches/NOTES.md), and its limits beyond the end of a curve,
/// where steep curves flatten.
constexpr double kPower = 0.73;
constexpr double kPowerMin = 0.4;
constexpr double kPowerMax = 1.0;
/// The exponent is fitted to the end of the curve, where the bytes grow by this factor.
constexpr double kPowerFitFactor = 8.0;
/// exp() of this exceeds any budget.
constexpr double kLogBytesMax = 60.0;

double slope(const ErrorPoint& a, const ErrorPoint& b) {
    return (a.wrong - b.wrong) / (b.bytes - a.bytes);
}

/// Returns the points of the convex hull, where slopes decrease.
ErrorCurve hullOf(const ErrorCurve& curve) {
    ErrorCurve hull;
    for (const ErrorPoint& point : curve) {
        while (hull.size() > 1 && slope(hull[hull.size() - 2], hull.back()) <= slope(hull.back(), point)) {
            hull.pop_back();
        }
        hull.push_back(point);
    }
    return hull;
}

double powerOf(const ErrorCurve& hull) {
    if (hull.size() < 2) {
        return kPower;
    }
    const ErrorPoint& end = hull.back();
    std::size_t from = 0;
    while (from + 2 < hull.size() && hull[from + 1].bytes * kPowerFitFactor <= end.bytes) {
        ++from;
    }
    return portable::log(hull[from].wrong / end.wrong) / portable::log(end.bytes / hull[from].bytes);
}

/// The error that one more byte saves, as a function of the bytes of a mesh: the slope of the convex hull of its error
/// curve, interpolated linearly between logarithms. The power law at the end of the curve extends it.
class WorthCurve {
  public:
    /// \param curve  not empty. \param weight  factor on its errors, 0 or more.
    WorthCurve(const ErrorCurve& curve, double weight) : power_(kPower) {
        const ErrorCurve hull = hullOf(curve);
        for (std::size_t i = 1; i < hull.size(); ++i) {
            add(std::sqrt(hull[i - 1].bytes * hull[i].bytes), weight * slope(hull[i - 1], hull[i]));
        }
        const ErrorPoint& end = hull.back();
        if (!(weight * end.wrong >= std::numeric_limits<double>::min())) {
            most_ = end.bytes;
            return;
        }
        const double power = powerOf(hull);
        const double worth = weight * power * end.wrong / end.bytes;
        add(end.bytes, knots_.empty() ? worth : std::min(worth, portable::exp(knots_.back().worth)));
        power_ = std::clamp(power, kPowerMin, kPowerMax);
    }

    /// Returns the number of bytes up to which one more byte has at least this worth; grows as the worth falls.
    /// \param log_worth  natural logarithm of the worth.
    [[nodiscard]] double bytesAt(double log_worth) const {
        if (knots_.empty()) {
            return most_;
        }
        const auto bytes = [this](double log_bytes) {
            return std::min(most_, portable::exp(std::min(log_bytes, kLogBytesMax)));
        };
        if (log_worth >= knots_.front().worth) {
            return bytes(knots_.front().bytes);
        }
        for (std::size_t i = 1; i < knots_.size(); ++i) {
            const Knot& a = knots_[i - 1];
            const Knot& b = knots_[i];
            if (log_worth >= b.worth) {
                return bytes(a.bytes + (a.worth - log_worth) / (a.worth - b.worth) * (b.bytes - a.bytes));
            }
        }
        const Knot& end = knots_.back();
        return bytes(end.bytes + (end.worth - log_worth) / (power_ + 1.0));
    }

  private:
    struct Knot {
        double bytes = 0.0;  // natural logarithms
        double worth = 0.0;
    };
    void add(double bytes, double worth) {
        if (worth >= std::numeric_limits<double>::min()) {
            knots_.push_back({portable::log(bytes), portable::log(worth)});
        }
    }

    std::vector<Knot> knots_;  // in descending order of worth
    double power_;             // errors are proportional to bytes^-power beyond the last knot
    double most_ = std::numeric_limits<double>::infinity();  // bytes; more bytes do not reduce the error
};

class ShareSolver {
  public:
    ShareSolver(std::uint64_t budget, std::span<BudgetShare> shares, const PlanErrors& plan)
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
                if (curves_[i] && plannedOf(shares_[i].bytes) >= kReplanFactor * planned_[i]) {
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
        const double least = std::max(static_cast<double>(kShareMin), kEvenFractionMin * even);
        const double most = std::max(least, static_cast<double>(kPatchBytesMax));
        return curves_[i] ? std::clamp(curves_[i]->bytesAt(log_worth), least, most) : even;
    }

    /// Sets all shares to the bytes of the lowest worth at which they fit into the budget.
    void share() {
        double high = kLogWorthMax;
        double low = -kLogWorthMax;
        for (int step = 0; step < kBisections; ++step) {
            const double middle = 0.5 * (low + high);
            double sum = 0.0;
            for (std::size_t i = 0; i < shares_.size(); ++i) {
                sum += bytesOf(i, middle);
            }
            (sum > static_cast<double>(budget_) ? low : high) = middle;
        }
        for (std::size_t i = 0; i < shares_.size(); ++i) {
            shares_[i].bytes = static_cast<std::uint64_t>(bytesOf(i, high));
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
        ShareSolver(budget, shares, plan).run();
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
