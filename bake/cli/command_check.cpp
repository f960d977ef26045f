// relief check: whether a container is sound, and how well a collider keeps to its mesh.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "bake/cli/check_advice.h"
#include "bake/cli/check_file.h"
#include "bake/cli/command.h"
#include "bake/cli/import_options.h"
#include "bake/cli/preflight.h"
#include "bake/cli/recorded_bake.h"
#include "bake/measure/accuracy.h"
#include "bake/measure/worst_places.h"
#include "bake/repair/mesh_care.h"
#include "bake/repair/winding.h"
#include "bake/report/accuracy_page.h"
#include "bake/report/accuracy_report.h"
#include "bake/report/places_report.h"
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

/// The truth of a mesh, and how far the collider is from it.
struct Measured {
    TruthSamples samples;
    ColliderAccuracy accuracy;
};

/// A check against a mesh, and what its stages leave for the next.
struct CheckRun {
    Collider collider;
    PreparedMesh imported{TriangleMesh()};  ///< wound outwards
    /// The solid that stands for it: where solids overlap, their winding decides what is inside.
    PreparedMesh mesh{TriangleMesh()};
    ShapeReport shape;
    RecordedBake recorded;
    PreparedMesh baked{TriangleMesh()};  ///< the same of the repaired mesh; `mesh` without a repair
    bool same_file = false;
    std::vector<std::string> warnings;
    bool watertight = false;
    Measured original;
    std::optional<Measured> repaired;  ///< if the collider is of a repaired mesh
    std::vector<WorstPlace> places;
    std::vector<Advice> advice;
    bool passed = true;

    /// Against the mesh that was baked.
    [[nodiscard]] const Measured& judged() const { return repaired ? *repaired : original; }
    [[nodiscard]] double wrongPercent() const { return judged().accuracy.field.near.total(); }
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

/// The mesh, with the names that the collider was baked by.
Result<TriangleMesh> importFor(const RecordedBake& recorded, const CheckCommand& command) {
    ImportOptions options = command.import.options;
    options.names = recorded.shape.names();
    Result<TriangleMesh> mesh = importMeshInWorker(command.mesh, options, command.import.limits);
    if (!mesh && mesh.error().code == ErrorCode::kUsage && !options.names.empty()) {
        return invalidInput(
            mesh.error().message +
            "; the collider was baked by that name: give --mesh the mesh that it was baked from");
    }
    return mesh;
}

Result<void> readInputs(const CheckCommand& command, CheckRun& run) {
    run.collider = RELIEF_TRY(loadCollider(command.file));
    run.recorded = recordedBake(run.collider.provenance.options);
    TriangleMesh imported = RELIEF_TRY(importFor(run.recorded, command));
    Winding winding = RELIEF_TRY(windOutwards(std::move(imported)));
    run.imported = std::move(winding.mesh);
    ShapedMesh shaped = RELIEF_TRY(shapedMesh(run.recorded, run.imported));
    run.mesh = std::move(shaped.mesh);
    run.shape = std::move(shaped.report);
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
    return {};
}

/// The mesh as it was baked, or as it came if the repair cannot be made again.
void makeBakedMesh(CheckRun& run) {
    run.baked = run.mesh;
    if (run.recorded.repair.empty()) {
        return;
    }
    std::string reason = "it is not the same file";
    if (run.same_file) {
        Result<ShapedMesh> baked = repairedMesh(run.recorded, run.imported);
        if (baked) {
            run.baked = std::move(baked->mesh);
            run.shape = std::move(baked->report);
            return;
        }
        reason = baked.error().message;
    }
    run.warnings.push_back("the collider is of a mesh repaired by " + run.recorded.repair +
                           ", which is not made again (" + reason + "); all is measured against " +
                           run.mesh->name + " as it came");
}

/// Where the collider is wrong most, and what to do about it.
void lookCloser(const CheckCommand& command, const MeshQuery& query, CheckRun& run) {
    const Sights sights(run.collider.maps, query);
    run.places = worstPlaces(run.judged().samples, query, sights, run.collider);
    if (run.passed && run.wrongPercent() <= kGoodPercent) {
        return;
    }
    const std::string output = command.file == "-" ? "out.relief" : command.file;
    run.advice = adviceFor({command.mesh, output, run.collider, run.recorded, run.imported, run.baked,
                            run.shape, query, run.judged().samples, run.places, run.wrongPercent()});
}

/// Measures, and writes the page that --html asks for.
Result<void> measure(const CheckCommand& command, CheckRun& run) {
    makeBakedMesh(run);
    for (const std::string& warning : run.warnings) {
        spdlog::warn(warning);
    }
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(run.mesh));
    const MeshQuery baked = RELIEF_TRY(MeshQuery::build(run.baked));
    AccuracyOptions options;
    options.samples = static_cast<std::uint32_t>(command.samples);
    options.seed = command.seed;
    run.watertight = query.watertight();
    run.original.samples = sampleTruth(query, options);
    run.original.accuracy = measureCollider(run.original.samples, query, run.collider);
    const bool is_repaired = run.baked->triangles != run.mesh->triangles;
    if (is_repaired) {
        run.repaired = Measured{sampleTruth(baked, options), {}};
        run.repaired->accuracy = measureCollider(run.repaired->samples, baked, run.collider);
    }
    spdlog::debug("truth {:.2f} s, field {:.2f} s", run.original.samples.seconds,
                  run.original.accuracy.field.seconds);
    run.passed = !command.max_error || run.original.accuracy.field.near.total() <= double{*command.max_error};
    const MeshQuery& judged = is_repaired ? baked : query;
    lookCloser(command, judged, run);
    if (command.html.empty()) {
        return {};
    }
    const std::string page =
        RELIEF_TRY(accuracyPage({inputName(command.file), run.collider, judged, run.judged().samples,
                                 run.judged().accuracy, run.places, run.advice}));
    return writeFile(command.html, std::as_bytes(std::span(page)));
}

