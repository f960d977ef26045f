// relief bake: a mesh becomes a collider.
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>

#include "bake/cli/bake_settings.h"
#include "bake/cli/care_options.h"
#include "bake/cli/command.h"
#include "bake/cli/command_recipe.h"
#include "bake/cli/gl_options.h"
#include "bake/cli/import_options.h"
#include "bake/cli/progress.h"
#include "bake/mesh/mesh_query.h"
#include "bake/pipeline/bake.h"
#include "bake/pipeline/budget_search.h"
#include "bake/plan/plan_file.h"
#include "bake/plan/view_planner.h"
#include "bake/recipe/depfile.h"
#include "bake/repair/hole_caps.h"
#include "bake/repair/mesh_care.h"
#include "bake/report/bake_report.h"
#include "bake/report/report.h"
#include "formats/base/byte_count.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/stopwatch.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::uint64_t kBudgetDefault = 1'000'000;  // bytes

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
    if (command.quality.empty()) {
        settings.bake.quality = plan.quality;
        settings.plan_quality = plan.quality;
    }
    if (command.prefer.empty()) {
        settings.bake.prefer = plan.prefer;
    }
    for (const PlanFileMap& map : plan.maps) {
        settings.bake.maps.push_back(map.spec);
    }
    return {};
}

/// Chooses the maps for the budget.
Result<PlanReport> planMaps(const MeshQuery& query, BakeSettings& settings) {
    PlanReport report;
    report.budget = settings.budget.value_or(kBudgetDefault);
    PlanOptions options;
    options.budget_bytes = report.budget;
    options.views.prefer = settings.bake.prefer;
    Plan plan = RELIEF_TRY(planViews(query, options));
    report.plan = std::move(plan);
    settings.bake.maps = specsOf(report.plan);
    return report;
}

/// Bakes at the least budget that keeps --max-error.
Result<Baked> searchBudget(const MeshQuery& query, const MeshQuery& truth, const BakeSettings& settings,
                           std::optional<PlanReport>& report) {
    BudgetSearchOptions options;
    options.max_error_percent = *settings.max_error;
    if (settings.budget) {
        options.budget_max = *settings.budget;
    }
    options.bake = settings.bake;
    options.tried = [](const BudgetTry& made) {
        spdlog::info("{}: {:.3g} % of the points near the surface are on the wrong side",
                     bytesText(made.budget), made.wrong_percent);
    };
    BudgetSearchResult found = RELIEF_TRY(bakeForError(query, truth, options));
    report = PlanReport{std::move(found.plan), found.chosen.budget, settings.max_error,
                        found.chosen.wrong_percent, std::move(found.tries)};
    return std::move(found.baked);
}

