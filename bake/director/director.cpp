// SPDX-License-Identifier: Apache-2.0
#include "bake/director/director.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <set>
#include <span>

#include "bake/import/animated_import.h"
#include "bake/import/mesh_import.h"
#include "bake/measure/self_check.h"
#include "bake/pipeline/budget_search.h"
#include "bake/report/parts_report.h"
#include "bake/report/report_text.h"
#include "formats/animation/mesh_pose.h"
#include "formats/base/file_io.h"
#include "formats/base/stopwatch.h"
#include "formats/base/text.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

/// From so many nodes on, a source may be a level.
constexpr std::size_t kLevelNodes = 100;

template <class... Arguments>
void tell(const std::function<void(Arguments...)>& function, Arguments... arguments) {
    if (function) {
        function(arguments...);
    }
}

/// The ways to the maps, shared by a whole bake and by bakeSolid().
class MapMaker {
  public:
    MapMaker(const BakeRequest& request, const BakeSettings& settings, const BakeWatcher& watcher)
        : request_(request), settings_(settings), watcher_(watcher) {}

    /// Patches for --budget and --texel.
    Result<Baked> forBudget(const MeshQuery& query, PatchesReport& report) const {
        report.budget = request_.texel ? request_.budget : request_.budget.value_or(kBudgetDefault);
        return bakePatchesWithin(query, report.budget.value_or(0), begin("baking the maps"));
    }

    /// The least budget that keeps --max-error.
    /// \param truth  of the mesh whose points count: as it came, if it was repaired.
    Result<Baked> forError(const MeshQuery& query, const MeshQuery& truth, PatchesReport& report) const {
        tell(watcher_.begin, "searching for the least budget");
        BudgetSearchOptions options;
        options.max_error_percent = double{*request_.max_error};
        if (const double floats = wrongByFloats(truth.mesh()); floats > 2.0 * options.max_error_percent) {
            return fail(ErrorCode::kDifference, truth.mesh().name + ": --max-error is " +
                                                    percentText(options.max_error_percent) +
                                                    ", and floats so far from the origin leave about " +
                                                    percentText(floats) + " wrong; move it to the origin");
        }
        options.budget_max = request_.budget.value_or(options.budget_max);
        options.bake = settings_.bake;
        options.bake.progress = [this](double) { tell(watcher_.checkpoint); };
        options.tried = watcher_.tried;
        BudgetSearchResult found = RELIEF_TRY(bakeForError(query, truth, options));
        report.budget = found.chosen.budget;
        report.max_error = options.max_error_percent;
        report.wrong_percent = found.chosen.wrong_percent;
        report.tries = std::move(found.tries);
        return std::move(found.baked);
    }

    Result<Baked> named(const PreparedMesh& mesh) const { return bake(mesh, begin("baking the maps")); }

  private:
    [[nodiscard]] BakeOptions begin(const char* stage) const {
        tell(watcher_.begin, stage);
        BakeOptions options = settings_.bake;
        options.progress = watcher_.progress;
        return options;
    }

    const BakeRequest& request_;
    const BakeSettings& settings_;
    const BakeWatcher& watcher_;
};

/// MaterialSource::sides
bool knowsSides(const BakeRequest& request, const ShapeReport& shape) {
    return request.holes == Holes::kClose && request.repair.method.empty() && shape.sheets == 0 &&
           shape.terrains == 0;
}

/// Turns those triangles of an animated mesh that were turned in its rest pose.
/// \param rest   the pose's vertices. \param before, wound  its triangles with an area, as they came and as they are.
void turnAlike(const std::vector<glm::vec3>& rest, const std::vector<glm::uvec3>& before,
               const std::vector<glm::uvec3>& wound, AnimatedMesh& mesh) {
    std::size_t next = 0;
    for (glm::uvec3& t : mesh.triangles) {
        if (!hasArea(planeOf(rest, t))) {
            continue;  // finishMesh has dropped it
        }
        if (next < before.size() && next < wound.size() && before[next] != wound[next]) {
            t = {t.x, t.z, t.y};
        }
        ++next;
    }
}

/// A bake, and what its stages leave for the next.
class Director {
  public:
    Director(const BakeRequest& request, const BakeWatcher& watcher) : watcher_(watcher) {
        result_.request = request;
    }

