// SPDX-License-Identifier: Apache-2.0
// relief check: validates containers, and measures colliders against their meshes.
#include "bake/cli/command_check.h"

#include <tuple>

#include "bake/cli/command_view.h"
#include "bake/cli/option_details.h"
#include "bake/report/bake_report.h"
#include "bake/report/inspect_report.h"
#include "bake/report/mesh_check_report.h"
#include "bake/verdict/parts_report.h"
#include "bake/verdict/report_text.h"
#include "formats/animation/animated_mesh.h"
#include "formats/base/file_io.h"
#include "formats/base/result.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "formats/container_reader.h"
#include "formats/fields/json.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"

namespace relief {
namespace {

/// Prints the report of inspectContainer, also for a damaged file.
/// Errors: kIo, kLimit; kInvalidInput or Inspection::errorCode() if the file is damaged.
Result<void> checkFile(const std::string& file, bool json, const ContainerLimits& limits) {
    const std::vector<std::byte> bytes = RELIEF_TRY(readFile(file, containerSizeMax(limits)));
    const std::string quoted = inputText(file);
    const Inspection inspection = RELIEF_TRY(withPrefix(quoted, inspectContainer(bytes, limits)));
    if (!inspection.damaged()) {
        // The inspection does not read the animation.
        const Collider collider = RELIEF_TRY(withPrefix(quoted, readContainer(bytes, limits)));
        if (!collider.animation.empty()) {
            if (const Result<AnimatedMesh> mesh = readAnimatedMesh(collider.animation); !mesh) {
                return fail(mesh.error().code, quoted + ": " + mesh.error().message + "; bake it again");
            }
        }
    }
    const std::string name = inputName(file);
    const Result<void> printed =
        printOut(json ? jsonTextOf(InspectionReport{inspection, name}) : inspectionText(inspection, name));
    if (!printed || !inspection.damaged()) {
        return printed;
    }
    RELIEF_TRY(rejectMesh(file, bytes));
    for (const Issue& issue : inspection.issues) {
        if (issue.severity() != Severity::kWarning) {
            const std::string map = issue.map >= 0 ? "map " + std::to_string(issue.map) + ": " : "";
            return fail(inspection.errorCode(), quoted + " is not usable: " + issue.id() + ", " + map +
                                                    issue.message + fixFor(issue.code, inspection.major));
        }
    }
    return {};
}

std::string checkText(const MeshCheckReport& report) {
    const MeshCheck& run = report.run;
    const auto& [samples, accuracy] = run.judged();
    std::string text = report.file + ": " + report.verdict().text + "\n";
    if (const std::string inside = insideVerdictText(accuracy.field.inside); !inside.empty()) {
        text += report.file + ": " + inside + "\n";
    }
    if (run.repaired) {
        const std::string repaired = "the mesh repaired by " + run.recorded.request.repair.method + ", " +
                                     std::to_string(run.baked->triangles.size()) + " triangles";
        const std::string original = run.mesh->name + " before repair";
        const auto& [judged, other, wrong] =
            report.max_error ? std::tuple(original, repaired, run.wrongPercent())
                             : std::tuple(repaired, original, run.original.accuracy.field.near.total());
        text +=
            "The verdict is for " + judged + "; for " + other + ", " + shortNumber(wrong) + " % are wrong\n";
    }
    for (const std::string& part :
         {partsText(run.part_accuracy, run.parts, run.collider), placesText(run.places, run.collider),
          adviceText(run.advice, run.wrongPercent())}) {
        text += part.empty() ? "" : "\n" + part;
    }
    return text + "\nMeasured against " + run.mesh->name +
           (run.recorded.request.animated ? " in its rest pose" : "") +
           (run.repaired ? " repaired, " : ", ") +
           std::to_string((run.repaired ? run.baked : run.mesh)->sourceTriangles()) + " triangles" +
           (run.watertight || run.repaired ? "" : " (not closed)") + "\n" +
           shapeText(run.shape, run.collider.unit) + "\n" +
           accuracyText(accuracy, samples, run.collider.unit) + "\n" +
           proofText(run.proof, samples.longest_side, run.collider.unit);
}

Result<void> runCheck(const CheckCommand& command, const std::string& file, FileGuard& files) {
    if (!command.heights.empty() || isHeightMapFile(command.request.mesh)) {
        return runGroundCheck(command, file);
    }
    if (isWorldFile(file)) {
        return runWorldCheck(command, file, files);
    }
    if (command.within) {
        return fail(ErrorCode::kUsage, "--within applies only to worlds and ground; remove it");
    }
    if (command.request.mesh.empty()) {
        return checkFile(file, command.json, command.limits);
    }
    static_cast<void>(RELIEF_TRY(preflightPage(file, command.request.mesh, command.html, files)));
    auto [container, collider] = RELIEF_TRY(readColliderFile(file, command.limits));
    MeshCheck run = RELIEF_TRY(check(command.request, std::move(collider)));
    showCheckWarnings(run);
    // The files that the mesh references are known only after its import.
    for (const std::string& read : run.imported->dependencies) {
        RELIEF_TRY(files.reads(read));
    }
    const bool passed = run.passes(command.max_error);
    // No advice applies to an animated collider, because its maps are fixed.
    if (!run.recorded.request.animated &&
        !(passed && (command.max_error || run.wrongPercent() <= kGoodPercent))) {
        run.advice = adviceFor(run, command.request.mesh, file == "-" ? "out.relief" : file);
    }
    const MeshCheckReport report{run, inputName(file), command.max_error};
    if (!command.html.empty()) {
        const std::string page =
            RELIEF_TRY(makeCheckPage(report.file, container.size(), report.run, report.max_error));
        RELIEF_TRY(writeText(command.html, page));
    }
    RELIEF_TRY(printOut(command.json ? jsonTextOf(report) : checkText(report)));
    if (!passed && run.original.accuracy.field.near.total() <= double{*command.max_error}) {
        return fail(ErrorCode::kDifference, *lostPartsWarning(run.part_accuracy, run.parts, run.collider) +
                                                "; --min-part LENGTH ignores shorter parts");
    }
    if (!passed) {
        return fail(ErrorCode::kDifference,
                    shortNumber(run.original.accuracy.field.near.total()) +
                        " % of the points near the surface are on the wrong side" +
                        (run.repaired ? " of the mesh before repair" : "") + ", more than --max-error " +
                        shortest(*command.max_error) + " %; " +
                        (floatsLimit(*run.mesh, run.wrongPercent()) ? "move the mesh to the origin"
                                                                    : "bake with larger or more maps"));
    }
    return {};
}

}  // namespace

void addCheck(CLI::App& app, Action& action) {
    auto command = std::make_shared<CheckCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "check",
        withDetails(
            "Check a container, or measure a collider against its mesh\n\n"
            "Without --mesh, it lists the issues of each file, with their codes, and the sections of a "
            "damaged file that are usable. With --mesh, it prints a verdict, the three worst places with "
            "their causes, and commands that may help.",
            "formats/README.md lists the codes.\n"
            "With --mesh, the report also contains the percentage of wrong points near the surface and in "
            "the whole box, the errors of distance and normal, and the fraction of the surface that no map "
            "sees. Most commands were tried in memory; others are marked \"not tried\". Truth is the parity "
            "of rays through the mesh, independent of the maps. A collider baked with --repair is also "
            "measured against the repaired mesh.\n"
            "For a world.json of relief bake --world, it checks that all containers are present and correct. "
            "With --mesh, it prints the percentage of wrong points near each body, the ten worst places, and "
            "the meshes that lose parts.\n"
            "For ground of relief bake --heights, --mesh names the height map. It prints the percentage of "
            "wrong points near the surface and near seams between tiles, the error along y, and the ten "
            "worst places."),
        "relief check bunny.relief\n"
        "relief check *.relief\n"
        "relief check bunny.relief --mesh bunny.obj\n"
        "relief check bunny.relief --mesh bunny.obj --page bunny.html\n"
        "relief check bunny.relief --mesh bunny.obj --max-error 2 --json\n"
        "relief check level/world.json --mesh level.glb\n"
        "relief check ground/world.json --mesh heights.png");
    addOption(verb, "FILE", command->files,
              "Collider or world.json; - for standard input; several only without --mesh")
        ->typeName("")
        ->required();
    OptionRef mesh = addMeshOptions(verb, command->request);
    addOption(verb, "--max-error", command->max_error,
              "Exit with code 7 if more than this percentage of points near the surface is wrong, or a part "
              "is lost")
        ->valueText("PCT")
        ->transform(percent())
        ->needs(mesh);
    addOption(
        verb, "--heights", command->heights,
        "Settings of the height map --mesh: KEY=VALUE,... as in relief bake (default: those of the bake)")
        ->valueText("SPEC")
        ->needs(mesh);
    addOption(
        verb, "--within", command->within,
        withDetails(
            "Maximum distance of sample points from the surface of a world or ground, in world units",
            "By default, nearly all points of a body lie within 1.5 % of its longest side, and those of "
            "ground within the distance between samples."))
        ->valueText("LENGTH")
        ->range(1e-6, 1e15)
        ->needs(mesh);
    addOption(verb, "--page", command->html,
              "Also write the page of relief view with the verdict, the worst places and the advice; not for "
              "height maps")
        ->valueText("OUT.html")
        ->needs(mesh);
    addFields(verb, command->request.import);
    addFields(verb, command->request.import_limits);
    addMemoryOption(verb, command->limits);
    addFlag(verb, "--json", command->json, "Print the report as JSON");
    groupVerbOptions(
        verb, {{"Comparison with the mesh",
                {"--mesh", "--max-error", "--samples", "--seed", "--min-part", "--heights", "--within"}},
               {"Output", {"--page", "--json"}}});
    setAction(verb, action, [command](FileGuard& files) -> Result<void> {
        if (command->files.size() > 1 && !command->request.mesh.empty()) {
            return fail(ErrorCode::kUsage, "--mesh needs a single FILE; check each collider separately");
        }
        return forEachFile(command->files,
                           [&](const std::string& file) { return runCheck(*command, file, files); });
    });
}

}  // namespace relief
