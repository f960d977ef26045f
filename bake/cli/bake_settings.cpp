#include "bake/cli/bake_settings.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "bake/cli/preflight.h"
#include "bake/plan/map_spec.h"
#include "formats/base/byte_count.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::uint64_t kThreadsMax = 1024;
constexpr std::uint64_t kCompressionMax = 19;

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

/// What --decode and --depth make of maps that do not say it themselves.
Result<MapSpecDefaults> mapDefaults(const BakeCommand& command) {
    constexpr std::array<std::string_view, 2> kDecodes = {"projected", "plane"};
    constexpr std::array<std::string_view, 2> kDepths = {"half", "unorm16"};
    MapSpecDefaults defaults;
    if (!command.decode.empty()) {
        const std::size_t decode = RELIEF_TRY(wordOf("--decode", command.decode, kDecodes));
        defaults.decode = decode == 0 ? Decode::kProjected : Decode::kPlane;
    }
    if (!command.depth.empty()) {
        const std::size_t depth = RELIEF_TRY(wordOf("--depth", command.depth, kDepths));
        defaults.front_back = depth == 0 ? MapFormat::kFrontBackHalf : MapFormat::kFrontBackFixed;
    }
    if (command.maps.empty() && !(command.decode.empty() && command.depth.empty())) {
        return fail(ErrorCode::kUsage, std::string(command.decode.empty() ? "--depth" : "--decode") +
                                           " does nothing without --map; leave it out");
    }
    return defaults;
}

/// Who chooses the maps; one alone may.
Result<MapSource> sourceOf(const BakeCommand& command) {
    const char* planning = !command.budget.empty() ? "--budget" : "--max-error";
    struct Way {
        const char* name;
        bool given;
        MapSource source;
    };
    const std::array<Way, 4> ways = {
        {{"--map", !command.maps.empty(), MapSource::kMaps},
         {"--paper", command.paper, MapSource::kPaper},
         {"--plan", !command.plan.empty(), MapSource::kPlanFile},
         {planning, !command.budget.empty() || !command.max_error.empty(), MapSource::kPlanner}}};
    const Way* chosen = nullptr;
    for (const Way& way : ways) {
        if (!way.given) {
            continue;
        }
        if (chosen != nullptr) {
            return fail(ErrorCode::kUsage, std::string(chosen->name) + " and " + way.name +
                                               " are two ways to choose the maps; leave one out");
        }
        chosen = &way;
    }
    return chosen == nullptr ? MapSource::kPlanner : chosen->source;
}

Result<void> readPlanSettings(const BakeCommand& command, BakeSettings& settings) {
    if (!command.budget.empty()) {
        settings.budget = parseByteCount(command.budget);
        if (!settings.budget) {
            return fail(ErrorCode::kUsage, "--budget is '" + cleanUtf8(command.budget) +
                                               "' but must be a number of bytes, such as 1MB or 512KiB");
        }
    }
    if (!command.max_error.empty()) {
        const float percent = RELIEF_TRY(parsePercent(command.max_error, "--max-error"));
        settings.max_error = double{percent};
    }
    if (!command.plan_out.empty()) {
        if (settings.source != MapSource::kPlanner) {
            return fail(ErrorCode::kUsage,
                        "--plan-out writes what was planned, but the maps were named; leave it out");
        }
        if (command.plan_out == "-") {
            return fail(ErrorCode::kUsage, "--plan-out cannot be standard output; name a file");
        }
    }
    if (!command.quality.empty()) {
        constexpr std::array<std::string_view, 3> kQualities = {"fast", "normal", "best"};
        const std::size_t quality = RELIEF_TRY(wordOf("--quality", command.quality, kQualities));
        settings.bake.quality = static_cast<Quality>(quality);
    }
    if (!command.prefer.empty()) {
        constexpr std::array<std::string_view, 3> kPreferences = {"neither", "inside", "outside"};
        const std::size_t prefer = RELIEF_TRY(wordOf("--prefer", command.prefer, kPreferences));
        settings.bake.prefer = static_cast<Prefer>(prefer);
    }
    return {};
}