    /// \param mesh  instead of the file's. \param solid  instead of one, if not null.
    Result<BakeResult> run(std::optional<TriangleMesh> mesh, const SolidMesh* solid = nullptr) {
        tell(watcher_.begin, "reading its options");
        RELIEF_TRY(readOptions(mesh));
        // Measuring keeps to --threads too.
        std::optional<tbb::global_control> control;
        if (request().threads) {
            control.emplace(tbb::global_control::max_allowed_parallelism, *request().threads);
        }
        if (solid != nullptr) {
            take(*solid);
        } else {
            RELIEF_TRY(readMesh(std::move(mesh)));
        }
        RELIEF_TRY(protectInputs());
        RELIEF_TRY(makeCollider());
        RELIEF_TRY(measure());
        gatherWarnings();
        return std::move(result_);
    }

    Result<SolidMesh> prepare(TriangleMesh mesh) {
        result_.settings = RELIEF_TRY(settingsOf(request()));
        RELIEF_TRY(readMesh(std::move(mesh)));
        return SolidMesh{result_.unused_vertices, std::move(result_.mesh), std::move(result_.shape),
                         std::move(result_.parts), std::move(result_.materials)};
    }

  private:
    [[nodiscard]] BakeRequest& request() { return result_.request; }

    /// Before anything large is read.
    Result<void> readOptions(const std::optional<TriangleMesh>& given) {
        result_.settings = RELIEF_TRY(settingsOf(request()));
        if (!request().heights.empty()) {
            return fail(ErrorCode::kUsage,
                        "--heights is for a height map that is read from a file; leave it out");
        }
        const std::string import = importOptionOf(request().import, request().import_limits);
        if (given && !import.empty()) {
            return fail(ErrorCode::kUsage, import + " is for a mesh that is read from a file; leave it out");
        }
        if (given && request().animated) {
            return fail(ErrorCode::kUsage, "--animated is for a mesh that is read from a file; leave it out");
        }
        if (request().animated) {
            // Its parts pass through each other as it moves, and are drawn as they are.
            request().holes = Holes::kKeep;
        }
        if (given && given->marks.empty() && !result_.settings.shape.named.empty()) {
            return fail(ErrorCode::kUsage,
                        "--as NAME=KIND is for a mesh that is read from a file; leave NAME= out");
        }
        return {};
    }

    /// \param given  instead of the file's.
    Result<void> readMesh(std::optional<TriangleMesh> given) {
        const Stopwatch watch;
        tell(watcher_.begin, "reading the mesh");
        if (!given) {
            ImportOptions import = request().import;
            import.names = result_.settings.shape.names();
            given = request().animated
                        ? RELIEF_TRY(readAnimated())
                        : RELIEF_TRY(importMeshInWorker(request().mesh, import, request().import_limits));
        }
        TriangleMesh mesh = std::move(*given);
        std::set<std::uint32_t> nodes;
        for (const SurfaceName& name : mesh.surface_names) {
            nodes.insert(name.node_index);
        }
        nodes_ = nodes.size();
        result_.times.import_ms = watch.ms();
        result_.unused_vertices = mesh.unused_vertices;
        if (watcher_.imported) {
            watcher_.imported(mesh);
        }
        const bool repairs = !request().repair.method.empty();
        if (request().max_error && repairs) {
            imported_ = mesh;
        }
        tell(watcher_.begin, repairs ? "repairing the mesh" : "examining the mesh");
        const std::vector<glm::uvec3> before = result_.animated ? mesh.triangles : std::vector<glm::uvec3>();
        if (repairs) {
            RELIEF_TRY(takeMaterials(mesh));
        }
        result_.mesh = RELIEF_TRY(repairMesh(std::move(mesh), request().repair));
        if (!repairs) {
            RELIEF_TRY(takeMaterials(*result_.mesh.mesh));  // with its winding mended
        }
        if (result_.animated && result_.mesh.report.turned > 0) {
            AnimatedMesh& animated = *result_.animated;
            turnAlike(posed(animated, restPose(animated)), before, result_.mesh.mesh->triangles, animated);
        }
        return makeSolidOf(result_.mesh.mesh);
    }

