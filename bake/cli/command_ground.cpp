// SPDX-License-Identifier: Apache-2.0
#include "bake/cli/command_ground.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cstdio>

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

Result<void> preflightGround(const std::string& folder, const WorldCall& call) {
    if (!folder.empty()) {
        return preflightWorld(folder, call);
    }
    if (call.request.mesh.empty()) {
        return fail(ErrorCode::kUsage, "MESH is required; name a height map, or see relief bake --help");
    }
    return preflightBake(call.request, call.output, call.outputs, call.files);
}

Result<void> writeOutputs(const std::string& written, const std::string& folder, const WorldCall& call,
                          const GroundResult& result) {
    if (folder.empty()) {
        RELIEF_TRY(writeFile(call.output, result.container));
    }
    return call.outputs.depfile.empty() ? Result<void>()
                                        : writeDepfile(call.outputs.depfile, {written}, {call.request.mesh});
}

/// The field of a world, or of a collider as the only body of a world.
Result<WorldField> fieldOf(const std::string& file, const ContainerLimits& limits) {
    if (namesWorld(file)) {
        return WorldField(RELIEF_TRY(loadWorld(file, limits)));
    }
    LoadedWorld single;
    single.world.colliders.emplace_back();
    single.world.bodies.emplace_back();
    single.colliders.push_back(RELIEF_TRY(readColliderFile(file, limits)).collider);
    return WorldField(std::move(single));
}

Result<void> checkOptions(const std::string& file, const WorldCheckCall& call) {
    ImportLimits of_mesh;
    of_mesh.triangles = call.request.import_limits.triangles;
    const std::string of_import = importOptionOf(call.request.import, of_mesh);
    const std::string option = !call.html.empty()      ? "--page"
                               : call.request.min_part ? "--min-part"
                                                       : of_import;
    if (!option.empty()) {
        return fail(ErrorCode::kUsage, option + " has no effect with a height map; remove it");
    }
    if (file == "-" && call.request.mesh == "-") {
        return fail(ErrorCode::kUsage,
                    "the collider and the height map cannot both be standard input; name a file for one");
    }
    return {};
}

bool isHeightMapExtension(const std::string& extension) {
    constexpr std::array<std::string_view, 5> kExtensions = {".png", ".exr", ".raw", ".r16", ".hgt"};
    return std::ranges::find(kExtensions, lowerCase(extension)) != kExtensions.end();
}

/// Returns the settings that the ground records. \param mesh  the value of --mesh
Result<HeightsSpec> recorded(const WorldField& field, const std::string& name, const std::string& mesh) {
    Result<HeightsSpec> heights = recordedHeights(field, name);
    const std::string extension = std::filesystem::path(mesh).extension().string();
    if (heights || isHeightMapExtension(extension)) {
        return heights;
    }
    return fail(ErrorCode::kUnsupported, shownInput(mesh) + ": no mesh format has the extension '" +
                                             cleanUtf8(extension) + "', and " + heights.error().message);
}

}  // namespace

bool namesHeightMap(const std::string& file) {
    const std::string extension = std::filesystem::path(file).extension().string();
    const bool mesh = !extension.empty() && meshFormat(extension.substr(1)) != nullptr;
    std::error_code error;
    return !mesh &&
           (file == "-" || isHeightMapExtension(extension) || std::filesystem::is_regular_file(file, error));
}

Result<void> runGroundCheck(const std::string& file, const GroundCheckCall& call) {
    const WorldCheckCall& world = call.world;
    RELIEF_TRY(checkOptions(file, world));
    const std::string name = inputName(file);
    std::optional<HeightsSpec> heights;
    if (!call.heights.empty()) {
        heights = RELIEF_TRY(parseHeightsSpec(call.heights));
    }
    const WorldField field = RELIEF_TRY(fieldOf(file, world.limits));
    if (!heights) {
        heights = RELIEF_TRY(recorded(field, name, world.request.mesh));
    }
    Progress progress({quotedPath(world.request.mesh), !call.quiet, {}});
    progress.begin("measuring the ground");
    GroundCheckRequest request{world.request.mesh, *heights, world.request.samples, world.request.seed, {}};
    request.within = world.within;
    request.limits = world.request.import_limits;
    request.progress = [&](double share) { progress.set(share); };
    const GroundAccuracy accuracy = RELIEF_TRY(checkGround(request, field, name));
    progress.finish();
    for (const std::string& warning : accuracy.warnings) {
        spdlog::warn(warning);
    }
    RELIEF_TRY(printOut(world.json
                            ? jsonTextOf(GroundCheckJson{accuracy, name, toString(*heights), world.max_error})
                            : groundCheckText(accuracy, name)));
    if (world.max_error && accuracy.near.wrong.total() > double{*world.max_error}) {
        return fail(ErrorCode::kDifference,
                    shortNumber(accuracy.near.wrong.total()) +
                        " % of the points near the surface are on the wrong side, more than --max-error " +
                        shortest(*world.max_error) + " %; bake this height map again");
    }
    return {};
}

Result<void> runGroundCommand(const std::string& folder, const WorldCall& call) {
    const Stopwatch total;
    static_cast<void>(RELIEF_TRY(settingsOf(call.request)));
    RELIEF_TRY(preflightGround(folder, call));
    Progress progress({quotedPath(call.request.mesh), !call.common.quiet, call.request.timeout});
    progress.begin("baking the ground");
    const GroundResult result = RELIEF_TRY(bakeGroundOf(
        call.request, {{}, folder, call.outputs.compress, [&](double share) { progress.set(share); }}));
    progress.finish();
    const std::string written =
        folder.empty() ? call.output : (std::filesystem::path(folder) / kWorldFileName).string();
    RELIEF_TRY(writeOutputs(written, folder, call, result));
    for (const std::string& warning : result.warnings) {
        spdlog::warn(warning);
    }
    const std::string& output = folder.empty() ? call.output : folder;
    if (call.outputs.json) {
        return printOut(jsonTextOf(GroundJson{result, output, toString(result.heights), total.ms()}));
    }
    if (!call.common.quiet) {
        std::fputs(groundText(result, cleanUtf8(output), total.ms()).c_str(), stderr);
    }
    return {};
}

}  // namespace relief
