// relief diff: where two colliders differ, texel by texel.
#include <CLI/CLI.hpp>

#include "bake/cli/command.h"
#include "bake/report/diff_report.h"
#include "formats/base/error_context.h"
#include "formats/base/file_io.h"
#include "formats/container.h"
#include "runtime/tool/command_line.h"
#include "runtime/tool/option_values.h"

namespace relief {
namespace {

constexpr float kMost = std::numeric_limits<float>::max();

struct DiffCommand {
    CommonOptions common;
    std::string a;
    std::string b;
    float max_coverage = 0.0F;  // percent
    float max_depth = 0.0F;     // steps
    float max_normal = 0.0F;    // degrees
    float max_texels = 0.0F;    // percent
    bool strict_metadata = false;
    bool json = false;
};

struct Loaded {
    std::vector<std::byte> bytes;
    Collider collider;
};

Result<Loaded> load(const std::string& file) {
    std::vector<std::byte> bytes = RELIEF_TRY(readFile(file));
    auto collider = RELIEF_TRY(inFront(shownInput(file), readContainer(bytes)));
    return Loaded{std::move(bytes), std::move(collider)};
}

DiffLimits limitsOf(const DiffCommand& command) {
    return {{double{command.max_depth}, double{command.max_normal}},
            double{command.max_coverage},
            double{command.max_texels},
            command.strict_metadata};
}

Result<void> runDiff(const DiffCommand& command) {
    startLogging(command.common);
    const DiffLimits limits = limitsOf(command);
    if (command.a == "-" && command.b == "-") {
        return fail(ErrorCode::kUsage, "A and B cannot both be standard input; give one of them a file");
    }
    const Loaded a = RELIEF_TRY(load(command.a));
    const Loaded b = RELIEF_TRY(load(command.b));
    const ColliderDifference difference = compareColliders(a.collider, b.collider, limits.surface);
    const std::string verdict = diffVerdict(difference, limits);
    const DiffSummary summary{shownInput(command.a), shownInput(command.b), a.collider, difference, limits,
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
        "is.",
        "relief diff before.relief after.relief\n"
        "relief diff raycast.relief raster.relief --max-depth 2 --max-normal 1 --max-texels 0.1%\n"
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
    verb.add_flag("--strict-metadata", command->strict_metadata,
                  "Mesh, tool and options of the bake count too; otherwise they are only shown");
    verb.add_flag("--json", command->json, "Print JSON");
    verb.callback([command, &action] { action = [command] { return runDiff(*command); }; });
}

}  // namespace relief
