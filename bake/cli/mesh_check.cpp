#include "bake/cli/mesh_check.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "bake/measure/sight.h"
#include "bake/repair/mesh_care.h"
#include "bake/repair/winding.h"
#include "bake/report/parts_report.h"
#include "formats/base/text.h"
#include "runtime/tool/command_line.h"
#include "runtime/tool/option_values.h"

namespace relief {
namespace {

constexpr std::uint64_t kSamplesMax = 100'000'000;
/// Bounds that differ by more, in units of the longest side, are those of another mesh.
constexpr double kBoundsTolerance = 1e-3;

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

/// The mesh, with the names that the collider was baked by.
Result<TriangleMesh> importFor(const RecordedBake& recorded, const MeshCheckSettings& settings) {
    ImportOptions options = settings.import.options;
    options.names = recorded.shape.names();
    Result<TriangleMesh> mesh = importMeshInWorker(settings.mesh, options, settings.import.limits);
    if (!mesh && mesh.error().code == ErrorCode::kUsage && !options.names.empty()) {
        return invalidInput(
            mesh.error().message +
            "; the collider was baked by that name: give --mesh the mesh that it was baked from");
    }
    return mesh;
}

Result<void> readMesh(const MeshCheckSettings& settings, std::optional<TriangleMesh> given, MeshCheck& run) {
    run.recorded = recordedBake(run.collider.provenance.options);
    if (!given) {
        given = RELIEF_TRY(importFor(run.recorded, settings));
    } else if (!run.recorded.shape.names().empty()) {
        return fail(ErrorCode::kUsage,
                    given->name + ": the collider was baked by names in the mesh's file; give that file");
    }
    Winding winding = RELIEF_TRY(windOutwards(std::move(*given)));
    run.imported = std::move(winding.mesh);
    ShapedMesh shaped = RELIEF_TRY(shapedMesh(run.recorded, run.imported));
    run.mesh = std::move(shaped.mesh);
    run.shape = std::move(shaped.report);
    run.parts = std::move(shaped.parts);
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
void makeBakedMesh(MeshCheck& run) {
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
            run.parts = std::move(baked->parts);
            return;
        }
        reason = baked.error().message;
    }
    run.warnings.push_back("the collider is of a mesh repaired by " + run.recorded.repair +
                           ", which is not made again (" + reason + "); all is measured against " +
                           run.mesh->name + " as it came");
}

Result<void> measure(const MeshCheckSettings& settings, MeshCheck& run) {
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(run.mesh));
    const MeshQuery baked = RELIEF_TRY(MeshQuery::build(run.baked));
    AccuracyOptions options;
    options.samples = static_cast<std::uint32_t>(settings.samples);
    options.seed = settings.seed;
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
    run.query = is_repaired ? baked : query;
    PartOptions part_options;
    part_options.seed = settings.seed;
    part_options.points_all = settings.samples;
    if (settings.detail) {
        part_options.detail = double{*settings.detail};
    }
    run.part_accuracy = measureParts(*run.query, run.parts, fieldOf(run.collider), part_options);
    const Sights sights(run.collider.maps, *run.query);
    run.places = worstPlaces(run.judged().samples, *run.query, sights, run.collider);
    return {};
}

}  // namespace

bool MeshCheck::passes(std::optional<float> max_error) const {
    return !max_error || (original.accuracy.field.near.total() <= double{*max_error} &&
                          part_accuracy.countOf(PartVerdict::kLost) == 0);
}

CLI::Option* addMeshCheckOptions(CLI::App& verb, MeshCheckSettings& settings) {
    CLI::Option* mesh =
        verb.add_option("--mesh", settings.mesh, "The mesh that it was baked from")->option_text("MESH");
    verb.add_option("--samples", settings.samples, "Points of each kind; default 200000")
        ->option_text("N")
        ->transform(wholeNumber(1, std::numeric_limits<std::uint64_t>::max(), "a whole number of at least 1"))
        ->needs(mesh);
    verb.add_option("--seed", settings.seed, "Of the points; default 1")
        ->option_text("S")
        ->transform(wholeNumber())
        ->needs(mesh);
    verb.add_option(
            "--detail", settings.detail,
            "Judge each part of the mesh that is at least so long by itself; default: a thousandth of\n"
            "the longest part, in metres at most 0.1")
        ->option_text("LENGTH")
        ->transform(number(0.0F, 1e15F, "a length of at least 0, in the collider's units"))
        ->needs(mesh);
    return mesh;
}

Result<MeshCheckSettings> meshCheckSettingsOf(std::vector<std::string> options, const std::string& mesh) {
    CLI::App app("", "relief check");
    MeshCheckSettings settings;
    addMeshCheckOptions(app, settings);
    addImportOptions(app, settings.import);
    options.emplace_back("--mesh=MESH");  // which others need
    static_cast<void>(RELIEF_TRY(parseCommandLine(app, std::move(options))));
    settings.mesh = mesh;
    return settings;
}

Result<void> prepareMeshCheck(const MeshCheckSettings& settings) {
    if (settings.samples > kSamplesMax) {
        return fail(ErrorCode::kLimit, "--samples is " + std::to_string(settings.samples) +
                                           "; the limit is " + std::to_string(kSamplesMax));
    }
    return {};
}

Result<MeshCheck> checkAgainstMesh(const MeshCheckSettings& settings, Collider collider,
                                   std::optional<TriangleMesh> given,
                                   const std::function<void()>& checkpoint) {
    MeshCheck run;
    run.collider = std::move(collider);
    RELIEF_TRY(readMesh(settings, std::move(given), run));
    checkpoint();
    makeBakedMesh(run);
    checkpoint();
    for (const std::string& warning : run.warnings) {
        spdlog::warn(warning);
    }
    RELIEF_TRY(measure(settings, run));
    return run;
}

}  // namespace relief
