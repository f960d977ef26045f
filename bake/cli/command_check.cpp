// relief check: whether a container is sound, and how well a collider keeps to its mesh.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <span>

#include "bake/cli/check_advice.h"
#include "bake/cli/check_file.h"
#include "bake/cli/command.h"
#include "bake/cli/mesh_check.h"
#include "bake/measure/accuracy.h"
#include "bake/measure/worst_places.h"
#include "bake/report/accuracy_page.h"
#include "bake/report/accuracy_report.h"
#include "bake/report/parts_report.h"
#include "bake/report/places_report.h"
#include "bake/report/shape_report.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "runtime/tool/command_line.h"
#include "runtime/tool/json_text.h"
#include "runtime/tool/memory_option.h"
#include "runtime/tool/option_values.h"

namespace relief {
namespace {

struct CheckCommand {
    CommonOptions common;
    std::string file;
    MeshCheckSettings settings;
    ContainerLimits limits;
    std::optional<float> max_error;  // percent
    std::string html;
    bool json = false;
};

/// The measurement, and what it means for this command.
struct CheckRun : MeshCheck {
    std::vector<Advice> advice;
    bool passed = true;
};

/// Before the long work.
Result<void> prepare(const CheckCommand& command, FileGuard& files) {
    RELIEF_TRY(prepareMeshCheck(command.settings));
    if (command.html.empty()) {
        return {};
    }
    if (command.html == "-") {
        return fail(ErrorCode::kUsage, "--html cannot be standard output, where the report goes");
    }
    RELIEF_TRY(files.reads(command.file));
    RELIEF_TRY(files.reads(command.settings.mesh));
    return files.writes(command.html, "--html");
}

/// What to do about the places.
void addAdvice(const CheckCommand& command, CheckRun& run) {
    run.passed =
        !command.max_error || (run.original.accuracy.field.near.total() <= double{*command.max_error} &&
                               run.part_accuracy.countOf(PartVerdict::kLost) == 0);
    if (run.passed && run.wrongPercent() <= kGoodPercent) {
        return;
    }
    const std::string output = command.file == "-" ? "out.relief" : command.file;
    run.advice =
        adviceFor({command.settings.mesh, output, run.collider, run.recorded, run.imported, run.baked,
                   run.shape, *run.query, run.judged().samples, run.places, run.wrongPercent()});
}

/// The page that --html asks for.
Result<void> writePage(const CheckCommand& command, const CheckRun& run) {
    if (command.html.empty()) {
        return {};
    }
    const std::string page = RELIEF_TRY(
        accuracyPage({inputName(command.file), run.collider, *run.query, run.judged().samples,
                      run.judged().accuracy, run.parts, run.part_accuracy, run.places, run.advice}));
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
        {"verdict",
         {{"wrong_percent", run.wrongPercent()},
          {"lost_parts", run.part_accuracy.countOf(PartVerdict::kLost)},
          {"grade", gradeOf(run.wrongPercent(), run.part_accuracy)}}},
        {"parts", jsonParts(run.part_accuracy, run.parts, run.collider)},
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
    std::string text =
        inputName(command.file) + ": " + verdictText(run.wrongPercent(), run.part_accuracy) + "\n";
    if (run.repaired) {
        text += "That is against the mesh repaired by " + run.recorded.repair + ", " +
                std::to_string(run.baked->triangles.size()) + " triangles; against " + run.mesh->name +
                " as it came: " + shortNumber(run.original.accuracy.field.near.total()) + " %\n";
    }
    for (const std::string& part :
         {partsText(run.part_accuracy, run.parts, run.collider), placesText(run.places, run.collider),
          adviceText(run.advice, run.wrongPercent())}) {
        text += part.empty() ? "" : "\n" + part;
    }
    return text + "\nMeasured against " + run.mesh->name + (run.repaired ? " repaired, " : ", ") +
           std::to_string((run.repaired ? run.baked : run.mesh)->sourceTriangles()) + " triangles" +
           (run.watertight || run.repaired ? "" : " (not closed)") + "\n" +
           shapeText(run.shape, run.collider.unit) + "\n" +
           accuracyText(accuracy, samples, run.collider.unit);
}

Result<void> runCheck(const CheckCommand& command, FileGuard& files) {
    startLogging(command.common);
    if (command.settings.mesh.empty()) {
        return checkFile(command.file, command.json, command.limits);
    }
    RELIEF_TRY(prepare(command, files));
    Collider collider = RELIEF_TRY(loadCollider(command.file, command.limits));
    CheckRun run{RELIEF_TRY(checkAgainstMesh(command.settings, std::move(collider))), {}};
    // The files that the mesh refers to are known only now.
    for (const std::string& file : run.imported->dependencies) {
        RELIEF_TRY(files.reads(file));
    }
    addAdvice(command, run);
    RELIEF_TRY(writePage(command, run));
    RELIEF_TRY(printOut(command.json ? jsonText(jsonCheck(command, run)) : checkText(command, run)));
    if (!run.passed && run.original.accuracy.field.near.total() <= double{*command.max_error}) {
        return fail(ErrorCode::kDifference, *lostPartsWarning(run.part_accuracy, run.parts, run.collider) +
                                                "; --detail LENGTH leaves smaller ones out");
    }
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
    CLI::Option* mesh = addMeshCheckOptions(verb, command->settings);
    verb.add_option("--max-error", command->max_error,
                    "Exit with 7 if more than this share of the points near the surface, in percent, is on "
                    "the wrong side, or a part is lost")
        ->option_text("PCT")
        ->transform(percent())
        ->needs(mesh);
    verb.add_option("--html", command->html,
                    "Also write a page to look at: numbers, error on the surface, slices and maps")
        ->option_text("OUT")
        ->needs(mesh);
    addImportOptions(verb, command->settings.import);
    addMemoryOption(verb, command->limits);
    verb.add_flag("--json", command->json, "Print JSON");
    verb.callback(
        [command, &action] { action = [command](FileGuard& files) { return runCheck(*command, files); }; });
}

}  // namespace relief
