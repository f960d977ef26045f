// SPDX-License-Identifier: Apache-2.0
#include "bake/recipe/recipe_run.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "bake/recipe/child_process.h"
#include "formats/base/file_io.h"
#include "formats/base/temporary_file.h"
#include "formats/base/text.h"
#include "formats/container_reader.h"
#include "formats/world/world.h"

namespace relief {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Interval of cache updates during bakes; a killed run loses at most the entries since the last update.
constexpr auto kCacheInterval = std::chrono::seconds(2);
constexpr std::string_view kErrorStart = "relief: error: ";
constexpr std::string_view kWarningStart = "relief: warning: ";

/// Returns a cache entry with the bytes and hashes of a job's output. Errors: the output is missing, or not a world.
Result<BakeCacheEntry> entryOf(const RecipeJob& job) {
    BakeCacheEntry entry;
    const std::optional<std::string> hash = hashOfFile(job.output_path);
    std::error_code error;
    entry.output_bytes = fs::file_size(job.output_path, error);
    if (!hash || error) {
        return fail(ErrorCode::kFailure, "its bake wrote no output; bake it separately for details");
    }
    entry.output_hash = *hash;
    if (!job.world) {
        return entry;
    }
    const World world = RELIEF_TRY(loadWorldFile(job.output_path));
    for (const WorldCollider& collider : world.colliders) {
        entry.containers[collider.file] = collider.hash;
        if (collider.coarse) {
            entry.containers[collider.coarse->file] = collider.coarse->hash;
        }
    }
    for (const auto& [file, file_hash] : entry.containers) {
        const std::uintmax_t bytes = fs::file_size(job.output_path.parent_path() / file, error);
        entry.output_bytes += error ? 0 : bytes;  // the next run reports a missing container
    }
    return entry;
}

/// Returns `wrong_percent` of a bake's report. For a world, returns that of its worst collider, or nullopt if any
/// collider was not measured.
std::optional<double> wrongPercentOf(const nlohmann::json& report) {
    const auto of = [](const nlohmann::json& json) {
        const auto found = json.find("wrong_percent");
        return found != json.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
    };
    const auto colliders = report.find("colliders");
    if (colliders == report.end() || !colliders->is_array()) {
        return of(report);
    }
    std::optional<double> worst;
    for (const nlohmann::json& collider : *colliders) {
        const std::optional<double> wrong = of(collider);
        if (!wrong) {
            return std::nullopt;
        }
        worst = std::max(worst.value_or(0.0), *wrong);
    }
    return worst;
}

/// For an output that is not in the cache: fails if it would replace a file of another kind (collider or world), because
/// a mesh may reference such a file.
Result<void> checkReplaced(const RecipeJob& job) {
    constexpr std::size_t kBegin = 4096;
    std::error_code error;
    if (!fs::is_regular_file(job.output_path, error)) {
        return {};
    }
    std::string begin(kBegin, '\0');
    std::ifstream file(job.output_path, std::ios::binary);
    file.read(begin.data(), kBegin);
    begin.resize(static_cast<std::size_t>(file.gcount()));
    const auto& signature = ContainerHeader::kSignature;
    const bool ours = job.world
                          ? begin.find(kWorldFormat) != std::string::npos
                          : std::ranges::equal(std::string_view(begin).substr(0, signature.size()), signature,
                                               {}, [](char c) { return static_cast<std::uint8_t>(c); });
    return ours || begin.empty()
               ? Result<void>()
               : fail(ErrorCode::kUsage, "the output " + quotedPath(job.output_path) +
                                             " exists and is not a " + (job.world ? "world" : "collider") +
                                             ", and would be overwritten; remove it, or name another output");
}

class Runner {
  public:
    Runner(const RecipeRun& run, std::string tool) : run_(run), tool_(std::move(tool)) {}

    Result<RecipeResult> go(std::vector<RecipeJob> jobs) {
        RELIEF_TRY(findStale(std::move(jobs)));
        if (!run_.dry_run) {
            bakeStale();
        }
        result_.signal = children_.terminationSignal();
        if (result_.signal != 0) {
            for (const ChildEnd& end : children_.endAll()) {
                take(end);
            }
        }
        for (AssetResult& asset : result_.assets) {
            if (asset.state == AssetState::kStale && !(run_.dry_run && result_.signal == 0)) {
                asset.state = AssetState::kCanceled;
                notify(run_.ended, asset);
            }
        }
        if (!fresh_.empty()) {
            RELIEF_TRY(updateBakeCache(run_.output_folder, fresh_));
        }
        return std::move(result_);
    }

  private:
    template <class Function, class Argument>
    static void notify(const Function& function, const Argument& argument) {
        if (function) {
            function(argument);
        }
    }

