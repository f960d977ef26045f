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

/// The maps of --holes keep and of --animated. The runtime draws those of a moving mesh in the same directions
/// (runtime/live/live_collider.h).
constexpr std::array<const char*, 3> kAxisMaps = {"front-back:dir=+x,up=+y", "front-back:dir=-y,up=-z",
                                                  "front-back:dir=-z,up=+y"};
constexpr std::uint32_t kAxisResolution = 256;

/// \return the option that chooses the maps. Errors: kUsage: there are two.
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
                                               " are two ways to choose the maps; leave one out");
        }
        chosen = &chooser;
    }
    return chosen == nullptr ? MapSource::kPatches : chosen->source;
}

/// Options of a mesh beside those of a height map.
std::string otherThanHeights(const BakeRequest& request) {
    constexpr std::array<std::string_view, 5> kOfBoth = {"heights", "threads", "time_limit", "import_memory",
                                                         "import_time"};
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
    if (request.map.empty() && (request.decode || request.depth)) {
        return std::string(request.decode ? "--decode" : "--depth") +
               " does nothing without --map; leave it out";
    }
    const bool axis_maps = settings.source == MapSource::kPatches && request.holes == Holes::kKeep;
    if (request.resolution && settings.source == MapSource::kPatches && !axis_maps) {
        return "--resolution does nothing for patches; leave it out, set --budget, or choose --map, --paper "
               "or --holes keep";
    }
    if (axis_maps && (request.budget || request.texel || request.max_error)) {
        return std::string(request.budget  ? "--budget"
                           : request.texel ? "--texel"
                                           : "--max-error") +
               " does nothing with --holes keep, whose surfaces have no inside for patches; set --resolution";
    }
    if (request.texel && request.max_error) {
        return "--texel and --max-error are two ways to choose the bytes; leave one out";
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

/// Takes one option of a record. \return whether it is one that a bake records, with a value that makes sense.
bool take(std::string_view name, std::string_view value, BakeRequest& request) {
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
    settings.bake.texel = request.texel.value_or(0.0F);
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

void fields(FieldVisitor& visit, BakeRequest& request) {
    visit(
        "map", request.map,
        {.help = "A map to bake instead of patches for a budget, once for each: FORMAT[:key=value,...] with\n"
                 "FORMAT   float, fixed8, front-back, cube or patches\n"
                 "bytes    of patches, such as 1MB\n"
                 "texel    of patches, wanted everywhere, as --texel; they have no other keys\n"
                 "dir      direction the view looks in: +x -x +y -y +z -z or a/b/c\n"
                 "up       direction that points upwards in the image: as dir\n"
                 "size     texels, N or WxH (cube: N)\n"
                 "compare  less or greater: keep the nearest or the farthest surface; not of front-back, "
                 "which keeps both\n"
                 "center   a/b/c, where a cube looks from\n"
                 "depth    of front-back maps: unorm16, or half (the paper's)\n"
                 "decode   plane: fitted to the whole texel, or projected (the paper's)\n"
                 "box      tight, or x0/y0/z0/x1/y1/z1: the part of space to cover",
         .value = "SPEC",
         .recorded = true});
    visit("decode", request.decode,
          {.help = "For each --map that does not set it: plane, or projected, the paper's",
           .fallback = "plane"});
    visit("depth", request.depth,
          {.help = "For each --map front-back that does not set it: unorm16, or half, the paper's",
           .fallback = "unorm16"});
    visit("paper", request.paper,
          {.help = "Bake the paper's maps: front-back along -x, -y and -z and a cube, "
                   "depth=half, decode=projected"});
    visit("resolution", request.resolution,
          {.help = "Texels along a side of --map without size, of --paper, --holes keep and --animated",
           .fallback = "512; with --holes keep and --animated, 256",
           .recorded = true});
    visit("budget", request.budget,
          {.help = "The bytes that patches may take on the GPU. The file has some hundred "
                   "bytes more, or fewer with --compress. With --max-error: use no more",
           .unit = "bytes",
           .range = {1.0},
           .fallback = "1MB",
           .recorded = true});
    visit(
        "texel", request.texel,
        {.help = "Patches of this texel everywhere, whatever bytes that takes: a cell is split as long "
                 "as its patch is off by more than a quarter of it and its side is longer than two of it. "
                 "With --world in the units of the level, at the largest scale of each mesh. With --budget "
                 "that is the most, and what does not fit gets a larger texel, with a warning",
         .unit = "object units",
         .range = {0.0, 1e15, false},
         .value = "LENGTH",
         .must = "a length above 0, in the collider's units, with --world of the level; of metres also with "
                 "mm, cm or m "
                 "behind it",
         .recorded = true});
    visit(
        "max_error", request.max_error,
        {.help = "Patches of the least bytes (32kB to 64MB) that leave at most this share of the points near "
                 "the surface, in percent, on the wrong side; measured as by relief check, on 50000 points. "
                 "Exit with 7, and write nothing, if none do",
         .unit = "%",
         .range = {0.0}});
    visit("quality", request.quality,
          {.help = "The work on planes (one ray a texel, 16 or 36) and on patches: fast, normal or best",
           .fallback = "normal",
           .recorded = true});
    visit(
        "prefer", request.prefer,
        {.help = "Where planes and patches must err: inside keeps particles out of walls, outside keeps free "
                 "space free, neither errs least",
         .fallback = "neither",
         .recorded = true});
    visit("threads", request.threads,
          {.help = "Threads to use. The result is the same. With --recipe: assets at once",
           .range = {1.0, 1024.0},
           .fallback = "all cores",
           .letter = 'j'});
    visit("holes", request.holes,
          {.help = "close: make solids of what --as says; keep: bake the surface as it is, in three "
                   "front-back maps "
                   "along the axes, or in those of --map or --paper",
           .recorded = true});
    visit("no_check", request.no_check, {.help = "Do not measure the result (a few percent of the time)"});
    fields(visit, request.import);
    fields(visit, request.import_limits);
    fields(visit, request.repair);
    visit("as", request.as,
          {.help = "What the parts of the mesh are: auto (each is judged by what rays see), "
                   "solid (holes are closed), shell (a wall with two sides) or terrain (solid below). "
                   "With NAME=, what has that name in the file: a node with all below it, a mesh, an "
                   "OBJ group or a material; once for each, and of several that fit the last counts",
           .fallback = "auto",
           .value = "[NAME=]auto|solid|shell|terrain",
           .recorded = true});
    visit("thickness", request.thickness,
          {.help = "Of shells, in the collider's units",
           .unit = "object units",
           .fallback = "a texel and a half",
           .value = "LENGTH",
           .must = "a length above 0, in the collider's units",
           .recorded = true});
    visit(
        "voids", request.voids,
        {.help = "What sheets and solids seal off from the outside together, as a pot and its lid do: full, "
                 "or hollow",
         .fallback = "full",
         .recorded = true});
    visit("materials", request.materials,
          {.help =
               "Materials of the mesh, by their names: keep, or none. The collider knows which surface is of "
               "which, for responses and events; that takes at most 6 % of its bytes, or "
               "4 KiB",
           .fallback = "keep, of a mesh or level with several",
           .recorded = true});
    visit(
        "animated", request.animated,
        {.help = "Bake a glTF file that moves: the collider also has its skins, morph targets, moving nodes "
                 "and clips, by which the runtime poses it. Its maps, three of front-back along the axes, "
                 "are of the rest pose, and of --resolution, 256 by default",
         .recorded = true});
    visit(
        "clips", request.clips,
        {.help = "With --animated: add the animations of this glTF file, once for each, by nodes of the same "
                 "name",
         .value = "FILE"});
    visit("heights", request.heights,
          {.help =
               "Bake the ground below a height map, in place of a mesh: a grey PNG of 16 or 8 bits, an EXR\n"
               "image of one channel in metres, whose NaN are holes, or raw samples (.raw, .r16, .hgt).\n"
               "Heights go along +y, columns along +x, rows along +z. key=value,... with\n"
               "spacing  metres between samples, 1 by default\n"
               "low      height of sample 0, of unsigned samples\n"
               "high     height of sample 65535, or 255 of 8 bits\n"
               "hole     sample that is none; squares at holes have no ground\n"
               "width    samples in a row of a raw file, which else is square\n"
               "type     of raw samples: uint16, or int16 or float32 in metres\n"
               "order    byte order of raw samples: little or big\n"
               "offset   x/y/z: place of the first sample at height 0\n"
               "tile     with --world, squares along a tile's side, 1024 by default",
           .value = "SPEC",
           .recorded = true});
    visit(
        "time_limit", request.time_limit,
        {.help =
             "Seconds that the whole bake may take, the import included. Beyond them exit with 6, and write "
             "nothing",
         .unit = "s",
         .range = {double{0.001F}, 1e7},
         .fallback = "any",
         .value = "SECONDS",
         .must = "a number of seconds from 0.001 to 10000000"});
}

}  // namespace relief
