// All that decides what a bake makes, and how it goes about it. The options of `relief bake`, the keys of recipes, the
// arguments of relief.bake() in Python and the provenance of a collider are derived from fields().
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/import/import_fields.h"
#include "bake/pipeline/bake.h"
#include "bake/plan/prefer.h"
#include "bake/plan/view_planner.h"
#include "bake/repair/repair.h"
#include "bake/shape/shape.h"
#include "formats/base/result.h"
#include "formats/container_limits.h"
#include "formats/fields/text.h"

namespace relief {

inline constexpr std::uint64_t kBudgetDefault = 1'000'000;  ///< bytes; where none is recorded too

enum class Holes : std::uint8_t { kClose, kKeep };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Holes>{"close", "keep"};

enum class MaterialsAs : std::uint8_t { kKeep, kNone };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<MaterialsAs>{"keep", "none"};

enum class FrontBackDepth : std::uint8_t { kUnorm16, kHalf };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<FrontBackDepth>{"unorm16", "half"};

template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Decode>{"projected", "plane"};

struct BakeRequest {
    std::string mesh;                     ///< a file
    std::vector<std::string> map;         ///< MapSpecs; empty: planned, unless paper or plan
    std::optional<Decode> decode;         ///< of `map`
    std::optional<FrontBackDepth> depth;  ///< of `map`
    bool paper = false;
    std::optional<std::uint64_t> resolution;
    std::optional<std::uint64_t> budget;
    std::optional<float> texel;  ///< object units
    std::optional<float> max_error;
    std::optional<Layout> layout;
    std::uint32_t max_maps = kPlannedMapsMax;
    std::string plan_out;
    std::string plan;
    std::optional<Quality> quality;
    std::optional<Prefer> prefer;
    std::optional<unsigned> threads;
    Holes holes = Holes::kClose;
    bool no_check = false;
    ImportOptions import;
    ImportLimits import_limits;
    RepairOptions repair;
    std::vector<std::string> as;
    std::optional<Thickness> thickness;
    std::optional<VoidsAs> voids;
    std::optional<MaterialsAs> materials;
    bool animated = false;
    std::vector<std::string> clips;   ///< files, beside `mesh`, of `animated`
    std::string heights;              ///< HeightsSpec: `mesh` is a height map; empty: it is a mesh
    std::optional<float> time_limit;  ///< seconds; kept by the caller, who can end the bake
    /// Object units: a box that the roots of planned patches hold beside the mesh. No option; it is not recorded.
    std::optional<Bounds> roots_hold{};
};

template <class Visitor, FieldsOf<BakeRequest> Request>
void fields(Visitor& visit, Request& request) {
    visit("map", request.map,
          {.help = "A map to bake instead of planned ones, once for each: FORMAT[:key=value,...] with\n"
                   "FORMAT   float, fixed8, front-back, cube or patches\n"
                   "bytes    of patches, such as 1MB\n"
                   "texel    of patches, wanted everywhere, as --texel; they have no other keys\n"
                   "dir      direction the view looks in: +x -x +y -y +z -z or a/b/c\n"
                   "up       direction that points upwards in the image: as dir\n"
                   "size     texels, N or WxH (cube: N)\n"
                   "compare  less or greater: keep the nearest or the farthest surface; of front-back\n"
                   "         gap: both ends of what lies between solids\n"
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
    visit(
        "paper", request.paper,
        {.help = "Bake the paper's maps instead of planned ones: front-back along -x, -y and -z and a cube, "
                 "depth=half, decode=projected"});
    visit("resolution", request.resolution,
          {.help = "Texels along a side of --map without size, of --paper and of --animated",
           .fallback = "512; with --animated, 256",
           .recorded = true});
    visit("budget", request.budget,
          {.help =
               "Plan for this many bytes: what all maps together take on the GPU. The file has some hundred "
               "bytes more, or fewer with --compress. With --max-error: use no more",
           .unit = "bytes",
           .range = {1.0},
           .fallback = "1MB",
           .recorded = true});
    visit(
        "texel", request.texel,
        {.help = "Plan patches for this texel everywhere, whatever bytes that takes: a cell is split as long "
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
        {.help = "Plan for the least bytes (32kB to 64MB) that leave at most this share of the points near "
                 "the surface, in percent, on the wrong side; measured as by relief check, on 50000 points. "
                 "Exit with 7, and write nothing, if none do",
         .unit = "%",
         .range = {0.0}});
    visit(
        "layout", request.layout,
        {.help =
             "What to plan. patches: small depth maps in an octree, by far the fewest mistakes. views: depth "
             "maps of the whole mesh, to look at and to edit",
         .fallback = "patches; with --holes keep, views"});
    visit("max_maps", request.max_maps,
          {.help = "Plan at most this many views, each of which every step of a simulation looks at",
           .range = {1.0, double{ContainerLimits{}.maps}}});
    visit(
        "plan_out", request.plan_out,
        {.help = "Also write what was planned, as TOML, to be changed and given to --plan", .value = "FILE"});
    visit("plan", request.plan, {.help = "Bake the maps of such a file", .value = "FILE"});
    visit("quality", request.quality,
          {.help = "The work on planes (one ray a texel, 16 or 36) and on patches: fast, normal or best",
           .fallback = "normal; with --plan, the file's",
           .recorded = true});
    visit(
        "prefer", request.prefer,
        {.help = "Where planes and patches must err: inside keeps particles out of walls, outside keeps free "
                 "space free, neither errs least",
         .fallback = "neither; with --plan, the file's",
         .recorded = true});
    visit("threads", request.threads,
          {.help = "Threads to use. The result is the same. With --recipe: assets at once",
           .range = {1.0, 1024.0},
           .fallback = "all cores",
           .letter = 'j'});
    visit(
        "holes", request.holes,
        {.help = "close: make solids of what --as says; keep: bake the surface as it is", .recorded = true});
    visit("no_check", request.no_check,
          {.help = "Do not measure what was planned (a few percent of the time)"});
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
               "image of one channel in metres, whose NaN are holes, or raw samples of 16 bits, "
               "little-endian.\n"
               "Heights go along +y, columns along +x, rows along +z. key=value,... with\n"
               "spacing  metres between samples, 1 by default\n"
               "low      height of sample 0, not of EXR\n"
               "high     height of sample 65535, or 255 of 8 bits\n"
               "hole     sample that is none; squares at holes have no ground\n"
               "width    samples in a row of a raw file, which else is square\n"
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

enum class MapSource : std::uint8_t { kPlanner, kMaps, kPaper, kPlanFile };

/// A request, read and found consistent.
struct BakeSettings {
    MapSource source = MapSource::kPlanner;
    Layout layout = Layout::kPatches;
    BakeOptions bake;
    ShapeOptions shape;  ///< without a thickness: it depends on the mesh
};

/// The rules across fields. Fails with kUsage for two ways to choose the maps, and for options that do nothing together; as
/// parseMapSpec, checkMapSize, parseShapeOptions and wrapAlpha.
[[nodiscard]] Result<BakeSettings> settingsOf(const BakeRequest& request);

/// A request as a container records it: the maps that were baked, with their sizes, and all else that the bytes depend on.
struct RecordedBake {
    BakeRequest request;
    /// Every option is known; otherwise another version baked it, or the record is made up.
    bool understood = true;
};

[[nodiscard]] RecordedBake recordedBake(const std::vector<RecordedOption>& options);
/// Hollow where the record says nothing: there were none, or they were no part of the shape yet.
[[nodiscard]] inline VoidsAs voidsOf(const BakeRequest& recorded) {
    return recorded.voids.value_or(VoidsAs::kHollow);
}

/// A bake of a mesh as a command line, quoted for a shell.
[[nodiscard]] std::string commandLine(const BakeRequest& request, const std::string& output);
/// The first option about the import that is set; empty: none.
[[nodiscard]] std::string importOptionOf(const ImportOptions& options, const ImportLimits& limits);
/// A path as a word of a command line.
[[nodiscard]] std::string shellWord(const std::string& path);

}  // namespace relief
