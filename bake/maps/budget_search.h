// SPDX-License-Identifier: Apache-2.0
// Patches for a budget of bytes, and the least budget that keeps a promise: bakes at growing numbers of bytes until few enough
// points near the surface are on the wrong side, then narrows the last step down.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bake/maps/bake_maps.h"
#include "bake/measure/accuracy.h"
#include "bake/mesh/mesh_query.h"
#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

inline constexpr std::uint64_t kBudgetMin = 4096;  ///< bytes

/// A tree of patches.
/// \param budget_bytes  at least kBudgetMin; 0: none, where options.texel decides
/// \param options  its maps and budget do not count
/// Errors: kUsage (below kBudgetMin), those of bake.
[[nodiscard]] Result<Baked> bakePatchesWithin(const MeshQuery& query, std::uint64_t budget_bytes,
                                              BakeOptions options);

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
    /// Fewer samples than `relief check` takes, whose noise (0.04 percent of deviation where 1 % is wrong) is
    /// below what one more step would tell apart.
    AccuracyOptions accuracy{.samples = 50'000};
    /// Called after each try.
    std::function<void(const BudgetTry&)> tried;
};

struct BudgetSearchResult {
    Baked baked;
    BudgetTry chosen;
    std::vector<BudgetTry> tries;  ///< in the order they were made
};

/// Budgets grow fourfold; four bisections of the last step's logarithm then leave the budget at most 1.1
/// times what the promise needs (as far as more bytes mean fewer wrong points). Truth is sampled once. The same for any number of
/// threads. Errors: kDifference (not reached: the message names the best), those of bakePatchesWithin.
/// \param query  of the mesh that is baked, its holes closed or not.
/// \param truth  of the mesh that the points are measured against, as `relief check` does: with its holes.
[[nodiscard]] Result<BudgetSearchResult> bakeForError(const MeshQuery& query, const MeshQuery& truth,
                                                      const BudgetSearchOptions& options);

}  // namespace relief
