// relief diff: where two colliders differ, texel by texel.
#include <CLI/CLI.hpp>

#include "bake/cli/command.h"
#include "bake/report/diff_report.h"
#include "formats/bake_first.h"
#include "formats/base/error_context.h"
#include "formats/base/file_io.h"
#include "formats/container.h"
#include "formats/container_reader.h"
#include "runtime/tool/command_line.h"
#include "runtime/tool/memory_option.h"
#include "runtime/tool/option_values.h"

namespace relief {
namespace {

constexpr float kMost = std::numeric_limits<float>::max();

struct DiffCommand {
    CommonOptions common;
    std::string a;
    std::string b;
    ContainerLimits limits;
    float max_coverage = 0.0F;          // percent
    float max_depth = 0.0F;             // steps
    float max_normal = 0.0F;            // degrees
    float max_texels = 0.0F;            // percent
    std::optional<float> max_sides;     // percent
    std::optional<float> max_distance;  // object units
    bool strict_metadata = false;
    bool json = false;
};

struct Loaded {
    std::vector<std::byte> bytes;
    Collider collider;
};

Result<Loaded> load(const std::string& file, const ContainerLimits& limits) {
    std::vector<std::byte> bytes = RELIEF_TRY(readFile(file, containerSizeMax(limits)));
    RELIEF_TRY(refuseMesh(file, bytes));
    auto collider = RELIEF_TRY(inFront(shownInput(file), readContainer(bytes, limits)));
    return Loaded{std::move(bytes), std::move(collider)};
}

DiffLimits limitsOf(const DiffCommand& command) {
    return {{double{command.max_depth}, double{command.max_normal}},
            double{command.max_coverage},
            double{command.max_texels},
            command.strict_metadata,
            command.max_sides,
            command.max_distance};
}

/// What counts is either the maps or the fields.
Result<void> checkLimits(const CLI::App& verb, const DiffCommand& command) {
    const char* const of_fields = command.max_sides ? "--max-sides" : "--max-distance";
    for (const char* of_maps : {"--max-coverage", "--max-depth", "--max-normal", "--max-texels"}) {
        if ((command.max_sides || command.max_distance) && verb.count(of_maps) > 0) {
            return fail(ErrorCode::kUsage, std::string(of_maps) + " is about maps and " + of_fields +
                                               " about what all maps say together; leave one out");
        }
    }
    return {};
}

/// Maps of two plans tell nothing of each other: then what they say together is compared.
std::optional<FieldsDifference> fieldsOf(const Collider& a, const Collider& b,
                                         const ColliderDifference& difference, const DiffLimits& limits) {
    return difference.structureDiffers() || limits.ofFields() ? std::optional(compareFields(a, b))
                                                              : std::nullopt;
}

Result<void> runDiff(const DiffCommand& command) {
    startLogging(command.common);
    const DiffLimits limits = limitsOf(command);
    if (command.a == "-" && command.b == "-") {
        return fail(ErrorCode::kUsage, "A and B cannot both be standard input; give one of them a file");
    }
    const Loaded a = RELIEF_TRY(load(command.a, command.limits));
    const Loaded b = RELIEF_TRY(load(command.b, command.limits));
    const ColliderDifference difference = compareColliders(a.collider, b.collider, limits.surface);
    const std::optional<FieldsDifference> fields = fieldsOf(a.collider, b.collider, difference, limits);
    const std::string verdict = diffVerdict(difference, fields, limits);
    const DiffSummary summary{
        shownInput(command.a), shownInput(command.b), a.collider, difference, fields, limits,
        a.bytes == b.bytes};
    if (command.json || !command.common.quiet) {
        const std::string text = command.json ? diffJson(summary) : diffText(summary);
        RELIEF_TRY(printOut(text));
    }
    if (!verdict.empty()) {
        return fail(ErrorCode::kDifference, summary.a + " and " + summary.b + " differ: " + verdict);
    }
    return {};
}

}  // namespace

void addDiff(CLI::App& app, Action& action) {
    auto command = std::make_shared<DiffCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "diff",
        "Compares two colliders texel by texel\n\nMap i of A with map i of B: which texels have a surface in "
        "one of them alone, and by how much depths and\nnormals differ where both have one. Depth is counted "
        "in steps of what is stored: of fixed point and floats\n1/65534 of the range, of halves the next "
        "half "
        "(ulp). Exit code 7 if the difference is beyond the limits\nin any map; without limits any "
        "difference "
        "is.\n\nColliders of other maps, such as two plans, are also compared by what they say of the same\n"
        "points: which side of the surface, and how far. With --max-sides or --max-distance that counts\n"
        "alone, whatever the maps.",
        "relief diff before.relief after.relief\n"
        "relief diff raycast.relief raster.relief --max-depth 2 --max-normal 1 --max-texels 0.1%\n"
        "relief diff small.relief large.relief --max-sides 1% --max-distance 0.002\n"
        "relief bake bunny.obj -o - -q | relief diff golden.relief - --json");
    verb.add_option("A", command->a, "A collider; - for standard input")->type_name("")->required();
    verb.add_option("B", command->b, "The one to compare it with; - for standard input")
        ->type_name("")
        ->required();
    verb.add_option(
            "--max-coverage", command->max_coverage,
            "Share of a map's texels, in percent, that may have a surface in one file alone; default 0")
        ->option_text("PCT")
        ->transform(percent());
    verb.add_option("--max-depth", command->max_depth, "Steps by which a depth may differ; default 0")
        ->option_text("STEPS")
        ->transform(number(0.0F, kMost, "a number of steps of depth, 0 or more"));
    verb.add_option("--max-normal", command->max_normal, "Degrees by which a normal may differ; default 0")
        ->option_text("DEG")
        ->transform(number(0.0F, kMost, "a number of degrees, 0 or more"));
    verb.add_option("--max-texels", command->max_texels,
                    "Share of a map's surfaces, in percent, that may differ by more than that; default 0")
        ->option_text("PCT")
        ->transform(percent());
    verb.add_option("--max-sides", command->max_sides,
                    "Share of the points near the surfaces, in percent, that may be on another side")
        ->option_text("PCT")
        ->transform(percent());
    verb.add_option("--max-distance", command->max_distance,
                    "Length, in object units, by which 99 % of the distances near the surfaces may differ")
        ->option_text("LENGTH")
        ->transform(number(0.0F, kMost, "a length in object units, 0 or more"));
    verb.add_flag("--strict-metadata", command->strict_metadata,
                  "Mesh, tool and options of the bake count too; otherwise they are only shown");
    addMemoryOption(verb, command->limits);
    verb.add_flag("--json", command->json, "Print JSON");
    verb.callback([command, &verb, &action] {
        action = [command, &verb](FileGuard&) -> Result<void> {
            RELIEF_TRY(checkLimits(verb, *command));
            return runDiff(*command);
        };
    });
}

}  // namespace relief
