// SPDX-License-Identifier: Apache-2.0
// relief bake: bakes a mesh into a collider.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <span>

#include "bake/cli/command.h"
#include "bake/cli/command_ground.h"
#include "bake/cli/command_recipe.h"
#include "bake/cli/command_world.h"
#include "bake/cli/option_details.h"
#include "bake/pipeline/bake.h"
#include "bake/report/bake_report.h"
#include "bake/verdict/report_text.h"
#include "formats/base/file_io.h"
#include "formats/base/stopwatch.h"
#include "formats/container.h"
#include "formats/fields/json.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"
#include "runtime/command_line/progress.h"

namespace relief {
namespace {

struct BakeCommand {
    CommonOptions common;
    BakeRequest request;
    std::string output;
    BakeOutputs outputs;
    BakeRecipeOptions recipe;
    std::string world;  // folder
};

/// Shows the stages of a bake on the terminal.
BakeWatcher watcherOf(Progress& progress, FileGuard& files) {
    BakeWatcher watcher;
    watcher.begin = [&progress](const char* stage) { progress.begin(stage); };
    watcher.progress = [&progress](double share) { progress.set(share); };
    watcher.tried = [&progress](const BudgetTry& made) {
        progress.print([&made] {
            spdlog::info("{}: {:.3g} % of the points near the surface are on the wrong side",
                         bytesText(made.budget), made.wrong_percent);
        });
    };
    watcher.imported = [&progress](const TriangleMesh& mesh) {
        progress.print([&mesh] {
            spdlog::debug("{}: {} triangles, {} vertices, XXH3-128 {}", mesh.name, mesh.triangles.size(),
                          mesh.positions.size(), mesh.content_hash);
            if (mesh.dropped_triangles > 0) {
                spdlog::debug("{}: {} triangles without area dropped", mesh.name, mesh.dropped_triangles);
            }
        });
    };
    watcher.files = &files;
    return watcher;
}

/// Logs notices and warnings. Call it after the bake has succeeded, because a failed bake prints one line only.
void showNotices(BakeResult& result, std::size_t file_size) {
    const std::uint64_t in_memory = result.baked.collider.texelBytes();
    std::vector<std::string>& warnings = result.baked.report.warnings;
    if (in_memory > std::max(kToolMemory, kUnpackedPerStored * file_size)) {
        warnings.push_back(result.mesh.mesh->name + ": its maps take " + bytesText(in_memory) +
                           " in memory, for a file of " + bytesText(file_size) +
                           "; other tools read it with --max-memory " + std::to_string(in_memory));
    }
    for (const std::string& notice : result.notices) {
        spdlog::info(notice);
    }
    for (const std::string& warning : warnings) {
        spdlog::warn(warning);
    }
}

/// Writes the collider and its depfile.
Result<void> writeOutputs(const BakeCommand& command, const BakeResult& result,
                          std::span<const std::byte> bytes) {
    RELIEF_TRY(writeFile(command.output, bytes));
    if (command.outputs.depfile.empty()) {
        return {};
    }
    std::vector<std::string> names;
    for (const InputFile& input : result.inputs) {
        names.push_back(input.path);
    }
    return writeDepfile(command.outputs.depfile, {command.output}, names);
}

Result<void> report(const BakeCommand& command, const BakeResult& result, std::span<const std::byte> bytes) {
    if (command.outputs.json) {
        const ContainerInfo info = RELIEF_TRY(readContainerInfo(bytes));
        return printOut(jsonTextOf(BakeJson{result, info, command.output, command.outputs.compress}));
    }
    if (!command.common.quiet) {
        std::fputs(bakeText(result, command.output, bytes.size(), command.common.verbose).c_str(), stderr);
    }
    return {};
}

/// Bakes a mesh, animated or not.
Result<void> runMeshCommand(BakeCommand& command, FileGuard& files) {
    if (command.request.mesh.empty()) {
        return fail(ErrorCode::kUsage, "MESH is required; name a mesh file, or see relief bake --help");
    }
    const Stopwatch total;
    Progress progress({quotedPath(command.request.mesh), !command.common.quiet, command.request.timeout});
    static_cast<void>(RELIEF_TRY(settingsOf(command.request)));
    RELIEF_TRY(preflightBake(command.request, command.output, command.outputs, files));
    command.request.repair.examine = command.outputs.json || !command.common.quiet;
    BakeResult result = RELIEF_TRY(bake(command.request, watcherOf(progress, files)));
    Stopwatch writing;
    progress.begin("packing the collider");
    const std::vector<std::byte> bytes =
        RELIEF_TRY(writeContainer(result.baked.collider, {static_cast<int>(command.outputs.compress)}));
    progress.finish();
    showNotices(result, bytes.size());
    RELIEF_TRY(writeOutputs(command, result, bytes));
    result.times.write_ms = writing.ms();
    result.times.total_ms = total.ms();
    return report(command, result, bytes);
}

/// Bakes a recipe, a height map, a level or a mesh.
Result<void> runBake(BakeCommand& command, const CLI::App& verb, FileGuard& files) {
    if (!command.recipe.recipe.empty()) {
        return runRecipeCommand(command.recipe,
                                {verb, command.common, command.output, command.request.threads,
                                 command.outputs.depfile, command.outputs.json, files});
    }
    if (command.output.empty() && command.world.empty()) {
        // A folder has no file name: bakes reject it.
        const std::filesystem::path mesh(command.request.mesh);
        command.output = mesh.filename().replace_extension(kColliderExtension).string();
    }
    const WorldCall call{command.request, command.outputs, command.common, command.output, files};
    return !command.request.heights.empty() ? runGroundCommand(command.world, call)
           : !command.world.empty()         ? runWorldCommand(command.world, call)
                                            : runMeshCommand(command, files);
}

}  // namespace

void addBake(CLI::App& app, Action& action) {
    auto command = std::make_shared<BakeCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "bake",
        withDetails(
            "Bake a mesh into a collider\n\n"
            "By default, the collider consists of patches: small depth maps in an octree, 1 MB in all. Set "
            "their size with --budget, their resolution with --texel, or their accuracy with --max-error. "
            "Rays through each part of the mesh classify it as a solid, a shell or terrain; --as overrides "
            "this. At the end, the bake checks the result.",
            "--map and --paper bake depth maps of the whole mesh instead. --animated bakes a mesh that "
            "moves, --world a level of many meshes, --heights ground from a height map, and --recipe all "
            "assets that a file lists."),
        "relief bake bunny.obj\n"
        "relief bake bunny.obj -o bunny.relief --budget 256kB\n"
        "relief bake bunny.obj -o bunny.relief --max-error 1%\n"
        "relief bake level.glb --world level --budget 16MB\n"
        "relief bake hero.glb --animated --clips walk.glb -o hero.relief\n"
        "relief bake heights.png --heights spacing=1,low=0,high=500 -o ground.relief\n"
        "relief bake rock.glb -o rock.relief --map cube:size=256 --map fixed8:dir=-y,size=512x256\n"
        "relief bake --recipe colliders.toml -j 4");
    addOption(verb, "MESH", command->request.mesh,
              "Mesh file: OBJ, STL, PLY, OFF, glTF, FBX, COLLADA, 3DS and more; with --heights, a height map")
        ->typeName("");
    addOption(
        verb, "-o,--output", command->output,
        withDetails(
            "Collider to write; - for standard output (default: MESH with the extension .relief, in the "
            "current folder)",
            "With --recipe, it is the output folder, by default the recipe's folder."))
        ->valueText("OUT.relief");
    addFields(verb, command->request);
    addFields(verb, command->outputs);
    addRecipeOptions(verb, command->recipe);
    addWorldOption(verb, command->world);
    addKeyDetails(verb);
    groupBakeOptions(verb);
    onVerb(verb, [command, &verb, &action] {
        action = [command, &verb](FileGuard& files) { return runBake(*command, verb, files); };
    });
}

}  // namespace relief
