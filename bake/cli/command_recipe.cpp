#include "bake/cli/command_recipe.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <thread>

#include "bake/cli/preflight.h"
#include "bake/recipe/child_process.h"
#include "bake/recipe/recipe_run.h"
#include "bake/recipe/recipe_stamp.h"
#include "bake/report/recipe_report.h"
#include "bake/report/report.h"
#include "formats/base/file_io.h"
#include "formats/base/stopwatch.h"
#include "formats/base/text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t kAtOnceMax = 1024;
constexpr std::uint64_t kShardsMax = 1'000'000;
constexpr double kTimeoutDefault = 3600.0;  // seconds
constexpr double kTimeoutMax = 1e7;

/// What speaks of a whole run, and not of what an asset is: no keys of a recipe.
constexpr std::array<std::string_view, 17> kOfTheRun = {
    "list-devices", "help",   "quiet", "verbose", "output",  "threads",   "json",       "depfile", "plan-out",
    "recipe",       "events", "shard", "stamp",   "timeout", "fail-fast", "keep-going", "dry-run"};

std::vector<RecipeKey> recipeKeys(const CLI::App& verb) {
    std::vector<RecipeKey> keys;
    for (const CLI::Option* option : verb.get_options()) {
        const std::vector<std::string>& names = option->get_lnames();
        if (names.empty() || std::find(kOfTheRun.begin(), kOfTheRun.end(), names[0]) != kOfTheRun.end()) {
            continue;
        }
        const bool list = option->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
        keys.push_back({names[0], option->get_expected_max() == 0 ? RecipeKey::Kind::kFlag
                                  : list                          ? RecipeKey::Kind::kList
                                                                  : RecipeKey::Kind::kValue});
    }
    return keys;
}

/// Options that a recipe has its own place for.
Result<void> checkOptions(const RecipeCall& call) {
    for (const CLI::Option* option : call.verb.get_options()) {
        if (option->count() == 0) {
            continue;
        }
        const std::vector<std::string>& names = option->get_lnames();
        if (names.empty()) {
            return fail(ErrorCode::kUsage,
                        option->get_name() + " and --recipe are two ways to name meshes; leave one out");
        }
        if (names[0] == "plan-out") {
            return fail(ErrorCode::kUsage, "--plan-out is for one mesh; leave it out beside --recipe");
        }
        if (std::find(kOfTheRun.begin(), kOfTheRun.end(), names[0]) == kOfTheRun.end()) {
            return fail(ErrorCode::kUsage, "--" + names[0] + " does nothing beside --recipe; write " +
                                               names[0] + " = … under [defaults] in the recipe");
        }
    }
    return {};
}

/// Every different set of options is tried before anything is baked.
Result<void> checkAssets(const std::vector<RecipeAsset>& assets, const RecipeCall& call) {
    std::set<std::vector<std::string>> known;
    for (const RecipeAsset& asset : assets) {
        std::vector<std::string> arguments = recipeArguments(asset.options);
        if (known.contains(arguments)) {
            continue;
        }
        if (const Result<void> fits = call.check(arguments); !fits) {
            const Error& error = fits.error();
            RecipePlace place = asset.place;
            for (const auto& [name, value] : asset.options) {
                if (error.message.starts_with("--" + name + " ")) {
                    place = value.place;
                }
            }
            return fail(error.code == ErrorCode::kUsage ? ErrorCode::kInvalidInput : error.code,
                        place + ": " + error.message);
        }
        known.insert(std::move(arguments));
    }
    return {};
}

Result<Shard> parseShard(const std::string& text) {
    Shard shard;
    if (text.empty()) {
        return shard;
    }
    const std::vector<std::string_view> parts = split(text, '/');
    const auto index = parts.size() == 2 ? parseUnsigned(parts[0]) : std::nullopt;
    const auto count = parts.size() == 2 ? parseUnsigned(parts[1]) : std::nullopt;
    if (!index || !count || *index < 1 || *index > *count || *count > kShardsMax) {
        return fail(ErrorCode::kUsage,
                    "--shard is '" + cleanUtf8(text) + "' but must be K/N with 1 <= K <= N, such as 2/4");
    }
    shard.index = *index;
    shard.count = *count;
    return shard;
}

