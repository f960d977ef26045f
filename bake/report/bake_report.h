// The report of `relief bake`: the maps, the reasons for them, and the time it took.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/pipeline/bake.h"
#include "bake/pipeline/budget_search.h"
#include "bake/plan/view_planner.h"
#include "bake/recipe/depfile.h"
#include "bake/repair/mesh_care.h"
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
    std::uint64_t budget = 0;         ///< bytes
    std::optional<double> max_error;  ///< percent; of --max-error, as are the next two
    double wrong_percent = 0.0;       ///< measured
    std::vector<BudgetTry> tries;
};

/// The effective options.
struct BakeSettingsReport {
    std::string mesh;
    std::string output;
    std::string plan_file;                         ///< empty: none
    std::vector<std::string> maps = {};            ///< as --map takes them
    std::optional<std::uint32_t> resolution = {};  ///< if it was used
    std::optional<std::uint64_t> budget = {};      ///< of a plan, bytes
    Quality quality = Quality::kNormal;
    Prefer prefer = Prefer::kNeither;
    bool raster = false;
    std::string backend_reason = {};  ///< of --backend auto; else empty
    std::string device = {};          ///< of raster; else empty
    int threads = 1;
    int compress = 0;
    bool closes_holes = true;
};

struct BakeSummary {
    const TriangleMesh& mesh = kNone<TriangleMesh>;
    const Baked& baked = kNone<Baked>;
    const std::optional<PlanReport>& plan = kNone<std::optional<PlanReport>>;
    const BakeTimes& times = kNone<BakeTimes>;
    const MeshCare& care = kNone<MeshCare>;
    const ShapeReport& shape = kNone<ShapeReport>;
    const std::optional<WrongShare>& wrong =
        kNone<std::optional<WrongShare>>;  ///< near the surface, if measured
    std::uint64_t unused_vertices = 0;     ///< of the mesh file (TriangleMesh)
    bool verbose = false;
    const SurfaceParts& parts = kNone<SurfaceParts>;
    /// Of a planned bake of several parts.
    const std::optional<PartsAccuracy>& part_accuracy = kNone<std::optional<PartsAccuracy>>;
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
    visit("budget", report.budget, {"Budget of the plan", "bytes of texels"});
    visit("bytes", plan.bytes, {"Size of the plan", "bytes of texels"});
    visit("texel", plan.texel, {"Side of a texel", "object units", kFromZero});
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

template <class Visitor, FieldsOf<MeshCare> C>
void fields(Visitor& visit, C& care) {
    visit("mesh_health", care.health, {"Health of the mesh as imported"});
    const auto repair = [&](auto& visit_repair) {
        visit_repair("method", care.repair, {"Value of --repair: wrap=ALPHA, orient or holes"});
        visit_repair("mesh_health", care.repaired, {"Health of the repaired mesh"});
        visit_repair("filled_holes", care.filled_holes, {"Holes filled by --repair holes"});
        visit_repair("holes_left", care.holes_left, {"Holes too large to fill"});
    };
    visit("repair", groupIf(!care.repair.empty(), repair), {"Results of --repair; null without it"});
    visit("turned_triangles", care.turned, {"Triangles turned to face outwards"});
}

template <class Visitor, FieldsOf<InputFile> I>
void fields(Visitor& visit, I& input) {
    visit("file", input.path, {"File as it was opened"});
    visit("hash", input.hash, {.help = "XXH3-128 of its contents", .pattern = kHashPattern});
}

template <class Visitor, FieldsOf<BakeSettingsReport> R>
void fields(Visitor& visit, R& report) {
    visit("mesh", report.mesh, {"Mesh as given"});
    visit("output", report.output, {"--output as given"});
    visit("plan_file", nonEmpty(report.plan_file), {"--plan; null without it"});
    visit("maps", report.maps, {"Baked maps, as --map takes them"});
    visit("resolution", report.resolution, {"--resolution; null where it has no effect", "texels"});
    visit("budget", report.budget, {"Budget of the plan; null without a plan", "bytes of texels"});
    visit("quality", report.quality, {"--quality"});
    visit("prefer", report.prefer, {"--prefer"});
    visit("backend", report.raster ? "raster" : "raycast",
          {.help = "Backend that baked", .words = kWords<"raycast", "raster">});
    visit("backend_reason", nonEmpty(report.backend_reason),
          {"Reason for the choice of --backend auto; null with another --backend"});
    visit("device", onlyIf(report.raster, report.device),
          {"OpenGL version, renderer and platform of raster; null for raycast"});
    visit("threads", report.threads, {"Threads used", {}, kFromOne});
    visit("compress", report.compress, {"zstd level; 0: none", {}, {0.0, 19.0}});
    visit("holes", report.closes_holes ? "close" : "keep",
          {.help = "--holes", .words = kWords<"close", "keep">});
}

/// `relief bake --json`
struct BakeJson {
    const BakeSummary& summary = kNone<BakeSummary>;
    const ContainerInfo& info = kNone<ContainerInfo>;
    const BakeSettingsReport& settings = kNone<BakeSettingsReport>;
    const std::vector<InputFile>& inputs = kNone<std::vector<InputFile>>;

