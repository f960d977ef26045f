// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "bake/cli/command_bake.h"
#include "bake/cli/command_check.h"
#include "bake/import/import_format.h"
#include "bake/report/ground_report.h"
#include "formats/base/file_io.h"
#include "formats/base/stopwatch.h"
#include "formats/base/text.h"
#include "formats/fields/json.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/progress.h"

namespace relief {
namespace {

/// The field of a world, or of a collider as the only body of a world.
Result<WorldField> fieldOf(const std::string& file, const ContainerLimits& limits) {
    if (isWorldFile(file)) {
        return WorldField(RELIEF_TRY(loadWorld(file, limits)));
    }
    LoadedWorld single;
    single.world.colliders.emplace_back();
    single.world.bodies.emplace_back();
    single.colliders.push_back(RELIEF_TRY(readColliderFile(file, limits)).collider);
    return WorldField(std::move(single));
}

Result<void> checkOptions(const std::string& file, const CheckCommand& command) {
    const std::string import_option =
        importOptionOf(command.request.import, {.triangles = command.request.import_limits.triangles});
    const std::string option = !command.html.empty()      ? "--page"
                               : command.request.min_part ? "--min-part"
                                                          : import_option;
    if (!option.empty()) {
        return fail(ErrorCode::kUsage, option + " has no effect with a height map; remove it");
    }
    if (file == "-" && command.request.mesh == "-") {
        return fail(ErrorCode::kUsage,
                    "the collider and the height map cannot both be standard input; name a file for one");
    }
    return {};
}

bool isHeightMapExtension(const std::string& extension) {
    constexpr std::array<std::string_view, 5> kExtensions = {".png", ".exr", ".raw", ".r16", ".hgt"};
    return std::ranges::find(kExtensions, lowerCase(extension)) != kExtensions.end();
}

/// Returns the settings recorded in the ground. \param mesh  the value of --mesh
Result<HeightsSpec> recorded(const WorldField& field, const std::string& name, const std::string& mesh) {
    Result<HeightsSpec> heights = recordedHeights(field, name);
    const std::string extension = std::filesystem::path(mesh).extension().string();
    if (heights || isHeightMapExtension(extension)) {
        return heights;
    }
    return fail(ErrorCode::kUnsupported, inputText(mesh) + ": no mesh format has the extension '" +
                                             cleanUtf8(extension) + "', and " + heights.error().message);
}

}  // namespace

bool isHeightMapFile(const std::string& file) {
    const std::string extension = std::filesystem::path(file).extension().string();
    const bool mesh = !extension.empty() && meshFormat(extension.substr(1)) != nullptr;
    std::error_code error;
    return !mesh &&
           (file == "-" || isHeightMapExtension(extension) || std::filesystem::is_regular_file(file, error));
}

Result<void> runGroundCheck(const CheckCommand& command, const std::string& file) {
    RELIEF_TRY(checkOptions(file, command));
    const CheckRequest& check = command.request;
    const std::string name = inputName(file);
    std::optional<HeightsSpec> heights;
    if (!command.heights.empty()) {
        heights = RELIEF_TRY(parseHeightsSpec(command.heights));
    }
    const WorldField field = RELIEF_TRY(fieldOf(file, command.limits));
    if (!heights) {
        heights = RELIEF_TRY(recorded(field, name, check.mesh));
    }
    Progress progress({quotedPath(check.mesh), !command.common.quiet, {}});
    progress.begin("measuring the ground");
    GroundCheckRequest request{check.mesh, *heights, check.samples, check.seed, {}};
    request.within = command.within;
    request.limits = check.import_limits;
    request.progress = [&](double share) { progress.set(share); };
    const GroundAccuracy accuracy = RELIEF_TRY(checkGround(request, field, name));
    progress.finish();
    logWarnings(accuracy.warnings);
    RELIEF_TRY(printOut(
        command.json ? jsonTextOf(GroundCheckJson{accuracy, name, toString(*heights), command.max_error})
                     : groundCheckText(accuracy, name)));
    const double wrong = accuracy.near.wrong.total();
    if (command.max_error && wrong > double{*command.max_error}) {
        return fail(ErrorCode::kDifference,
                    shortNumber(wrong) +
                        " % of the points near the surface are on the wrong side, more than --max-error " +
                        shortest(*command.max_error) +
                        " %; set --mesh and --heights as in the bake, or raise --max-error");
    }
    return {};
}

Result<void> runGroundCommand(const BakeCommand& command, FileGuard& files) {
    const Stopwatch total;
    const std::string& folder = command.world;
    static_cast<void>(RELIEF_TRY(settingsOf(command.request)));
    if (folder.empty() && command.request.mesh.empty()) {
        return fail(ErrorCode::kUsage, "MESH is required; name a height map, or see relief bake --help");
    }
    RELIEF_TRY(folder.empty() ? preflightBake(command, files) : preflightWorld(command, files));
    Progress progress({quotedPath(command.request.mesh), !command.common.quiet, command.request.timeout});
    progress.begin("baking the ground");
    const GroundResult result = RELIEF_TRY(bakeHeightMap(
        command.request, {{}, folder, command.outputs.compress, [&](double share) { progress.set(share); }}));
    progress.finish();
    if (folder.empty()) {
        RELIEF_TRY(writeFile(command.output, result.container));
    }
    RELIEF_TRY(writeDepfile(
        command, folder.empty() ? command.output : (std::filesystem::path(folder) / kWorldFileName).string(),
        result.inputs));
    logWarnings(result.warnings);
    const std::string& output = folder.empty() ? command.output : folder;
    return printReport(command, GroundJson{result, output, toString(result.heights), total.ms()},
                       [&] { return groundText(result, cleanUtf8(output), total.ms()); });
}

}  // namespace relief
