// SPDX-License-Identifier: Apache-2.0
#include "bake/pipeline/bake_request.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "bake/height_map/heights_spec.h"
#include "bake/maps/budget_search.h"
#include "bake/views/map_spec.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// The maps of --holes keep and --animated. The runtime draws the maps of a moving mesh in the same directions
/// (runtime/live/live_collider.h).
constexpr std::array<const char*, 3> kAxisMaps = {"front-back:dir=+x,up=+y", "front-back:dir=-y,up=-z",
                                                  "front-back:dir=-z,up=+y"};
constexpr std::uint32_t kAxisResolution = 256;

/// Returns the first option that sets the size of patches; null if none is set.
const char* sizeOption(const BakeRequest& request) {
    return request.budget      ? "--budget"
           : request.texel     ? "--texel"
           : request.max_error ? "--max-error"
                               : nullptr;
}

/// Returns the source of the maps. Errors: kUsage if several options choose it.
Result<MapSource> sourceOf(const BakeRequest& request) {
    struct Chooser {
        const char* name;
        bool given;
        MapSource source;
    };
    const char* const size = sizeOption(request);
    const std::array<Chooser, 3> choosers = {{{"--map", !request.map.empty(), MapSource::kMaps},
                                              {"--paper", request.paper, MapSource::kPaper},
                                              {size, size != nullptr, MapSource::kPatches}}};
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

/// The options that have an effect with --heights, and with --animated.
constexpr std::array<std::string_view, 5> kWithHeights = {"heights", "threads", "timeout",
                                                          "max_import_memory", "import_timeout"};
constexpr std::array<std::string_view, 12> kWithAnimated = {
    "animated", "clips", "resolution",        "quality",        "prefer",        "threads",
    "unit",     "up",    "max_import_memory", "import_timeout", "max_triangles", "timeout"};

/// Returns an error if an option outside `allowed` is set; otherwise an empty text.
std::string otherThan(std::span<const std::string_view> allowed, const BakeRequest& request,
                      const char* error) {
    for (const FieldWords& field : changedFields(request)) {
        if (std::ranges::find(allowed, field.name) == allowed.end()) {
            return optionName(field.name) + error;
        }
    }
    return {};
}

/// Returns an error if an option has no effect with another; otherwise an empty text.
std::string conflictOf(const BakeRequest& request, const BakeSettings& settings) {
    if (!request.heights.empty()) {
        return otherThan(kWithHeights, request, " has no effect with --heights; remove it");
    }
    if (request.animated) {
        return otherThan(kWithAnimated, request, " has no effect with --animated; remove one of them");
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
    if (axis_maps && sizeOption(request) != nullptr) {
        return sizeOption(request) +
               std::string(
                   " has no effect with --holes keep, because an open surface has no inside for patches; set "
                   "--resolution");
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

/// Reads one recorded option into the request. \return false if bakes do not record it, or its value is invalid
bool readRecorded(std::string_view name, std::string_view value, BakeRequest& request) {
    static const std::vector<FieldWords> kFields = fieldsOf(BakeRequest());
    const bool recorded = std::ranges::any_of(
        kFields, [&](const FieldWords& field) { return field.name == name && field.info.recorded; });
    BakeRequest changed = request;
    if (!recorded || !setField(changed, name, value) || !parseShapeOptions(changed.as) ||
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
    options.voids = request.voids.value_or(VoidMode::kFill);
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
    settings.bake.roots_contain = request.roots_contain;
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
    return shellQuoted(path.starts_with("-") ? "./" + path : path);  // "-…" would be parsed as an option
}

void fields(FieldVisitor& visit, BakeRequest& request) {
    static const std::string kMapHelp =
        "Bake this map instead of patches: FORMAT[:KEY=VALUE,...] with FORMAT " +
        listed(std::span(kMapFormatWords).first(kMapFormatWords.size() - 1)) + " or " +
        std::string(kMapFormatWords.back()) + "; repeatable";
    visit("map", request.map,
          {.help = kMapHelp,
           .value = "SPEC",
           .recorded = true,
           .details = "A map covers the whole mesh from one view. It can be drawn and inspected as an image, "
                      "but has more errors than patches of the same size. --map excludes --paper, --budget, "
                      "--texel and --max-error."});
    visit("decode", request.decode,
          {.help = "Default of decode= in --map; the paper uses projected",
           .fallback = "plane",
           .details = "plane measures the distance to a plane that is fitted to the whole texel. projected "
                      "measures along the ray, to a flat texel."});
    visit("depth", request.depth,
          {.help = "Default of depth= in --map front-back; the paper uses half",
           .fallback = "unorm16",
           .details = "unorm16 is 16-bit fixed point; half is half floats."});
    visit("paper", request.paper,
          {.help = "Bake the maps of Kolb et al. 2004: front-back along -x, -y and -z, and a cube",
           .details = "The maps have the keys depth=half and decode=projected."});
    visit("resolution", request.resolution,
          {.help = "Texels along each side of a map whose size is not set",
           .fallback = "512; 256 with --holes keep or --animated",
           .recorded = true,
           .details = "Applies to --paper, --holes keep, --animated, and to each --map without the key size. "
                      "It has no effect on patches."});
    visit("budget", request.budget,
          {.help = "Size limit of the patches on the GPU, such as 256kB or 4MB",
           .unit = "bytes",
           .range = {static_cast<double>(kBudgetMin)},
           .fallback = "1MB",
           .recorded = true,
           .details = "The file is a few hundred bytes larger, or smaller with --compress. With --max-error "
                      "or --texel, the budget is an upper limit. With --world, it is shared by all "
                      "colliders, and its default is 16MB."});
    visit(
        "texel", request.texel,
        {.help = "Texel length of the patches, in object units or with a unit, such as 1cm; the default of "
                 "--budget then does not apply",
         .unit = "object units",
         .range = {0.0, 1e15, false},
         .value = "LENGTH",
         .must = "a length above 0 in object units (with --world, units of the level); if these are metres, "
                 "mm, cm or m may follow the number",
         .recorded = true,
         .details = "A cell is split while its patch is off by more than a quarter of the texel and its side "
                    "is longer than two texels; all patches take at most 134 MB. With --budget, the texel "
                    "grows until the patches fit, and a warning states its length. With --world, the length "
                    "is in units of the level, and each mesh is baked for its largest scale."});
    visit("max_error", request.max_error,
          {.help = "Bake the smallest collider that misclassifies at most this percentage of points near the "
                   "surface, and loses no part",
           .unit = "%",
           .range = {0.0},
           .details =
               "Tries budgets from 32kB to 64MB, or up to --budget. `relief check --max-error` accepts the "
               "result. If no trial is accurate enough, the exit code is 7 and nothing is written. It "
               "excludes --texel."});
    visit("quality", request.quality,
          {.help = "Effort spent on fitting maps to the surface; best is the slowest",
           .fallback = "normal",
           .recorded = true,
           .details = "fast fits each plane to 1 ray per texel, normal to 16 and best to 36. Higher settings "
                      "sample patches finer and try more cells."});
    visit("prefer", request.prefer,
          {.help = "Side given to doubtful space; 'neither' gives the fewest errors",
           .fallback = "neither",
           .recorded = true,
           .details = "inside keeps particles out of walls, outside keeps free space free. Each removes most "
                      "errors of one kind and adds errors of the other kind."});
    visit("threads", request.threads,
          {.help = "Number of worker threads; with --recipe, of simultaneous bakes",
           .range = {1.0, 1024.0},
           .fallback = "all cores",
           .letter = 'j',
           .details = "Results do not depend on it."});
    visit("holes", request.holes,
          {.help = "Close the mesh's parts into solids (see --as), or bake the open surface as it is",
           .recorded = true,
           .details = "keep uses three front-back maps along the axes, or the maps of --map or --paper. An "
                      "open surface has no inside, so it cannot be baked into patches."});
    visit("no_check", request.no_check,
          {.help = "Skip the check of the result, which takes a few percent of the bake time",
           .details = "A bake of patches otherwise ends with a verdict from 4000 points. It warns, with "
                      "remedies, if more than 1 % of them are wrong or a part is lost."});
    fields(visit, request.import);
    fields(visit, request.import_limits);
    fields(visit, request.repair);
    visit(
        "as", request.as,
        {.help = "Kind of the mesh's parts, or of those named NAME in the file; repeatable",
         .fallback = "auto",
         .value = "[NAME=]auto|solid|shell|terrain",
         .recorded = true,
         .details = "auto classifies each part by casting rays. solid closes holes. shell makes a wall with "
                    "two sides. terrain is solid below the surface. NAME is a node and everything below it, "
                    "a mesh, an OBJ group or a material. If several names match, the last option counts."});
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
          {.help = "Keep or drop the mesh's named materials, which collisions and events use",
           .fallback = "keep if there are several",
           .recorded = true,
           .details = "The collider stores which material covers each part of its surface, in at most 6 % of "
                      "its bytes, or 4 KiB if that is more."});
    visit(
        "animated", request.animated,
        {.help = "Bake an animated glTF file with its skins, morph targets, moving nodes and clips",
         .recorded = true,
         .details =
             "The runtime poses the collider. Three front-back maps along the axes, with --resolution texels "
             "a side, store its rest pose. Only --clips, --resolution, --quality, --prefer, --unit, --up and "
             "options of the groups Output and Limits also apply."});
    visit("clips", request.clips,
          {.help = "With --animated: add the animations of this glTF file, matched by node name; repeatable",
           .value = "FILE"});
    visit(
        "heights", request.heights,
        {.help = "Bake ground from a height map (PNG, EXR or raw samples) instead of a mesh: KEY=VALUE,... "
                 "such as spacing=1,low=0,high=500",
         .value = "SPEC",
         .recorded = true,
         .details = "+x is the next column, +y up and +z the next row. A PNG is grey, of 8 or 16 "
                    "bits. An EXR image has one channel of heights in metres; NaN marks holes. Raw samples "
                    "are files .raw, .r16 or .hgt. Squares with a hole at a corner have no ground. Only "
                    "--world, options of the group Output, and all limits but --max-triangles also apply."});
    visit("timeout", request.timeout,
          {.help = "Time limit of the whole bake, in seconds; beyond it, exit with code 6 and write nothing",
           .unit = "s",
           .range = {double{0.001F}, 1e7},
           .fallback = "none",
           .value = "SECONDS",
           .must = "a number of seconds from 0.001 to 10000000"});
}

}  // namespace relief