Result<void> readMapSettings(const BakeCommand& command, BakeSettings& settings) {
    const MapSpecDefaults defaults = RELIEF_TRY(mapDefaults(command));
    for (const std::string& text : command.maps) {
        const MapSpec spec = RELIEF_TRY(parseMapSpec(text, defaults));
        settings.bake.maps.push_back(spec);
    }
    if (settings.source == MapSource::kPaper) {
        settings.bake.maps = paperMapSpecs();
    }
    if (command.resolution.empty()) {
        return {};
    }
    if (settings.source != MapSource::kMaps && settings.source != MapSource::kPaper) {
        return fail(
            ErrorCode::kUsage,
            "--resolution does nothing where maps are planned, each of the size that it needs; leave it "
            "out, set --budget, or choose --map or --paper");
    }
    const std::uint64_t resolution = RELIEF_TRY(parseCount(command.resolution, "--resolution"));
    const std::uint32_t texels =
        RELIEF_TRY(checkMapSize(resolution, MapFormat::kFrontBackHalf, "--resolution"));
    settings.bake.resolution = texels;
    return {};
}

}  // namespace

Result<BakeSettings> settingsOf(const BakeCommand& command) {
    BakeSettings settings;
    const MapSource source = RELIEF_TRY(sourceOf(command));
    settings.source = source;
    for (const auto& read : {readPlanSettings, readMapSettings}) {
        RELIEF_TRY(read(command, settings));
    }
    if (command.holes != "close" && command.holes != "keep") {
        return fail(ErrorCode::kUsage,
                    "--holes is '" + cleanUtf8(command.holes) + "' but must be close or keep");
    }
    if (!command.threads.empty()) {
        const std::uint64_t threads = RELIEF_TRY(parseCount(command.threads, "--threads"));
        if (threads < 1 || threads > kThreadsMax) {
            return fail(ErrorCode::kUsage, "--threads must be 1 to " + std::to_string(kThreadsMax));
        }
        settings.bake.threads = static_cast<unsigned>(threads);
    }
    const std::uint64_t level = RELIEF_TRY(parseCount(command.compress, "--compress"));
    if (level > kCompressionMax) {
        return fail(ErrorCode::kUsage,
                    "--compress must be 0 (none) to " + std::to_string(kCompressionMax) + " (smallest)");
    }
    settings.write.compression_level = static_cast<int>(level);
    if (command.json && command.output == "-") {
        return fail(ErrorCode::kUsage, "--json and -o - both want standard output; give -o a file");
    }
    return settings;
}

Result<void> preflight(const BakeCommand& command) {
    std::vector<Result<void>> checks = {preflightFile(command.output),
                                        preflightDistinct(command.mesh, command.output)};
    if (!command.plan.empty()) {
        checks.push_back(preflightDistinct(command.plan, command.output));
    }
    if (!command.plan_out.empty()) {
        checks.push_back(preflightFile(command.plan_out));
        checks.push_back(preflightDistinct(command.mesh, command.plan_out));
        checks.push_back(preflightTwoOutputs(command.output, command.plan_out));
    }
    if (!command.depfile.empty()) {
        if (command.depfile == "-" || command.output == "-") {
            return fail(ErrorCode::kUsage, "--depfile needs files, and not standard output; name them");
        }
        checks.push_back(preflightFile(command.depfile));
        for (const std::string* other : {&command.mesh, &command.plan}) {
            checks.push_back(preflightDistinct(*other, command.depfile));
        }
        for (const std::string* other : {&command.output, &command.plan_out}) {
            checks.push_back(preflightTwoOutputs(*other, command.depfile));
        }
    }
    for (const Result<void>& check : checks) {
        if (!check) {
            return check;
        }
    }
    return {};
}

}  // namespace relief
