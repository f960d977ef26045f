// SPDX-License-Identifier: Apache-2.0
#include "bake/cli/command_world.h"

#include <spdlog/spdlog.h>

#include <cstdio>
#include <span>

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

Result<void> writeWorldDepfile(const fs::path& folder, const WorldCall& call, const WorldBakeResult& result) {
    std::vector<std::string> names;
    for (const InputFile& input : result.inputs) {
        names.push_back(input.path);
    }
    return call.outputs.depfile.empty()
               ? Result<void>()
               : writeDepfile(call.outputs.depfile, {(folder / kWorldFileName).string()}, names);
}

void showMessages(const WorldBakeResult& result) {
    for (const std::string& warning : result.warnings) {
        spdlog::warn(warning);
    }
    std::vector<OwnWarnings> all;
    for (const WorldColliderResult& collider : result.colliders) {
        all.push_back({collider.mesh, collider.mesh, collider.warnings});
    }
    for (const std::string& warning : warningLines(all, "meshes", true)) {
        spdlog::warn(warning);
    }
}

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

/// Reads the coarse containers, which loadWorld() skips.
Result<void> checkCoarse(const World& world, const std::string& file, const ContainerLimits& limits) {
    for (std::size_t i = 0; i < world.colliders.size(); ++i) {
        if (world.colliders[i].coarse) {
            static_cast<void>(RELIEF_TRY(withPrefix(
                quotedPath(file),
                loadWorldCollider(world, i, WorldDetail::kCoarse, fs::path(file).parent_path(), limits))));
        }
    }
    return {};
}

}  // namespace

Result<void> preflightWorld(const fs::path& folder, const WorldCall& call) {
    if (!call.output.empty()) {
        return fail(ErrorCode::kUsage, "--output and --world both name the output; remove one");
    }
    if (call.request.mesh.empty()) {
        return fail(ErrorCode::kUsage, "MESH is required; name a level, or see relief bake --help");
    }
    if (folder == "-" || call.outputs.depfile == "-") {
        return fail(ErrorCode::kUsage,
                    "--world needs a folder and --depfile a file, not standard output; name them");
    }
    RELIEF_TRY(call.files.reads(call.request.mesh));
    if (call.outputs.json) {
        RELIEF_TRY(call.files.writes("-", "--json"));
    }
    RELIEF_TRY(call.files.writes(folder / kWorldFileName, "--world", folder));
    RELIEF_TRY(ownWorldFolder(folder, "--world", call.files));
    RELIEF_TRY(call.files.writes(call.outputs.depfile, "--depfile", folder));
    return call.files.makes(folder, "--world");  // created only if all checks pass
}

void addWorldOption(CLI::App& verb, std::string& folder) {
    addOption(verb, "--world", folder,
              withDetails("Bake a level into this folder: a collider for each distinct mesh, and world.json, "
                          "which places them",
                          "Each distinct mesh is baked once, however many nodes place it. Only what has "
                          "changed is baked again. Options that choose maps, such as --map, --holes keep and "
                          "--max-error, are for one mesh; the others apply to every mesh."))
        ->valueText("DIR")
        ->excludes("--recipe");
}

Result<void> runWorldCommand(const std::string& folder_name, const WorldCall& call) {
    const Stopwatch total;
    const fs::path folder = folder_name;
    RELIEF_TRY(checkWorldRequest(call.request));
    RELIEF_TRY(preflightWorld(folder, call));
    Progress progress({quotedPath(call.request.mesh), !call.common.quiet, call.request.timeout});
    WorldWatcher watcher;
    watcher.begin = [&](const char* stage) { progress.begin(stage); };
    watcher.ended = [&](std::size_t done, std::size_t all) {
        progress.set(static_cast<double>(done) / static_cast<double>(all));
    };
    watcher.files = &call.files;
    const WorldBakeResult result =
        RELIEF_TRY(bakeWorld({call.request, folder, call.outputs.compress}, watcher));
    progress.finish();
    RELIEF_TRY(verdict(folder, result));
    showMessages(result);
    RELIEF_TRY(writeWorldDepfile(folder, call, result));
    if (call.outputs.json) {
        return printOut(jsonTextOf(WorldBakeJson{result, folder_name, total.ms()}));
    }
    if (!call.common.quiet) {
        std::fputs(worldBakeText(result, cleanUtf8(folder_name), total.ms(), call.common.verbose).c_str(),
                   stderr);
    }
    return {};
}

namespace {

Result<void> writePage(const std::string& file, const WorldCheckCall& call, const WorldField& field,
                       const WorldAccuracy& accuracy, const std::string& player) {
    const std::string page = RELIEF_TRY(
        makeWorldPage(file, {inputName(file), &field, &accuracy, call.max_error}, player, call.files));
    return writeFile(call.html, std::as_bytes(std::span(page)));
}

}  // namespace

Result<void> runWorldCheck(const std::string& file, const WorldCheckCall& call) {
    if (call.request.min_part) {
        return fail(ErrorCode::kUsage, "--min-part has no effect on worlds; remove it");
    }
    const std::string player = RELIEF_TRY(preflightPage(file, call.request.mesh, call.html, call.files));
    const WorldField field(RELIEF_TRY(loadWorld(file, call.limits)));
    RELIEF_TRY(checkCoarse(field.world(), file, call.limits));
    std::optional<WorldAccuracy> accuracy;
    if (!call.request.mesh.empty()) {
        accuracy = RELIEF_TRY(checkWorld({call.request, call.within, !call.html.empty()}, field));
        for (const std::string& warning : accuracy->warnings) {
            spdlog::warn(warning);
        }
    }
    if (!call.html.empty()) {
        RELIEF_TRY(writePage(file, call, field, *accuracy, player));
    }
    const std::string name = inputName(file);
    const WorldAccuracy* const measured = accuracy ? &*accuracy : nullptr;
    RELIEF_TRY(printOut(call.json ? jsonTextOf(WorldCheckJson{name, &field, measured, call.max_error})
                                  : worldCheckText(field, name, measured)));
    if (accuracy && !accuracy->passes(call.max_error)) {
        if (accuracy->all.total() <= double{*call.max_error}) {
            const LostParts& first = accuracy->lost.front();
            return fail(ErrorCode::kDifference, "mesh '" + first.mesh + "': " + first.text);
        }
        const bool floats = accuracy->places.front().cause == WorldCause::kPrecision;  // at the worst body
        return fail(ErrorCode::kDifference,
                    shortNumber(accuracy->all.total()) +
                        " % of the points near the surface are on the wrong side, more than "
                        "--max-error " +
                        shortest(*call.max_error) +
                        (floats ? " %; move its meshes to their origins"
                                : " %; bake the level with a larger --budget"));
    }
    return {};
}

}  // namespace relief
