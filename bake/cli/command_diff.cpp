// relief diff: where two colliders differ.
#include <CLI/CLI.hpp>

#include "bake/cli/command.h"
#include "bake/report/diff_report.h"
#include "formats/fields/json.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"

namespace relief {
namespace {

constexpr float kMost = std::numeric_limits<float>::max();

struct DiffCommand {
    CommonOptions common;
    std::string a;
    std::string b;
    ContainerLimits limits;
    DiffReport report;  // its limits
    bool json = false;
};

Result<void> runDiff(const DiffCommand& command) {
    if (command.a == "-" && command.b == "-") {
        return fail(ErrorCode::kUsage, "A and B cannot both be standard input; give one of them a file");
    }
    const ColliderFile a = RELIEF_TRY(readColliderFile(command.a, command.limits));
    const ColliderFile b = RELIEF_TRY(readColliderFile(command.b, command.limits));
    DiffReport report = command.report;
    report.a = shownInput(command.a);
    report.b = shownInput(command.b);
    report.same_bytes = a.bytes == b.bytes;
    report.compare(a.collider, b.collider);
    if (command.json || !command.common.quiet) {
        RELIEF_TRY(printOut(command.json ? jsonText(jsonOf(report)) : report.text()));
    }
    if (const std::string verdict = report.verdict(); !verdict.empty()) {
        return fail(ErrorCode::kDifference, report.a + " and " + report.b + " differ: " + verdict);
    }
    return {};
}

}  // namespace

void addDiff(CLI::App& app, Action& action) {
    auto command = std::make_shared<DiffCommand>();
    CLI::App& verb =
        addVerb(app, command->common, "diff",
                "Compares two colliders\n\nLists the fields that differ, of the colliders and of map i "
                "of A and map i of B, and then\nevaluates both at the same points near their surfaces. "
                "Exit code 7 for any difference; with --max-sides or\n--max-distance, only for points "
                "beyond them, whatever the maps.",
                "relief diff before.relief after.relief\n"
                "relief diff before.relief after.relief --max-sides 0.1%\n"
                "relief diff small.relief large.relief --max-sides 1% --max-distance 0.002\n"
                "relief bake bunny.obj -o - -q | relief diff golden.relief - --json");
    verb.add_option("A", command->a, "A collider; - for standard input")->type_name("")->required();
    verb.add_option("B", command->b, "The one to compare it with; - for standard input")
        ->type_name("")
        ->required();
    verb.add_option("--max-sides", command->report.max_sides,
                    "Share of the points near the surfaces, in percent, that may be on another side")
        ->option_text("PCT")
        ->transform(percent());
    verb.add_option("--max-distance", command->report.max_distance,
                    "Length, in object units, by which 99 % of the distances near the surfaces may differ")
        ->option_text("LENGTH")
        ->transform(number(0.0F, kMost, "a length in object units, 0 or more"));
    addMemoryOption(verb, command->limits);
    verb.add_flag("--json", command->json, "Print JSON");
    verb.callback([command, &action] { action = [command](FileGuard&) { return runDiff(*command); }; });
}

}  // namespace relief
