// SPDX-License-Identifier: Apache-2.0
// How a level shares its bytes among its colliders: so that the next byte goes where it mends most.
//
// The errors of a mesh fall with its bytes along a curve. A small plan gives the beginning, a power law goes on from there.
// Shares are where a byte more mends the same in all of them,
//
//     weight · −d wrong / d bytes = worth,
//
// but none is below an eighth of an even one. Shares are rounded down to steps of an eighth of an octave, so that a mesh that
// changes leaves most others theirs, and they need not be baked again. NOTES.md has other ways.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "bake/patches/patch_planner.h"
#include "formats/base/result.h"

namespace relief {

struct BudgetShare {
    double weight = 0.0;      ///< 0 or more
    std::uint64_t bytes = 0;  ///< filled in
};

/// The least share, in bytes.
inline constexpr std::uint64_t kShareMin = 4096;

/// A share is planned with one in so many of its bytes, and down to half as many.
inline constexpr std::uint64_t kSharePerPlan = 8;

/// Plans trees of a mesh up to so many bytes, a power of two. Called from several threads. One that fails, or without trees,
/// leaves its mesh an even share.
using PlanErrors = std::function<Result<ErrorCurve>(std::size_t mesh, std::uint64_t bytes)>;

/// Plans each mesh for an even share, and those again whose shares become twice as large or more.
/// \param shares  at least one, of which a single one takes all without a plan; weights are of wrong volumes.
/// Errors: kUsage: the budget gives less than 2·kShareMin to each.
[[nodiscard]] Result<void> shareByErrors(std::uint64_t budget, std::span<BudgetShare> shares,
                                         const PlanErrors& plan);

/// Half evenly, half by weight: of maps without such a curve.
/// \param shares  at least one; weights are areas in the world.
/// Errors: as shareByErrors.
[[nodiscard]] Result<void> shareByArea(std::uint64_t budget, std::span<BudgetShare> shares);

/// The largest 2^(k/8), rounded down, that is not above a number of at least 1.
[[nodiscard]] std::uint64_t roundDownToEighth(std::uint64_t bytes);

}  // namespace relief
