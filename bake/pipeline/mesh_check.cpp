// SPDX-License-Identifier: Apache-2.0
#include "bake/pipeline/mesh_check.h"

#include <algorithm>
#include <cmath>

#include "bake/import/animated_import.h"
#include "bake/import/mesh_import.h"
#include "bake/measure/sight.h"
#include "bake/pipeline/bake.h"
#include "bake/repair/winding.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::uint64_t kSamplesMax = 100'000'000;
/// Limits of the proof, in time and memory.
constexpr std::uint64_t kBoxesPerSample = 10;
constexpr std::uint64_t kBoxesMax = 5'000'000;
/// Bounds that differ by more than this, in units of the longest side, are those of another mesh.
constexpr double kBoundsTolerance = 1e-3;
/// The offset of a wrap, which enlarges the bounds: see wrapMesh.
constexpr double kWrapOffset = 1.0 / 30.0;
/// A finer wrap takes minutes.
constexpr double kAdvisedAlphaMin = double{0.005F};

Result<void> checkSameMesh(const Collider& collider, const std::string& repair, const TriangleMesh& mesh) {
    const double tolerance = (kBoundsTolerance + kWrapOffset * wrapAlpha(repair).value_or(0.0)) *
                             static_cast<double>(mesh.bounds.longestSide());
    for (int i = 0; i < 3; ++i) {
        // Written so that NaN fails too.
        const bool same =
            std::abs(double{collider.bounds.min[i]} - double{mesh.bounds.min[i]}) <= tolerance &&
            std::abs(double{collider.bounds.max[i]} - double{mesh.bounds.max[i]}) <= tolerance;
        if (!same) {
            return invalidInput(mesh.name + " has bounds " + shortest(mesh.bounds.min) + " to " +
                                shortest(mesh.bounds.max) + ", but the collider baked from " +
                                cleanUtf8(collider.provenance.mesh_name) + " has " +
                                shortest(collider.bounds.min) + " to " + shortest(collider.bounds.max) +
                                "; set --mesh to the mesh that it was baked from");
        }
    }
    return {};
}

/// Imports the mesh with the names and hidden objects that the collider was baked with; the rest pose if it is
/// animated.
Result<TriangleMesh> importFor(const std::vector<std::string>& names, const BakeRequest& recorded,
                               const CheckRequest& request) {
    ImportOptions options = request.import;
    options.hidden = std::max(options.hidden, recorded.import.hidden);
    if (recorded.animated) {
        return RELIEF_TRY(importAnimatedFileInWorker(request.mesh, ImportKind::kAnimated, options,
                                                     request.import_limits))
            .rest;
    }
    options.names = names;
    Result<TriangleMesh> mesh = importMeshInWorker(request.mesh, options, request.import_limits);
    if (!mesh && mesh.error().code == ErrorCode::kUsage && !options.names.empty()) {
        return invalidInput(
            mesh.error().message +
            "; the collider was baked with this name: set --mesh to the mesh that it was baked from");
    }
    return mesh;
}

Result<void> readMesh(const CheckRequest& request, std::optional<TriangleMesh> given, MeshCheck& run) {
    run.recorded = recordedBake(run.collider.provenance.options);
    const BakeRequest& recorded = run.recorded.request;
    const std::vector<std::string> names = RELIEF_TRY(parseShapeOptions(recorded.as)).names();
    if (!given) {
        given = RELIEF_TRY(importFor(names, recorded, request));
    } else if (const std::string option = importOptionOf(request.import, request.import_limits);
               !option.empty()) {
        return fail(ErrorCode::kUsage, option + " applies only to a mesh read from a file; remove it");
    } else if (!names.empty()) {
        return fail(
            ErrorCode::kUsage,
            given->name + ": the collider was baked with names from the mesh file; check against that file");
    }
    Winding winding = RELIEF_TRY(windOutwards(std::move(*given)));
    run.imported = std::move(winding.mesh);
    ShapedMesh shaped = RELIEF_TRY(recordedSolid(recorded, run.imported));
    run.mesh = std::move(shaped.mesh);
    run.shape = std::move(shaped.report);
    run.parts = std::move(shaped.parts);
    RELIEF_TRY(checkSameMesh(run.collider, recorded.repair.method, *run.mesh));
    const Provenance& from = run.collider.provenance;
    run.same_file = from.mesh_hash == run.mesh->content_hash;
    run.warnings = run.mesh->warnings;
    if (const std::optional<std::string> warning = coarseFloatsWarning(*run.mesh)) {
        run.warnings.push_back(*warning);
    }
    if (!run.same_file) {
        run.warnings.push_back(run.mesh->name + " is not the file that the collider was baked from (" +
                               cleanUtf8(from.mesh_name) + ", XXH3-128 " +
                               (from.mesh_hash.empty() ? "unknown" : from.mesh_hash) +
                               "); its bounds are the same");
    }
    return {};
}

