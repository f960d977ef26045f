#include "bake/pipeline/planned_bake.h"

#include <optional>
#include <utility>

#include "bake/measure/sight.h"
#include "bake/measure/truth.h"

namespace relief {
namespace {

/// Points on the surface, to say how much of it no map sees.
constexpr std::uint32_t kSurfacePoints = 4'000;
/// Of the bytes that a second bake aims at: its texels are others.
constexpr double kSecondShare = 0.99;

}  // namespace

Result<PlannedBake> bakePlanned(const MeshQuery& query, const ViewChoice& views, std::uint64_t budget_bytes,
                                BakeOptions options) {
    Plan plan = RELIEF_TRY(planSizes(views, budget_bytes));
    options.planned_budget = budget_bytes;
    for (auto aim = static_cast<double>(budget_bytes);;) {
        options.maps = specsOf(plan);
        Baked baked = RELIEF_TRY(bake(query.prepared(), options));
        plan.bytes = baked.collider.gpuBytes();
        if (plan.bytes <= budget_bytes) {
            plan.unseen_percent = Sights(baked.collider.maps, query)
                                      .unseenPercent(sampleSurface(query, {.samples = kSurfacePoints}));
            return PlannedBake{std::move(plan), std::move(baked)};
        }
        aim *= kSecondShare * static_cast<double>(budget_bytes) / static_cast<double>(plan.bytes);
        std::optional<Plan> smaller = sizesWithin(views, static_cast<std::uint64_t>(aim));
        if (!smaller) {
            return tl::unexpected<Error>(budgetTooSmall(views, budget_bytes));
        }
        plan = std::move(*smaller);
    }
}

}  // namespace relief