    /// \param mesh  whose triangles are the source's.
    Result<void> takeMaterials(const TriangleMesh& mesh) {
        if (request().materials == MaterialsAs::kNone || request().animated) {
            return {};
        }
        MaterialSource source = RELIEF_TRY(materialSource(mesh, request().materials.has_value()));
        if (!source.empty()) {
            result_.materials = std::make_shared<MaterialSource>(std::move(source));
        }
        return {};
    }

    /// \return its rest pose.
    Result<TriangleMesh> readAnimated() {
        AnimatedImport animated = RELIEF_TRY(importAnimatedInWorker(
            request().mesh, request().clips, request().import, request().import_limits));
        result_.animated = std::move(animated.mesh);
        return std::move(animated.rest);
    }

    void take(const SolidMesh& solid) {
        result_.unused_vertices = solid.unused_vertices;
        result_.mesh = solid.mesh;
        result_.shape = solid.shape;
        result_.parts = solid.parts;
        result_.materials = solid.materials;
    }

    /// Turns a non-solid mesh into a solid.
    Result<void> makeSolidOf(PreparedMesh& mesh) {
        const std::optional<Thickness>& thickness = request().thickness;
        const float longest = mesh->bounds.longestSide();
        if (request().holes == Holes::kClose && thickness && !thickness->by_part &&
            !(thickness->length <= kThicknessMax * double{longest})) {
            return fail(ErrorCode::kUsage,
                        "--thickness is " + shortest(static_cast<float>(thickness->length)) + " but " +
                            mesh->name + " is " + shortest(longest) + " long; give at most " +
                            shortest(float(kThicknessMax)) + " of that");
        }
        if (request().holes == Holes::kClose) {
            tell(watcher_.begin, "making a solid of the mesh");
        }
        ShapedMesh shaped = RELIEF_TRY(makeSolid(request(), mesh));
        mesh = std::move(shaped.mesh);
        result_.shape = std::move(shaped.report);
        result_.parts = std::move(shaped.parts);
        if (result_.materials) {
            result_.materials->sides = knowsSides(request(), result_.shape);
        }
        if (request().holes == Holes::kKeep) {
            mesh.freeEdges();
        }
        return {};
    }

    /// None of the files that the mesh refers to, a buffer or a material, may be lost to an output.
    Result<void> protectInputs() {
        const TriangleMesh& mesh = *result_.mesh.mesh;
        for (std::size_t i = 0; i < mesh.dependencies.size(); ++i) {
            if (watcher_.files != nullptr) {
                RELIEF_TRY(watcher_.files->reads(mesh.dependencies[i]));
            }
            result_.inputs.push_back({mesh.dependencies[i], mesh.dependency_hashes[i]});
        }
        return {};
    }

    Result<Baked> makeMaps() {
        const PreparedMesh& mesh = result_.mesh.mesh;
        const MapMaker maker(request(), result_.settings, watcher_);
        if (result_.settings.source != MapSource::kPatches) {
            return maker.named(mesh);
        }
        const Stopwatch watch;
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
        const double tree_ms = watch.ms();
        PatchesReport report;
        report.wanted_texel = request().texel;
        const auto search = [&]() -> Result<Baked> {
            const MeshQuery truth = imported_ ? RELIEF_TRY(MeshQuery::build(*imported_)) : query;
            return maker.forError(query, truth, report);
        };
        Baked baked = RELIEF_TRY(request().max_error ? search() : maker.forBudget(query, report));
        result_.times.search_ms = request().max_error ? watch.ms() : 0.0;
        const DepthMap& tree = baked.collider.maps.front();
        baked.report.build_ms += request().max_error ? 0.0 : tree_ms;
        report.bytes = baked.collider.texelBytes();
        report.texel = patchSpacing(tree.texels) * double{tree.object_per_map.x};
        result_.patches = std::move(report);
        return baked;
    }