Result<Baked> bakeMaps(const BakeCommand& command, const PreparedMesh& mesh, BakeSettings& settings) {
    ProgressBar bar("baking " + mesh->name, !command.common.quiet);
    settings.bake.progress = [&bar](double share) { bar.set(share); };
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
/// \param imported  the mesh as it came, whose points --max-error is about.
/// \param mesh      the same, its holes closed where it is nearly closed.
Result<Baked> makeCollider(const BakeCommand& command, const PreparedMesh& imported, const PreparedMesh& mesh,
                           BakeSettings& settings, std::optional<PlanReport>& plan, BakeTimes& times) {
    if (settings.source == MapSource::kPlanner) {
        const Stopwatch watch;
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
        if (settings.max_error) {
            MeshQuery truth = query;
            if (mesh->closed_holes > 0 || !command.care.repair.empty()) {
                truth = RELIEF_TRY(MeshQuery::build(imported));
            }
            Result<Baked> baked = searchBudget(query, truth, settings, plan);
            times.search_ms = watch.ms();
            return baked;
        }
        PlanReport planned = RELIEF_TRY(planMaps(query, settings));
        plan = std::move(planned);
        times.plan_ms = watch.ms();
    }
    return bakeMaps(command, mesh, settings);
}

Result<void> writePlanFile(const std::string& path, const PlanReport& plan, const Baked& baked,
                           const BakeOptions& options) {
    PlanFile file;
    file.quality = options.quality;
    file.prefer = options.prefer;
    for (std::size_t i = 0; i < plan.plan.maps.size(); ++i) {
        file.maps.push_back({baked.report.maps[i].spec, plan.plan.maps[i].reason});
    }
    const std::string text = planText(file);
    return writeFile(path, std::as_bytes(std::span(text)));
}

nlohmann::ordered_json jsonSettings(const BakeCommand& command, const BakeSettings& settings,
                                    const Backend& backend, const Baked& baked,
                                    const std::optional<PlanReport>& plan) {
    using Json = nlohmann::ordered_json;
    Json specs = Json::array();
    for (const MapReport& map : baked.report.maps) {
        specs.push_back(toString(map.spec));
    }
    const bool sized = settings.source == MapSource::kMaps || settings.source == MapSource::kPaper;
    return {{"mesh", command.mesh},
            {"output", command.output},
            {"plan_file", command.plan.empty() ? Json(nullptr) : Json(command.plan)},
            {"maps", specs},
            {"resolution", sized ? Json(settings.bake.resolution) : Json(nullptr)},
            {"budget", plan ? Json(plan->budget) : Json(nullptr)},
            {"quality", qualityName(settings.bake.quality)},
            {"prefer", preferName(settings.bake.prefer)},
            {"backend", backend.raster ? "raster" : "raycast"},
            {"backend_reason", backend.reason.empty() ? Json(nullptr) : Json(backend.reason)},
            {"device", backend.raster ? Json(backend.device) : Json(nullptr)},
            {"threads", settings.bake.threads == 0 ? tbb::info::default_concurrency()
                                                   : static_cast<int>(settings.bake.threads)},
            {"compress", settings.write.compression_level},
            {"holes", command.holes}};
}

Result<void> runBake(const BakeCommand& command) {
    startLogging(command.common);
    const Stopwatch total;
    BakeSettings settings = RELIEF_TRY(settingsOf(command));
    for (const Result<void>& ready :
         {checkImportArguments(command.import), checkMeshCare(command.care), preflight(command)}) {
        if (!ready) {
            return ready;
        }
    }
    std::string plan_hash;
    if (settings.source == MapSource::kPlanFile) {
        // Before it is read: should it change meanwhile, the hash is that of neither, or of the older one.
        const auto plan_bytes = readFile(command.plan);
        plan_hash = plan_bytes ? xxh3_128Hex(*plan_bytes) : "";
        RELIEF_TRY(readPlanFile(command, settings));
    }
    const Backend backend =
        RELIEF_TRY(chooseBackend(command.backend, command.gl,
                                 {settings.source == MapSource::kPlanner,
                                  !command.quality.empty() || settings.plan_quality.has_value(),
                                  settings.bake.quality, settings.bake.prefer}));
    settings.bake.rasterize = backend.raster;
    if (backend.raster) {
        settings.bake.quality = Quality::kFast;
    }
    // Planning and measuring keep to --threads too.
    std::optional<tbb::global_control> control;
    if (settings.bake.threads != 0) {
        control.emplace(tbb::global_control::max_allowed_parallelism, settings.bake.threads);
    }

    BakeTimes times;
    const Stopwatch import_watch;
    TriangleMesh loaded = RELIEF_TRY(importByArguments(command.mesh, command.import));
    times.import_ms = import_watch.ms();
    spdlog::debug("{}: {} triangles, {} vertices, XXH3-128 {}", loaded.name, loaded.triangles.size(),
                  loaded.positions.size(), loaded.content_hash);
    if (loaded.dropped_triangles > 0) {
        spdlog::debug("{}: {} triangles without area dropped", loaded.name, loaded.dropped_triangles);
    }

    std::optional<PreparedMesh> imported;  // only --max-error looks back
    if (settings.max_error && (command.holes == "close" || !command.care.repair.empty())) {
        imported = loaded;
    }
    MeshCareOptions care_options = command.care;
    care_options.report = command.json || !command.common.quiet;
    CaredMesh cared = RELIEF_TRY(careFor(std::move(loaded), care_options));
    PreparedMesh mesh = std::move(cared.mesh);
    if (command.holes == "close") {
        mesh = RELIEF_TRY(closeHoles(mesh));
    }
    std::optional<PlanReport> plan;
    Result<Baked> baked = makeCollider(command, imported.value_or(mesh), mesh, settings, plan, times);
    if (backend.raster) {
        backend.gl.watchdog->rest();
    }
    if (!baked) {
        return forward(baked);
    }
    // Not before: a bake that fails has one line to say.
    if (mesh->closed_holes > 0) {
        spdlog::info("{}: closed {} hole{} with {} triangles for baking: the mesh is nearly closed",
                     mesh->name, mesh->closed_holes, mesh->closed_holes == 1 ? "" : "s", mesh->cap_triangles);
    }
    if (!backend.reason.empty()) {
        spdlog::info("backend {}: {}", backend.raster ? "raster" : "raycast", backend.reason);
    }
    std::vector<std::string>& warnings = baked->report.warnings;
    warnings.insert(warnings.begin(), mesh->warnings.begin(), mesh->warnings.end());
    for (const std::string& warning : warnings) {
        spdlog::warn(warning);
    }

    if (command.holes == "keep") {
        baked->collider.provenance.options += " --holes keep";
    }
    baked->collider.provenance.options += importProvenance(command.import);
    baked->collider.provenance.options += careOptionsText(cared.care);
    const Stopwatch write_watch;
    const std::vector<std::byte> bytes = RELIEF_TRY(writeContainer(baked->collider, settings.write));
    RELIEF_TRY(writeFile(command.output, bytes));
    if (!command.plan_out.empty()) {
        RELIEF_TRY(writePlanFile(command.plan_out, *plan, *baked, settings.bake));
    }
    const std::vector<InputFile> inputs = inputsOf(command, *mesh, plan_hash);
    if (!command.depfile.empty()) {
        std::vector<std::string> names;
        for (const InputFile& input : inputs) {
            names.push_back(input.path);
        }
        RELIEF_TRY(writeDepfile(command.depfile, {command.output}, names));
    }
    times.write_ms = write_watch.ms();
    times.total_ms = total.ms();

    const BakeSummary summary{*mesh, *baked, plan, times, cared.care, command.common.verbose};
    if (command.json) {
        const ContainerInfo info = RELIEF_TRY(readContainerInfo(bytes));
        auto report = jsonBake(summary, info, jsonSettings(command, settings, backend, *baked, plan));
        for (const InputFile& input : inputs) {
            report["inputs"].push_back({{"file", input.path}, {"hash", input.hash}});
        }
        return printOut(dump(report));
    }
    if (!command.common.quiet) {
        std::fputs(bakeText(summary, command.output, bytes.size()).c_str(), stderr);
    }
    return {};
}

/// Adds the verb. \return what its options are read into.
std::shared_ptr<BakeCommand> registerBake(CLI::App& app, Action& action);

/// Whether the settings that these arguments make can be baked with.
Result<void> checkArguments(const std::vector<std::string>& arguments) {
    CLI::App app;
    Action none;
    const std::shared_ptr<BakeCommand> command = registerBake(app, none);
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    reversed.emplace_back("bake");
    try {
        app.parse(std::move(reversed));
    } catch (const CLI::ParseError& error) {
        return fail(ErrorCode::kUsage, cleanUtf8(error.what()));
    }
    const Result<BakeSettings> settings = settingsOf(*command);
    return settings ? Result<void>() : forward(settings);
}

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
    verb.add_option("MESH", command->mesh, "The mesh: OBJ, STL, PLY, OFF, glTF, FBX, COLLADA, 3DS and more")
        ->type_name("");
    verb.add_option("-o,--output", command->output, "The collider to write; - for standard output")
        ->option_text("OUT.relief");
    verb.add_option("--map", command->maps,
                    "A map to bake instead of planned ones, once for each: FORMAT[:key=value,...] with\n"
                    "FORMAT   float, fixed8, front-back or cube\n"
                    "dir      direction the view looks in: +x -x +y -y +z -z or a/b/c\n"
                    "up       direction that points upwards in the image: as dir\n"
                    "size     texels, N or WxH (cube: N)\n"
                    "compare  less or greater: keep the nearest or the farthest surface\n"
                    "center   a/b/c, where a cube looks from\n"
                    "depth    of front-back maps: unorm16, or half (the paper's)\n"
                    "decode   plane: fitted to the whole texel, or projected (the paper's)\n"
                    "box      tight, or x0/y0/z0/x1/y1/z1: the part of space to cover")
        ->option_text("SPEC")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);
    verb.add_option("--decode", command->decode,
                    "Of --map that does not say it: plane (default) or projected, the paper's")
        ->option_text("plane|projected");
    verb.add_option("--depth", command->depth,
                    "Of --map front-back that does not say it: unorm16 (default) or half, the paper's")
        ->option_text("unorm16|half");
    verb.add_flag(
        "--paper", command->paper,
        "Bake the paper's maps instead of planned ones: front-back along -x, -y and -z and a cube,\n"
        "depth=half, decode=projected");
    verb.add_option("--resolution", command->resolution,
                    "Texels along a side of --map without size, and of --paper; default 512")
        ->option_text("N");
    verb.add_option("--budget", command->budget,
                    "Plan for this many bytes of texels; default 1MB. With --max-error: use no more")
        ->option_text("BYTES");
    verb.add_option(
            "--max-error", command->max_error,
            "Plan for the least bytes (32kB to 64MB) that leave at most this share of the points near\n"
            "the surface, in percent, on the wrong side; measured as by relief check, on 50000 points.\n"
            "Exit with 7, and write nothing, if none do")
        ->option_text("PCT");
    verb.add_option("--plan-out", command->plan_out,
                    "Also write what was planned, as TOML, to be changed and given to --plan")
        ->option_text("FILE");
    verb.add_option("--plan", command->plan, "Bake the maps of such a file")->option_text("FILE");
    verb.add_option("--quality", command->quality,
                    "Of planes: fast (one ray a texel), normal (16 rays, default) or best (36).\n"
                    "With --plan, the file's by default")
        ->option_text("fast|normal|best");
    verb.add_option("--prefer", command->prefer,
                    "Where planes must err: inside keeps particles out of walls, outside keeps free\n"
                    "space free, neither (default) errs least")
        ->option_text("inside|outside|neither");
    verb.add_option(
            "-j,--threads", command->threads,
            "Threads to use; default: all cores. The result is the same. With --recipe: assets at once")
        ->option_text("N");
    verb.add_option("--compress", command->compress, "zstd level of the texels, 0 (none, default) to 19")
        ->option_text("LEVEL");
    verb.add_option("--holes", command->holes,
                    "Of a nearly closed mesh: close (bake it as a solid, default) or keep")
        ->option_text("close|keep");
    addBackendOptions(verb, command->backend);
    addGlOptions(verb, command->gl);
    addImportOptions(verb, command->import);
    addMeshCareOptions(verb, command->care);
    verb.add_flag("--json", command->json, "Print a report as JSON to standard output");
    verb.add_option("--depfile", command->depfile,
                    "Also write which files were read, for Make and Ninja: every input of the output")
        ->option_text("FILE");
    addRecipeOptions(verb, command->recipe);
    verb.callback([command, &verb, &action] {
        action = [command, &verb]() -> Result<void> {
            if (!command->recipe.recipe.empty()) {
                return runRecipeCommand(command->recipe,
                                        {verb, command->common, command->output, command->threads,
                                         command->depfile, command->json, checkArguments});
            }
            const Result<void> complete = checkOneBake(verb);
            return complete ? runBake(*command) : complete;
        };
    });
    return command;
}

}  // namespace

void addBake(CLI::App& app, Action& action) {
    registerBake(app, action);
}

}  // namespace relief
