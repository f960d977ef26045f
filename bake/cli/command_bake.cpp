// relief bake: a mesh becomes a collider.
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <optional>
#include <span>

#include "bake/cli/bake_in_memory.h"
#include "bake/cli/bake_settings.h"
#include "bake/cli/command.h"
#include "bake/cli/command_line.h"
#include "bake/cli/command_recipe.h"
#include "bake/measure/accuracy.h"
#include "bake/measure/part_accuracy.h"
#include "bake/mesh/mesh_query.h"
#include "bake/pipeline/bake.h"
#include "bake/pipeline/budget_search.h"
#include "bake/pipeline/planned_bake.h"
#include "bake/plan/plan_file.h"
#include "bake/plan/view_planner.h"
#include "bake/recipe/depfile.h"
#include "bake/repair/mesh_care.h"
#include "bake/report/bake_report.h"
#include "bake/report/parts_report.h"
#include "bake/report/report_text.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/stopwatch.h"
#include "formats/base/text.h"
#include "formats/fields/json.h"
#include "runtime/tool/command_line.h"
#include "runtime/tool/memory_option.h"
#include "runtime/tool/progress.h"

namespace relief {
namespace {

/// Points that a planned bake measures itself at: one in a hundred is then known to a sixth of that.
constexpr std::uint32_t kSelfCheckPoints = 4000;
/// Of each part: a lost one has a quarter of its points on the wrong side.
const PartOptions kSelfCheckParts{
    .points = 64, .points_min = 16, .points_all = 16'384, .parts_max = 1024, .detail = {}};
/// Percent of them on the wrong side, above which the bake warns.
constexpr double kSelfCheckWarns = 5.0;
/// What one more map would have served, from which on the warning speaks of more maps.
constexpr double kMoreMapsHelp = 0.005;

/// Every file that the collider was made from, the mesh first.
std::vector<InputFile> inputsOf(const BakeCommand& command, const TriangleMesh& mesh,
                                const std::string& plan_hash) {
    std::vector<InputFile> inputs;
    for (std::size_t i = 0; i < mesh.dependencies.size(); ++i) {
        inputs.push_back({mesh.dependencies[i], mesh.dependency_hashes[i]});
    }
    if (!command.plan.empty()) {
        inputs.push_back({command.plan, plan_hash});
    }
    return inputs;
}

/// The maps of --plan, and its quality and preference where the command line names none.
Result<void> readPlanFile(const BakeCommand& command, BakeSettings& settings) {
    const PlanFile plan = RELIEF_TRY(loadPlan(command.plan));
    if (!command.quality) {
        settings.bake.quality = plan.quality;
        settings.plan_quality = plan.quality;
    }
    if (!command.prefer) {
        settings.bake.prefer = plan.prefer;
    }
    settings.bake.planned_budget = plan.budget;
    settings.shape.thickness = plan.thickness;
    for (const PlanFileMap& map : plan.maps) {
        settings.bake.maps.push_back(map.spec);
    }
    return {};
}

/// Bakes at the least budget that keeps --max-error.
Result<Baked> searchBudget(const MeshQuery& query, const MeshQuery& truth, const BakeCommand& command,
                           const BakeSettings& settings, std::optional<PlanReport>& report,
                           Progress& progress) {
    progress.begin("searching for the least budget");
    BudgetSearchOptions options;
    options.max_error_percent = double{*command.max_error};
    options.budget_max = command.budget.value_or(options.budget_max);
    options.bake = settings.bake;
    options.bake.progress = [&progress](double) { progress.checkpoint(); };
    options.max_maps = command.max_maps;
    options.tried = [&progress](const BudgetTry& made) {
        progress.print([&made] {
            spdlog::info("{}: {:.3g} % of the points near the surface are on the wrong side",
                         bytesText(made.budget), made.wrong_percent);
        });
    };
    BudgetSearchResult found = RELIEF_TRY(bakeForError(query, truth, options));
    report = PlanReport{std::move(found.plan), found.chosen.budget, options.max_error_percent,
                        found.chosen.wrong_percent, std::move(found.tries)};
    return std::move(found.baked);
}

/// Chooses the maps for the budget, and bakes them.
Result<Baked> bakeForBudget(const MeshQuery& query, const BakeCommand& command, const BakeSettings& settings,
                            std::optional<PlanReport>& report, BakeTimes& times, const Stopwatch& watch,
                            Progress& progress) {
    ViewOptions options;
    options.prefer = settings.bake.prefer;
    options.max_maps = command.max_maps;
    const ViewChoice views = RELIEF_TRY(chooseViews(query, options));
    times.plan_ms = watch.ms();
    PlanReport made;
    made.budget = command.budget.value_or(kBudgetDefault);
    progress.begin("baking the maps");
    BakeOptions bake_options = settings.bake;
    bake_options.progress = [&progress](double share) { progress.set(share); };
    PlannedBake planned = RELIEF_TRY(bakePlanned(query, views, made.budget, bake_options));
    made.plan = std::move(planned.plan);
    report = std::move(made);
    return std::move(planned.baked);
}

Result<Baked> bakeMaps(const BakeCommand& command, const PreparedMesh& mesh, BakeSettings& settings,
                       Progress& progress) {
    progress.begin("baking the maps");
    settings.bake.progress = [&progress](double share) { progress.set(share); };
    Result<Baked> baked = bake(mesh, settings.bake);
    if (!baked && settings.source == MapSource::kPlanFile) {
        // What no single map shows: too many texels, a volume that floats cannot hold, maps that see nothing.
        const ErrorCode code = baked.error().code;
        return fail(code == ErrorCode::kUsage ? ErrorCode::kInvalidInput : code,
                    quotedPath(command.plan) + ": " + baked.error().message);
    }
    return baked;
}

/// Chooses the maps and bakes them.
/// \param imported  the mesh whose points --max-error is about: as it came, if it was repaired.
/// \param mesh      the solid that is baked.
Result<Baked> makeCollider(const BakeCommand& command, const PreparedMesh& imported, const PreparedMesh& mesh,
                           BakeSettings& settings, std::optional<PlanReport>& plan, BakeTimes& times,
                           Progress& progress) {
    if (settings.source == MapSource::kPlanner) {
        const Stopwatch watch;
        progress.begin("planning the maps");
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
        if (command.max_error) {
            MeshQuery truth = query;
            if (!command.care.repair.empty()) {
                truth = RELIEF_TRY(MeshQuery::build(imported));
            }
            Result<Baked> baked = searchBudget(query, truth, command, settings, plan, progress);
            times.search_ms = watch.ms();
            return baked;
        }
        return bakeForBudget(query, command, settings, plan, times, watch, progress);
    }
    return bakeMaps(command, mesh, settings, progress);
}

Result<void> writePlanFile(const std::string& path, const PlanReport& plan, const Baked& baked,
                           const BakeOptions& options, const ShapeReport& shape) {
    PlanFile file;
    file.quality = options.quality;
    file.prefer = options.prefer;
    file.budget = plan.budget;
    file.thickness = shape.default_thickness;
    for (std::size_t i = 0; i < plan.plan.maps.size(); ++i) {
        file.maps.push_back({baked.report.maps[i].spec, plan.plan.maps[i].reason});
    }
    const std::string text = planText(file);
    return writeFile(path, std::as_bytes(std::span(text)));
}

BakeSettingsReport settingsReport(const BakeCommand& command, const BakeSettings& settings,
                                  const Backend& backend, const Baked& baked,
                                  const std::optional<PlanReport>& plan) {
    BakeSettingsReport report{.mesh = command.mesh, .output = command.output, .plan_file = command.plan};
    for (const MapReport& map : baked.report.maps) {
        report.maps.push_back(toString(map.spec));
    }
    if (settings.source == MapSource::kMaps || settings.source == MapSource::kPaper) {
        report.resolution = settings.bake.resolution;
    }
    if (plan) {
        report.budget = plan->budget;
    }
    report.quality = settings.bake.quality;
    report.prefer = settings.bake.prefer;
    report.raster = backend.raster;
    report.backend_reason = backend.reason;
    report.device = backend.device;
    report.threads = settings.bake.threads == 0 ? tbb::info::default_concurrency()
                                                : static_cast<int>(settings.bake.threads);
    report.compress = settings.write.compression_level;
    report.closes_holes = command.holes == Holes::kClose;
    return report;
}

/// A bake, and what its stages leave for the next.
struct BakeRun {
    BakeRun(const BakeCommand& command_of_run, FileGuard& files_of_run, std::function<void()> checkpoint = {})
        : command(command_of_run),
          files(files_of_run),
          progress({quotedPath(command.mesh), !command.common.quiet, command.time_limit,
                    std::move(checkpoint), reportError}) {}

    const BakeCommand& command;
    FileGuard& files;
    Stopwatch total;
    Progress progress;
    BakeTimes times;
    BakeSettings settings;
    std::string plan_hash;
    Backend backend;
    std::optional<PreparedMesh> imported;  ///< as it came, where --max-error looks back at it after a repair
    std::uint64_t unused_vertices = 0;     ///< of the mesh file: a repaired mesh knows them no more
    CaredMesh cared;
    ShapeReport shape;
    SurfaceParts parts;
    std::optional<PartsAccuracy> part_accuracy;  ///< of a planned bake of several parts
    std::optional<PlanReport> plan;
    Baked baked;
    std::optional<WrongShare> wrong;  ///< near the surface; of a planned bake
    std::vector<InputFile> inputs;
    std::vector<std::byte> bytes;  ///< of the container
};

/// What the options and the plan file say, before anything large is read.
Result<void> prepare(BakeRun& run) {
    const BakeCommand& command = run.command;
    run.settings = RELIEF_TRY(settingsOf(command));
    RELIEF_TRY(checkMeshCare(command.care));
    RELIEF_TRY(preflight(command, run.files));
    if (run.settings.source == MapSource::kPlanFile) {
        // Before it is read: should it change meanwhile, the hash is that of neither, or of the older one.
        const auto plan_bytes = readFile(command.plan);
        run.plan_hash = plan_bytes ? xxh3_128Hex(*plan_bytes) : "";
        RELIEF_TRY(readPlanFile(command, run.settings));
    }
    BakeOptions& options = run.settings.bake;
    run.backend = RELIEF_TRY(chooseBackend(
        command.backend, command.gpu,
        {run.settings.source == MapSource::kPlanner, command.quality || run.settings.plan_quality,
         options.quality, options.prefer, std::ranges::any_of(options.maps, [](const MapSpec& spec) {
             return spec.compare == Compare::kGap;
         })}));
    options.rasterize = run.backend.raster;
    if (run.backend.raster) {
        options.quality = Quality::kFast;
    }
    return {};
}

/// Turns a non-solid mesh into a solid.
Result<void> shape(BakeRun& run) {
    const BakeCommand& command = run.command;
    const Bounds& bounds = run.cared.mesh->bounds;
    ShapeOptions options = run.settings.shape;
    options.thickness_by_part = !command.thickness;
    if (command.thickness) {
        options.thickness = double{*command.thickness};
    } else if (!(options.thickness > 0.0)) {  // else it is that of --plan
        options.thickness = defaultThickness(
            bounds, command.max_error ? kBudgetDefault : command.budget.value_or(kBudgetDefault));
    }
    if (command.thickness && !(options.thickness <= kThicknessMax * double{bounds.longestSide()})) {
        return fail(ErrorCode::kUsage, "--thickness is " + shortest(*command.thickness) + " but " +
                                           run.cared.mesh->name + " is " + shortest(bounds.longestSide()) +
                                           " long; give at most " + shortest(float(kThicknessMax)) +
                                           " of that");
    }
    run.progress.begin("making a solid of the mesh");
    ShapedMesh shaped = RELIEF_TRY(shapeMesh(run.cared.mesh, options));
    run.cared.mesh = std::move(shaped.mesh);
    run.shape = std::move(shaped.report);
    run.parts = std::move(shaped.parts);
    return {};
}

/// Reads the mesh and makes it fit to be baked.
/// \param given  instead of the file's.
Result<void> readMesh(BakeRun& run, std::optional<TriangleMesh> given = {}) {
    const BakeCommand& command = run.command;
    const Stopwatch watch;
    ImportOptions import = command.import.options;
    import.names = run.settings.shape.names();
    run.progress.begin("reading the mesh");
    if (!given) {
        given = RELIEF_TRY(importMeshInWorker(command.mesh, import, command.import.limits));
    }
    TriangleMesh mesh = std::move(*given);
    run.times.import_ms = watch.ms();
    run.unused_vertices = mesh.unused_vertices;
    run.progress.print([&mesh] {
        spdlog::debug("{}: {} triangles, {} vertices, XXH3-128 {}", mesh.name, mesh.triangles.size(),
                      mesh.positions.size(), mesh.content_hash);
        if (mesh.dropped_triangles > 0) {
            spdlog::debug("{}: {} triangles without area dropped", mesh.name, mesh.dropped_triangles);
        }
    });
    if (command.max_error && !command.care.repair.empty()) {
        run.imported = mesh;
    }
    MeshCareOptions care = command.care;
    care.report = command.json || !command.common.quiet;
    run.progress.begin(care.repair.empty() ? "examining the mesh" : "repairing the mesh");
    run.cared = RELIEF_TRY(careFor(std::move(mesh), care));
    if (command.holes == Holes::kClose) {
        return shape(run);
    }
    run.parts = surfacePartsOf(run.cared.mesh);
    run.cared.mesh.freeEdges();
    return {};
}

/// Chooses the maps and bakes them.
Result<void> makeCollider(BakeRun& run) {
    const PreparedMesh& mesh = run.cared.mesh;
    Result<Baked> baked = makeCollider(run.command, run.imported.value_or(mesh), mesh, run.settings, run.plan,
                                       run.times, run.progress);
    if (run.backend.raster) {
        run.backend.gl.watchdog->rest();
    }
    if (!baked && baked.error().code != ErrorCode::kUsage) {
        if (const auto stray = strayText(run.parts, mesh->unit)) {
            return fail(baked.error().code, mesh->name + ": " + *stray);
        }
    }
    run.baked = RELIEF_TRY(std::move(baked));
    run.baked.collider.provenance.options += (run.command.holes == Holes::kKeep ? " --holes keep" : "") +
                                             importProvenance(run.command.import.options) +
                                             careOptionsText(run.cared.care) + shapeOptionsText(run.shape);
    return {};
}

/// What may help a bake that is wrong in many places.
std::string cureOf(const BakeRun& run) {
    const std::uint64_t budget = run.command.budget.value_or(kBudgetDefault);
    std::string more = "--budget " + std::to_string(4 * budget / 1000) + "kB";
    if (run.plan->plan.maps.size() >= run.command.max_maps && run.plan->plan.next_gain > kMoreMapsHelp) {
        more += " --max-maps " + std::to_string(2 * run.plan->plan.maps.size());
    }
    if (run.shape.sheets > 0 && run.shape.as == ShapeAs::kAuto) {
        return "try " + more + ", or a larger --thickness for its sheets (now " +
               shortNumber(run.shape.thickness) + ")";
    }
    if (run.plan->plan.unseen_percent > 5.0) {
        return shortNumber(run.plan->plan.unseen_percent) + " % of the surface is seen by no map; try " +
               more + ", --as shell if it is walls, or --repair wrap=0.01 if its insides do not matter";
    }
    return "try " + more;
}

/// A planned bake measures itself: whoever names the maps may want what looks wrong.
Result<void> checkItself(BakeRun& run) {
    if (run.settings.source != MapSource::kPlanner || run.command.no_check) {
        return {};
    }
    const Stopwatch watch;
    run.progress.begin("measuring the collider");
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(run.cared.mesh));
    AccuracyOptions options;
    options.samples = kSelfCheckPoints;
    const Field field = fieldOf(run.baked.collider);
    run.wrong = measureNear(sampleNear(query, options), field);
    if (run.parts.parts.size() > 1) {
        run.part_accuracy = measureParts(query, run.parts, field, kSelfCheckParts);
    }
    run.times.check_ms = watch.ms();
    if (run.wrong->total() > kSelfCheckWarns) {
        run.baked.report.warnings.push_back(run.cared.mesh->name + ": " + shortNumber(run.wrong->total()) +
                                            " % wrong near the surface; " + cureOf(run));
    }
    if (run.part_accuracy) {
        if (const auto lost = lostPartsWarning(*run.part_accuracy, run.parts, run.baked.collider)) {
            run.baked.report.warnings.push_back(run.cared.mesh->name + ": " + *lost);
        }
    }
    return {};
}

/// All warnings of the bake, in those of its report.
void gatherWarnings(BakeRun& run) {
    const TriangleMesh& mesh = *run.cared.mesh;
    std::vector<std::string>& warnings = run.baked.report.warnings;
    for (const NamedTriangles& named : run.shape.named) {
        if (named.triangles == 0) {
            warnings.insert(warnings.begin(),
                            mesh.name + ": --as " + named.shape.name + "=" +
                                std::string(shapeAsName(named.shape.as)) +
                                " changes nothing: a later --as names all its triangles too, or they have "
                                "no area; give it last");
        }
    }
    const auto forgotten = mesh.unit.empty() ? forgottenUnit(run.baked.collider.bounds) : std::nullopt;
    // A terrain of hundreds of metres is nothing special.
    if (forgotten && run.shape.terrains == 0) {
        warnings.insert(warnings.begin(), mesh.name + ": " + *forgotten);
    }
    for (const std::string& warning : partWarnings(run.parts, mesh.unit)) {
        warnings.insert(warnings.begin(), mesh.name + ": " + warning);
    }
    const std::uint64_t in_memory = run.baked.collider.texelBytes();
    if (!run.bytes.empty() && in_memory > std::max(kToolMemory, kUnpackedPerStored * run.bytes.size())) {
        warnings.push_back(mesh.name + ": its maps take " + bytesText(in_memory) +
                           " in memory, for a file of " + bytesText(run.bytes.size()) +
                           "; other tools read it with --max-memory " + std::to_string(in_memory));
    }
    warnings.insert(warnings.begin(), mesh.warnings.begin(), mesh.warnings.end());
}

/// Says what was out of the ordinary. Only now: a bake that fails has one line to say.
void tellNotices(BakeRun& run) {
    const TriangleMesh& mesh = *run.cared.mesh;
    if (mesh.closed_holes > 0) {
        spdlog::info("{}: closed {} for baking: the mesh is nearly closed", mesh.name,
                     countText(mesh.closed_holes, "hole"));
    }
    if (!run.backend.reason.empty()) {
        spdlog::info("backend {}: {}", run.backend.raster ? "raster" : "raycast", run.backend.reason);
    }
    gatherWarnings(run);
    for (const std::string& warning : run.baked.report.warnings) {
        spdlog::warn(warning);
    }
}

/// The bytes of the container: the last that may take long.
Result<void> packContainer(BakeRun& run) {
    const Stopwatch watch;
    run.progress.begin("packing the collider");
    run.bytes = RELIEF_TRY(writeContainer(run.baked.collider, run.settings.write));
    run.times.write_ms = watch.ms();
    run.progress.finish();
    return {};
}

/// The collider, and the files beside it.
Result<void> writeOutputs(BakeRun& run) {
    const BakeCommand& command = run.command;
    const Stopwatch watch;
    RELIEF_TRY(writeFile(command.output, run.bytes));
    if (!command.plan_out.empty()) {
        RELIEF_TRY(writePlanFile(command.plan_out, *run.plan, run.baked, run.settings.bake, run.shape));
    }
    run.inputs = inputsOf(command, *run.cared.mesh, run.plan_hash);
    if (!command.depfile.empty()) {
        std::vector<std::string> names;
        for (const InputFile& input : run.inputs) {
            names.push_back(input.path);
        }
        RELIEF_TRY(writeDepfile(command.depfile, {command.output}, names));
    }
    run.times.write_ms += watch.ms();
    run.times.total_ms = run.total.ms();
    return {};
}

Result<void> report(const BakeRun& run) {
    const BakeCommand& command = run.command;
    const BakeSummary summary{*run.cared.mesh,        run.baked, run.plan,         run.times,
                              run.cared.care,         run.shape, run.wrong,        run.unused_vertices,
                              command.common.verbose, run.parts, run.part_accuracy};
    if (command.json) {
        const ContainerInfo info = RELIEF_TRY(readContainerInfo(run.bytes));
        const BakeSettingsReport settings =
            settingsReport(command, run.settings, run.backend, run.baked, run.plan);
        return printOut(jsonText(jsonOf(BakeJson{summary, info, settings, run.inputs})));
    }
    if (!command.common.quiet) {
        std::fputs(bakeText(summary, command.output, run.bytes.size()).c_str(), stderr);
    }
    return {};
}

/// None of the files that the mesh refers to, a buffer or a material, may be lost to an output.
Result<void> protectInputs(const BakeRun& run) {
    for (const std::string& file : run.cared.mesh->dependencies) {
        RELIEF_TRY(run.files.reads(file));
    }
    return {};
}

/// The bake from the options to the collider.
/// \param given  as readMesh has it.
Result<void> bakeCollider(BakeRun& run, std::optional<TriangleMesh> given) {
    RELIEF_TRY(prepare(run));
    // Planning and measuring keep to --threads too.
    std::optional<tbb::global_control> control;
    if (run.command.threads) {
        control.emplace(tbb::global_control::max_allowed_parallelism, *run.command.threads);
    }
    RELIEF_TRY(readMesh(run, std::move(given)));
    RELIEF_TRY(protectInputs(run));
    RELIEF_TRY(makeCollider(run));
    return checkItself(run);
}

Result<void> runBake(const BakeCommand& command, FileGuard& files) {
    startLogging(command.common);
    BakeRun run(command, files);
    RELIEF_TRY(run.progress.ready());
    run.progress.begin("reading its options");
    RELIEF_TRY(bakeCollider(run, std::nullopt));
    RELIEF_TRY(packContainer(run));
    tellNotices(run);
    RELIEF_TRY(writeOutputs(run));
    return report(run);
}

/// Whether the settings that these arguments make can be baked with.
Result<void> checkArguments(const std::vector<std::string>& arguments) {
    static_cast<void>(RELIEF_TRY(bakeCommandOf(arguments)));
    return {};
}

/// Adds the verb. \return what its options are read into.
std::shared_ptr<BakeCommand> registerBake(CLI::App& app, Action& action) {
    auto command = std::make_shared<BakeCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "bake",
        "Bakes a mesh into a collider\n\nWithout --map, --paper or --plan, the maps are planned: "
        "directions, places (cubes in cavities that no\nouter view sees) and sizes, for --budget bytes "
        "or for --max-error.",
        "relief bake bunny.obj -o bunny.relief\n"
        "relief bake bunny.obj -o bunny.relief --budget 256kB --plan-out plan.toml\n"
        "relief bake bunny.obj -o bunny.relief --plan plan.toml\n"
        "relief bake bunny.obj -o bunny.relief --max-error 1%\n"
        "relief bake rock.glb -o rock.relief --map cube:size=256 --map fixed8:dir=-y,size=512x256\n"
        "relief bake hall.fbx -o hall.relief --map cube:center=0/2/0,compare=less --json\n"
        "relief bake --recipe colliders.toml -j 4");
    addBakeOptions(verb, *command);
    verb.callback([command, &verb, &action] {
        action = [command, &verb](FileGuard& files) -> Result<void> {
            if (!command->recipe.recipe.empty()) {
                return runRecipeCommand(command->recipe,
                                        {verb, command->common, command->output, command->threads,
                                         command->depfile, command->json, files, checkArguments});
            }
            if (command->mesh.empty() || command->output.empty()) {
                return fail(ErrorCode::kUsage, std::string(command->mesh.empty() ? "MESH" : "--output") +
                                                   " is required; see relief bake --help");
            }
            return runBake(*command, files);
        };
    });
    return command;
}

}  // namespace

