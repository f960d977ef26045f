// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <set>
#include <thread>
#include <tuple>

#include "bake/cli/command_bake.h"
#include "bake/import/animated_import.h"
#include "bake/import/import_format.h"
#include "bake/import/level.h"
#include "bake/import/mesh_import.h"
#include "bake/recipe/bake_cache.h"
#include "bake/recipe/child_process.h"
#include "bake/recipe/recipe_run.h"
#include "bake/report/recipe_report.h"
#include "bake/verdict/report_text.h"
#include "bake/world/world_bake.h"
#include "formats/base/file_io.h"
#include "formats/base/stopwatch.h"
#include "formats/base/text.h"
#include "formats/fields/json.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kShardsMax = 1'000'000;
constexpr std::string_view kClips = "--clips=";
constexpr std::string_view kHeights = "--heights=";

/// Options that apply to the whole run, and are therefore not keys of recipes.
constexpr std::array<std::string_view, 3> kRunOptions = {"threads", "json", "depfile"};

/// Returns an error if an option is set that belongs in the recipe.
Result<void> checkOptions(const CLI::App& verb) {
    const std::vector<RecipeKey> keys = recipeKeys();
    for (const GivenOption& option : givenOptions(verb)) {
        const std::vector<std::string>& names = option.long_names;
        if (names.empty()) {
            return fail(ErrorCode::kUsage, option.name + " and --recipe both name meshes; remove one");
        }
        if (std::ranges::find(keys, names[0], &RecipeKey::name) != keys.end()) {
            return fail(ErrorCode::kUsage, "--" + names[0] + " has no effect with --recipe; write " +
                                               names[0] + " = … under [defaults] in the recipe");
        }
    }
    return {};
}

/// Checks that a bake accepts these options.
Result<void> checkAsset(const RecipeOptions& options, bool is_world) {
    BakeRequest request;
    BakeOutputs outputs;
    for (const auto& [key, value] : options) {
        std::string name = key;
        std::ranges::replace(name, '-', '_');
        for (const std::string& text : value.values) {
            const std::string& word = text.empty() ? "true" : text;
            RELIEF_TRY(name == "compress" ? setField(outputs, name, word) : setField(request, name, word));
        }
    }
    static_cast<void>(RELIEF_TRY(settingsOf(request)));
    return is_world ? checkWorldRequest(request) : Result<void>();
}

/// Checks every distinct set of options before the first bake.
Result<void> checkAssets(const std::vector<RecipeAsset>& assets) {
    std::set<std::pair<bool, std::vector<std::string>>> known;
    for (const RecipeAsset& asset : assets) {
        if (!known.emplace(asset.isWorld(), recipeArguments(asset.options)).second) {
            continue;
        }
        if (const Result<void> fits = checkAsset(asset.options, asset.isWorld()); !fits) {
            const Error& error = fits.error();
            RecipePlace place = asset.place;
            for (const auto& [name, value] : asset.options) {
                if (error.message.starts_with("--" + name + " ")) {
                    place = value.place;
                }
            }
            return fail(error.code == ErrorCode::kUsage ? ErrorCode::kInvalidInput : error.code,
                        place + ": " + nameKeys(error.message, recipeKeys()));
        }
    }
    return {};
}

/// "2/4"
std::optional<Shard> parseShard(const std::string& text) {
    const std::vector<std::string_view> parts = split(text, '/');
    const auto index = parts.size() == 2 ? parseUnsigned(parts[0]) : std::nullopt;
    const auto count = parts.size() == 2 ? parseUnsigned(parts[1]) : std::nullopt;
    if (!index || !count || *index < 1 || *index > *count || *count > kShardsMax) {
        return std::nullopt;
    }
    return Shard{*index, *count};
}