Result<RecipeRun> runOf(const RecipeOptionsOfBake& options, const RecipeCall& call) {
    RecipeRun run;
    run.recipe = options.recipe;
    run.output_folder = call.output.empty() ? recipeFolder(options.recipe) : fs::path(call.output);
    run.fail_fast = options.fail_fast;
    run.dry_run = options.dry_run;
    run.seconds_max = kTimeoutDefault;
    if (!options.timeout.empty()) {
        const std::optional<float> seconds = parseFloat(options.timeout);
        if (!seconds || *seconds < 0.0F || double{*seconds} > kTimeoutMax) {
            return fail(ErrorCode::kUsage, "--timeout is '" + cleanUtf8(options.timeout) +
                                               "' but must be a number of seconds, 0 for any");
        }
        run.seconds_max = double{*seconds};
    }
    run.at_once = std::max(1U, std::thread::hardware_concurrency());
    if (!call.threads.empty()) {
        const std::uint64_t at_once = RELIEF_TRY(parseCount(call.threads, "--threads"));
        if (at_once < 1 || at_once > kAtOnceMax) {
            return fail(ErrorCode::kUsage, "--threads must be 1 to " + std::to_string(kAtOnceMax));
        }
        run.at_once = static_cast<unsigned>(at_once);
    }
    if (call.output == "-") {
        return fail(ErrorCode::kUsage, "--output is a folder beside --recipe, and not standard output");
    }
    if (call.json && options.events == "-") {
        return fail(ErrorCode::kUsage,
                    "--json and --events - both want standard output; give --events a file");
    }
    return run;
}

/// Files that are written beside the outputs must be none of them, nor any input.
Result<void> preflight(const RecipeOptionsOfBake& options, const RecipeCall& call, const RecipeRun& run,
                       const std::vector<RecipeJob>& jobs) {
    if (!run.dry_run) {
        RELIEF_TRY(preflightFolder(run.output_folder));
    }
    std::vector<std::string> files;
    for (const std::string& file : {options.stamp, call.depfile, options.events}) {
        if (file.empty() || (file == "-" && file == options.events)) {
            continue;
        }
        if (file == "-") {
            return fail(ErrorCode::kUsage, "--stamp and --depfile cannot be standard output; name files");
        }
        std::vector<Result<void>> checks = {preflightFile(file), preflightDistinct(options.recipe, file),
                                            preflightTwoOutputs(run.output_folder / kBakeCacheName, file)};
        for (const RecipeJob& job : jobs) {
            checks.push_back(preflightDistinct(job.mesh_path, file));
            checks.push_back(preflightTwoOutputs(job.output_path, file));
        }
        for (const std::string& other : files) {
            checks.push_back(preflightTwoOutputs(other, file));
        }
        for (const Result<void>& check : checks) {
            if (!check) {
                return check;
            }
        }
        files.push_back(file);
    }
    return {};
}

Result<void> printDryRun(const std::vector<AssetResult>& assets) {
    std::vector<std::vector<std::string>> rows = {{"output", "mesh", "why"}};
    for (const AssetResult& asset : assets) {
        rows.push_back({cleanUtf8(asset.job.output), cleanUtf8(asset.job.mesh),
                        asset.reason.empty() ? "up to date" : asset.reason});
    }
    return printOut(table(rows));
}

/// The error of the whole run, if any asset failed.
Result<void> verdict(const std::vector<AssetResult>& assets, const RecipeCounts& counts) {
    for (const AssetResult& asset : assets) {
        if (asset.state == AssetState::kFailed) {
            return fail(asset.error.code, std::to_string(counts.failed) + " of " +
                                              std::to_string(counts.all()) + " assets failed, first " +
                                              quotedPath(asset.job.output) +
                                              "; mend what is said above and run the recipe again");
        }
    }
    return {};
}

}  // namespace

void addRecipeOptions(CLI::App& verb, RecipeOptionsOfBake& options) {
    CLI::Option* recipe = verb.add_option(
        "--recipe", options.recipe,
        "Bake what this TOML file lists instead of MESH: only what is not up to date, -j assets at\n"
        "once, each by a process of its own; -o is a folder, the recipe's by default");
    recipe->option_text("FILE");
    const auto add = [&](const char* name, std::string& value, const char* text, const char* words) {
        verb.add_option(name, value, words)->option_text(text)->needs(recipe);
    };
    add("--shard", options.shard, "K/N",
        "Of --recipe: only the K-th of N parts, which may run at the same time");
    add("--events", options.events, "FILE",
        "Of --recipe: write what happens as lines of JSON; - for standard output");
    add("--stamp", options.stamp, "FILE",
        "Of --recipe: write this file when everything is up to date: the target for --depfile");
    add("--timeout", options.timeout, "SECONDS", "Of --recipe: for one asset; default 3600, 0 for any");
    CLI::Option* fast = verb.add_flag("--fail-fast", options.fail_fast,
                                      "Of --recipe: begin no further asset once one has failed");
    CLI::Option* going = verb.add_flag("--keep-going", options.keep_going,
                                       "Of --recipe: bake the others when one fails (default)");
    fast->needs(recipe);
    going->needs(recipe)->excludes(fast);
    verb.add_flag("--dry-run", options.dry_run, "Of --recipe: only say what would be baked, and why")
        ->needs(recipe);
}

Result<void> checkOneBake(const CLI::App& verb) {
    for (const char* name : {"MESH", "--output"}) {
        if (verb.get_option(name)->count() == 0) {
            return fail(ErrorCode::kUsage, std::string(name) + " is required; see relief bake --help");
        }
    }
    return {};
}