void addBake(CLI::App& app, Action& action) {
    registerBake(app, action);
}

Result<BakeCommand> bakeCommandOf(std::vector<std::string> options) {
    CLI::App app("", "relief");
    Action none;
    const std::shared_ptr<BakeCommand> command = registerBake(app, none);
    options.insert(options.begin(), "bake");
    static_cast<void>(RELIEF_TRY(parseCommandLine(app, std::move(options))));
    static_cast<void>(RELIEF_TRY(settingsOf(*command)));
    return *command;
}

Result<BakedInMemory> bakeInMemory(BakeCommand command, std::optional<TriangleMesh> mesh,
                                   std::function<void()> checkpoint) {
    command.output = "-";  // which is never written
    command.common = {.quiet = true};
    command.time_limit.reset();
    const ShapeOptions shape = RELIEF_TRY(parseShapeOptions(command.as));
    if (mesh && !shape.named.empty()) {
        return fail(ErrorCode::kUsage,
                    "--as NAME=KIND is for a mesh that is read from a file; leave NAME= out");
    }
    FileGuard files;
    BakeRun run(command, files, std::move(checkpoint));
    RELIEF_TRY(bakeCollider(run, std::move(mesh)));
    run.progress.checkpoint();
    if (!command.plan_out.empty()) {
        RELIEF_TRY(writePlanFile(command.plan_out, *run.plan, run.baked, run.settings.bake, run.shape));
    }
    gatherWarnings(run);
    return BakedInMemory{std::move(run.baked.collider), std::move(run.baked.report.warnings)};
}

}  // namespace relief