/// Checks the files that are written in addition to the outputs.
Result<void> preflight(const BakeCommand& command, const RecipeRun& run, FileGuard& files) {
    const BakeRecipeOptions& options = command.recipe;
    const BakeOutputs& outputs = command.outputs;
    for (const std::string& file : {options.stamp, outputs.depfile}) {
        if (file == "-") {
            return fail(ErrorCode::kUsage, "--stamp and --depfile cannot be standard output; name a file");
        }
    }
    const fs::path made = run.dry_run ? fs::path() : run.output_folder;
    RELIEF_TRY(files.keeps(run.output_folder / kBakeCacheName, "--output (the recipe's cache)"));
    if (outputs.json || (run.dry_run && options.events != "-")) {
        RELIEF_TRY(files.writes("-", outputs.json ? "--json" : "the list of --dry-run"));
    }
    RELIEF_TRY(files.writes(options.stamp, "--stamp", made));
    RELIEF_TRY(files.writes(outputs.depfile, "--depfile", made));
    RELIEF_TRY(files.writes(options.events, "--events", made));
    return run.dry_run ? Result<void>() : preflightFolder(run.output_folder, "--output");
}

/// The error of the whole run, if any asset failed.
Result<void> verdict(const std::vector<AssetResult>& assets, const RecipeCounts& counts) {
    for (const AssetResult& asset : assets) {
        if (asset.state == AssetState::kFailed) {
            return fail(asset.error.code, std::to_string(counts.of(AssetState::kFailed)) + " of " +
                                              std::to_string(counts.all()) + " assets failed, first " +
                                              quotedPath(asset.job.output) +
                                              "; fix the errors above and run the recipe again");
        }
    }
    return {};
}

struct RecipeWork {
    RecipeRun run;
    std::vector<RecipeJob> jobs;    ///< jobs of the shard
    std::vector<fs::path> folders;  ///< folders that patterns searched
    FileGuard files;                ///< all files that are read and written, also by other shards
};

/// Reads the recipe and plans the run, without writing anything.
Result<RecipeWork> plan(const BakeCommand& command, const CLI::App& verb, const FileGuard& files) {
    RecipeWork work;
    RecipeRun& run = work.run;
    RELIEF_TRY(checkOptions(verb));
    if (command.output == "-") {
        return fail(ErrorCode::kUsage,
                    "--output is a folder with --recipe, and cannot be standard output; name a folder");
    }
    const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
    run.recipe = command.recipe.recipe;
    run.output_folder = command.output.empty() ? recipeFolder(run.recipe) : fs::path(command.output);
    run.dry_run = command.recipe.dry_run;
    run.keys = recipeKeys();
    run.jobs = command.request.threads.value_or(cores);
    const std::vector<RecipeAsset> assets = RELIEF_TRY(loadRecipe(run.recipe, run.keys));
    RELIEF_TRY(checkAssets(assets));
    RecipeJobs all = RELIEF_TRY(recipeJobs(assets, run.recipe, run.output_folder, files));
    work.folders = std::move(all.folders);
    work.files = std::move(all.files);
    const Shard shard = command.recipe.shard.value_or(Shard{});
    std::ranges::copy_if(all.jobs, std::back_inserter(work.jobs),
                         [&](const RecipeJob& job) { return inShard(job.output, shard); });
    RELIEF_TRY(preflight(command, run, work.files));
    run.threads =
        std::max(1U, cores / std::max(1U, std::min(run.jobs, static_cast<unsigned>(work.jobs.size()))));
    return work;
}

/// Bakes the assets that are not up to date, and prints a line for each.
Result<RecipeResult> bakeAll(RecipeWork& work, bool shown, RecipeEvents& events) {
    RecipeRun run = work.run;
    std::size_t done = 0;
    run.started = [&](const AssetResult& asset) {
        events.write(AssetEvent{{asset, true}});
        spdlog::debug("{}: {}", cleanUtf8(asset.job.output), asset.reason);
    };
    run.ended = [&, all = work.jobs.size()](const AssetResult& asset) {
        events.write(AssetEvent{{asset, true}});
        ++done;
        const std::string name = cleanUtf8(asset.job.output);
        if (asset.state == AssetState::kFailed) {
            spdlog::error("{}: {}", name, asset.error.message);
        } else if (shown && asset.state == AssetState::kBaked) {
            std::fprintf(stderr, "[%zu/%zu] %s: %s\n", done, all, name.c_str(), bakedText(asset).c_str());
        }
    };
    run.warn = [](const std::string& warning) { spdlog::warn(warning); };
    Result<RecipeResult> result = runRecipe(std::move(work.jobs), run);
    if (result) {
        logWarnings(warningLines(result->assets));
    }
    return result;
}

