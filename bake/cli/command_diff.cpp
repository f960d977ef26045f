// relief diff: where two colliders differ, texel by texel.
#include "bake/cli/command.h"
#include "bake/report/diff_report.h"
#include "bake/report/report.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/container.h"

namespace relief {
namespace {

struct DiffCommand {
    CommonOptions common;
    std::string a;
    std::string b;
    std::string max_coverage = "0";
    std::string max_depth = "0";
    std::string max_normal = "0";
    std::string max_texels = "0";
    bool strict_metadata = false;
    bool json = false;
};

struct Loaded {
    std::vector<std::byte> bytes;
    Collider collider;
};

std::string shownName(const std::string& file) {
    return file == "-" ? "standard input" : quotedPath(file);
}

Result<Loaded> load(const std::string& file) {
    std::vector<std::byte> bytes = RELIEF_TRY(readFile(file));
    Result<Collider> collider = readContainer(bytes);
    if (!collider) {
        return fail(collider.error().code, shownName(file) + ": " + collider.error().message);
    }
    return Loaded{std::move(bytes), std::move(*collider)};
}

Result<double> parseAmount(const std::string& text, const std::string& option, const char* unit) {
    const std::optional<float> amount = parseFloat(trimmed(text));
    if (!amount || *amount < 0.0F) {
        return fail(ErrorCode::kUsage,
                    option + " is '" + cleanUtf8(text) + "' but must be a number of " + unit + ", 0 or more");
    }
    return double{*amount};
}

Result<DiffLimits> limitsOf(const DiffCommand& command) {
    DiffLimits limits;
    limits.strict_metadata = command.strict_metadata;
    const Result<float> coverage = parsePercent(command.max_coverage, "--max-coverage");
    const Result<float> texels = parsePercent(command.max_texels, "--max-texels");
    if (!coverage || !texels) {
        return forward(!coverage ? coverage : texels);
    }
    limits.max_coverage = double{*coverage};
    limits.max_texels = double{*texels};
    const Result<double> depth = parseAmount(command.max_depth, "--max-depth", "steps of depth");
    const Result<double> normal = parseAmount(command.max_normal, "--max-normal", "degrees");
    if (!depth || !normal) {
        return forward(!depth ? depth : normal);
    }
    limits.surface = {*depth, *normal};
    return limits;
}

Result<void> runDiff(const DiffCommand& command) {
    startLogging(command.common);
    const DiffLimits limits = RELIEF_TRY(limitsOf(command));
    if (command.a == "-" && command.b == "-") {
        return fail(ErrorCode::kUsage, "A and B cannot both be standard input; give one of them a file");
    }
    const Loaded a = RELIEF_TRY(load(command.a));
    const Loaded b = RELIEF_TRY(load(command.b));
    const ColliderDifference difference = compareColliders(a.collider, b.collider, limits.surface);
    const std::string verdict = diffVerdict(difference, limits);
    const DiffSummary summary{shownName(command.a), shownName(command.b), a.collider, difference, limits,
                              a.bytes == b.bytes};
    if (command.json || !command.common.quiet) {
        const std::string text = command.json ? dump(jsonDiff(summary)) : diffText(summary);
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
        ->option_text("PCT");
    verb.add_option("--max-depth", command->max_depth, "Steps by which a depth may differ; default 0")
        ->option_text("STEPS");
    verb.add_option("--max-normal", command->max_normal, "Degrees by which a normal may differ; default 0")
        ->option_text("DEG");
    verb.add_option("--max-texels", command->max_texels,
                    "Share of a map's surfaces, in percent, that may differ by more than that; default 0")
        ->option_text("PCT");
    verb.add_flag("--strict-metadata", command->strict_metadata,
                  "Mesh, tool and options of the bake count too; otherwise they are only shown");
    verb.add_flag("--json", command->json, "Print JSON");
    verb.callback([command, &action] { action = [command] { return runDiff(*command); }; });
}

}  // namespace relief
