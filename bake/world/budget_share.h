// SPDX-License-Identifier: Apache-2.0
// Distributes the bytes of a level among its colliders, so that each byte goes where it reduces the error most.
//
// Each mesh has a curve of its errors, which fall as its bytes grow. A small patch plan provides the start of the
// curve, and a power law continues it. In all shares, one more byte reduces the weighted error by the same amount:
//
//     weight · −d wrong / d bytes = worth.
//
// No share is below an eighth of an even share. Shares are rounded down to a power of 2^(1/8): if one mesh changes,
// most others keep their share and need no new bake.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "bake/patches/patch_planner.h"
#include "formats/base/result.h"

namespace relief {

struct BudgetShare {
    double weight = 0.0;      ///< 0 or more
    std::uint64_t bytes = 0;  ///< output
};

/// Minimum share, in bytes.
inline constexpr std::uint64_t kShareMin = 4096;

/// The bytes of a share divided by the bytes of its plan, before the plan is rounded down to a power of two.
inline constexpr std::uint64_t kSharePerPlan = 8;

/// Returns the error curve of a mesh from a plan of `bytes` bytes, a power of two. Called from several threads. A mesh
/// gets an even share if its plan fails or its curve is empty.
using PlanErrors = std::function<Result<ErrorCurve>(std::size_t mesh, std::uint64_t bytes)>;

/// Plans each mesh for an even share, and again if its share grows by a factor of two or more.
/// \param shares  at least one; a single share is the budget, rounded down, without a plan. Weights apply to
/// misclassified volume.
/// Errors: kUsage (the budget is below 2·kShareMin per share).
[[nodiscard]] Result<void> shareByErrors(std::uint64_t budget, std::span<BudgetShare> shares,
                                         const PlanErrors& plan);

/// Distributes half of the budget evenly and half by weight, for maps without error curves.
/// \param shares  at least one; weights are areas in world space.
/// Errors: those of shareByErrors.
[[nodiscard]] Result<void> shareByArea(std::uint64_t budget, std::span<BudgetShare> shares);

/// Returns the largest 2^(k/8), rounded down, that does not exceed `bytes` (at least 1).
[[nodiscard]] std::uint64_t roundDownToEighth(std::uint64_t bytes);

}  // namespace relief
