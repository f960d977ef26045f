// SPDX-License-Identifier: Apache-2.0
// Plans the maps of a mesh: directions and places, and sizes for a budget of bytes.
//
// Points are drawn just outside the surface. A view serves the points that it sees, less at a grazing angle, where a texel
// covers much surface. Maps are added greedily while one more is worth its price: the bytes that it takes from the others,
// and its time in every step of a simulation. There are three kinds:
//
//   front-back maps of the whole mesh, along directions spread over the sphere and the axes of its box and of its
//   oriented box (oriented_box.h), turned for short rows (outer_views.h);
//   for what these see badly (cavities, armpits, insides of holes), small cubes in free space that keep the nearest surface;
//   for what lies between solids (shelves, rails, leaves), maps of gaps along one of those directions (gap_grid.h).
//
// The choice is independent of the budget, which decides the sizes alone: one texel size for all maps, for an even error.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "bake/plan/map_spec.h"
#include "bake/plan/prefer.h"
#include "bake/plan/silhouette.h"
#include "formats/base/result.h"

namespace relief {

/// Default limit of maps: every step of a simulation samples them all.
inline constexpr std::uint32_t kPlannedMapsMax = 8;

struct ViewOptions {
    std::uint64_t seed = 1;
    Prefer prefer = Prefer::kNeither;          ///< kOutside: more views, so that less free space is doubtful
    std::uint32_t max_maps = kPlannedMapsMax;  ///< at least 1
    bool gaps = true;                          ///< maps of gaps may be taken (bake/texels/gap_map.h)
    bool oriented_box = true;                  ///< with the axes of the oriented box
};

struct PlannedMap {
    MapSpec spec;         ///< complete but for compare, which is set for cubes; without sizes in a ViewChoice
    double serves = 0.0;  ///< gain in mean service over the maps before it
    std::string reason;   ///< for people: "front-back along (0, 1, 0): sees 61.2 % of the surface"
};

/// The views of a mesh, for any budget.
struct ViewChoice {
    struct Chosen {
        PlannedMap map;
        double width = 0.0;  ///< object units; of a cube the mean width of its volume
        double height = 0.0;
        double area = 0.0;                     ///< bytes for texels of side 1
        std::optional<Silhouette> silhouette;  ///< not of cubes
    };
    std::vector<Chosen> views;
    double area = 0.0;       ///< of all views
    double next_gain = 0.0;  ///< of the best view that was left out, as `serves`
    std::string mesh_name;
};

/// The same mesh and options give the same views, for any number of threads.
/// Errors: kFailure (no free space beside the surface), those of makeView.
[[nodiscard]] Result<ViewChoice> chooseViews(const MeshQuery& query, const ViewOptions& options);

inline constexpr std::uint64_t kPlanBudgetMin = 4096;
/// Errors: kUsage (below that).
[[nodiscard]] Result<void> checkPlanBudget(std::uint64_t budget_bytes);

struct Plan {
    std::vector<PlannedMap> maps;
    double texel = 0.0;           ///< side of a texel, object units
    double unseen_percent = 0.0;  ///< of the surface's area (bake/measure/sight.h); 0 before the bake
    double next_gain = 0.0;       ///< as in ViewChoice
    std::uint64_t bytes = 0;      ///< of all maps on the GPU; an estimate before the bake
};

/// For bake().
[[nodiscard]] std::vector<MapSpec> specsOf(const Plan& plan);

/// \param budget_bytes  of all maps together on the GPU (Collider::gpuBytes), at least kPlanBudgetMin
/// Errors: kUsage (a budget below kPlanBudgetMin or too small for the views).
[[nodiscard]] Result<Plan> planSizes(const ViewChoice& choice, std::uint64_t budget_bytes);
/// The same for any number of bytes; nullopt where even the smallest maps take more.
[[nodiscard]] std::optional<Plan> sizesWithin(const ViewChoice& choice, std::uint64_t bytes);
/// The error of planSizes in that case.
[[nodiscard]] Error budgetTooSmall(const ViewChoice& choice, std::uint64_t budget_bytes);

}  // namespace relief