    Result<void> findStale(std::vector<RecipeJob> jobs) {
        Result<BakeCacheEntries> cache = loadBakeCache(run_.output_folder);
        if (!cache) {
            notify(run_.warn, cache.error().message + "; baking everything again");
            cache = BakeCacheEntries{};
        }
        const fs::path folder = recipeFolder(run_.recipe);
        for (RecipeJob& job : jobs) {
            AssetResult asset;
            asset.job = std::move(job);
            const auto entry = cache->find(asset.job.output);
            const bool known = entry != cache->end();
            const std::optional<std::string> reason =
                children_.terminationSignal() != 0
                    ? "not examined"
                    : staleness(asset.job, known ? &entry->second : nullptr, tool_, folder);
            if (!known) {
                RELIEF_TRY(checkReplaced(asset.job));
            }
            if (!reason) {
                complete(asset, AssetState::kUpToDate, entry->second);
            } else {
                asset.reason = *reason;
            }
            result_.assets.push_back(std::move(asset));
        }
        return {};
    }

    void complete(AssetResult& asset, AssetState state, const BakeCacheEntry& entry) {
        asset.state = state;
        asset.hash = entry.output_hash;
        asset.bytes = entry.output_bytes;
        asset.inputs = entry.inputs;
        asset.wrong_percent = entry.wrong_percent;
        asset.key = assetKey(tool_, asset.job.options, asset.inputs);
        for (const auto& [file, hash] : entry.containers) {
            asset.containers.push_back((fs::path(asset.job.output).parent_path() / file).string());
        }
        notify(run_.ended, asset);
    }

    void bakeStale() {
        std::size_t next = 0;
        Clock::time_point cached = Clock::now();
        while (children_.terminationSignal() == 0) {
            while (children_.running() < run_.jobs) {
                while (next < result_.assets.size() && result_.assets[next].state != AssetState::kStale) {
                    ++next;
                }
                if (next == result_.assets.size()) {
                    break;
                }
                start(next++);
            }
            if (children_.running() == 0) {
                return;
            }
            for (const ChildEnd& end : children_.wait(std::chrono::seconds(1))) {
                take(end);
            }
            if (!fresh_.empty() && Clock::now() - cached > kCacheInterval) {
                // Errors are ignored here; the last update reports them.
                if (updateBakeCache(run_.output_folder, fresh_)) {
                    fresh_.clear();
                }
                cached = Clock::now();
            }
        }
    }

    void start(std::size_t index) {
        AssetResult& asset = result_.assets[index];
        notify(run_.started, asset);
        std::error_code error;
        fs::create_directories(asset.job.output_path.parent_path(), error);
        if (error) {
            failAsset(asset,
                      {ErrorCode::kIo, "cannot create the folder of " + quotedPath(asset.job.output_path) +
                                           ": " + error.message() + "; choose another output"});
            return;
        }
        if (asset.job.mesh_is_folder) {
            // Hash the mesh before the child reads it: the next run notices later changes.
            asset.inputs = {{asset.job.mesh, hashOfInput(asset.job.mesh_path).value_or("")}};
        }
        std::vector<std::string> arguments = {"bake", asset.job.mesh_path.string(),
                                              asset.job.world
                                                  ? "--world=" + asset.job.output_path.parent_path().string()
                                                  : "--output=" + asset.job.output_path.string(),
                                              "--json", "--threads=" + std::to_string(run_.threads)};
        const std::vector<std::string>& own = asset.job.arguments;
        arguments.insert(arguments.end(), own.begin(), own.end());
        if (std::ranges::none_of(own,
                                 [](const std::string& word) { return word.starts_with("--timeout"); })) {
            arguments.emplace_back("--timeout=3600");  // a hanging bake must not block the others
        }
        if (const Result<void> started = children_.startSelf(arguments, index); !started) {
            failAsset(asset, started.error());
        }
    }

    void failAsset(AssetResult& asset, Error error) {
        asset.state = AssetState::kFailed;
        asset.error = std::move(error);
        notify(run_.ended, asset);
    }

    void take(const ChildEnd& end) {
        AssetResult& asset = result_.assets[end.tag];
        asset.ms = end.ms;
        std::string message;
        for (const std::string_view line : split(end.err, '\n')) {
            if (line.starts_with(kErrorStart)) {
                message = nameKeys(cleanUtf8(line.substr(kErrorStart.size())), run_.keys);
            } else if (line.starts_with(kWarningStart)) {
                asset.warnings.push_back(nameKeys(cleanUtf8(line.substr(kWarningStart.size())), run_.keys));
            }
        }
        if (end.signal != 0) {
            TemporaryFile::removeLeftovers(asset.job.output_path.parent_path());
            if (children_.terminationSignal() == 0) {
                failAsset(asset, {ErrorCode::kFailure,
                                  "its bake was ended by signal " + std::to_string(end.signal) + " (" +
                                      ::strsignal(end.signal) + "); repair or simplify the mesh"});
            }
            return;  // go() marks it as canceled
        }
        if (end.exit_code != 0) {
            const bool known = end.exit_code <= static_cast<int>(ErrorCode::kDifference);
            if (!known && children_.terminationSignal() != 0) {
                return;
            }
            failAsset(asset, {known ? static_cast<ErrorCode>(end.exit_code) : ErrorCode::kFailure,
                              message.empty() ? "its bake exited with code " + std::to_string(end.exit_code) +
                                                    " and no message; bake it separately for details"
                                              : message});
            return;
        }
        succeed(asset, end.out);
    }