    [[nodiscard]] ColliderReport<BakedMapReport> collider() const;
};

template <class Visitor, FieldsOf<BakeJson> R>
void fields(Visitor& visit, R& report) {
    const BakeSummary& summary = report.summary;
    const TriangleMesh& mesh = summary.mesh;
    fields(visit, report.collider());
    visit("settings", report.settings, {"Effective options"});
    visit("plan", summary.plan, {"Plan of the maps; null if they were given"});
    visit("shape", madeShapes(summary.shape), {"Treatment of the parts of the mesh; null with --holes keep"});
    visit("wrong_percent", summary.wrong ? std::optional(summary.wrong->total()) : std::nullopt,
          {"Share of 4000 points near the surface that are on the wrong side; null without a plan or with "
           "--no-check",
           "%", kPercentRange});
    visit("parts",
          summary.part_accuracy
              ? std::optional(PartsReport{*summary.part_accuracy, summary.parts, summary.baked.collider})
              : std::nullopt,
          {"Each part of the mesh judged by its own size; null if the bake did not measure itself or the "
           "mesh has one "
           "part"});
    visit("closed_holes", mesh.closed_holes, {"Holes of the mesh that were closed"});
    visit("cap_triangles", mesh.cap_triangles,
          {"Triangles added to close holes, for the rims of shells, and for the ground below terrains"});
    visit("dropped_triangles", mesh.dropped_triangles, {"Triangles without area, which were left out"});
    visit("unused_vertices", summary.unused_vertices, {"Vertices of the mesh file that no triangle uses"});
    const auto times = [&](auto& visit_time) {
        const BakeReport& baked = summary.baked.report;
        const BakeTimes& all = summary.times;
        const auto ms = [&](const char* name, double value, const char* help) {
            visit_time(name, value, {help, "ms", kFromZero});
        };
        ms("import", all.import_ms, "Import of the mesh");
        ms("plan", all.plan_ms, "Planning");
        ms("search", all.search_ms, "Search for the least budget");
        ms("build", baked.build_ms, "Acceleration structure");
        ms("trace", baked.trace_ms, "Rays");
        ms("encode", baked.encode_ms, "Texels");
        ms("fit", baked.fit_ms, "Planes");
        ms("raster", baked.raster_ms, "Drawing on the GPU");
        ms("refine", baked.refine_ms, "Refinement of texels by the other maps");
        ms("check", all.check_ms, "Measuring the result");
        ms("write", all.write_ms, "Writing");
        ms("total", all.total_ms, "The whole bake");
    };
    visit("times_ms", group(times), {"Wall-clock times"});
    fields(visit, summary.care);
    visit("warnings", summary.baked.report.warnings, {"Warnings, one line each"});
    // A wrapped mesh has lost the names of its files. The schema, which is made without maps, requires them.
    if (!report.inputs.empty() || summary.baked.collider.maps.empty()) {
        visit("inputs", report.inputs,
              {.help = "All files that were read, the mesh first", .items = kFromOne});
    }
}

}  // namespace relief
