// relief check: whether a container is sound, and how well a collider keeps to its mesh.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "bake/cli/check_file.h"
#include "bake/cli/command.h"
#include "bake/cli/import_options.h"
#include "bake/cli/preflight.h"
#include "bake/measure/accuracy.h"
#include "bake/repair/mesh_care.h"
#include "bake/repair/winding.h"
#include "bake/report/accuracy_page.h"
#include "bake/report/accuracy_report.h"
#include "bake/report/shape_report.h"
#include "bake/shape/shape.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "runtime/tool/command_line.h"
#include "runtime/tool/json_text.h"
#include "runtime/tool/option_values.h"

namespace relief {
namespace {

constexpr std::uint64_t kSamplesMax = 100'000'000;
/// Bounds that differ by more, in units of the longest side, are those of another mesh.
constexpr double kBoundsTolerance = 1e-3;

struct CheckCommand {
    CommonOptions common;
    std::string file;
    std::string mesh;
    std::uint64_t samples = 200'000;
    std::uint64_t seed = 1;
    std::optional<float> max_error;  // percent
    std::string html;
    ImportSettings import;
    bool json = false;
};

Result<void> checkSameMesh(const Collider& collider, const TriangleMesh& mesh) {
    const double tolerance = (kBoundsTolerance + repairReach(collider.provenance.options)) *
                             static_cast<double>(mesh.bounds.longestSide());
    for (int i = 0; i < 3; ++i) {
        // Written so that NaN fails too.
        const bool same =
            std::abs(double{collider.bounds.min[i]} - double{mesh.bounds.min[i]}) <= tolerance &&
            std::abs(double{collider.bounds.max[i]} - double{mesh.bounds.max[i]}) <= tolerance;
        if (!same) {
            return fail(ErrorCode::kInvalidInput,
                        mesh.name + " has the bounds " + shortest(mesh.bounds.min) + " to " +
                            shortest(mesh.bounds.max) + " but the collider, of " +
                            collider.provenance.mesh_name + ", has " + shortest(collider.bounds.min) +
                            " to " + shortest(collider.bounds.max) +
                            "; give --mesh the mesh that it was baked from");
        }
    }
    return {};
}

/// A check against a mesh, and what its stages leave for the next.
struct CheckRun {
    Collider collider;
    PreparedMesh mesh{
        TriangleMesh()};  ///< as baked: where solids overlap, their winding decides what is inside
    ShapeReport shape;
    bool same_file = false;
    std::vector<std::string> warnings;
    TruthSamples samples;
    bool watertight = false;
    ColliderAccuracy accuracy;
    bool passed = true;
};

/// Before the long work.
Result<void> prepare(const CheckCommand& command) {
    if (command.samples > kSamplesMax) {
        return fail(ErrorCode::kLimit, "--samples is " + std::to_string(command.samples) + "; the limit is " +
                                           std::to_string(kSamplesMax));
    }
    if (command.html.empty()) {
        return {};
    }
    if (command.html == "-") {
        return fail(ErrorCode::kUsage, "--html cannot be standard output, where the report goes");
    }
    RELIEF_TRY(preflightFile(command.html));
    RELIEF_TRY(preflightDistinct(command.file, command.html));
    return preflightDistinct(command.mesh, command.html);
}

Result<void> readInputs(const CheckCommand& command, CheckRun& run) {
    run.collider = RELIEF_TRY(loadCollider(command.file));
    TriangleMesh imported =
        RELIEF_TRY(importMeshInWorker(command.mesh, command.import.options, command.import.limits));
    Winding winding = RELIEF_TRY(windOutwards(std::move(imported)));
    run.mesh = std::move(winding.mesh);
    const std::string& options = run.collider.provenance.options;
    if (options.find(" --holes keep") == std::string::npos) {
        ShapedMesh shaped = RELIEF_TRY(shapeMesh(
            run.mesh,
            shapeOptionsOf(options, {ShapeAs::kAuto, defaultThickness(run.mesh->bounds, 1'000'000)})));
        run.mesh = std::move(shaped.mesh);
        run.shape = std::move(shaped.report);
    }
    RELIEF_TRY(checkSameMesh(run.collider, *run.mesh));
    const Provenance& from = run.collider.provenance;
    run.same_file = from.mesh_hash == run.mesh->content_hash;
    run.warnings = run.mesh->warnings;
    if (!run.same_file) {
        run.warnings.push_back(run.mesh->name + " is not the file that the collider was baked from (" +
                               from.mesh_name + ", XXH3-128 " +
                               (from.mesh_hash.empty() ? "unknown" : from.mesh_hash) +
                               "); its bounds are the same");
    }
    for (const std::string& warning : run.warnings) {
        spdlog::warn(warning);
    }
    return {};
}

/// Measures, and writes the page that --html asks for.
Result<void> measure(const CheckCommand& command, CheckRun& run) {
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(run.mesh));
    AccuracyOptions options;
    options.samples = static_cast<std::uint32_t>(command.samples);
    options.seed = command.seed;
    run.samples = sampleTruth(query, options);
    run.watertight = query.watertight();
    run.accuracy = measureCollider(run.samples, query, run.collider);
    spdlog::debug("truth {:.2f} s, field {:.2f} s", run.samples.seconds, run.accuracy.field.seconds);
    run.passed = !command.max_error || run.accuracy.field.near.total() <= double{*command.max_error};
    if (command.html.empty()) {
        return {};
    }
    const std::string page =
        RELIEF_TRY(accuracyPage({inputName(command.file), run.collider, query, run.samples, run.accuracy}));
    return writeFile(command.html, std::as_bytes(std::span(page)));
}

nlohmann::ordered_json jsonCheck(const CheckCommand& command, const CheckRun& run) {
    nlohmann::ordered_json json = {
        {"file", inputName(command.file)},
        {"mesh",
         {{"name", run.mesh->name},
          {"hash", run.mesh->content_hash},
          {"triangles", run.mesh->sourceTriangles()},
          {"watertight", run.watertight},
          {"shape", jsonShape(run.shape)},
          {"baked_from_it", run.same_file}}},
        {"unit", run.collider.unit},
        {"sampling", jsonSamples(run.samples)},
        {"accuracy", jsonColliderAccuracy(run.accuracy, run.samples.longest_side)},
        {"max_error_percent", nullptr},
        {"passed", run.passed},
        {"warnings", run.warnings},
        {"times_ms",
         {{"truth", 1000.0 * run.samples.seconds}, {"field", 1000.0 * run.accuracy.field.seconds}}}};
    if (command.max_error) {
        json["max_error_percent"] = jsonNumber(*command.max_error);
    }
    return json;
}

std::string checkText(const CheckCommand& command, const CheckRun& run) {
    return inputName(command.file) + " measured against " + run.mesh->name + ", " +
           std::to_string(run.mesh->sourceTriangles()) + " triangles" +
           (run.watertight ? "" : " (not closed)") + "\n" + shapeText(run.shape, run.collider.unit) + "\n" +
           accuracyText(run.accuracy, run.samples, run.collider.unit);
}

Result<void> runCheck(const CheckCommand& command) {
    startLogging(command.common);
    if (command.mesh.empty()) {
        return checkFile(command.file, command.json);
    }
    CheckRun run;
    RELIEF_TRY(prepare(command));
    RELIEF_TRY(readInputs(command, run));
    RELIEF_TRY(measure(command, run));
    RELIEF_TRY(printOut(command.json ? jsonText(jsonCheck(command, run)) : checkText(command, run)));
    if (!run.passed) {
        return fail(ErrorCode::kDifference, shortNumber(run.accuracy.field.near.total()) +
                                                " % of the points near the surface are on the wrong side, "
                                                "more than --max-error " +
                                                shortest(*command.max_error) +
                                                " %; bake with larger or more maps");
    }
    return {};
}

}  // namespace

