#include "bake/report/bake_report.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "bake/report/accuracy_report.h"
#include "bake/report/care_report.h"
#include "bake/report/parts_report.h"
#include "bake/report/report.h"
#include "bake/report/shape_report.h"
#include "bake/report/size_report.h"
#include "formats/base/file_io.h"
#include "formats/row_spans.h"
#include "runtime/tool/json_text.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

double coverage(const MapReport& map) {
    return static_cast<double>(map.covered) / static_cast<double>(map.texels);
}

std::string percent(double share) {
    char text[16];
    std::snprintf(text, sizeof(text), "%.1f %%", 100.0 * share);
    return text;
}

std::string sizeText(const DepthMap& map) {
    const std::string size = std::to_string(map.width) + "x" + std::to_string(map.height);
    return map.faceCount() == 1 ? size : std::to_string(map.faceCount()) + "x" + size;
}

std::string planLine(const PlanReport& report, const std::string& unit) {
    const Plan& plan = report.plan;
    std::string line = "planned for " + bytesText(report.budget) + " on the GPU, where the maps take " +
                       bytesText(plan.bytes) + ": texels of " + shortNumber(plan.texel) + " " +
                       (unit.empty() ? "object units" : unit) + "; " + shortNumber(plan.unseen_percent) +
                       " % of the surface is seen by no map; one more map would have "
                       "served " +
                       shortNumber(100.0 * plan.next_gain) + " % more";
    if (report.max_error) {
        line += "; " + shortNumber(report.wrong_percent) +
                " % of the points near the surface are on the wrong side, found by " +
                std::to_string(report.tries.size()) + (report.tries.size() == 1 ? " try" : " tries");
    }
    return line + "\n";
}

Json jsonPlan(const PlanReport& report) {
    Json maps = Json::array();
    for (const PlannedMap& map : report.plan.maps) {
        maps.push_back({{"reason", map.reason}, {"serves", map.serves}});
    }
    Json search = nullptr;
    if (report.max_error) {
        Json tries = Json::array();
        for (const BudgetTry& made : report.tries) {
            tries.push_back(
                {{"budget", made.budget}, {"bytes", made.bytes}, {"wrong_percent", made.wrong_percent}});
        }
        search = {{"max_error_percent", jsonNumber(static_cast<float>(*report.max_error))},
                  {"wrong_percent", report.wrong_percent},
                  {"tries", tries}};
    }
    return {{"budget", report.budget},
            {"bytes", report.plan.bytes},
            {"texel", report.plan.texel},
            {"unseen_percent", report.plan.unseen_percent},
            {"next_map_serves", report.plan.next_gain},
            {"maps", maps},
            {"search", search}};
}

}  // namespace

std::string bakeText(const BakeSummary& summary, const std::string& output, std::size_t file_size) {
    const Baked& baked = summary.baked;
    std::string text =
        summary.mesh.name + ": " + std::to_string(summary.mesh.sourceTriangles()) + " triangles";
    if (summary.mesh.dropped_triangles > 0) {
        text += ", " + std::to_string(summary.mesh.dropped_triangles) + " without area dropped";
    }
    if (summary.unused_vertices > 0) {
        text += ", " + std::to_string(summary.unused_vertices) +
                (summary.unused_vertices == 1 ? " vertex" : " vertices") + " of no triangle";
    }
    text += "\nbox " + boxText(summary.mesh.bounds, summary.mesh.unit);
    text += "\n" + careText(summary.care, summary.verbose) + shapeText(summary.shape, summary.mesh.unit);
    if (summary.plan) {
        text += planLine(*summary.plan, summary.mesh.unit);
    }
    std::vector<std::vector<std::string>> rows = {{"map", "format", "projection", "keeps", "size>", "bytes>",
                                                   "covered>", summary.plan ? "why" : "spec"}};
    for (std::size_t i = 0; i < baked.collider.maps.size(); ++i) {
        const DepthMap& map = baked.collider.maps[i];
        const MapReport& report = baked.report.maps[i];
        rows.push_back({std::to_string(i), mapFormatName(map.format),
                        map.projection() == Projection::kCube ? "cube" : "orthographic",
                        compareName(map.compare), sizeText(map), bytesText(gpuBytes(map)),
                        percent(coverage(report)),
                        summary.plan ? summary.plan->plan.maps[i].reason : toString(report.spec)});
    }
    text += table(rows);
    const BakeTimes& times = summary.times;
    char line[256];
    std::snprintf(line, sizeof(line), "%.0f ms: import %.0f, %s %.0f, ", times.total_ms, times.import_ms,
                  times.search_ms > 0.0 ? "search" : "plan",
                  times.search_ms > 0.0 ? times.search_ms : times.plan_ms);
    text += line;
    if (baked.report.raster_ms > 0.0) {
        std::snprintf(line, sizeof(line), "upload %.0f, drawing %.0f, writing %.0f\n", baked.report.build_ms,
                      baked.report.raster_ms, times.write_ms);
        return text + line + (output == "-" ? "standard output" : quotedPath(output)) + ": " +
               bytesText(file_size) + "\n";
    }
    std::snprintf(line, sizeof(line),
                  "%stree %.0f, rays %.0f, texels %.0f, planes %.0f, refining %.0f%s writing %.0f\n",
                  times.search_ms > 0.0 ? "its last bake: " : "", baked.report.build_ms,
                  baked.report.trace_ms, baked.report.encode_ms, baked.report.fit_ms, baked.report.refine_ms,
                  times.search_ms > 0.0 ? ";" : ",", times.write_ms);
    text += line;
    if (summary.wrong) {
        text += "wrong near the surface: " + shortNumber(summary.wrong->total()) + " %\n";
    }
    return text + (output == "-" ? "standard output" : quotedPath(output)) + ": " + bytesText(file_size) +
           "\n";
}

Json jsonBake(const BakeSummary& summary, const ContainerInfo& info, const Json& settings) {
    const BakeReport& report = summary.baked.report;
    const BakeTimes& times = summary.times;
    Json json = jsonCollider(summary.baked.collider, info);
    for (std::size_t i = 0; i < report.maps.size(); ++i) {
        json["maps"][i]["coverage"] = coverage(report.maps[i]);
    }
    json["settings"] = settings;
    json["plan"] = summary.plan ? jsonPlan(*summary.plan) : Json(nullptr);
    json["shape"] = jsonShape(summary.shape);
    json["wrong_percent"] = summary.wrong ? Json(summary.wrong->total()) : Json(nullptr);
    json["parts"] = summary.part_accuracy
                        ? jsonParts(*summary.part_accuracy, summary.parts, summary.baked.collider)
                        : Json(nullptr);
    json["closed_holes"] = summary.mesh.closed_holes;
    json["cap_triangles"] = summary.mesh.cap_triangles;
    json["dropped_triangles"] = summary.mesh.dropped_triangles;
    json["unused_vertices"] = summary.unused_vertices;
    json["times_ms"] = {
        {"import", times.import_ms}, {"plan", times.plan_ms},      {"search", times.search_ms},
        {"build", report.build_ms},  {"trace", report.trace_ms},   {"encode", report.encode_ms},
        {"fit", report.fit_ms},      {"raster", report.raster_ms}, {"refine", report.refine_ms},
        {"check", times.check_ms},   {"write", times.write_ms},    {"total", times.total_ms}};
    addCareJson(summary.care, json);
    json["warnings"] = report.warnings;
    return json;
}

}  // namespace relief
