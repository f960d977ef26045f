// SPDX-License-Identifier: Apache-2.0
// Bakes patches for a budget of bytes, and finds the smallest budget that meets an error limit. The search increases
// the budget until few enough points near the surface are misclassified and no part is lost, then bisects the last
// interval.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bake/maps/bake_maps.h"
#include "bake/measure/truth.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_parts.h"
#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

inline constexpr std::uint64_t kBudgetMin = 4096;  ///< bytes

/// Bakes a tree of patches. The provenance records the budget, but no map or texel.
/// \param budget_bytes  at least kBudgetMin; 0: no limit, only options.texel applies
/// \param options  its maps are ignored
/// Errors: kUsage (below kBudgetMin), those of bake.
[[nodiscard]] Result<Baked> bakePatchesWithin(const MeshQuery& query, std::uint64_t budget_bytes,
                                              BakeOptions options);

struct BudgetTrial {
    std::uint64_t budget = 0;      ///< bytes
    std::uint64_t bytes = 0;       ///< on the GPU, at most the budget
    double wrong_percent = 0.0;    ///< misclassified points near the surface (FieldAccuracy::near)
    std::uint64_t lost_parts = 0;  ///< counted only if wrong_percent is within the limit
};

void fields(FieldVisitor& visit, const BudgetTrial& attempt);

struct BudgetSearchOptions {
    double max_error_percent = 1.0;
    std::uint64_t budget_min = 32'000;      ///< bytes; budget_max if that is smaller
    std::uint64_t budget_max = 64'000'000;  ///< bytes
    BakeOptions bake;                       ///< its maps are ignored
    AccuracyOptions accuracy;               ///< by default those of `relief check`
    /// Called after each attempt.
    std::function<void(const BudgetTrial&)> tried;
};

struct BudgetSearchResult {
    Baked baked;
    BudgetTrial chosen;
    std::vector<BudgetTrial> tries;  ///< in the order of the attempts
};

/// Finds the smallest budget that meets the error limit. Budgets grow by factors of four; four bisections of the
/// logarithm then bring the budget to at most 1.1 times the minimum, provided that more bytes mean fewer misclassified
/// points. The criterion is MeshCheck::passes(), so the default check of the result passes. Truth is sampled once. The
/// result does not depend on the number of threads.
/// Errors: kDifference (limit not reached; the message names the best result), those of bakePatchesWithin.
/// \param query  of the mesh to bake, with holes closed or open. \param parts  of that mesh.
/// \param truth  of the mesh to measure against, with its holes open, as in `relief check`.
[[nodiscard]] Result<BudgetSearchResult> bakeForError(const MeshQuery& query, const MeshQuery& truth,
                                                      const SurfaceParts& parts,
                                                      const BudgetSearchOptions& options);

}  // namespace relief
