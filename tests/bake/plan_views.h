// SPDX-License-Identifier: Apache-2.0
// Views and sizes in one call.
#pragma once

#include "bake/plan/view_planner.h"

namespace relief::test {

struct PlanOptions {
    std::uint64_t budget_bytes = std::uint64_t{1} << 20;  ///< as planSizes has it
    ViewOptions views;
};

/// Errors: those of chooseViews and planSizes.
[[nodiscard]] inline Result<Plan> planViews(const MeshQuery& query, const PlanOptions& options) {
    const ViewChoice choice = RELIEF_TRY(chooseViews(query, options.views));
    return planSizes(choice, options.budget_bytes);
}

}  // namespace relief::test
