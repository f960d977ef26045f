// Chosen views, baked for a budget of bytes.
#pragma once

#include <cstdint>

#include "bake/mesh/mesh_query.h"
#include "bake/pipeline/bake.h"
#include "bake/plan/view_planner.h"
#include "formats/base/result.h"

namespace relief {

struct PlannedBake {
    Plan plan;  ///< its bytes are those of the baked maps
    Baked baked;
};

/// What the rows of a map of gaps take up is known to some per cent before it is baked: where all maps together take more
/// than the budget, they are baked again with larger texels.
/// \param query    of the mesh that the views were chosen for
/// \param options  its maps and planned_budget do not count
/// Errors: those of planSizes and bake.
[[nodiscard]] Result<PlannedBake> bakePlanned(const MeshQuery& query, const ViewChoice& views,
                                              std::uint64_t budget_bytes, BakeOptions options);

}  // namespace relief
