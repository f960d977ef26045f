// SPDX-License-Identifier: Apache-2.0
#include "bake/pipeline/bake_request.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "bake/height_map/heights_spec.h"
#include "bake/views/map_spec.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// The maps of --holes keep and --animated. The runtime draws the maps of a moving mesh in the same directions
/// (runtime/live/live_collider.h).
constexpr std::array<const char*, 3> kAxisMaps = {"front-back:dir=+x,up=+y", "front-back:dir=-y,up=-z",
                                                  "front-back:dir=-z,up=+y"};
constexpr std::uint32_t kAxisResolution = 256;

/// Returns the option that chooses the maps. Errors: kUsage if there are several.
Result<MapSource> sourceOf(const BakeRequest& request) {
    struct Chooser {
        const char* name;
        bool given;
        MapSource source;
    };
    const std::array<Chooser, 3> choosers = {
        {{"--map", !request.map.empty(), MapSource::kMaps},
         {"--paper", request.paper, MapSource::kPaper},
         {request.budget  ? "--budget"
          : request.texel ? "--texel"
                          : "--max-error",
          request.budget || request.texel || request.max_error, MapSource::kPatches}}};
    const Chooser* chosen = nullptr;
    for (const Chooser& chooser : choosers) {
        if (!chooser.given) {
            continue;
        }
        if (chosen != nullptr) {
            return fail(ErrorCode::kUsage, std::string(chosen->name) + " and " + chooser.name +
                                               " both choose the maps; remove one");
        }
        chosen = &chooser;
    }
    return chosen == nullptr ? MapSource::kPatches : chosen->source;
}

/// Returns an error if an option for meshes is set.
std::string otherThanHeights(const BakeRequest& request) {
    constexpr std::array<std::string_view, 5> kAllowed = {"heights", "threads", "timeout",
                                                          "max_import_memory", "import_timeout"};
    for (const FieldWords& field : changedFields(request)) {
        if (std::ranges::find(kAllowed, field.name) == kAllowed.end()) {
            return optionName(field.name) + " has no effect with --heights; remove it";
        }
    }
    return {};
}

/// Returns an error if an option is set that --animated does not support.
std::string otherThanAnimated(const BakeRequest& request) {
    constexpr std::array<std::string_view, 12> kAllowed = {
        "animated", "clips", "resolution",        "quality",        "prefer",        "threads",
        "unit",     "up",    "max_import_memory", "import_timeout", "max_triangles", "timeout"};
    for (const FieldWords& field : changedFields(request)) {
        if (std::ranges::find(kAllowed, field.name) == kAllowed.end()) {
            return optionName(field.name) + " has no effect with --animated; remove one of them";
        }
    }
    return {};
}