    Result<void> makeCollider() {
        Result<Baked> baked = makeMaps();
        const PreparedMesh& mesh = result_.mesh.mesh;
        if (!baked && baked.error().code != ErrorCode::kUsage) {
            if (const auto stray = strayText(result_.parts, mesh->unit)) {
                return fail(baked.error().code, mesh->name + ": " + *stray);
            }
        }
        result_.baked = RELIEF_TRY(std::move(baked));
        if (result_.animated) {
            Collider& collider = result_.baked.collider;
            collider.animation = writeAnimatedMesh(*result_.animated);
            for (DepthMap& map : collider.maps) {
                map.encloses = false;  // the mesh may leave the box of its rest pose
            }
        }
        result_.baked.collider.materials = materialsFor(result_.baked.collider, result_.materials.get());
        // The maps have recorded themselves; beside them, the mesh as it was made.
        BakeRequest made;
        if (request().animated) {
            // Which maps these are follows from it, and that its holes stay.
            std::erase_if(result_.baked.collider.provenance.options,
                          [](const RecordedOption& option) { return option.name == "map"; });
            made.animated = true;
            made.resolution = result_.settings.bake.resolution;
        } else {
            made.holes = request().holes;
        }
        made.import = request().import;
        made.repair.method = result_.mesh.report.repair;
        made.as = asWords(result_.shape);
        made.thickness = thicknessOf(result_.shape);
        made.texel = request().texel;
        made.materials = request().materials;
        made.voids = result_.shape.voids > 0 ? VoidsAs::kFull : request().voids;
        for (const FieldWords& field : changedFields(made)) {
            for (const std::string& word : field.words) {
                result_.baked.collider.provenance.options.push_back({field.name, word});
            }
        }
        return {};
    }

    /// Patches are measured; named maps may be wrong on purpose.
    Result<void> measure() {
        if (!result_.patches || request().no_check) {
            return {};
        }
        const Stopwatch watch;
        tell(watcher_.begin, "measuring the collider");
        const PreparedMesh& mesh = result_.mesh.mesh;
        SelfCheck check = RELIEF_TRY(selfCheck(mesh, result_.parts, result_.baked.collider));
        result_.wrong = check.wrong;
        result_.part_accuracy = std::move(check.parts);
        result_.times.check_ms = watch.ms();
        std::vector<std::string>& warnings = result_.baked.report.warnings;
        if (const double wrong = result_.wrong->total(); wrong > kGoodPercent) {
            warnings.push_back(mesh->name + ": " + shortNumber(wrong) + " % wrong near the surface; " +
                               (floatsLimit(*mesh, wrong) ? "move it to the origin" : cure()));
        }
        if (result_.part_accuracy) {
            if (const auto lost =
                    lostPartsWarning(*result_.part_accuracy, result_.parts, result_.baked.collider)) {
                warnings.push_back(mesh->name + ": " + *lost);
            }
        }
        return {};
    }

    /// Options that may help a bake that is wrong in many places.
    [[nodiscard]] std::string cure() {
        const std::uint64_t budget = request().budget.value_or(kBudgetDefault);
        const std::string more = request().texel && !request().budget
                                     ? "--texel " + shortest(0.5F * *request().texel)
                                     : "--budget " + std::to_string(4 * budget / 1000) + "kB";
        if (result_.shape.sheets > 0 && result_.shape.as == ShapeAs::kAuto) {
            return "try " + more + ", or a larger --thickness for its sheets (now " +
                   shortNumber(result_.shape.thickness) + ")";
        }
        return "try " + more;
    }

    void gatherWarnings() {
        const TriangleMesh& mesh = *result_.mesh.mesh;
        std::vector<std::string> warnings = mesh.warnings;
        std::vector<std::string> parts = partWarnings(result_.parts, mesh.unit);
        std::reverse(parts.begin(), parts.end());
        for (const std::string& warning : parts) {
            warnings.push_back(mesh.name + ": " + warning);
        }
        const auto forgotten =
            mesh.unit.empty() ? forgottenUnit(result_.baked.collider.bounds) : std::nullopt;
        // A terrain of hundreds of metres is nothing special.
        if (forgotten && result_.shape.terrains == 0) {
            warnings.push_back(mesh.name + ": " + *forgotten);
        }
        for (auto named = result_.shape.named.rbegin(); named != result_.shape.named.rend(); ++named) {
            if (named->triangles == 0) {
                warnings.push_back(mesh.name + ": --as " + named->shape.name + "=" +
                                   std::string(wordOf(named->shape.as)) +
                                   " changes nothing: a later --as names all its triangles too, or they have "
                                   "no area; give it last");
            }
        }
        std::vector<std::string>& all = result_.baked.report.warnings;
        all.insert(all.begin(), warnings.begin(), warnings.end());
        if (mesh.closed_holes > 0) {
            result_.notices.push_back(mesh.name + ": closed " + countText(mesh.closed_holes, "hole") +
                                      " for baking: the mesh is nearly closed");
        }
        if (nodes_ >= kLevelNodes && !result_.animated) {
            result_.notices.push_back(
                mesh.name + ": " + std::to_string(nodes_) +
                " nodes become one collider; if it is a level, bake it with --world DIR: "
                "each mesh once, with more detail for the same bytes");
        }
        if (const std::uint64_t shells = result_.shape.unjoined_shells; shells > 0) {
            result_.notices.push_back(
                mesh.name + ": " + countText(shells, "open shell") +
                " within another one, with mouths too far apart to join: the space within is full; to free "
                "it, close the gap between the rims in the mesh");
        }
        if (const std::uint64_t walls = result_.shape.unclear_walls; walls > 0) {
            result_.notices.push_back(
                mesh.name + ": " + countText(walls, "wall") +
                " made of two open shells whose winding does not tell a lining from a body: the space within "
                "is free; bake bodies in their clothes with --as solid");
        }
        if (const std::uint64_t sheets = result_.shape.closable_sheets; sheets > 0) {
            result_.notices.push_back(
                mesh.name + ": " + countText(sheets, "sheet") +
                " would be solid with closed holes: if no vessel should stay open, bake with --as solid");
        }
    }

