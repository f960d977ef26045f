#include "bake/world/budget_share.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

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

Result<void> shareBudget(std::uint64_t budget, std::span<BudgetShare> shares) {
    if (budget / 2 / shares.size() < kShareMin) {
        return fail(ErrorCode::kUsage, "--budget is " + std::to_string(budget) + " bytes, too few for " +
                                           std::to_string(shares.size()) + " colliders; give at least " +
                                           std::to_string(2 * kShareMin * shares.size()));
    }
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
