#include "bake/director/bake_request.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "bake/heights/heights_spec.h"
#include "bake/plan/map_spec.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// The runtime draws the maps of an animated mesh anew in the same directions (runtime/collider/live_collider.h).
constexpr std::array<const char*, 3> kAnimatedMaps = {"front-back:dir=+x,up=+y", "front-back:dir=-y,up=-z",
                                                      "front-back:dir=-z,up=+y"};
constexpr std::uint32_t kAnimatedResolution = 256;

/// \return the option that chooses the maps. Errors: kUsage: there are two.
Result<MapSource> sourceOf(const BakeRequest& request) {
    struct Chooser {
        const char* name;
        bool given;
        MapSource source;
    };
    const std::array<Chooser, 4> choosers = {
        {{"--map", !request.map.empty(), MapSource::kMaps},
         {"--paper", request.paper, MapSource::kPaper},
         {"--plan", !request.plan.empty(), MapSource::kPlanFile},
         {request.budget  ? "--budget"
          : request.texel ? "--texel"
                          : "--max-error",
          request.budget || request.texel || request.max_error, MapSource::kPlanner}}};
    const Chooser* chosen = nullptr;
    for (const Chooser& chooser : choosers) {
        if (!chooser.given) {
            continue;
        }
        if (chosen != nullptr) {
            return fail(ErrorCode::kUsage, std::string(chosen->name) + " and " + chooser.name +
                                               " are two ways to choose the maps; leave one out");
        }
        chosen = &chooser;
    }
    return chosen == nullptr ? MapSource::kPlanner : chosen->source;
}

/// Options of a mesh beside those of a height map.
std::string otherThanHeights(const BakeRequest& request) {
    constexpr std::array<std::string_view, 3> kOfBoth = {"heights", "threads", "time_limit"};
    for (const FieldWords& field : changedFields(request)) {
        if (std::ranges::find(kOfBoth, field.name) == kOfBoth.end()) {
            return optionName(field.name) + " is for meshes, and does nothing with --heights; leave it out";
        }
    }
    return {};
}

/// Options that have no place beside --animated.
std::string otherThanAnimated(const BakeRequest& request) {
    constexpr std::array<std::string_view, 12> kOfBoth = {
        "animated", "clips", "resolution",    "quality",     "prefer",        "threads",
        "unit",     "up",    "import_memory", "import_time", "max_triangles", "time_limit"};
    for (const FieldWords& field : changedFields(request)) {
        if (std::ranges::find(kOfBoth, field.name) == kOfBoth.end()) {
            return optionName(field.name) + " does nothing with --animated; leave one out";
        }
    }
    return {};
}

/// The fault of options that do nothing together; empty: there is none.
std::string conflictOf(const BakeRequest& request, const BakeSettings& settings) {
    if (!request.heights.empty()) {
        return otherThanHeights(request);
    }
    if (request.animated) {
        return otherThanAnimated(request);
    }
    if (!request.clips.empty()) {
        return "--clips does nothing without --animated; add it";
    }
    if (!request.plan_out.empty() && settings.source != MapSource::kPlanner) {
        return "--plan-out writes what was planned, but the maps were named; leave it out";
    }
    if (request.plan_out == "-") {
        return "--plan-out cannot be standard output; name a file";
    }
    if (request.map.empty() && (request.decode || request.depth)) {
        return std::string(request.decode ? "--decode" : "--depth") +
               " does nothing without --map; leave it out";
    }
    if (request.resolution && settings.source != MapSource::kMaps && settings.source != MapSource::kPaper) {
        return "--resolution does nothing where maps are planned, each of the size that it needs; leave it "
               "out, set --budget, or choose --map or --paper";
    }
    if (request.texel && request.max_error) {
        return "--texel and --max-error are two ways to choose the bytes; leave one out";
    }
    if (request.texel && settings.layout == Layout::kViews) {
        return "--texel is of patches; leave it out, or --layout views and --holes keep";
    }
    if (request.layout && settings.source != MapSource::kPlanner) {
        return "--layout is of what is planned, but the maps were named; leave it out";
    }
    if (request.max_maps != kPlannedMapsMax && settings.source == MapSource::kPlanner &&
        settings.layout == Layout::kPatches) {
        return "--max-maps does nothing with patches, which are one map; leave it out, or add --layout views";
    }
    // Names need the file's own triangles and separate parts.
    const char* const against = !request.repair.method.empty() ? "--repair, which makes another surface"
                                : request.holes == Holes::kKeep
                                    ? "--holes keep, which takes nothing for a solid"
                                    : nullptr;
    if (!settings.shape.named.empty() && against != nullptr) {
        return "--as NAME=KIND does nothing with " + std::string(against) + "; leave one out";
    }
    return {};
}

