// Which maps a mesh needs: directions, places and sizes, chosen for a budget of bytes.
//
// Points just outside the surface are drawn. A view serves a point if it sees it; less so at a grazing angle,
// where a texel covers much surface. Maps are added greedily, each time the one that serves most for its
// bytes:
//
//   1. front-back maps of the whole mesh, along directions spread over the sphere and the axes of its box and
//      of its oriented box (oriented_box.h), each turned so that its rectangle is small, while one more
//      serves a worthwhile share of the points;
//   2. for what no outer direction sees (cavities, armpits, insides of holes), small cubes in free space that
//      keep the nearest surface, placed where they see most of it.
//
// Sizes follow from the budget: one texel size for all maps, so that the error is even.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/mesh/mesh_query.h"
#include "bake/plan/map_spec.h"
#include "bake/plan/prefer.h"
#include "formats/base/result.h"

namespace relief {

struct PlanOptions {
    std::uint64_t budget_bytes = std::uint64_t{1} << 20;  ///< of all texels together, at least kPlanBudgetMin
    std::uint64_t seed = 1;
    Prefer prefer = Prefer::kNeither;  ///< kOutside: more views, so that less free space is doubtful
    bool oriented_box = true;  ///< false: do without the axes of the oriented box, to see what they are worth
};

inline constexpr std::uint64_t kPlanBudgetMin = 4096;

struct PlannedMap {
    MapSpec spec;         ///< complete but for compare, which is set for cubes
    double serves = 0.0;  ///< share of the points that this map serves and none before it does
    std::string reason;   ///< for people: "front-back along (0, 1, 0): sees 61.2 % of the surface"
};

struct Plan {
    std::vector<PlannedMap> maps;
    double texel = 0.0;           ///< side of a texel, object units
    double unseen_percent = 0.0;  ///< of the surface's area: no chosen map sees it
    std::uint64_t bytes = 0;      ///< of all texels
};

/// What bake() takes of a plan.
[[nodiscard]] std::vector<MapSpec> specsOf(const Plan& plan);

/// The same mesh and options give the same plan, for any number of threads.
/// Errors: kUsage (a budget below kPlanBudgetMin or too small for the maps), kFailure (no free space beside
/// the surface), those of makeView.
[[nodiscard]] Result<Plan> planViews(const TriangleMesh& mesh, const MeshQuery& query,
                                     const PlanOptions& options);

}  // namespace relief
