// SPDX-License-Identifier: Apache-2.0
#include "bake/report/bake_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/verdict/report_text.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Writes each field with a value as a line "  boundary edges: 12".
class LineWriter : public FieldVisitor {
  public:
    void operator()(std::string_view name, FieldRef value, const FieldInfo& /*info*/) override {
        if (value.form() == FieldForm::kOptional) {
            if (value.count() > 0) {
                const auto& fault = value[0].as<const MeshFault>();
                add(name, fault.description + " at " + shortest(fault.position));
            }
        } else {
            add(name, value.form() == FieldForm::kBool ? value.as<bool>() ? "yes" : "no"
                                                       : std::to_string(value.whole()));
        }
    }
    [[nodiscard]] std::string take() { return std::move(text_); }

  private:
    void add(std::string_view name, const std::string& value) {
        std::string words(name);
        std::ranges::replace(words, '_', ' ');
        text_ += "  " + words + ": " + value + "\n";
    }

    std::string text_;
};

std::string linesOf(const MeshHealth& health) {
    LineWriter lines;
    fields(lines, health);
    return lines.take();
}

std::string healthLine(const MeshHealth& health) {
    std::string text = health.isSolid() ? "a closed solid" : faultsText(health);
    text += "; " + countText(health.components, "component");
    if (health.closed_components != health.components) {
        text += ", " + std::to_string(health.closed_components) + " closed";
    }
    return text;
}

/// Returns complete lines; empty if all counts are zero.
std::string healthText(const RepairReport& report, bool verbose) {
    if (!report.health) {
        return "";
    }
    std::string text =
        "mesh: " +
        (report.repaired ? std::to_string(report.health->triangles) + " triangles as imported; " : "") +
        healthLine(*report.health) + "\n";
    text += verbose ? linesOf(*report.health) : "";
    if (report.repaired) {
        text += "after --repair " + report.repair + ": " + std::to_string(report.repaired->triangles) +
                " triangles; " + healthLine(*report.repaired) + "\n" +
                (verbose ? linesOf(*report.repaired) : "");
    } else if (report.turned > 0) {
        text += "flipped " + countText(report.turned, "triangle") + " to face outwards\n";
    }
    return text;
}

std::string patchesLine(const PatchesReport& report, const std::string& unit) {
    const std::optional<float>& requested = report.requested_texel;
    std::string line =
        "patches for " +
        (requested ? "a texel of " + shortNumber(double{*requested}) + " " + unitText(unit) : "") +
        (requested && report.budget ? " and at most " : "") +
        (report.budget ? bytesText(*report.budget) + " on the GPU" : "") + " use " + bytesText(report.bytes) +
        ": heights at least " + shortNumber(report.texel) + " " + unitText(unit) + " apart";
    if (report.max_error) {
        line += "; " + shortNumber(report.wrong_percent) +
                " % of the points near the surface are on the wrong side, found in " +
                countText(report.tries.size(), "trial");
    }
    return line + "\n";
}

std::string msText(const char* stage, double ms) {
    return stage + (" " + std::to_string(std::llround(ms)));
}

/// Returns the time of each stage that ran: "ray tree 3, fitting 812".
std::string stagesText(const BakeReport& report) {
    const std::pair<const char*, double> stages[] = {{"ray tree", report.build_ms},
                                                     {"rays", report.trace_ms},
                                                     {"texels", report.encode_ms},
                                                     {"fitting", report.fit_ms}};
    std::string text;
    for (const auto& [stage, ms] : stages) {
        text += ms > 0.0 ? (text.empty() ? "" : ", ") + msText(stage, ms) : "";
    }
    return text;
}

}  // namespace

std::string shapeText(const ShapeReport& report, const std::string& unit) {
    std::string text = report.text();
    if (text.empty()) {
        return text;
    }
    if (report.thickness > 0.0) {
        const bool uniform = report.thickness_min == report.thickness;
        text += "; sheets are " + (uniform ? "" : shortNumber(report.thickness_min) + " to ") +
                shortNumber(report.thickness) + " " + unitText(unit) + " thick";
    }
    if (report.coincident_triangles > 0) {
        text += "; " + std::to_string(report.coincident_triangles) + " coincident triangles count once";
    }
    for (const auto& [shape, triangles] : report.named) {
        text += "; " + shape.name + " (" + std::to_string(triangles) + " triangles) as " +
                std::string(wordOf(shape.as));
    }
    return "shape: " + text + "\n";
}

std::optional<ShapeReport> shapesIfAny(const ShapeReport& report) {
    return report.text().empty() ? std::nullopt : std::optional(report);
}

