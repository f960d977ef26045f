// relief check: whether a container is sound, and how well a collider keeps to its mesh.
#include <spdlog/spdlog.h>

#include <cmath>
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
#include "bake/report/report.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/container.h"

namespace relief {
namespace {

constexpr std::uint64_t kSamplesMax = 100'000'000;
/// Bounds that differ by more, in units of the longest side, are those of another mesh.
constexpr double kBoundsTolerance = 1e-3;

struct CheckCommand {
    CommonOptions common;
    std::string file;
    std::string mesh;
    std::string samples = "200000";
    std::string seed = "1";
    std::string max_error;
    std::string html;
    ImportArguments import;
    bool json = false;
};

struct Settings {
    AccuracyOptions accuracy;
    std::optional<float> max_error;  // percent
};

Result<Settings> settingsOf(const CheckCommand& command) {
    Settings settings;
    const std::uint64_t samples = RELIEF_TRY(parseCount(command.samples, "--samples"));
    if (samples < 1) {
        return fail(ErrorCode::kUsage, "--samples is 0 but must be at least 1");
    }
    if (samples > kSamplesMax) {
        return fail(ErrorCode::kLimit, "--samples is " + std::to_string(samples) + "; the limit is " +
                                           std::to_string(kSamplesMax));
    }
    settings.accuracy.samples = static_cast<std::uint32_t>(samples);
    const std::uint64_t seed = RELIEF_TRY(parseCount(command.seed, "--seed"));
    settings.accuracy.seed = seed;
    if (!command.max_error.empty()) {
        const float percent = RELIEF_TRY(parsePercent(command.max_error, "--max-error"));
        settings.max_error = percent;
    }
    return settings;
}

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

std::string fileName(const std::string& file) {
    return file == "-" ? "standard input" : cleanUtf8(std::filesystem::path(file).filename().string());
}

Result<void> runCheck(const CheckCommand& command) {
    startLogging(command.common);
    if (command.mesh.empty()) {
        return checkFile(command.file, command.json);
    }
    const Settings settings = RELIEF_TRY(settingsOf(command));
    RELIEF_TRY(checkImportArguments(command.import));
    if (!command.html.empty()) {
        if (command.html == "-") {
            return fail(ErrorCode::kUsage, "--html cannot be standard output, where the report goes");
        }
        for (const Result<void>& ready :
             {preflightFile(command.html), preflightDistinct(command.file, command.html),
              preflightDistinct(command.mesh, command.html)}) {
            if (!ready) {
                return ready;
            }
        }
    }
    const Collider collider = RELIEF_TRY(loadCollider(command.file));
    TriangleMesh imported = RELIEF_TRY(importByArguments(command.mesh, command.import));
    // As baked: where solids overlap, their winding decides what is inside.
    const Winding winding = RELIEF_TRY(windOutwards(std::move(imported)));
    const PreparedMesh& mesh = winding.mesh;
    RELIEF_TRY(checkSameMesh(collider, *mesh));
    const bool same_file = collider.provenance.mesh_hash == mesh->content_hash;
    std::vector<std::string> warnings = mesh->warnings;
    if (!same_file) {
        warnings.push_back(
            mesh->name + " is not the file that the collider was baked from (" +
            collider.provenance.mesh_name + ", XXH3-128 " +
            (collider.provenance.mesh_hash.empty() ? "unknown" : collider.provenance.mesh_hash) +
            "); its bounds are the same");
    }
    for (const std::string& warning : warnings) {
        spdlog::warn(warning);
    }
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
    const TruthSamples samples = sampleTruth(query, settings.accuracy);
    const ColliderAccuracy accuracy = measureCollider(samples, query, collider);
    spdlog::debug("truth {:.2f} s, field {:.2f} s", samples.seconds, accuracy.field.seconds);

    if (!command.html.empty()) {
        const std::string page =
            RELIEF_TRY(accuracyPage({fileName(command.file), collider, query, samples, accuracy}));
        RELIEF_TRY(writeFile(command.html, std::as_bytes(std::span(page))));
    }
    const bool passed = !settings.max_error || accuracy.field.near.total() <= double{*settings.max_error};
    std::string text;
    if (command.json) {
        nlohmann::ordered_json json = {
            {"file", fileName(command.file)},
            {"mesh",
             {{"name", mesh->name},
              {"hash", mesh->content_hash},
              {"triangles", mesh->triangles.size()},
              {"watertight", query.watertight()},
              {"baked_from_it", same_file}}},
            {"unit", collider.unit},
            {"sampling", jsonSamples(samples)},
            {"accuracy", jsonColliderAccuracy(accuracy, samples.longest_side)},
            {"max_error_percent", nullptr},
            {"passed", passed},
            {"warnings", warnings},
            {"times_ms", {{"truth", 1000.0 * samples.seconds}, {"field", 1000.0 * accuracy.field.seconds}}}};
        if (settings.max_error) {
            json["max_error_percent"] = jsonNumber(*settings.max_error);
        }
        text = dump(json);
    } else {
        text = fileName(command.file) + " measured against " + mesh->name + ", " +
               std::to_string(mesh->triangles.size()) + " triangles" +
               (query.watertight() ? "" : " (not closed)") + "\n\n" +
               accuracyText(accuracy, samples, collider.unit);
    }
    RELIEF_TRY(printOut(text));
    if (!passed) {
        return fail(ErrorCode::kDifference, shortNumber(accuracy.field.near.total()) +
                                                " % of the points near the surface are on the wrong side, "
                                                "more than --max-error " +
                                                shortest(*settings.max_error) +
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
        ->needs(mesh);
    verb.add_option("--seed", command->seed, "Of the points; default 1")->option_text("S")->needs(mesh);
    verb.add_option("--max-error", command->max_error,
                    "Exit with 7 if more than this share of the points near the surface, in percent, is on "
                    "the wrong side")
        ->option_text("PCT")
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
