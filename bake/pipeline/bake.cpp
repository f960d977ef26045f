// SPDX-License-Identifier: Apache-2.0
#include "bake/pipeline/bake.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <set>

#include "bake/materials/material_tree.h"
#include "bake/pipeline/stages.h"
#include "bake/verdict/parts_report.h"
#include "formats/animation/animated_mesh.h"
#include "formats/base/stopwatch.h"

namespace relief {
namespace {

/// An animated mesh keeps its holes: its parts pass through each other as it moves, and are drawn unchanged.
BakeRequest completed(BakeRequest request) {
    request.holes = request.animated ? Holes::kKeep : request.holes;
    return request;
}

/// Validates a request before any mesh is read. \param given  mesh used instead of the file; may be null.
Result<BakeSettings> checkedSettings(const BakeRequest& request, const TriangleMesh* given) {
    BakeSettings settings = RELIEF_TRY(settingsOf(request));
    if (!request.heights.empty()) {
        return fail(ErrorCode::kUsage,
                    "--heights applies only to a height map read from a file; remove --heights");
    }
    const std::string import = importOptionOf(request.import, request.import_limits);
    if (given != nullptr && !import.empty()) {
        return fail(ErrorCode::kUsage, import + " applies only to a mesh read from a file; remove it");
    }
    if (given != nullptr && request.animated) {
        return fail(ErrorCode::kUsage, "--animated applies only to a mesh read from a file; remove it");
    }
    if (given != nullptr && given->marks.empty() && !settings.shape.named.empty()) {
        return fail(ErrorCode::kUsage,
                    "--as NAME=KIND applies only to a mesh read from a file; remove NAME=");
    }
    return settings;
}

/// Limits all threads to --threads, including those of measurements, while the result exists.
std::optional<tbb::global_control> threadLimit(const BakeRequest& request) {
    if (!request.threads) {
        return std::nullopt;
    }
    return std::optional<tbb::global_control>(std::in_place, tbb::global_control::max_allowed_parallelism,
                                              *request.threads);
}

/// Returns the request that makes the same solid again, for recordedBake(). Maps record their own settings.
BakeRequest recordOf(const BakeRequest& request, const BakeSettings& settings, const SolidMesh& solid) {
    BakeRequest record;
    if (request.animated) {
        // `animated` determines the maps, and keeps the holes.
        record.animated = true;
        record.resolution = settings.bake.resolution;
    } else {
        record.holes = request.holes;
    }
    record.import = request.import;
    record.repair.method = solid.mesh.report.repair;
    record.as = asOptionWords(solid.shape);
    record.thickness = thicknessOf(solid.shape);
    record.texel = request.texel;
    record.materials = request.materials;
    record.voids = solid.shape.voids > 0 ? VoidMode::kFill : request.voids;
    return record;
}

/// Completes a collider with everything that a container stores in addition to the maps.
Collider finished(Collider collider, const BakeRequest& request, const BakeSettings& settings,
                  const SolidMesh& solid) {
    std::vector<RecordedOption>& options = collider.provenance.options;
    if (solid.animated) {
        collider.animation = writeAnimatedMesh(*solid.animated);
        for (DepthMap& map : collider.maps) {
            map.encloses = false;  // the mesh may leave the bounds of its rest pose
        }
        std::erase_if(options, [](const RecordedOption& option) { return option.name == "map"; });
    }
    collider.materials = materialsFor(collider, solid.materials.get());
    for (const FieldWords& field : changedFields(recordOf(request, settings, solid))) {
        for (const std::string& word : field.words) {
            options.push_back({field.name, word});
        }
    }
    return collider;
}

/// \param nodes  as in noticesOf().
Result<BakeResult> bakeFrom(const BakeRequest& request, const BakeSettings& settings, SolidMesh prepared,
                            std::size_t nodes, const BakeWatcher& watcher) {
    BakeResult result{std::move(prepared), request, settings, {}, {}, {}, {}, {}, {}, {}};
    const SolidMesh& solid = result;
    const TriangleMesh& mesh = *solid.mesh.mesh;
    result.notices = noticesOf(solid, nodes);
    for (std::size_t i = 0; i < mesh.dependencies.size(); ++i) {
        if (watcher.files != nullptr) {  // no output may replace the files that the mesh references
            RELIEF_TRY(watcher.files->reads(mesh.dependencies[i]));
        }
        result.inputs.push_back({mesh.dependencies[i], mesh.dependency_hashes[i]});
    }
    Result<BakedMaps> maps = bakeMaps(request, settings, solid, watcher);
    if (!maps && maps.error().code != ErrorCode::kUsage) {
        if (const auto stray = outlierText(solid.parts, mesh.unit)) {
            return fail(maps.error().code, mesh.name + ": " + *stray);
        }
    }
    BakedMaps made = RELIEF_TRY(std::move(maps));
    result.imported.reset();  // only --max-error needed it
    made.baked.collider = finished(std::move(made.baked.collider), request, settings, solid);
    std::optional<SelfCheck> check;
    if (made.patches && !request.no_check) {  // named maps may be inaccurate on purpose
        const Stopwatch watch;
        notify(watcher.begin, "measuring the collider");
        check = RELIEF_TRY(selfCheck(solid.mesh.mesh, solid.parts, made.baked.collider));
        result.times.check_ms = watch.ms();
        result.wrong = check->wrong;
        result.part_accuracy = check->parts;
    }
    made.baked.report.warnings = warningsOf(request, solid, made.baked, check ? &*check : nullptr);
    result.times.search_ms = made.search_ms;
    result.baked = std::move(made.baked);
    result.patches = std::move(made.patches);
    return result;
}

}  // namespace

std::optional<Verdict> BakeResult::verdict() const {
    return wrong ? std::optional(
                       verdictOf(wrong->total(), part_accuracy.value_or(PartsAccuracy{}), mesh.mesh->unit))
                 : std::nullopt;
}

int BakeResult::threads() const {
    return request.threads ? static_cast<int>(*request.threads) : tbb::info::default_concurrency();
}

Result<BakeResult> bake(const BakeRequest& request, const BakeWatcher& watcher,
                        std::optional<TriangleMesh> mesh) {
    notify(watcher.begin, "reading its options");
    const BakeSettings settings = RELIEF_TRY(checkedSettings(request, mesh ? &*mesh : nullptr));
    const BakeRequest whole = completed(request);
    const auto threads = threadLimit(whole);
    const Stopwatch watch;
    notify(watcher.begin, "reading the mesh");
    SourceMesh source = mesh ? SourceMesh{std::move(*mesh)} : RELIEF_TRY(importSource(whole, settings));
    std::set<std::uint32_t> nodes;
    for (const SurfaceName& name : source.mesh.surface_names) {
        nodes.insert(name.node_index);
    }
    const double import_ms = watch.ms();
    if (watcher.imported) {
        watcher.imported(source.mesh);
    }
    SolidMesh solid = RELIEF_TRY(solidOf(whole, std::move(source), watcher));
    BakeResult result = RELIEF_TRY(bakeFrom(whole, settings, std::move(solid), nodes.size(), watcher));
    result.times.import_ms = import_ms;
    return result;
}

Result<BakeResult> bake(const BakeRequest& request, const SolidMesh& solid) {
    const BakeSettings settings = RELIEF_TRY(checkedSettings(request, nullptr));
    const BakeRequest whole = completed(request);
    const auto threads = threadLimit(whole);
    return bakeFrom(whole, settings, solid, 0, {});
}

Result<SolidMesh> prepareSolid(const BakeRequest& request, TriangleMesh mesh) {
    static_cast<void>(RELIEF_TRY(settingsOf(request)));
    return solidOf(request, SourceMesh{std::move(mesh)}, {});
}

Result<ErrorCurve> planErrors(const BakeRequest& request, const SolidMesh& solid, std::uint64_t bytes) {
    const BakeSettings settings = RELIEF_TRY(settingsOf(request));
    return planErrors(solid.mesh.mesh, settings.bake, bytes);
}

}  // namespace relief