void addCheck(CLI::App& app, Action& action) {
    auto command = std::make_shared<CheckCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "check",
        "Checks a container, or measures a collider against its mesh\n\nWithout --mesh: every issue of the "
        "file by its code (formats/README.md), and what of a damaged file can be trusted.\nWith --mesh: the "
        "share of points on the wrong side, near the "
        "surface and anywhere in the box, the errors of distance and normal,\nand the share of the "
        "surface that no map sees. Truth is the parity of rays through the mesh, whatever the maps say.",
        "relief check bunny.relief\n"
        "relief check bunny.relief --mesh bunny.obj\n"
        "relief check bunny.relief --mesh bunny.obj --html bunny.html\n"
        "relief check bunny.relief --mesh bunny.obj --max-error 2 --json");
    verb.add_option("FILE", command->file, "The collider; - for standard input")->type_name("")->required();
    CLI::Option* mesh =
        verb.add_option("--mesh", command->mesh, "The mesh that it was baked from")->option_text("MESH");
    verb.add_option("--samples", command->samples, "Points of each kind; default 200000")
        ->option_text("N")
        ->transform(wholeNumber(1, std::numeric_limits<std::uint64_t>::max(), "a whole number of at least 1"))
        ->needs(mesh);
    verb.add_option("--seed", command->seed, "Of the points; default 1")
        ->option_text("S")
        ->transform(wholeNumber())
        ->needs(mesh);
    verb.add_option("--max-error", command->max_error,
                    "Exit with 7 if more than this share of the points near the surface, in percent, is on "
                    "the wrong side")
        ->option_text("PCT")
        ->transform(percent())
        ->needs(mesh);
    verb.add_option("--html", command->html,
                    "Also write a page to look at: numbers, error on the surface, slices and maps")
        ->option_text("OUT")
        ->needs(mesh);
    addImportOptions(verb, command->import);
    verb.add_flag("--json", command->json, "Print JSON");
    verb.callback([command, &action] { action = [command] { return runCheck(*command); }; });
}

}  // namespace relief
