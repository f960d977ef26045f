// SPDX-License-Identifier: Apache-2.0
#include "bake/report/mesh_check_report.h"

namespace relief {

Verdict MeshCheckReport::verdict() const {
    const double wrong = run.original.accuracy.field.near.total();
    const bool within = max_error && wrong <= double{*max_error};
    Verdict verdict = verdictOf(run.wrongPercent(), run.part_accuracy, run.collider.unit);
    if (max_error && (!within || run.passes(max_error))) {
        const std::string ignored = ignoredText(run.part_accuracy.ignored, run.collider.unit);
        verdict.text = percentText(wrong) + " wrong near the surface" +
                       (run.repaired ? " of the imported mesh" : "") + ": " + (within ? "within" : "above") +
                       " --max-error " + percentText(double{*max_error}) +
                       (ignored.empty() ? "" : "; " + ignored);
    }
    return verdict;
}

void fields(FieldVisitor& visit, const MeshCheckReport& report) {
    const MeshCheck& run = report.run;
    const TruthSamples& samples = run.original.samples;
    const ColliderAccuracy& accuracy = run.original.accuracy;
    visit("file", report.file, {"Name of the container without its folder, or standard input"});
    const auto mesh = [&](FieldVisitor& visit_mesh) {
        visit_mesh("name", run.mesh->name, {"File name"});
        visit_mesh("hash", run.mesh->content_hash, {.help = "XXH3-128 of the file", .pattern = kHashPattern});
        visit_mesh("triangles", run.mesh->sourceTriangles(), {"Triangles of the mesh"});
        visit_mesh("closed", run.watertight, {"Whether the mesh is closed"});
        visit_mesh("shape", shapesIfAny(run.shape),
                   {"Treatment of the parts of the mesh; null if it was baked with --holes keep"});
        visit_mesh("is_source", run.same_file, {"Whether the collider was baked from exactly this file"});
    };
    visit("mesh", group(mesh), {"Mesh that the collider is measured against"});
    visit("unit", run.collider.unit, {"Unit of lengths; may be empty"});
    const auto verdict = [&](FieldVisitor& visit_verdict) {
        visit_verdict(
            "wrong_percent", run.wrongPercent(),
            {"Points near the surface that are on the wrong side, against the repaired mesh if there "
             "is one",
             "%", kPercentRange});
        visit_verdict("lost_parts", run.part_accuracy.countOf(PartVerdict::kLost),
                      {"Parts of the mesh with more than 25 % of their points on the wrong side"});
        visit_verdict("ignored_parts", run.part_accuracy.ignored,
                      {"Parts that the grade ignores because they are small"});
        fields(visit_verdict, report.verdict());
        visit_verdict(
            "inside_grade", insideGradeOf(run.judged().accuracy.field.inside),
            {.help =
                 "Votes at points inside: good if the nearest face decides at least 97 % of them; fair: at "
                 "least 90 %; unknown with fewer than 300 points",
             .words = kWords<"good", "fair", "poor", "unknown">});
        visit_verdict("inside_text", insideVerdictText(run.judged().accuracy.field.inside),
                      {"The grade in words; empty if it is good or unknown"});
    };
    visit("verdict", group(verdict), {"Summary"});
    visit("parts", PartsReport{run.part_accuracy, run.parts, run.collider},
          {"Accuracy of each part of the mesh relative to its size"});
    visit("worst_places", viewsOf<WorstPlaceReport>(run.places, run.collider),
          {.help = "At most three places, the worst first", .items = {0.0, 3.0}});
    visit("depth_proof", DepthProofReport{run.proof, run.judged().samples.longest_side},
          {"Proven bound on the depth of errors against the baked mesh"});
    visit("advice", run.advice, {"Commands to try; empty if the verdict is good and --max-error is met"});
    visit("sampling", samples, {"Points of the measurement"});
    visit("accuracy", ColliderAccuracyReport{accuracy, samples.longest_side},
          {"Accuracy against the mesh as imported"});
    const auto repaired = [&](FieldVisitor& visit_repaired) {
        const Measured& measured = run.repaired ? *run.repaired : run.original;
        visit_repaired("repair", run.recorded.request.repair.method, {"--repair of the bake"});
        visit_repaired("triangles", run.baked->triangles.size(), {"Triangles of the repaired mesh"});
        visit_repaired("accuracy", ColliderAccuracyReport{measured.accuracy, measured.samples.longest_side},
                       {"Accuracy against the repaired mesh"});
    };
    visit("repaired", groupIf(run.repaired.has_value(), repaired),
          {"Comparison with the mesh that --repair made; null without a repair"});
    visit("max_error_percent", report.max_error, {"--max-error; null without it", "%", kFromZero});
    visit("passed", run.passes(report.max_error),
          {"Whether --max-error is met and no part is lost; true without --max-error"});
    visit("warnings", run.warnings, {"Warnings, one line each"});
    const auto times = [&](FieldVisitor& visit_time) {
        visit_time("truth", 1000.0 * samples.seconds,
                   {"Evaluation of the mesh at the points", "ms", kFromZero});
        visit_time("field", 1000.0 * accuracy.field.seconds,
                   {"Evaluation of the collider at the points", "ms", kFromZero});
    };
    visit("times_ms", group(times), {"Wall-clock times"});
}

}  // namespace relief
