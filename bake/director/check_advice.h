// Commands that may help a collider that is wrong too often, tried in memory before they are advised.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bake/director/bake_request.h"
#include "bake/measure/worst_places.h"
#include "bake/mesh/mesh_query.h"
#include "bake/report/check_report.h"

namespace relief {

/// Bakes of meshes and budgets beyond these take more than a few seconds, and are not tried.
inline constexpr std::uint64_t kTrialTrianglesMax = 200'000;
inline constexpr std::uint64_t kTrialBytesMax = 2'500'000;
/// Points near the surface that a trial is measured at.
inline constexpr std::uint32_t kTrialSamplesMax = 50'000;

struct AdviceInput {
    std::string mesh_file;
    std::string output;  ///< of the advised bake
    const Collider& collider;
    const RecordedBake& recorded;
    const PreparedMesh& imported;  ///< wound outwards
    const PreparedMesh& baked;     ///< the solid that was baked
    const ShapeReport& shape;      ///< of the same
    const MeshQuery& query;        ///< of the mesh that is measured against
    const TruthSamples& truth;     ///< of the same
    std::span<const WorstPlace> places;
    double wrong_percent = 0.0;  ///< near the surface
};

/// By the causes of the places: twice the budget, cubes at places that no map sees, holes filled, the mesh wrapped. What
/// helps most comes first, what does not help last. The same for any number of threads, and on every machine: what is
/// tried does not depend on the time it takes.
[[nodiscard]] std::vector<Advice> adviceFor(const AdviceInput& input);

}  // namespace relief
