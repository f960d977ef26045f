#include "bake/cli/command_ground.h"

#include <spdlog/spdlog.h>

#include <cstdio>

#include "bake/ground/ground_report.h"
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
    if (call.request.mesh.empty() || call.output.empty()) {
        return fail(ErrorCode::kUsage,
                    std::string(call.request.mesh.empty() ? "MESH, the height map," : "--output or --world") +
                        " is required; see relief bake --help");
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

}  // namespace

Result<void> runGroundCommand(const std::string& folder, const WorldCall& call) {
    const Stopwatch total;
    static_cast<void>(RELIEF_TRY(settingsOf(call.request)));
    const HeightsSpec heights = RELIEF_TRY(parseHeightsSpec(call.request.heights));
    RELIEF_TRY(preflightGround(folder, call));
    Progress progress({quotedPath(call.request.mesh), !call.common.quiet, call.request.time_limit});
    progress.begin("baking the ground");
    const GroundResult result = RELIEF_TRY(bakeGroundOf(
        call.request, {heights, folder, call.outputs.compress, [&](double share) { progress.set(share); }}));
    progress.finish();
    const std::string written =
        folder.empty() ? call.output : (std::filesystem::path(folder) / kWorldFileName).string();
    RELIEF_TRY(writeOutputs(written, folder, call, result));
    for (const std::string& warning : result.warnings) {
        spdlog::warn(warning);
    }
    const std::string& output = folder.empty() ? call.output : folder;
    if (call.outputs.json) {
        return printOut(jsonText(jsonOf(GroundJson{result, output, toString(heights), total.ms()})));
    }
    if (!call.common.quiet) {
        std::fputs(groundText(result, cleanUtf8(output), total.ms()).c_str(), stderr);
    }
    return {};
}

}  // namespace relief
