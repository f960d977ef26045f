#include "bake/cli/bake_settings.h"

#include <array>

#include "bake/plan/map_spec.h"

namespace relief {
namespace {

/// Applies --decode and --depth to the maps that do not set their own.
Result<MapSpecDefaults> mapDefaults(const BakeCommand& command) {
    if (command.maps.empty() && (command.decode || command.depth)) {
        return fail(ErrorCode::kUsage, std::string(command.decode ? "--decode" : "--depth") +
                                           " does nothing without --map; leave it out");
    }
    MapSpecDefaults defaults;
    defaults.decode = command.decode.value_or(defaults.decode);
    defaults.front_back = command.depth.value_or(defaults.front_back);
    return defaults;
}

/// The options that choose the maps; only one may be given.
Result<MapSource> sourceOf(const BakeCommand& command) {
    const char* planning = command.budget ? "--budget" : "--max-error";
    struct Way {
        const char* name;
        bool given;
        MapSource source;
    };
    const std::array<Way, 4> ways = {{{"--map", !command.maps.empty(), MapSource::kMaps},
                                      {"--paper", command.paper, MapSource::kPaper},
                                      {"--plan", !command.plan.empty(), MapSource::kPlanFile},
                                      {planning, command.budget || command.max_error, MapSource::kPlanner}}};
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

Result<void> checkPlanOut(const BakeCommand& command, MapSource source) {
    if (!command.plan_out.empty() && source != MapSource::kPlanner) {
        return fail(ErrorCode::kUsage,
                    "--plan-out writes what was planned, but the maps were named; leave it out");
    }
    if (command.plan_out == "-") {
        return fail(ErrorCode::kUsage, "--plan-out cannot be standard output; name a file");
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
    if (!command.resolution) {
        return {};
    }
    if (settings.source != MapSource::kMaps && settings.source != MapSource::kPaper) {
        return fail(
            ErrorCode::kUsage,
            "--resolution does nothing where maps are planned, each of the size that it needs; leave it "
            "out, set --budget, or choose --map or --paper");
    }
    settings.bake.resolution =
        RELIEF_TRY(checkMapSize(*command.resolution, MapFormat::kFrontBackHalf, "--resolution"));
    return {};
}

/// Names need the triangles of the file, and parts that are told apart.
Result<void> readShapeSettings(const BakeCommand& command, BakeSettings& settings) {
    settings.shape = RELIEF_TRY(parseShapeOptions(command.as));
    const char* const against = !command.care.repair.empty() ? "--repair, which makes another surface"
                                : command.holes == Holes::kKeep
                                    ? "--holes keep, which takes nothing for a solid"
                                    : nullptr;
    if (!settings.shape.named.empty() && against != nullptr) {
        return fail(ErrorCode::kUsage,
                    "--as NAME=KIND does nothing with " + std::string(against) + "; leave one out");
    }
    return {};
}

}  // namespace

Result<BakeSettings> settingsOf(const BakeCommand& command) {
    BakeSettings settings;
    settings.source = RELIEF_TRY(sourceOf(command));
    RELIEF_TRY(checkPlanOut(command, settings.source));
    RELIEF_TRY(readMapSettings(command, settings));
    RELIEF_TRY(readShapeSettings(command, settings));
    settings.bake.quality = command.quality.value_or(settings.bake.quality);
    settings.bake.prefer = command.prefer.value_or(settings.bake.prefer);
    settings.bake.threads = command.threads.value_or(settings.bake.threads);
    settings.write.compression_level = command.compress;
    return settings;
}

Result<void> preflight(const BakeCommand& command, FileGuard& files) {
    if (!command.depfile.empty() && (command.depfile == "-" || command.output == "-")) {
        return fail(ErrorCode::kUsage, "--depfile needs files, and not standard output; name them");
    }
    RELIEF_TRY(files.reads(command.mesh));
    RELIEF_TRY(files.reads(command.plan));
    if (command.json) {
        RELIEF_TRY(files.writes("-", "--json"));
    }
    RELIEF_TRY(files.writes(command.output, "-o"));
    RELIEF_TRY(files.writes(command.plan_out, "--plan-out"));
    return files.writes(command.depfile, "--depfile");
}

}  // namespace relief