std::string bakeText(const BakeResult& result, const std::string& output, std::size_t file_size,
                     bool verbose) {
    const Baked& baked = result.baked;
    const TriangleMesh& mesh = *result.mesh.mesh;
    std::string text = mesh.name + ": " + std::to_string(mesh.sourceTriangles()) + " triangles";
    if (mesh.dropped_triangles > 0) {
        text += ", " + std::to_string(mesh.dropped_triangles) + " without area dropped";
    }
    if (result.unused_vertices > 0) {
        text += ", " + countText(result.unused_vertices, "vertex", "vertices") + " unused";
    }
    text += "\nbox " + boxText(mesh.bounds, mesh.unit);
    text += "\n" + healthText(result.mesh.report, verbose) + shapeText(result.shape, mesh.unit);
    if (const Materials& materials = baked.collider.materials; !materials.empty()) {
        text += countText(materials.list.size(), "material") + " in " + bytesText(materials.bytes()) + "\n";
    }
    if (result.animated) {
        text += animationText(*result.animated);
    }
    if (result.patches) {
        text += patchesLine(*result.patches, mesh.unit);
    }
    std::vector<std::vector<std::string>> rows = {
        {"map", "format", "projection", "keeps", "size>", "bytes>", "covered>", "spec"}};
    for (std::size_t i = 0; i < baked.collider.maps.size(); ++i) {
        const DepthMap& map = baked.collider.maps[i];
        const MapReport& report = baked.report.maps[i];
        rows.push_back({std::to_string(i), mapFormatName(map.format), projectionText(map), keepsText(map),
                        sizeText(map), bytesText(map.texelBytes()),
                        map.format == MapFormat::kPatches ? "-" : fractionText(report.coverage()),
                        toString(report.spec)});
    }
    text += table(rows);
    const BakeTimes& times = result.times;
    const bool searched = times.search_ms > 0.0;
    text += std::to_string(std::llround(times.total_ms)) + " ms: " + msText("import", times.import_ms) +
            ", " + (searched ? msText("search", times.search_ms) + ", its last bake: " : "") +
            stagesText(baked.report) + (searched ? "; " : ", ") + msText("writing", times.write_ms) + "\n";
    if (const auto verdict = result.verdict()) {
        text += verdict->text + "\n";
    }
    return text + (output == "-" ? "standard output" : quotedPath(output)) + ": " + bytesText(file_size) +
           "\n";
}

void fields(FieldVisitor& visit, const PatchesReport& report) {
    visit("budget", report.budget, {"Budget; null for --texel without --budget", "bytes of texels"});
    visit("bytes", report.bytes, {"Size of the patches", "bytes of texels"});
    visit("texel", report.texel, {"Minimum distance between two heights", "object units", kFromZero});
    const auto search = [&](FieldVisitor& visit_search) {
        visit_search("max_error_percent", static_cast<float>(report.max_error.value_or(0.0)),
                     {"--max-error", "%", kFromZero});
        visit_search("wrong_percent", report.wrong_percent,
                     {"Points near the surface that are on the wrong side", "%", kPercentRange});
        visit_search("trials", report.tries, {"Trials, in order"});
    };
    visit("search", groupIf(report.max_error.has_value(), search),
          {"Search for the smallest budget; null without --max-error"});
}

void fields(FieldVisitor& visit, const RepairReport& report) {
    visit("mesh_health", report.health, {"Health of the mesh as imported"});
    const auto repair = [&](FieldVisitor& visit_repair) {
        visit_repair("method", report.repair, {"Value of --repair: wrap=ALPHA"});
        visit_repair("mesh_health", report.repaired, {"Health of the repaired mesh"});
    };
    visit("repair", groupIf(!report.repair.empty(), repair), {"Results of --repair; null without it"});
    visit("flipped_triangles", report.turned, {"Triangles flipped to face outwards"});
}

void fields(FieldVisitor& visit, const InputFile& input) {
    visit("file", input.path, {"Path of the file, as opened"});
    visit("hash", input.hash, {.help = "XXH3-128 of its contents", .pattern = kHashPattern});
}

void toolField(FieldVisitor& visit) {
    visit("tool", std::string("relief ") + RELIEF_VERSION, {"Name and version of the program"});
}

void folderFields(FieldVisitor& visit, const std::vector<std::string>& removed, double ms,
                  const std::vector<InputFile>& inputs, const std::vector<std::string>& warnings) {
    visit("removed", removed, {"Removed containers, which only the previous world referenced"});
    visit("ms", ms, {"Time of the whole run", "ms", kFromZero});
    visit("inputs", inputs, {.help = "All input files", .items = kFromOne});
    visit("warnings", warnings, {"Warnings, one line each"});
}

namespace {

struct BakedMapReport {
    ColliderMapReport map = {};
    MapReport baked = {};
};

void fields(FieldVisitor& visit, const BakedMapReport& report) {
    fields(visit, report.map);
    visit("coverage", report.baked.coverage(),
          {"Fraction of the texels that store a surface", {}, kFractionRange});
}

}  // namespace

