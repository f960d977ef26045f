// SPDX-License-Identifier: Apache-2.0
#include "bake/pipeline/bake_json.h"

namespace relief {

void fields(FieldVisitor& visit, const BakeJson& report) {
    const BakeResult& result = report.result;
    const BakeRequest& request = result.request;
    const BakeOptions& options = result.settings.bake;
    const TriangleMesh& mesh = *result.mesh.mesh;
    const Baked& baked = result.baked;
    fields(visit, report.collider());
    const auto settings = [&](FieldVisitor& visit_setting) {
        const MapSource source = result.settings.source;
        std::vector<std::string> maps;
        for (const MapReport& map : baked.report.maps) {
            maps.push_back(toString(map.spec));
        }
        visit_setting("mesh", request.mesh, {"Mesh as given"});
        visit_setting("output", report.output, {"--output as given"});
        visit_setting("maps", maps, {"Baked maps, as --map takes them"});
        visit_setting("resolution",
                      onlyIf(source == MapSource::kMaps || source == MapSource::kPaper, options.resolution),
                      {"--resolution; null where it has no effect", "texels"});
        visit_setting("budget", result.patches ? result.patches->budget : std::nullopt,
                      {"Budget of the patches; null of named maps, and of --texel without --budget",
                       "bytes of texels"});
        visit_setting("texel", request.texel,
                      {"--texel; null without it", "object units", {0.0, 1e15, false}});
        visit_setting("quality", options.quality, {"--quality"});
        visit_setting("prefer", options.prefer, {"--prefer"});
        visit_setting("threads", result.threads(), {"Threads used", {}, kFromOne});
        visit_setting("compress", report.compress, {"zstd level; 0: none", {}, {0.0, 19.0}});
        visit_setting("holes", request.holes, {"--holes"});
        visit_setting("animated", request.animated, {"--animated"});
        visit_setting("clips", request.clips, {"--clips, in their order"});
    };
    visit("settings", group(settings), {"Effective options"});
    visit("patches", result.patches, {"Patches for a budget, a texel or an error; null of named maps"});
    visit("shape", madeShapes(result.shape), {"Treatment of the parts of the mesh; null with --holes keep"});
    visit("wrong_percent", result.wrong ? std::optional(result.wrong->total()) : std::nullopt,
          {"Share of 4000 points near the surface that are on the wrong side; null of named maps and with "
           "--no-check",
           "%", kPercentRange});
    visit("verdict", result.verdict(), {"Summary; null unless the bake measured itself"});
    visit("parts",
          result.part_accuracy
              ? std::optional(PartsReport{*result.part_accuracy, result.parts, baked.collider})
              : std::nullopt,
          {"Each part of the mesh judged by its own size; null if the bake did not measure itself or the "
           "mesh has one "
           "part"});
    visit("closed_holes", mesh.closed_holes, {"Holes of the mesh that were closed"});
    visit("cap_triangles", mesh.cap_triangles,
          {"Triangles added to close holes, for the rims of shells, and for the ground below terrains"});
    visit("dropped_triangles", mesh.dropped_triangles, {"Triangles without area, which were left out"});
    visit("unused_vertices", result.unused_vertices, {"Vertices of the mesh file that no triangle uses"});
    const auto times = [&](FieldVisitor& visit_time) {
        const BakeReport& stages = baked.report;
        const BakeTimes& all = result.times;
        const auto ms = [&](const char* name, double value, const char* help) {
            visit_time(name, value, {help, "ms", kFromZero});
        };
        ms("import", all.import_ms, "Import of the mesh");
        ms("search", all.search_ms, "Search for the least budget");
        ms("build", stages.build_ms, "Acceleration structure");
        ms("trace", stages.trace_ms, "Rays");
        ms("encode", stages.encode_ms, "Texels");
        ms("fit", stages.fit_ms, "Planes and patches");
        ms("check", all.check_ms, "Measuring the result");
        ms("write", all.write_ms, "Writing");
        ms("total", all.total_ms, "The whole bake");
    };
    visit("times_ms", group(times), {"Wall-clock times"});
    fields(visit, result.mesh.report);
    visit("warnings", baked.report.warnings, {"Warnings, one line each"});
    // A wrapped mesh has lost the names of its files. The schema, which is made without maps, requires them.
    if (!result.inputs.empty() || baked.collider.maps.empty()) {
        visit("inputs", result.inputs,
              {.help = "All files that were read, the mesh first", .items = kFromOne});
    }
}

}  // namespace relief