    void succeed(AssetResult& asset, const std::string& report) {
        // Use the inputs reported by the child: a file may have changed since.
        const fs::path folder = recipeFolder(run_.recipe);
        const auto json = nlohmann::json::parse(report, nullptr, false);
        if (json.is_object() && json.contains("inputs") && json["inputs"].is_array()) {
            for (const auto& input : json["inputs"]) {
                if (!input.is_object() || !input.contains("file") || !input["file"].is_string() ||
                    !input.contains("hash") || !input["hash"].is_string()) {
                    continue;
                }
                asset.inputs.push_back({pathFromRecipe(input["file"].get<std::string>(), folder),
                                        input["hash"].get<std::string>()});
            }
        }
        Result<BakeCacheEntry> entry = entryOf(asset.job);
        if (!entry || asset.inputs.empty()) {
            failAsset(asset, entry ? Error{ErrorCode::kFailure,
                                           "its bake wrote no report; bake it separately for details"}
                                   : entry.error());
            return;
        }
        asset.inputs.front().path = asset.job.mesh;
        entry->tool = tool_;
        entry->options = asset.job.options;
        entry->inputs = asset.inputs;
        entry->wrong_percent = wrongPercentOf(json);
        complete(asset, AssetState::kBaked, *entry);
        fresh_[asset.job.output] = std::move(*entry);
    }

    const RecipeRun& run_;
    std::string tool_;
    ChildProcesses children_;
    RecipeResult result_;
    BakeCacheEntries fresh_;  ///< not yet in the cache file
};

fs::path realFolder(const fs::path& path) {
    std::error_code error;
    // The result is the same with and without a trailing slash.
    return fs::weakly_canonical(fs::absolute(path / ".", error), error).lexically_normal() / "";
}

}  // namespace

Result<RecipeResult> runRecipe(std::vector<RecipeJob> jobs, const RecipeRun& run) {
    std::string tool = RELIEF_TRY(toolIdentity());
    return Runner(run, std::move(tool)).go(std::move(jobs));
}

Result<void> writeRecipeDepfile(const fs::path& path, const std::string& stamp,
                                const std::vector<std::string>& beside, const RecipeRun& run,
                                const std::vector<fs::path>& folders,
                                const std::vector<AssetResult>& assets) {
    const fs::path folder = recipeFolder(run.recipe);
    // Normalized, but otherwise as given, to match the names in a build file.
    const auto name = [](const fs::path& file) { return file.lexically_normal().string(); };
    std::vector<std::string> targets;
    std::vector<std::string> inputs;
    if (run.recipe != "-") {
        inputs.push_back(name(run.recipe));
    }
    std::vector<fs::path> searched_folders = folders;
    std::set<fs::path> written = {realFolder(run.output_folder)};
    for (const std::string& file : beside) {
        if (!file.empty()) {
            const fs::path parent = fs::path(file).parent_path();
            written.insert(realFolder(parent.empty() ? fs::path(".") : parent));
        }
    }
    for (const AssetResult& asset : assets) {
        targets.push_back(name(asset.job.output_path));
        written.insert(realFolder(asset.job.output_path.parent_path()));
        if (asset.job.mesh_is_folder) {
            searched_folders.push_back(asset.job.mesh_path);
        }
        for (std::size_t i = asset.job.mesh_is_folder ? 1 : 0; i < asset.inputs.size(); ++i) {
            inputs.push_back(name(folder / asset.inputs[i].path));
        }
    }
    for (const fs::path& searched : searched_folders) {
        if (!written.contains(realFolder(searched))) {
            // Make treats "rocks/" and "rocks" as different files.
            const fs::path normal = (searched / "").lexically_normal();
            inputs.push_back(normal == "./" || normal == "." ? "." : normal.parent_path().string());
        }
    }
    if (!stamp.empty()) {
        targets = {stamp};
    }
    // A shard may be empty.
    return targets.empty() ? Result<void>() : writeDepfile(path, targets, inputs);
}

Result<void> writeRecipeStamp(const fs::path& path, const std::vector<AssetResult>& assets) {
    std::string text;
    for (const AssetResult& asset : assets) {
        text += asset.hash + "  " + cleanUtf8(asset.job.output) + "\n";
    }
    return writeText(path, text);
}

}  // namespace relief