/// Returns whether a bake reads only one file: a height map, or a mesh whose format never references other files.
bool readsOneFile(const RecipeJob& job) {
    if (std::ranges::any_of(job.options, [](const auto& word) { return word.starts_with(kHeights); })) {
        return true;
    }
    const std::string extension = job.mesh_path.extension().string();
    const MeshFormat* const format = extension.empty() ? nullptr : meshFormat(extension.substr(1));
    return !job.mesh_is_folder && format != nullptr && format->whole;
}

/// Returns the file that was read, and the files that it refers to; empty if `from` is null.
/// \param from  an import with dependencies and their hashes
std::vector<InputFile> filesOf(const auto* from, const fs::path& folder) {
    std::vector<InputFile> files;
    for (std::size_t i = 0; from != nullptr && i < from->dependencies.size(); ++i) {
        files.push_back({pathFromRecipe(from->dependencies[i], folder), from->dependency_hashes[i]});
    }
    return files;
}

/// Returns the mesh and all files that it refers to; empty if they cannot be read.
std::vector<InputFile> filesOfMesh(const RecipeJob& job, const fs::path& folder) {
    const bool one_file = readsOneFile(job);
    const std::optional<std::string> hash =
        one_file || job.mesh_is_folder ? hashOfInput(job.mesh_path) : std::nullopt;
    if (one_file) {
        return hash ? std::vector<InputFile>{{job.mesh, *hash}} : std::vector<InputFile>();
    }
    std::vector<InputFile> files;
    if (job.world) {
        const Result<Level> level = importLevel(job.mesh_path);
        files = filesOf(level ? &*level : nullptr, folder);
    } else {
        const Result<TriangleMesh> mesh = importMeshInWorker(job.mesh_path);
        files = filesOf(mesh ? &*mesh : nullptr, folder);
    }
    if (files.empty() || (job.mesh_is_folder && !hash)) {
        return {};
    }
    if (job.mesh_is_folder) {
        files.insert(files.begin(), {job.mesh, *hash});
    }
    files.front().path = job.mesh;
    return files;
}

/// Computes the keys of the assets of a dry run. It reads each mesh that may refer to other files once. An asset has no
/// key if its mesh cannot be read.
Result<void> addKeys(std::vector<AssetResult>& assets, const RecipeRun& run) {
    const std::string tool = RELIEF_TRY(toolIdentity());
    const fs::path folder = recipeFolder(run.recipe);
    std::map<std::tuple<std::string, bool, bool>, std::vector<InputFile>> known;
    for (AssetResult& asset : assets) {
        const RecipeJob& job = asset.job;
        if (!asset.key.empty()) {
            continue;
        }
        const auto [mesh, is_new] = known.try_emplace({job.mesh, job.world, readsOneFile(job)});
        if (is_new) {
            mesh->second = filesOfMesh(job, folder);
        }
        std::vector<InputFile> files = mesh->second;
        bool all_read = !files.empty();
        for (const std::string& argument : job.arguments) {
            if (all_read && argument.starts_with(kClips)) {
                const Result<AnimatedImport> clips = importAnimatedFileInWorker(
                    argument.substr(kClips.size()), ImportKind::kClips, {}, ImportLimits());
                std::ranges::move(filesOf(clips ? &clips->rest : nullptr, folder), std::back_inserter(files));
                all_read = clips.has_value();
            }
        }
        asset.key = all_read ? assetKey(tool, job.options, std::move(files)) : "";
    }
    return {};
}

/// Prints the report or list of the run to standard output.
Result<void> printResult(const BakeCommand& command, const RecipeRun& run, const RecipeResult& result,
                         double ms) {
    const BakeRecipeOptions& options = command.recipe;
    if (command.outputs.json) {
        return printOut(jsonTextOf(RecipeJson{options.recipe, run.output_folder.string(), options.shard,
                                              countAssets(result.assets), ms,
                                              viewsOf<AssetReport>(result.assets, false)}));
    }
    if (!options.dry_run || options.events == "-") {
        return {};
    }
    std::vector<std::vector<std::string>> rows = {{"output", "mesh", "why"}};
    for (const AssetResult& asset : result.assets) {
        rows.push_back({cleanUtf8(asset.job.output), cleanUtf8(asset.job.mesh),
                        asset.reason.empty() ? "up to date" : asset.reason});
    }
    return printOut(table(rows));
}

