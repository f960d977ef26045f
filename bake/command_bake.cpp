// relief bake: a mesh becomes a collider.
#include <spdlog/spdlog.h>
#include <tbb/info.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <optional>
#include <span>

#include "bake/bake.h"
#include "bake/byte_count.h"
#include "bake/command.h"
#include "bake/mesh_import.h"
#include "bake/mesh_query.h"
#include "bake/preflight.h"
#include "bake/progress.h"
#include "bake/report.h"
#include "bake/text.h"
#include "bake/view_planner.h"
#include "formats/file_io.h"

namespace relief {
namespace {

constexpr std::uint64_t kThreadsMax = 1024;
constexpr std::uint64_t kCompressionMax = 19;

struct BakeCommand {
    CommonOptions common;
    std::string mesh;
    std::string output;
    std::vector<std::string> maps;
    std::string resolution = "512";
    std::string budget;
    std::string decode;
    std::string depth;
    std::string quality = "normal";
    std::string threads;
    std::string compress = "0";
    bool json = false;
};

struct Settings {
    BakeOptions bake;
    std::optional<std::uint64_t> budget;  ///< bytes of texels to plan for
    ContainerWriteOptions write;
};

struct Times {
    double import_ms = 0.0;
    double plan_ms = 0.0;
    double write_ms = 0.0;
    double total_ms = 0.0;
};

class Stopwatch {
  public:
    [[nodiscard]] double ms() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// One of some words, or the error that lists them. \return its index.
Result<std::size_t> wordOf(const std::string& option, const std::string& value,
                           std::span<const std::string_view> words) {
    const auto found = std::find(words.begin(), words.end(), value);
    if (found == words.end()) {
        return fail(ErrorCode::kUsage, option + " is '" + cleanUtf8(value) + "' but must be one of " +
                                           listed(words) + didYouMean(value, words));
    }
    return static_cast<std::size_t>(found - words.begin());
}

Result<void> readPlanSettings(const BakeCommand& command, Settings& settings) {
    if (!command.budget.empty()) {
        if (!command.maps.empty()) {
            return fail(ErrorCode::kUsage,
                        "--budget chooses the maps by itself; leave out --budget or --map");
        }
        settings.budget = parseByteCount(command.budget);
        if (!settings.budget) {
            return fail(ErrorCode::kUsage, "--budget is '" + cleanUtf8(command.budget) +
                                               "' but must be a number of bytes, such as 1MB or 512KiB");
        }
    }
    constexpr std::array<std::string_view, 3> kQualities = {"fast", "normal", "best"};
    const Result<std::size_t> quality = wordOf("--quality", command.quality, kQualities);
    if (!quality) {
        return forward(quality);
    }
    settings.bake.quality = static_cast<Quality>(*quality);
    return {};
}

/// What --decode and --depth make of maps that do not say it themselves.
Result<MapSpecDefaults> mapDefaults(const BakeCommand& command) {
    constexpr std::array<std::string_view, 2> kDecodes = {"projected", "plane"};
    constexpr std::array<std::string_view, 2> kDepths = {"half", "unorm16"};
    MapSpecDefaults defaults;
    if (!command.decode.empty()) {
        const Result<std::size_t> decode = wordOf("--decode", command.decode, kDecodes);
        if (!decode) {
            return forward(decode);
        }
        defaults.decode = *decode == 0 ? Decode::kProjected : Decode::kPlane;
    }
    if (!command.depth.empty()) {
        const Result<std::size_t> depth = wordOf("--depth", command.depth, kDepths);
        if (!depth) {
            return forward(depth);
        }
        defaults.front_back = *depth == 0 ? MapFormat::kFrontBackHalf : MapFormat::kFrontBackFixed;
    }
    if (command.maps.empty() && !(command.decode.empty() && command.depth.empty())) {
        return fail(ErrorCode::kUsage, std::string(command.decode.empty() ? "--depth" : "--decode") +
                                           " does nothing without --map; leave it out");
    }
    return defaults;
}

Result<Settings> settingsOf(const BakeCommand& command) {
    Settings settings;
    if (const Result<void> plan = readPlanSettings(command, settings); !plan) {
        return forward(plan);
    }
    const Result<MapSpecDefaults> defaults = mapDefaults(command);
    if (!defaults) {
        return forward(defaults);
    }
    for (const std::string& text : command.maps) {
        const Result<MapSpec> spec = parseMapSpec(text, *defaults);
        if (!spec) {
            return forward(spec);
        }
        settings.bake.maps.push_back(*spec);
    }
    const Result<std::uint64_t> resolution = parseCount(command.resolution, "--resolution");
    if (!resolution) {
        return forward(resolution);
    }
    const Result<std::uint32_t> texels = checkMapSize(*resolution, MapFormat::kFrontBackHalf, "--resolution");
    if (!texels) {
        return forward(texels);
    }
    settings.bake.resolution = *texels;
    if (!command.threads.empty()) {
        const Result<std::uint64_t> threads = parseCount(command.threads, "--threads");
        if (!threads) {
            return forward(threads);
        }
        if (*threads < 1 || *threads > kThreadsMax) {
            return fail(ErrorCode::kUsage, "--threads must be 1 to " + std::to_string(kThreadsMax));
        }
        settings.bake.threads = static_cast<unsigned>(*threads);
    }
    const Result<std::uint64_t> level = parseCount(command.compress, "--compress");
    if (!level) {
        return forward(level);
    }
    if (*level > kCompressionMax) {
        return fail(ErrorCode::kUsage,
                    "--compress must be 0 (none) to " + std::to_string(kCompressionMax) + " (smallest)");
    }
    settings.write.compression_level = static_cast<int>(*level);
    if (command.json && command.output == "-") {
        return fail(ErrorCode::kUsage, "--json and -o - both want standard output; give -o a file");
    }
    return settings;
}

std::string percent(const MapReport& map) {
    char text[16];
    std::snprintf(text, sizeof(text), "%.1f %%",
                  100.0 * static_cast<double>(map.covered) / static_cast<double>(map.texels));
    return text;
}

std::string sizeText(const DepthMap& map) {
    const std::string size = std::to_string(map.width) + "x" + std::to_string(map.height);
    return map.faceCount() == 1 ? size : std::to_string(map.faceCount()) + "x" + size;
}

void printReport(const TriangleMesh& mesh, const Baked& baked, const Times& times, std::size_t file_size,
                 const std::string& output) {
    std::vector<std::vector<std::string>> rows = {
        {"map", "format", "projection", "keeps", "size>", "bytes>", "covered>", "spec"}};
    for (std::size_t i = 0; i < baked.collider.maps.size(); ++i) {
        const DepthMap& map = baked.collider.maps[i];
        const MapReport& report = baked.report.maps[i];
        rows.push_back({std::to_string(i), mapFormatName(map.format),
                        map.projection() == Projection::kCube ? "cube" : "orthographic",
                        compareName(map.compare), sizeText(map), bytesText(map.texelBytes()), percent(report),
                        toString(report.spec)});
    }
    std::string text = mesh.name + ": " + std::to_string(mesh.triangles.size()) + " triangles";
    if (mesh.dropped_triangles > 0) {
        text += ", " + std::to_string(mesh.dropped_triangles) + " without area dropped";
    }
    text += "\n" + table(rows);
    char line[256];
    std::snprintf(
        line, sizeof(line),
        "%.0f ms: import %.0f, plan %.0f, tree %.0f, rays %.0f, texels %.0f, planes %.0f, writing %.0f\n",
        times.total_ms, times.import_ms, times.plan_ms, baked.report.build_ms, baked.report.trace_ms,
        baked.report.encode_ms, baked.report.fit_ms, times.write_ms);
    text += line;
    text += (output == "-" ? "standard output" : quotedPath(output)) + ": " + bytesText(file_size) + "\n";
    std::fputs(text.c_str(), stderr);
}

nlohmann::ordered_json jsonReport(const BakeCommand& command, const Settings& settings,
                                  const TriangleMesh& mesh, const Baked& baked, const Times& times,
                                  const ContainerInfo& info) {
    nlohmann::ordered_json json = jsonCollider(baked.collider, info);
    nlohmann::ordered_json specs = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < baked.report.maps.size(); ++i) {
        const MapReport& map = baked.report.maps[i];
        specs.push_back(toString(map.spec));
        json["maps"][i]["coverage"] = static_cast<double>(map.covered) / static_cast<double>(map.texels);
    }
    json["settings"] = {{"mesh", command.mesh},
                        {"output", command.output},
                        {"maps", specs},
                        {"resolution", settings.bake.resolution},
                        {"budget", settings.budget ? nlohmann::ordered_json(*settings.budget) : nullptr},
                        {"quality", qualityName(settings.bake.quality)},
                        {"threads", settings.bake.threads == 0 ? tbb::info::default_concurrency()
                                                               : static_cast<int>(settings.bake.threads)},
                        {"compress", settings.write.compression_level}};
    json["dropped_triangles"] = mesh.dropped_triangles;
    json["times_ms"] = {{"import", times.import_ms},        {"plan", times.plan_ms},
                        {"build", baked.report.build_ms},   {"trace", baked.report.trace_ms},
                        {"encode", baked.report.encode_ms}, {"fit", baked.report.fit_ms},
                        {"write", times.write_ms},          {"total", times.total_ms}};
    json["warnings"] = baked.report.warnings;
    return json;
}

/// Chooses the maps for the budget, and says why.
Result<void> planMaps(const TriangleMesh& mesh, Settings& settings) {
    const Result<MeshQuery> query = MeshQuery::build(mesh);
    if (!query) {
        return forward(query);
    }
    PlanOptions options;
    options.budget_bytes = *settings.budget;
    const Result<Plan> plan = planViews(mesh, *query, options);
    if (!plan) {
        return forward(plan);
    }
    for (const PlannedMap& map : plan->maps) {
        spdlog::info("map {}: {}", settings.bake.maps.size(), map.reason);
        settings.bake.maps.push_back(map.spec);
    }
    spdlog::info("{} maps, {}, texels of {:.3g} object units; no map sees {:.2f} % of the surface",
                 plan->maps.size(), bytesText(plan->bytes), plan->texel, plan->unseen_percent);
    return {};
}

Result<void> runBake(const BakeCommand& command) {
    startLogging(command.common);
    const Stopwatch total;
    Result<Settings> settings = settingsOf(command);
    if (!settings) {
        return forward(settings);
    }
    for (const Result<void>& ready :
         {preflightFile(command.output), preflightDistinct(command.mesh, command.output)}) {
        if (!ready) {
            return ready;
        }
    }

    Times times;
    const Stopwatch import_watch;
    const Result<TriangleMesh> mesh = importMesh(command.mesh);
    times.import_ms = import_watch.ms();
    if (!mesh) {
        return forward(mesh);
    }
    spdlog::debug("{}: {} triangles, {} vertices, XXH3-128 {}", mesh->name, mesh->triangles.size(),
                  mesh->positions.size(), mesh->content_hash);
    if (mesh->dropped_triangles > 0) {
        spdlog::debug("{}: {} triangles without area dropped", mesh->name, mesh->dropped_triangles);
    }

    if (settings->budget) {
        const Stopwatch plan_watch;
        if (const Result<void> planned = planMaps(*mesh, *settings); !planned) {
            return planned;
        }
        times.plan_ms = plan_watch.ms();
    }
    std::optional<Result<Baked>> baked;
    {
        ProgressBar bar("baking " + mesh->name, !command.common.quiet);
        settings->bake.progress = [&bar](double share) { bar.set(share); };
        baked.emplace(bake(*mesh, settings->bake));
    }
    if (!*baked) {
        return forward(*baked);
    }
    for (const std::string& warning : (*baked)->report.warnings) {
        spdlog::warn(warning);
    }

    const Stopwatch write_watch;
    const Result<std::vector<std::byte>> bytes = writeContainer((*baked)->collider, settings->write);
    if (!bytes) {
        return forward(bytes);
    }
    if (const Result<void> written = writeFile(command.output, *bytes); !written) {
        return written;
    }
    times.write_ms = write_watch.ms();
    times.total_ms = total.ms();

    if (command.json) {
        const Result<ContainerInfo> info = readContainerInfo(*bytes);
        if (!info) {
            return forward(info);
        }
        return printOut(dump(jsonReport(command, *settings, *mesh, **baked, times, *info)));
    }
    if (!command.common.quiet) {
        printReport(*mesh, **baked, times, bytes->size(), command.output);
    }
    return {};
}

}  // namespace

void addBake(CLI::App& app, Action& action) {
    auto command = std::make_shared<BakeCommand>();
    CLI::App& verb =
        addVerb(app, command->common, "bake", "Bakes a mesh into a collider",
                "relief bake bunny.obj -o bunny.relief\n"
                "relief bake rock.glb -o rock.relief --map cube:size=256 --map fixed8:dir=-y,size=512x256\n"
                "relief bake hall.fbx -o hall.relief --map cube:center=0/2/0,compare=less --json");
    verb.add_option("MESH", command->mesh, "The mesh, in any format that assimp reads")
        ->type_name("")
        ->required();
    verb.add_option("-o,--output", command->output, "The collider to write; - for standard output")
        ->option_text("OUT.relief")
        ->required();
    verb.add_option("--map", command->maps,
                    "A map to bake, once for each: FORMAT[:key=value,...] with\n"
                    "FORMAT   float, fixed8, front-back or cube\n"
                    "dir      direction the view looks in: +x -x +y -y +z -z or a/b/c\n"
                    "up       direction that points upwards in the image: as dir\n"
                    "size     texels, N or WxH (cube: N)\n"
                    "compare  less or greater: keep the nearest or the farthest surface\n"
                    "center   a/b/c, where a cube looks from\n"
                    "depth    of front-back maps: unorm16, or half (the paper's)\n"
                    "decode   plane: fitted to the whole texel, or projected (the paper's)\n"
                    "box      tight, or x0/y0/z0/x1/y1/z1: the part of space to cover\n"
                    "Default: front-back along -x, -y and -z, and a cube")
        ->option_text("SPEC")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);
    verb.add_option("--decode", command->decode,
                    "Of maps that do not say it: plane (default) or projected, the paper's")
        ->option_text("WORD");
    verb.add_option("--depth", command->depth,
                    "Of front-back maps that do not say it: unorm16 (default) or half, the paper's")
        ->option_text("WORD");
    verb.add_option("--resolution", command->resolution,
                    "Texels along a side of maps without size; default 512")
        ->option_text("N");
    verb.add_option("--budget", command->budget,
                    "Choose the maps for this many bytes, such as 1MB: directions, places and sizes")
        ->option_text("BYTES");
    verb.add_option("--quality", command->quality,
                    "Of planes: fast (one ray a texel), normal (16 rays, default) or best (36)")
        ->option_text("WORD");
    verb.add_option("-j,--threads", command->threads,
                    "Threads to use; default: all cores. The result is the same")
        ->option_text("N");
    verb.add_option("--compress", command->compress, "zstd level of the texels, 0 (none, default) to 19")
        ->option_text("LEVEL");
    verb.add_flag("--json", command->json, "Print a report as JSON to standard output");
    verb.callback([command, &action] { action = [command] { return runBake(*command); }; });
}

}  // namespace relief