Result<void> readMaps(const BakeRequest& request, BakeSettings& settings) {
    MapSpecDefaults defaults;
    defaults.decode = request.decode.value_or(defaults.decode);
    if (request.depth == FrontBackDepth::kHalf) {
        defaults.front_back = MapFormat::kFrontBackHalf;
    }
    for (const std::string& text : request.map) {
        const MapSpec spec = RELIEF_TRY(parseMapSpec(text, defaults));
        settings.bake.maps.push_back(spec);
    }
    if (request.animated) {
        settings.source = MapSource::kMaps;
        settings.bake.resolution = kAnimatedResolution;
        for (const char* const text : kAnimatedMaps) {
            settings.bake.maps.push_back(RELIEF_TRY(parseMapSpec(text, defaults)));
        }
    }
    if (settings.source == MapSource::kPaper) {
        settings.bake.maps = paperMapSpecs();
    }
    if (request.resolution) {
        settings.bake.resolution =
            RELIEF_TRY(checkMapSize(*request.resolution, MapFormat::kFrontBackHalf, "--resolution"));
    }
    return {};
}

bool isRecorded(std::string_view name) {
    static const std::vector<FieldWords> kFields = fieldsOf(BakeRequest());
    return std::ranges::any_of(
        kFields, [&](const FieldWords& field) { return field.name == name && field.info.recorded; });
}

/// Takes one option of a record. \return whether it is one that a bake records, with a value that makes sense.
bool take(std::string_view name, std::string_view value, BakeRequest& request) {
    if (name == "backend") {
        return true;  // of older versions: raster, whose bakes were drawn on the GPU
    }
    BakeRequest changed = request;
    if (!isRecorded(name) || !setField(changed, name, value) || !parseShapeOptions(changed.as) ||
        !wrapAlpha(changed.repair.method) || (name == "map" && !parseMapSpec(value)) ||
        (name == "heights" && !parseHeightsSpec(value))) {
        return false;
    }
    request = std::move(changed);
    return true;
}

}  // namespace

Result<BakeSettings> settingsOf(const BakeRequest& request) {
    BakeSettings settings;
    settings.source = RELIEF_TRY(sourceOf(request));
    settings.layout =
        request.layout.value_or(request.holes == Holes::kKeep ? Layout::kViews : Layout::kPatches);
    settings.shape = RELIEF_TRY(parseShapeOptions(request.as));
    const std::string conflict = conflictOf(request, settings);
    if (!conflict.empty()) {
        return fail(ErrorCode::kUsage, conflict);
    }
    if (!request.heights.empty()) {
        static_cast<void>(RELIEF_TRY(parseHeightsSpec(request.heights)));
    }
    RELIEF_TRY(readMaps(request, settings));
    static_cast<void>(RELIEF_TRY(wrapAlpha(request.repair.method)));
    settings.bake.quality = request.quality.value_or(settings.bake.quality);
    settings.bake.prefer = request.prefer.value_or(settings.bake.prefer);
    settings.bake.planned_texel = request.texel.value_or(0.0F);
    settings.bake.roots_hold = request.roots_hold;
    settings.bake.threads = request.threads.value_or(settings.bake.threads);
    return settings;
}

RecordedBake recordedBake(const std::vector<RecordedOption>& options) {
    RecordedBake bake;
    for (const RecordedOption& option : options) {
        bake.understood = take(option.name, option.value, bake.request) && bake.understood;
    }
    if (bake.request.quality == Quality::kNormal) {
        bake.request.quality.reset();
    }
    return bake;
}

std::string commandLine(const BakeRequest& request, const std::string& output) {
    std::string text = "relief bake " + shellWord(request.mesh) + " -o " + shellWord(output);
    for (const FieldWords& field : changedFields(request)) {
        for (const std::string& word : field.words) {
            text += " " + optionName(field.name);
            if (field.kind != FieldKind::kFlag) {
                text +=
                    " " + shellQuoted(field.info.unit == "bytes" ? bytesWord(*parseUnsigned(word)) : word);
            }
        }
    }
    return text;
}

std::string importOptionOf(const ImportOptions& options, const ImportLimits& limits) {
    std::vector<FieldWords> changed = changedFields(options);
    std::ranges::copy(changedFields(limits), std::back_inserter(changed));
    return changed.empty() ? "" : optionName(changed.front().name);
}

std::string shellWord(const std::string& path) {
    return shellQuoted(path.starts_with("-") ? "./" + path : path);  // else it is taken for an option
}

}  // namespace relief