/// Writes the files for build systems, after everything is up to date.
Result<void> writeFiles(const BakeCommand& command, RecipeWork& work,
                        const std::vector<AssetResult>& assets) {
    const BakeRecipeOptions& options = command.recipe;
    const std::string& depfile = command.outputs.depfile;
    if (depfile.empty() && options.stamp.empty()) {
        return {};
    }
    // The files that a mesh references are known only after its bake.
    for (const AssetResult& asset : assets) {
        for (const InputFile& input : asset.inputs) {
            RELIEF_TRY(work.files.reads(recipeFolder(options.recipe) / input.path));
        }
    }
    if (!depfile.empty()) {
        const std::vector<std::string> beside = {options.stamp, depfile, options.events};
        RELIEF_TRY(writeRecipeDepfile(depfile, options.stamp, beside, work.run, work.folders, assets));
    }
    return options.stamp.empty() ? Result<void>() : writeRecipeStamp(options.stamp, assets);
}

}  // namespace

std::vector<RecipeKey> recipeKeys() {
    std::vector<FieldWords> all = fieldsOf(BakeRequest());
    std::ranges::move(fieldsOf(BakeOutputs()), std::back_inserter(all));
    std::vector<RecipeKey> keys;
    for (const FieldWords& field : all) {
        if (std::ranges::find(kRunOptions, field.name) == kRunOptions.end()) {
            keys.push_back({optionName(field.name).substr(2), field.kind});
        }
    }
    return keys;
}

void addRecipeOptions(CLI::App& verb, BakeRecipeOptions& options) {
    OptionRef recipe = addOption(verb, "--recipe", options.recipe,
                                 withDetails("Bake the assets of this TOML file that are out of date",
                                             "Each bake runs in its own process; -j sets how many run at "
                                             "once. Set the options of bakes as keys in the recipe."));
    recipe->valueText("FILE");
    addParsed(verb, "--shard", options.shard, parseShard, "K/N with 1 <= K <= N, such as 2/4",
              "Bake only part K of N of the recipe; the parts may run at the same time")
        ->valueText("K/N")
        ->needs(recipe);
    addOption(verb, "--events", options.events,
              "Write the events of the recipe's run as JSON lines; - for standard output")
        ->valueText("FILE")
        ->needs(recipe);
    addOption(verb, "--stamp", options.stamp,
              withDetails("Write this file once all assets of the recipe are up to date",
                          "--depfile names this file as its target."))
        ->valueText("FILE")
        ->needs(recipe);
    addFlag(verb, "--dry-run", options.dry_run, "Print what the recipe would bake and why, without baking")
        ->needs(recipe);
}

Result<void> runRecipeCommand(const BakeCommand& command, const CLI::App& verb, FileGuard& files) {
    const Stopwatch watch;
    const BakeRecipeOptions& options = command.recipe;
    RecipeWork work = RELIEF_TRY(plan(command, verb, files));
    RecipeEvents events;
    if (!options.events.empty()) {
        RELIEF_TRY(events.open(options.events));
    }
    events.write(RecipeStart{options.recipe, work.jobs.size(), options.shard, work.run.jobs});
    RecipeResult result = RELIEF_TRY(bakeAll(work, !command.common.quiet && !options.dry_run, events));
    if (options.dry_run && command.outputs.json) {
        RELIEF_TRY(addKeys(result.assets, work.run));
    }
    const RecipeCounts counts = countAssets(result.assets);
    const double ms = watch.ms();
    events.write(RecipeEnd{counts, ms, result.signal});
    if (!command.common.quiet) {
        std::fputs((recipeSummary(counts, ms) + "\n").c_str(), stderr);
    }
    if (result.signal != 0) {
        ChildProcesses::endBySignal(result.signal);
    }
    RELIEF_TRY(printResult(command, work.run, result, ms));
    RELIEF_TRY(verdict(result.assets, counts));
    if (options.dry_run) {
        return {};
    }
    RELIEF_TRY(writeFiles(command, work, result.assets));
    return events.finish();
}

}  // namespace relief
