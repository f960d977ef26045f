// SPDX-License-Identifier: Apache-2.0
#include "bake/cli/command_bake.h"
#include "bake/cli/command_check.h"
#include "bake/cli/command_view.h"
#include "bake/recipe/recipe_jobs.h"
#include "bake/report/recipe_report.h"
#include "bake/report/world_report.h"
#include "bake/verdict/report_text.h"
#include "bake/world/world_bake.h"
#include "formats/base/file_io.h"
#include "formats/base/stopwatch.h"
#include "formats/base/text.h"
#include "formats/fields/json.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/progress.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// The error of the whole run, if any collider failed.
Result<void> verdict(const fs::path& folder, const WorldBakeResult& result) {
    for (const WorldColliderResult& collider : result.colliders) {
        if (collider.state == WorldColliderState::kFailed) {
            const std::size_t failed = result.countOf(WorldColliderState::kFailed);
            return fail(collider.error.code, std::to_string(failed) + " of " +
                                                 std::to_string(result.colliders.size()) +
                                                 " colliders failed, first that of mesh '" + collider.mesh +
                                                 "': " + collider.error.message + "; " +
                                                 quotedPath(folder / kWorldFileName) + " is unchanged");
        }
    }
    return {};
}

}  // namespace

Result<void> preflightWorld(const BakeCommand& command, FileGuard& files) {
    const fs::path folder = command.world;
    const BakeOutputs& outputs = command.outputs;
    if (!command.output.empty()) {
        return fail(ErrorCode::kUsage, "--output and --world both name the output; remove one");
    }
    if (command.request.mesh.empty()) {
        return fail(ErrorCode::kUsage, "MESH is required; name a level, or see relief bake --help");
    }
    if (folder == "-" || outputs.depfile == "-") {
        return fail(ErrorCode::kUsage,
                    "--world and --depfile cannot be standard output; name a folder and a file");
    }
    RELIEF_TRY(files.reads(command.request.mesh));
    if (outputs.json) {
        RELIEF_TRY(files.writes("-", "--json"));
    }
    RELIEF_TRY(files.writes(folder / kWorldFileName, "--world", folder));
    RELIEF_TRY(reserveWorldFolder(folder, "--world", files));
    RELIEF_TRY(files.writes(outputs.depfile, "--depfile", folder));
    return files.makes(folder, "--world");  // created only if all checks pass
}

Result<void> runWorldCommand(const BakeCommand& command, FileGuard& files) {
    const Stopwatch total;
    const fs::path folder = command.world;
    RELIEF_TRY(checkWorldRequest(command.request));
    RELIEF_TRY(preflightWorld(command, files));
    Progress progress({quotedPath(command.request.mesh), !command.common.quiet, command.request.timeout});
    WorldWatcher watcher;
    watcher.begin = [&](const char* stage) { progress.begin(stage); };
    watcher.ended = [&](std::size_t done, std::size_t all) {
        progress.set(static_cast<double>(done) / static_cast<double>(all));
    };
    watcher.files = &files;
    const WorldBakeResult result =
        RELIEF_TRY(bakeWorld({command.request, folder, command.outputs.compress}, watcher));
    progress.finish();
    RELIEF_TRY(verdict(folder, result));
    logWarnings(result.warnings);
    std::vector<OwnerWarnings> warnings;
    for (const WorldColliderResult& collider : result.colliders) {
        warnings.push_back({collider.mesh, collider.mesh, collider.warnings});
    }
    logWarnings(warningLines(warnings, "meshes", true));
    RELIEF_TRY(writeDepfile(command, (folder / kWorldFileName).string(), result.inputs));
    return printReport(command, WorldBakeJson{result, command.world, total.ms()}, [&] {
        return worldBakeText(result, cleanUtf8(command.world), total.ms(), command.common.verbose);
    });
}

Result<void> runWorldCheck(const CheckCommand& command, const std::string& file, FileGuard& files) {
    const CheckRequest& request = command.request;
    if (request.min_part) {
        return fail(ErrorCode::kUsage, "--min-part has no effect on worlds; remove it");
    }
    const std::string player = RELIEF_TRY(preflightPage(file, request.mesh, command.html, files));
    const WorldField field(RELIEF_TRY(loadWorld(file, command.limits)));
    const World& world = field.world();
    for (std::size_t i = 0; i < world.colliders.size(); ++i) {
        if (world.colliders[i].coarse) {  // loadWorld() skips it
            static_cast<void>(RELIEF_TRY(withPrefix(
                quotedPath(file), loadWorldCollider(world, i, WorldDetail::kCoarse,
                                                    fs::path(file).parent_path(), command.limits))));
        }
    }
    std::optional<WorldAccuracy> accuracy;
    if (!request.mesh.empty()) {
        accuracy = RELIEF_TRY(checkWorld({request, command.within, !command.html.empty()}, field));
        logWarnings(accuracy->warnings);
    }
    const WorldAccuracy* const measured = accuracy ? &*accuracy : nullptr;
    const WorldCheckJson report{inputName(file), &field, measured, command.max_error};
    if (!command.html.empty()) {
        const std::string page = RELIEF_TRY(makeWorldPage(file, report, player, files));
        RELIEF_TRY(writeText(command.html, page));
    }
    RELIEF_TRY(printOut(command.json ? jsonTextOf(report) : worldCheckText(field, report.file, measured)));
    if (!accuracy || accuracy->passes(command.max_error)) {
        return {};
    }
    if (accuracy->all.total() <= double{*command.max_error}) {
        const LostParts& first = accuracy->lost.front();
        return fail(ErrorCode::kDifference, "mesh '" + first.mesh + "': " + first.text);
    }
    const bool floats = accuracy->places.front().cause == WorldCause::kPrecision;  // at the worst body
    return fail(
        ErrorCode::kDifference,
        shortNumber(accuracy->all.total()) +
            " % of the points near the surface are on the wrong side, more than --max-error " +
            shortest(*command.max_error) +
            (floats ? " %; move the meshes to their origins" : " %; bake the level with a larger --budget"));
}

}  // namespace relief