Result<void> runRecipeCommand(const RecipeOptionsOfBake& options, const RecipeCall& call) {
    startLogging(call.common);
    const Stopwatch watch;
    Result<RecipeRun> run = runOf(options, call);
    const Result<Shard> shard = parseShard(options.shard);
    for (const Result<void>& check : {checkOptions(call), run ? Result<void>() : Result<void>(forward(run)),
                                      shard ? Result<void>() : Result<void>(forward(shard))}) {
        if (!check) {
            return check;
        }
    }
    const std::vector<RecipeAsset> assets = RELIEF_TRY(loadRecipe(options.recipe, recipeKeys(call.verb)));
    RELIEF_TRY(checkAssets(assets, call));
    RecipeJobs all = RELIEF_TRY(recipeJobs(assets, options.recipe, run->output_folder));
    std::vector<RecipeJob> jobs;
    for (const RecipeJob& job : all.jobs) {
        if (inShard(job.output, *shard)) {
            jobs.push_back(job);
        }
    }
    RELIEF_TRY(preflight(options, call, *run, jobs));
    const auto cores = std::max(1U, std::thread::hardware_concurrency());
    run->threads =
        std::max(1U, cores / std::max(1U, std::min(run->at_once, static_cast<unsigned>(jobs.size()))));

    RecipeEvents events;
    if (!options.events.empty()) {
        RELIEF_TRY(events.open(options.events));
    }
    events.write({{"event", "start"},
                  {"tool", std::string("relief ") + RELIEF_VERSION},
                  {"recipe", options.recipe},
                  {"assets", jobs.size()},
                  {"shard", options.shard.empty() ? Json(nullptr) : Json(options.shard)},
                  {"at_once", run->at_once}});
    Result<RecipeResult> result;
    {
        RecipeDisplay display(jobs.size(), !call.common.quiet && !options.dry_run);
        const auto event = [&](const char* name, const AssetResult& asset) {
            Json json = {{"event", name}};
            json.update(jsonAsset(asset));
            events.write(json);
        };
        run->started = [&](const AssetResult& asset) {
            event("started", asset);
            display.wipe();
            spdlog::debug("{}: {}", cleanUtf8(asset.job.output), asset.reason);
            display.started(asset);
        };
        run->ended = [&](const AssetResult& asset) {
            const bool done = asset.state == AssetState::kBaked;
            event(done                                   ? "done"
                  : asset.state == AssetState::kFailed   ? "failed"
                  : asset.state == AssetState::kUpToDate ? "skipped"
                                                         : "cancelled",
                  asset);
            display.wipe();
            for (const std::string& warning : asset.warnings) {
                spdlog::warn("{}: {}", cleanUtf8(asset.job.output), warning);
            }
            if (asset.state == AssetState::kFailed) {
                spdlog::error("{}: {}", cleanUtf8(asset.job.output), asset.error.message);
            }
            display.ended(asset);
        };
        run->warn = [&](const std::string& warning) {
            display.wipe();
            spdlog::warn(warning);
        };
        result = relief::runRecipe(std::move(jobs), *run);
    }
    if (!result) {
        return forward(result);
    }
    const RecipeCounts counts = countAssets(result->assets);
    const double ms = watch.ms();
    Json summary = {{"event", "summary"}};
    summary.update(jsonCounts(counts));
    summary["ms"] = ms;
    summary["signal"] = result->signal == 0 ? Json(nullptr) : Json(result->signal);
    events.write(summary);
    if (!call.common.quiet) {
        std::fputs((recipeSummary(counts, ms) + "\n").c_str(), stderr);
    }
    if (result->signal != 0) {
        ChildProcesses::endBySignal(result->signal);
    }
    if (call.json) {
        Json json = {{"recipe", options.recipe},
                     {"output", run->output_folder.string()},
                     {"shard", options.shard.empty() ? Json(nullptr) : Json(options.shard)},
                     {"counts", jsonCounts(counts)},
                     {"ms", ms},
                     {"assets", Json::array()}};
        for (const AssetResult& asset : result->assets) {
            json["assets"].push_back(jsonAsset(asset));
        }
        RELIEF_TRY(printOut(dump(json)));
    } else if (options.dry_run && options.events != "-") {
        RELIEF_TRY(printDryRun(result->assets));
    }
    if (const Result<void> fine = verdict(result->assets, counts); !fine || options.dry_run) {
        return fine;
    }
    if (!call.depfile.empty()) {
        const std::vector<std::string> beside = {options.stamp, call.depfile, options.events};
        RELIEF_TRY(
            writeRecipeDepfile(call.depfile, options.stamp, beside, *run, all.folders, result->assets));
    }
    if (!options.stamp.empty()) {
        RELIEF_TRY(writeRecipeStamp(options.stamp, result->assets));
    }
    return events.finish();
}

}  // namespace relief
