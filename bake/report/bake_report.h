// The report of `relief bake`: the maps, the reasons for them, and the time it took.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/pipeline/bake.h"
#include "bake/pipeline/budget_search.h"
#include "bake/plan/view_planner.h"
#include "bake/recipe/depfile.h"
#include "bake/repair/repair.h"
#include "bake/report/collider_report.h"
#include "bake/report/parts_report.h"
#include "bake/shape/shape.h"

namespace relief {

struct BakeTimes {
    double import_ms = 0.0;
    double plan_ms = 0.0;    ///< views, and the tree that they are chosen by
    double search_ms = 0.0;  ///< of --max-error: all its plans, bakes and measurements
    double check_ms = 0.0;   ///< of a planned bake that measures itself
    double write_ms = 0.0;
    double total_ms = 0.0;
};

/// The choice of the maps, if none were named.
struct PlanReport {
    Plan plan;
    std::optional<std::uint64_t> budget;  ///< bytes; not of --texel alone
    std::optional<double> max_error;      ///< percent; of --max-error, as are the next two
    double wrong_percent = 0.0;           ///< measured
    std::vector<BudgetTry> tries;
};

struct BakeSummary {
    const TriangleMesh& mesh;
    const Baked& baked;
    const std::optional<PlanReport>& plan;
    const BakeTimes& times;
    const RepairReport& care;
    const ShapeReport& shape;
    const std::optional<WrongShare>& wrong;  ///< near the surface, if measured
    std::uint64_t unused_vertices = 0;       ///< of the mesh file (TriangleMesh)
    bool verbose = false;
    const AnimatedMesh* animated = nullptr;  ///< if it moves
};

/// For people: a few lines and a table. \param output  as on the command line
[[nodiscard]] std::string bakeText(const BakeSummary& summary, const std::string& output,
                                   std::size_t file_size);
/// One line with its end: "shape: 2 solids, 1 sheet (0.01 m thick)"; empty where no shapes were made.
[[nodiscard]] std::string shapeText(const ShapeReport& report, const std::string& unit);
/// Nothing where no shapes were made.
[[nodiscard]] std::optional<ShapeReport> madeShapes(const ShapeReport& report);

// --- The same as fields.

struct BakedMapReport {
    ColliderMapReport map = {};
    MapReport baked = {};

    /// Share of the texels that hold a surface.
    [[nodiscard]] double coverage() const {
        return static_cast<double>(baked.covered) / static_cast<double>(baked.texels);
    }
};

template <class Visitor, FieldsOf<BakedMapReport> R>
void fields(Visitor& visit, R& report) {
    fields(visit, report.map);
    visit("coverage", report.coverage(), {"Share of the texels that hold a surface", {}, kShareRange});
}

template <class Visitor, FieldsOf<PlannedMap> M>
void fields(Visitor& visit, M& map) {
    visit("reason", map.reason, {"Reason for the map"});
    visit("serves", map.serves, {"Share of the plan's aim that the map adds"});
}

template <class Visitor, FieldsOf<PlanReport> R>
void fields(Visitor& visit, R& report) {
    const Plan& plan = report.plan;
    visit("budget", report.budget, {"Budget of the plan; null of --texel alone", "bytes of texels"});
    visit("bytes", plan.bytes, {"Size of the plan", "bytes of texels"});
    visit("texel", plan.texel,
          {"Side of a texel; of patches, the least distance of two heights", "object units", kFromZero});
    visit("unseen_percent", plan.unseen_percent,
          {"Share of the surface that no map sees", "%", kPercentRange});
    visit("next_map_serves", plan.next_gain,
          {"Share of the points that one more map would have served", {}, kShareRange});
    visit("maps", plan.maps, {"One for each map"});
    const auto search = [&](auto& visit_search) {
        visit_search("max_error_percent", static_cast<float>(report.max_error.value_or(0.0)),
                     {"--max-error", "%", kFromZero});
        visit_search("wrong_percent", report.wrong_percent,
                     {"Share of the points near the surface that are on the wrong side", "%", kPercentRange});
        visit_search("tries", report.tries, {"Trials, in their order"});
    };
    visit("search", groupIf(report.max_error.has_value(), search),
          {"Search for the least budget; null without --max-error"});
}

template <class Visitor, FieldsOf<RepairReport> C>
void fields(Visitor& visit, C& care) {
    visit("mesh_health", care.health, {"Health of the mesh as imported"});
    const auto repair = [&](auto& visit_repair) {
        visit_repair("method", care.repair, {"Value of --repair: wrap=ALPHA"});
        visit_repair("mesh_health", care.repaired, {"Health of the repaired mesh"});
    };
    visit("repair", groupIf(!care.repair.empty(), repair), {"Results of --repair; null without it"});
    visit("turned_triangles", care.turned, {"Triangles turned to face outwards"});
}

template <class Visitor, FieldsOf<InputFile> I>
void fields(Visitor& visit, I& input) {
    visit("file", input.path, {"File as it was opened"});
    visit("hash", input.hash, {.help = "XXH3-128 of its contents", .pattern = kHashPattern});
}

}  // namespace relief
