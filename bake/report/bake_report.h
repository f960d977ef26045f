// What `relief bake` says when it is done: which maps, why these, and where the time went.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/measure/part_accuracy.h"
#include "bake/mesh/mesh.h"
#include "bake/pipeline/bake.h"
#include "bake/pipeline/budget_search.h"
#include "bake/plan/view_planner.h"
#include "bake/repair/mesh_care.h"
#include "bake/shape/shape.h"
#include "formats/container.h"

namespace relief {

struct BakeTimes {
    double import_ms = 0.0;
    double plan_ms = 0.0;    ///< views, the tree that they are chosen by included
    double search_ms = 0.0;  ///< of --max-error: all its plans, bakes and measurements
    double check_ms = 0.0;   ///< of a planned bake that measures itself
    double write_ms = 0.0;
    double total_ms = 0.0;
};

/// How the maps were chosen, if nobody named them.
struct PlanReport {
    Plan plan;
    std::uint64_t budget = 0;         ///< bytes
    std::optional<double> max_error;  ///< percent; of --max-error, as are the next two
    double wrong_percent = 0.0;       ///< measured
    std::vector<BudgetTry> tries;
};

struct BakeSummary {
    const TriangleMesh& mesh;
    const Baked& baked;
    const std::optional<PlanReport>& plan;
    const BakeTimes& times;
    const MeshCare& care;
    const ShapeReport& shape;
    const std::optional<WrongShare>& wrong;  ///< near the surface, as a planned bake measures itself
    std::uint64_t unused_vertices = 0;       ///< of the mesh file (TriangleMesh)
    bool verbose = false;
    const SurfaceParts& parts;
    const std::optional<PartsAccuracy>& part_accuracy;  ///< of a planned bake of several parts
};

/// For people: a few lines and a table. \param output  as the user names it.
[[nodiscard]] std::string bakeText(const BakeSummary& summary, const std::string& output,
                                   std::size_t file_size);

/// jsonCollider's object, with coverage, plan, dropped_triangles, unused_vertices, the mesh's health, times_ms and warnings.
/// \param settings  put in beside them.
[[nodiscard]] nlohmann::ordered_json jsonBake(const BakeSummary& summary, const ContainerInfo& info,
                                              const nlohmann::ordered_json& settings);

}  // namespace relief