nlohmann::ordered_json jsonRepaired(const CheckRun& run) {
    if (!run.repaired) {
        return nullptr;
    }
    return {{"repair", run.recorded.repair},
            {"triangles", run.baked->triangles.size()},
            {"accuracy", jsonColliderAccuracy(run.repaired->accuracy, run.repaired->samples.longest_side)}};
}

nlohmann::ordered_json jsonCheck(const CheckCommand& command, const CheckRun& run) {
    const auto& [samples, accuracy] = run.original;
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
        {"verdict", {{"wrong_percent", run.wrongPercent()}, {"grade", gradeOf(run.wrongPercent())}}},
        {"worst_places", jsonPlaces(run.places, run.collider)},
        {"advice", jsonAdvice(run.advice)},
        {"sampling", jsonSamples(samples)},
        {"accuracy", jsonColliderAccuracy(accuracy, samples.longest_side)},
        {"repaired", jsonRepaired(run)},
        {"max_error_percent", nullptr},
        {"passed", run.passed},
        {"warnings", run.warnings},
        {"times_ms", {{"truth", 1000.0 * samples.seconds}, {"field", 1000.0 * accuracy.field.seconds}}}};
    if (command.max_error) {
        json["max_error_percent"] = jsonNumber(*command.max_error);
    }
    return json;
}

std::string checkText(const CheckCommand& command, const CheckRun& run) {
    const auto& [samples, accuracy] = run.judged();
    std::string text = inputName(command.file) + ": " + verdictText(run.wrongPercent()) + "\n";
    if (run.repaired) {
        text += "That is against the mesh repaired by " + run.recorded.repair + ", " +
                std::to_string(run.baked->triangles.size()) + " triangles; against " + run.mesh->name +
                " as it came: " + shortNumber(run.original.accuracy.field.near.total()) + " %\n";
    }
    for (const std::string& part :
         {placesText(run.places, run.collider), adviceText(run.advice, run.wrongPercent())}) {
        text += part.empty() ? "" : "\n" + part;
    }
    return text + "\nMeasured against " + run.mesh->name + (run.repaired ? " repaired, " : ", ") +
           std::to_string((run.repaired ? run.baked : run.mesh)->sourceTriangles()) + " triangles" +
           (run.watertight || run.repaired ? "" : " (not closed)") + "\n" +
           shapeText(run.shape, run.collider.unit) + "\n" +
           accuracyText(accuracy, samples, run.collider.unit);
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
        return fail(ErrorCode::kDifference, shortNumber(run.original.accuracy.field.near.total()) +
                                                " % of the points near the surface are on the wrong side" +
                                                (run.repaired ? " of the mesh as it came" : "") +
                                                ", more than --max-error " + shortest(*command.max_error) +
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
        "file by its code (formats/README.md), and what of a damaged file can be trusted.\nWith --mesh: a "
        "verdict, the three worst places and why they are wrong, commands that help, each tried in memory\n"
        "before it is advised; and the share of points on the wrong side, near the surface and anywhere in "
        "the box,\nthe errors of distance and normal, and the share of the surface that no map sees. Truth "
        "is the parity of\nrays through the mesh, whatever the maps say; of a collider that was baked with "
        "--repair, the repaired mesh too.",
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
