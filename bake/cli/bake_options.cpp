// The options of `relief bake`.
#include <CLI/CLI.hpp>

#include "bake/cli/bake_settings.h"
#include "bake/cli/care_options.h"
#include "runtime/tool/option_values.h"

namespace relief {
namespace {

constexpr std::uint64_t kThreadsMax = 1024;
constexpr std::uint64_t kCompressionMax = 19;
constexpr float kSecondsMin = 0.001F;
constexpr float kSecondsMax = 1e7F;

/// Maps that are named.
void addMapOptions(CLI::App& verb, BakeCommand& command) {
    verb.add_option("--map", command.maps,
                    "A map to bake instead of planned ones, once for each: FORMAT[:key=value,...] with\n"
                    "FORMAT   float, fixed8, front-back or cube\n"
                    "dir      direction the view looks in: +x -x +y -y +z -z or a/b/c\n"
                    "up       direction that points upwards in the image: as dir\n"
                    "size     texels, N or WxH (cube: N)\n"
                    "compare  less or greater: keep the nearest or the farthest surface; of front-back\n"
                    "         gap: both ends of what lies between solids\n"
                    "center   a/b/c, where a cube looks from\n"
                    "depth    of front-back maps: unorm16, or half (the paper's)\n"
                    "decode   plane: fitted to the whole texel, or projected (the paper's)\n"
                    "box      tight, or x0/y0/z0/x1/y1/z1: the part of space to cover")
        ->option_text("SPEC")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);
    addWords(verb, "--decode", command.decode,
             WordsFor<Decode>{{"plane", Decode::kPlane}, {"projected", Decode::kProjected}},
             "Of --map that does not say it: plane (default) or projected, the paper's");
    addWords(
        verb, "--depth", command.depth,
        WordsFor<MapFormat>{{"unorm16", MapFormat::kFrontBackFixed}, {"half", MapFormat::kFrontBackHalf}},
        "Of --map front-back that does not say it: unorm16 (default) or half, the paper's");
    verb.add_flag(
        "--paper", command.paper,
        "Bake the paper's maps instead of planned ones: front-back along -x, -y and -z and a cube,\n"
        "depth=half, decode=projected");
    verb.add_option("--resolution", command.resolution,
                    "Texels along a side of --map without size, and of --paper; default 512")
        ->option_text("N")
        ->transform(wholeNumber());
}

/// Maps that are planned.
void addPlanOptions(CLI::App& verb, BakeCommand& command) {
    verb.add_option(
            "--budget", command.budget,
            "Plan for this many bytes; default 1MB. What counts is what all maps together take on the GPU:\n"
            "the file has some hundred bytes more, or fewer with --compress. With --max-error: use no more")
        ->option_text("BYTES")
        ->transform(byteCount());
    verb.add_option(
            "--max-error", command.max_error,
            "Plan for the least bytes (32kB to 64MB) that leave at most this share of the points near\n"
            "the surface, in percent, on the wrong side; measured as by relief check, on 50000 points.\n"
            "Exit with 7, and write nothing, if none do")
        ->option_text("PCT")
        ->transform(percent());
    verb.add_option("--max-maps", command.max_maps,
                    "Plan at most this many maps, each of which every step of a simulation looks at;\n"
                    "default " +
                        std::to_string(kPlannedMapsMax) + ", at most " +
                        std::to_string(ContainerLimits{}.maps))
        ->option_text("N")
        ->transform(wholeNumber(1, ContainerLimits{}.maps));
    verb.add_option("--plan-out", command.plan_out,
                    "Also write what was planned, as TOML, to be changed and given to --plan")
        ->option_text("FILE");
    verb.add_option("--plan", command.plan, "Bake the maps of such a file")->option_text("FILE");
}

/// How maps are baked, whoever chose them.
void addTexelOptions(CLI::App& verb, BakeCommand& command) {
    addWords(
        verb, "--quality", command.quality,
        WordsFor<Quality>{{"fast", Quality::kFast}, {"normal", Quality::kNormal}, {"best", Quality::kBest}},
        "Of planes: fast (one ray a texel), normal (16 rays, default) or best (36).\n"
        "With --plan, the file's by default");
    addWords(verb, "--prefer", command.prefer,
             WordsFor<Prefer>{
                 {"inside", Prefer::kInside}, {"outside", Prefer::kOutside}, {"neither", Prefer::kNeither}},
             "Where planes must err: inside keeps particles out of walls, outside keeps free\n"
             "space free, neither (default) errs least");
    verb.add_option(
            "-j,--threads", command.threads,
            "Threads to use; default: all cores. The result is the same. With --recipe: assets at once")
        ->option_text("N")
        ->transform(wholeNumber(1, kThreadsMax));
    verb.add_option("--compress", command.compress, "zstd level of the texels, 0 (none, default) to 19")
        ->option_text("LEVEL")
        ->transform(wholeNumber(0, kCompressionMax,
                                "0 (none) to " + std::to_string(kCompressionMax) + " (smallest)"));
    addWords(verb, "--holes", command.holes,
             WordsFor<Holes>{{"close", Holes::kClose}, {"keep", Holes::kKeep}},
             "close (default): make solids of what --as says; keep: bake the surface as it is");
    verb.add_option("--as", command.as,
                    "What the parts of the mesh are: auto (default: each is judged by what rays see),\n"
                    "solid (holes are closed), shell (a wall with two sides) or terrain (solid below).\n"
                    "With NAME=, what has that name in the file: a node with all below it, a mesh, an\n"
                    "OBJ group or a material; once for each, and of several that fit the last counts")
        ->option_text("[NAME=]auto|solid|shell|terrain")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);
    verb.add_option("--thickness", command.thickness,
                    "Of shells, in the collider's units; default: a texel and a half")
        ->option_text("LENGTH")
        ->transform(number(1e-15F, 1e15F, "a length above 0, in the collider's units"));
    verb.add_flag("--no-check", command.no_check,
                  "Do not measure what was planned (a few percent of the time)");
    addBackendOption(verb, command.backend);
    addGpuOptions(verb, command.gpu);
}

}  // namespace

void addBakeOptions(CLI::App& verb, BakeCommand& command) {
    verb.add_option("MESH", command.mesh, "The mesh: OBJ, STL, PLY, OFF, glTF, FBX, COLLADA, 3DS and more")
        ->type_name("");
    verb.add_option("-o,--output", command.output, "The collider to write; - for standard output")
        ->option_text("OUT.relief");
    addMapOptions(verb, command);
    addPlanOptions(verb, command);
    addTexelOptions(verb, command);
    addImportOptions(verb, command.import);
    addMeshCareOptions(verb, command.care);
    verb.add_option("--time-limit", command.time_limit,
                    "Seconds that the whole bake may take, the import included; default: any. Beyond them\n"
                    "exit with 6, and write nothing")
        ->option_text("SECONDS")
        ->transform(number(kSecondsMin, kSecondsMax, "a number of seconds from 0.001 to 10000000"));
    verb.add_flag("--json", command.json, "Print a report as JSON to standard output");
    verb.add_option("--depfile", command.depfile,
                    "Also write which files were read, for Make and Ninja: every input of the output")
        ->option_text("FILE");
    addRecipeOptions(verb, command.recipe);
}

}  // namespace relief
