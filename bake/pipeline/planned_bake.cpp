#include "bake/pipeline/planned_bake.h"

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
    for (double aim = static_cast<double>(budget_bytes);;) {
        Plan plan = RELIEF_TRY(planSizes(views, static_cast<std::uint64_t>(aim)));
        options.maps = specsOf(plan);
        Baked baked = RELIEF_TRY(bake(query.prepared(), options));
        plan.bytes = baked.collider.gpuBytes();
        if (plan.bytes <= budget_bytes) {
            plan.unseen_percent = Sights(baked.collider.maps, query)
                                      .unseenPercent(sampleSurface(query, {.samples = kSurfacePoints}));
            return PlannedBake{std::move(plan), std::move(baked)};
        }
        aim *= kSecondShare * static_cast<double>(budget_bytes) / static_cast<double>(plan.bytes);
    }
}

}  // namespace relief