void fields(FieldVisitor& visit, const BakeJson& report) {
    const BakeResult& result = report.result;
    const BakeRequest& request = result.request;
    const BakeOptions& options = result.settings.bake;
    const TriangleMesh& mesh = *result.mesh.mesh;
    const Baked& baked = result.baked;
    std::vector<BakedMapReport> maps;
    for (const ColliderMapReport& map : mapReports(baked.collider, report.info)) {
        maps.push_back({map, baked.report.maps[map.index]});
    }
    colliderFields(visit, baked.collider, report.info, maps, result.animated ? &*result.animated : nullptr);
    const auto settings = [&](FieldVisitor& visit_setting) {
        const MapSource source = result.settings.source;
        std::vector<std::string> specs;
        for (const MapReport& map : baked.report.maps) {
            specs.push_back(toString(map.spec));
        }
        visit_setting("mesh", request.mesh, {"Mesh, as on the command line"});
        visit_setting("output", report.output, {"--output, as on the command line"});
        visit_setting("maps", specs, {"Baked maps, in the syntax of --map"});
        visit_setting("resolution",
                      onlyIf(source == MapSource::kMaps || source == MapSource::kPaper, options.resolution),
                      {"--resolution; null where it has no effect", "texels"});
        visit_setting("budget", result.patches ? result.patches->budget : std::nullopt,
                      {"Budget of the patches; null for named maps, and for --texel without --budget",
                       "bytes of texels"});
        visit_setting("texel", request.texel,
                      {"--texel; null without it", "object units", {0.0, 1e15, false}});
        visit_setting("quality", options.quality, {"--quality"});
        visit_setting("prefer", options.prefer, {"--prefer"});
        visit_setting("threads", result.threads(), {"Worker threads", {}, kFromOne});
        visit_setting("compress", report.compress, {"zstd level; 0: none", {}, {0.0, 19.0}});
        visit_setting("holes", request.holes, {"--holes"});
        visit_setting("animated", request.animated, {"--animated"});
        visit_setting("clips", request.clips, {"Values of --clips, in order"});
    };
    visit("settings", group(settings), {"Effective options"});
    visit("patches", result.patches,
          {"Patches limited by a budget, a texel or an error; null for named maps"});
    visit("shape", shapesIfAny(result.shape), {"Treatment of the parts of the mesh; null with --holes keep"});
    visit("wrong_percent", result.wrong ? std::optional(result.wrong->total()) : std::nullopt,
          {"Points, out of 4000 near the surface, that are on the wrong side; null for named maps and with "
           "--no-check",
           "%", kPercentRange});
    visit("verdict", result.verdict(), {"Summary; null if the bake was not measured"});
    visit("parts",
          result.part_accuracy
              ? std::optional(PartsReport{*result.part_accuracy, result.parts, baked.collider})
              : std::nullopt,
          {"Accuracy of each part of the mesh relative to its size; null if the bake was not measured or the "
           "mesh has one part"});
    visit("closed_holes", mesh.closed_holes, {"Holes of the mesh that were closed"});
    visit("cap_triangles", mesh.cap_triangles,
          {"Triangles added to close holes, for the rims of shells, and for the ground below terrains"});
    visit("dropped_triangles", mesh.dropped_triangles, {"Triangles without area, which were dropped"});
    visit("unused_vertices", result.unused_vertices, {"Vertices of the mesh file that no triangle uses"});
    const auto times = [&](FieldVisitor& visit_time) {
        const BakeReport& stages = baked.report;
        const BakeTimes& all = result.times;
        const auto ms = [&](const char* name, double value, const char* help) {
            visit_time(name, value, {help, "ms", kFromZero});
        };
        ms("import", all.import_ms, "Import of the mesh");
        ms("search", all.search_ms, "Search for the smallest budget");
        ms("build", stages.build_ms, "Acceleration structure");
        ms("trace", stages.trace_ms, "Rays");
        ms("encode", stages.encode_ms, "Texels");
        ms("fit", stages.fit_ms, "Planes and patches");
        ms("check", all.check_ms, "Measurement of the result");
        ms("write", all.write_ms, "Writing");
        ms("total", all.total_ms, "The whole bake");
    };
    visit("times_ms", group(times), {"Wall-clock times"});
    fields(visit, result.mesh.report);
    visit("warnings", baked.report.warnings, {"Warnings, one line each"});
    // A mesh that was not read from a file has no inputs. The schema requires inputs; it is made from a report without maps.
    if (!result.inputs.empty() || baked.collider.maps.empty()) {
        visit("inputs", result.inputs,
              {.help = "All files that were read, the mesh first", .items = kFromOne});
    }
}

}  // namespace relief