/// Returns an error if options have no effect together; empty: there is none.
std::string conflictOf(const BakeRequest& request, const BakeSettings& settings) {
    if (!request.heights.empty()) {
        return otherThanHeights(request);
    }
    if (request.animated) {
        return otherThanAnimated(request);
    }
    if (!request.clips.empty()) {
        return "--clips has no effect without --animated; add --animated";
    }
    if (request.map.empty() && (request.decode || request.depth)) {
        return std::string(request.decode ? "--decode" : "--depth") +
               " has no effect without --map; remove it";
    }
    const bool axis_maps = settings.source == MapSource::kPatches && request.holes == Holes::kKeep;
    if (request.resolution && settings.source == MapSource::kPatches && !axis_maps) {
        return "--resolution has no effect on patches; set --budget instead, or add --map, --paper or "
               "--holes keep";
    }
    if (axis_maps && (request.budget || request.texel || request.max_error)) {
        return std::string(request.budget  ? "--budget"
                           : request.texel ? "--texel"
                                           : "--max-error") +
               " has no effect with --holes keep, because an open surface has no inside for patches; set "
               "--resolution";
    }
    if (request.texel && request.max_error) {
        return "--texel and --max-error both choose the size; remove one";
    }
    // Names need the file's own triangles and separate parts.
    const char* const against = !request.repair.method.empty()  ? "--repair, which makes another surface"
                                : request.holes == Holes::kKeep ? "--holes keep, which makes no solids"
                                                                : nullptr;
    if (!settings.shape.named.empty() && against != nullptr) {
        return "--as NAME=KIND has no effect with " + std::string(against) + "; remove one of them";
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
    if (request.animated || (settings.source == MapSource::kPatches && request.holes == Holes::kKeep)) {
        settings.source = MapSource::kMaps;
        settings.bake.resolution = kAxisResolution;
        for (const char* const text : kAxisMaps) {
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

/// Reads one recorded option into the request. \return false if bakes do not record it, or its value is invalid
bool readRecorded(std::string_view name, std::string_view value, BakeRequest& request) {
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

Result<ShapeOptions> shapeOptionsOf(const BakeRequest& request) {
    ShapeOptions options = RELIEF_TRY(parseShapeOptions(request.as));
    options.thickness_by_part = !request.thickness || request.thickness->by_part;
    options.thickness_by_texel = options.thickness_by_part && request.texel;
    options.voids = request.voids.value_or(VoidsAs::kFill);
    return options;
}

Result<BakeSettings> settingsOf(const BakeRequest& request) {
    BakeSettings settings;
    settings.source = RELIEF_TRY(sourceOf(request));
    settings.shape = RELIEF_TRY(shapeOptionsOf(request));
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
    settings.bake.texel = request.texel.value_or(0.0F);
    settings.bake.roots_hold = request.roots_hold;
    settings.bake.threads = request.threads.value_or(settings.bake.threads);
    return settings;
}

RecordedBake recordedBake(const std::vector<RecordedOption>& options) {
    RecordedBake bake;
    for (const RecordedOption& option : options) {
        bake.understood = readRecorded(option.name, option.value, bake.request) && bake.understood;
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
    return shellQuoted(path.starts_with("-") ? "./" + path : path);  // otherwise it reads as an option
}

void fields(FieldVisitor& visit, BakeRequest& request) {
    static const std::string kMapHelp =
        "Bake this map instead of patches: FORMAT[:KEY=VALUE,...] with FORMAT " +
        listed(std::span(kMapFormatWords).first(kMapFormatWords.size() - 1)) + " or " +
        std::string(kMapFormatWords.back()) + "; repeatable";
    visit("map", request.map, {.help = kMapHelp, .value = "SPEC", .recorded = true});
    visit("decode", request.decode,
          {.help = "Default for decode in --map; the paper uses projected", .fallback = "plane"});
    visit("depth", request.depth,
          {.help = "Default for depth in --map front-back; the paper uses half", .fallback = "unorm16"});
    visit("paper", request.paper,
          {.help = "Bake the maps of the original paper: front-back along -x, -y and -z, and a cube"});
    visit("resolution", request.resolution,
          {.help = "Texels along each side of a map whose size is not set",
           .fallback = "512; 256 with --holes keep or --animated",
           .recorded = true});
    visit("budget", request.budget,
          {.help = "Size limit of the patches on the GPU, such as 256kB or 4MB",
           .unit = "bytes",
           .range = {1.0},
           .fallback = "1MB",
           .recorded = true});
    visit(
        "texel", request.texel,
        {.help = "Texel length of the patches, in object units or as 1cm; without --budget, their size is "
                 "not limited",
         .unit = "object units",
         .range = {0.0, 1e15, false},
         .value = "LENGTH",
         .must = "a length above 0 in object units (with --world, units of the level); if these are metres, "
                 "mm, cm or m may follow the number",
         .recorded = true});
    visit(
        "max_error", request.max_error,
        {.help =
             "Bake the smallest patches that misclassify at most this percentage of points near the surface",
         .unit = "%",
         .range = {0.0}});
    visit("quality", request.quality,
          {.help = "Effort spent on fitting maps to the surface; best is the slowest",
           .fallback = "normal",
           .recorded = true});
    visit("prefer", request.prefer,
          {.help = "Treat doubtful space as inside, as outside, or for the fewest errors",
           .fallback = "neither",
           .recorded = true});
    visit("threads", request.threads,
          {.help = "Number of worker threads; with --recipe, of simultaneous bakes",
           .range = {1.0, 1024.0},
           .fallback = "all cores",
           .letter = 'j'});
    visit("holes", request.holes,
          {.help = "Close the mesh's parts into solids (see --as), or bake the open surface as it is",
           .recorded = true});
    visit("no_check", request.no_check,
          {.help = "Skip the check of the result, which takes a few percent of the bake time"});
    fields(visit, request.import);
    fields(visit, request.import_limits);
    fields(visit, request.repair);
    visit("as", request.as,
          {.help = "Kind of the mesh's parts, or of those named NAME in the file; repeatable",
           .fallback = "auto",
           .value = "[NAME=]auto|solid|shell|terrain",
           .recorded = true});
    visit("thickness", request.thickness,
          {.help = "Thickness of shells, in object units",
           .unit = "object units",
           .fallback = "1.5 texels",
           .value = "LENGTH",
           .must = "a length above 0 in object units",
           .recorded = true});
    visit("voids", request.voids,
          {.help = "Fill cavities that several parts seal off together, such as a pot and its lid, or keep "
                   "them hollow",
           .fallback = "fill",
           .recorded = true});
    visit("materials", request.materials,
          {.help = "Keep or drop the mesh's named materials, which responses and events use",
           .fallback = "keep if there are several",
           .recorded = true});
    visit("animated", request.animated,
          {.help = "Bake an animated glTF file with its skins, morph targets, moving nodes and clips",
           .recorded = true});
    visit("clips", request.clips,
          {.help = "With --animated: add the animations of this glTF file, matched by node name; repeatable",
           .value = "FILE"});
    visit("heights", request.heights,
          {.help = "Bake ground from a height map (PNG, EXR or raw samples) instead of a mesh: KEY=VALUE,... "
                   "such as spacing=1,low=0,high=500",
           .value = "SPEC",
           .recorded = true});
    visit("timeout", request.timeout,
          {.help = "Time limit of the whole bake, in seconds; beyond it, exit with code 6 and write nothing",
           .unit = "s",
           .range = {double{0.001F}, 1e7},
           .fallback = "none",
           .value = "SECONDS",
           .must = "a number of seconds from 0.001 to 10000000"});
}

}  // namespace relief