    const BakeWatcher& watcher_;
    BakeResult result_;
    std::size_t nodes_ = 0;                 // of the source, that show something
    std::optional<PreparedMesh> imported_;  // as it came, where --max-error looks back at it after a repair
};

}  // namespace

std::optional<Verdict> BakeResult::verdict() const {
    return wrong ? std::optional(
                       verdictOf(wrong->total(), part_accuracy.value_or(PartsAccuracy{}), mesh.mesh->unit))
                 : std::nullopt;
}

BakeSummary BakeResult::summary(bool verbose) const {
    return {*mesh.mesh, baked,     patches,         times,   mesh.report,
            shape,      verdict(), unused_vertices, verbose, animated ? &*animated : nullptr};
}

int BakeResult::threads() const {
    return request.threads ? static_cast<int>(*request.threads) : tbb::info::default_concurrency();
}

Result<BakeResult> bake(const BakeRequest& request, const BakeWatcher& watcher,
                        std::optional<TriangleMesh> mesh) {
    return Director(request, watcher).run(std::move(mesh));
}

Result<BakeResult> bake(const BakeRequest& request, const SolidMesh& solid) {
    return Director(request, {}).run({}, &solid);
}

Result<SolidMesh> prepareSolid(const BakeRequest& request, TriangleMesh mesh) {
    return Director(request, {}).prepare(std::move(mesh));
}

Result<MistakeCurve> planMistakes(const BakeRequest& request, const SolidMesh& solid, std::uint64_t bytes) {
    const BakeSettings settings = RELIEF_TRY(settingsOf(request));
    return planMistakes(solid.mesh.mesh, settings.bake, bytes);
}

Result<ShapedMesh> makeSolid(const BakeRequest& request, const PreparedMesh& mesh) {
    if (request.holes == Holes::kKeep || request.animated) {
        return ShapedMesh{mesh, {}, surfacePartsOf(mesh)};
    }
    ShapeOptions options = RELIEF_TRY(parseShapeOptions(request.as));
    options.thickness_by_part = !request.thickness || request.thickness->by_part;
    options.thickness_by_texel = options.thickness_by_part && request.texel;
    options.voids = request.voids.value_or(VoidsAs::kFull);
    options.thickness =
        request.thickness ? request.thickness->length
        : request.texel
            ? thicknessOfTexel(mesh->bounds, double{*request.texel})
            : defaultThickness(mesh->bounds,
                               request.max_error ? kBudgetDefault : request.budget.value_or(kBudgetDefault));
    return shapeMesh(mesh, options);
}

Result<Baked> bakeSolid(const BakeRequest& request, const PreparedMesh& solid) {
    const BakeSettings settings = RELIEF_TRY(settingsOf(request));
    const BakeWatcher watcher;
    const MapMaker maker(request, settings, watcher);
    if (settings.source != MapSource::kPatches) {
        return maker.named(solid);
    }
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(solid));
    PatchesReport report;
    return maker.forBudget(query, report);
}

}  // namespace relief