/// Makes the mesh that was baked, or uses the imported one if the repair cannot be repeated.
void makeBakedMesh(MeshCheck& run) {
    run.baked = run.mesh;
    const std::string& repair = run.recorded.request.repair.method;
    if (repair.empty()) {
        return;
    }
    std::string reason = "the file differs";
    if (run.same_file) {
        Result<ShapedMesh> baked = repairedSolid(run.recorded.request, run.imported);
        if (baked) {
            run.baked = std::move(baked->mesh);
            run.shape = std::move(baked->report);
            run.parts = std::move(baked->parts);
            return;
        }
        reason = baked.error().message;
    }
    run.warnings.push_back("the collider was baked from a mesh repaired by " + repair +
                           ", and the repair was not repeated (" + reason + "); measured against " +
                           run.mesh->name + " as imported");
}

Result<void> measure(const CheckRequest& request, MeshCheck& run) {
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(run.mesh));
    const MeshQuery baked = RELIEF_TRY(MeshQuery::build(run.baked));
    AccuracyOptions options;
    options.samples = static_cast<std::uint32_t>(request.samples);
    options.seed = request.seed;
    run.watertight = query.watertight();
    run.original.samples = sampleTruth(query, options);
    run.original.accuracy = measureCollider(run.original.samples, query, run.collider);
    const bool is_repaired = run.baked->triangles != run.mesh->triangles;
    if (is_repaired) {
        run.repaired = Measured{sampleTruth(baked, options), {}};
        run.repaired->accuracy = measureCollider(run.repaired->samples, baked, run.collider);
    }
    run.query = is_repaired ? baked : query;
    PartOptions part_options;
    part_options.seed = request.seed;
    part_options.points_all = request.samples;
    if (request.min_part) {
        part_options.min_part = double{*request.min_part};
    }
    run.part_accuracy = measureParts(*run.query, run.parts, fieldOf(run.collider), part_options);
    const Sights sights(run.collider.maps, *run.query);
    run.places = worstPlaces(run.judged().samples, *run.query, sights, run.collider);
    run.proof = proveDepth(*run.query, run.collider,
                           {.boxes_max = std::min(kBoxesPerSample * request.samples, kBoxesMax)});
    return {};
}

}  // namespace

Result<ShapedMesh> recordedSolid(BakeRequest recorded, const PreparedMesh& mesh) {
    recorded.budget.reset();
    recorded.voids = voidsOf(recorded);
    return makeSolid(recorded, mesh);
}

bool MeshCheck::passes(std::optional<float> max_error) const {
    return !max_error || (original.accuracy.field.near.total() <= double{*max_error} &&
                          part_accuracy.countOf(PartVerdict::kLost) == 0);
}

Result<ShapedMesh> repairedSolid(const BakeRequest& recorded, const PreparedMesh& mesh) {
    const double alpha = RELIEF_TRY(wrapAlpha(recorded.repair.method));
    if (alpha > 0.0 && alpha < kAdvisedAlphaMin) {
        return fail(ErrorCode::kUnsupported, "--repair " + recorded.repair.method + " takes too long");
    }
    RepairOptions options = recorded.repair;
    options.examine = false;
    const RepairedMesh repaired = RELIEF_TRY(repairMesh(mesh, options));
    return recordedSolid(recorded, repaired.mesh);
}

Result<MeshCheck> check(const CheckRequest& request, Collider collider, std::optional<TriangleMesh> given,
                        const std::function<void()>& checkpoint) {
    if (request.samples > kSamplesMax) {
        return fail(ErrorCode::kLimit, "--samples is " + std::to_string(request.samples) + "; the limit is " +
                                           std::to_string(kSamplesMax));
    }
    MeshCheck run;
    run.collider = std::move(collider);
    RELIEF_TRY(readMesh(request, std::move(given), run));
    checkpoint();
    makeBakedMesh(run);
    checkpoint();
    RELIEF_TRY(measure(request, run));
    return run;
}

void measurementFields(FieldVisitor& visit, CheckRequest& request) {
    visit("samples", request.samples,
          {.help = "Number of sample points near the surface, and as many in the whole box",
           .range = {1.0},
           .must = "a whole number of at least 1"});
    visit("seed", request.seed, {.help = "Seed of the sample points", .value = "S"});
    visit("min_part", request.min_part,
          {.help = "Shortest lost part of the mesh that lowers the grade, in object units",
           .unit = "object units",
           .range = {0.0, double{1e15F}},
           .fallback = "1/100 of the mesh's diagonal, at most 0.1 m",
           .value = "LENGTH",
           .must = "a length of at least 0 in object units; if these are metres, mm, cm or m may follow the "
                   "number"});
}

void fields(FieldVisitor& visit, CheckRequest& request) {
    measurementFields(visit, request);
    fields(visit, request.import);
    fields(visit, request.import_limits);
}

}  // namespace relief
