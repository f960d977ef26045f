// How a level shares its bytes among its colliders.
//
//     bytes = budget / 2 · (1 / colliders + weight / sum of weights),    weight = area · (largest scale)²
//
// The second half gives all the same texel in world units; the first keeps it from taking everything from small parts: of a
// terrain of 1 km² and fifty props of 8 m² these would get 0.04 %. Shares are rounded down to steps of an eighth of an
// octave, so that a mesh that changes leaves most others theirs, and they need not be baked again. NOTES.md has other ways.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/base/result.h"

namespace relief {

struct BudgetShare {
    double weight = 0.0;      ///< world units²; 0 or more
    std::uint64_t bytes = 0;  ///< filled in
};

/// The least share, in bytes.
inline constexpr std::uint64_t kShareMin = 4096;

/// \param shares  at least one. Errors: kUsage: the budget gives less than kShareMin to some.
[[nodiscard]] Result<void> shareBudget(std::uint64_t budget, std::span<BudgetShare> shares);

/// The largest 2^(k/8), rounded down, that is not above a number of at least 1.
[[nodiscard]] std::uint64_t roundDownToEighth(std::uint64_t bytes);

}  // namespace relief
