// SPDX-License-Identifier: Apache-2.0
#include "bake/cli/command_bake.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>

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

/// Shows the stages of a bake on the terminal.
BakeWatcher watcherOf(Progress& progress, FileGuard& files) {
    BakeWatcher watcher;
    watcher.begin = [&progress](const char* stage) { progress.begin(stage); };
    watcher.progress = [&progress](double share) { progress.set(share); };
    watcher.tried = [&progress](const BudgetTrial& made) {
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
        warnings.push_back(result.mesh.mesh->name + ": its maps unpack to " + bytesText(in_memory) +
                           ", from a file of " + bytesText(file_size) + "; other tools need --max-memory " +
                           std::to_string(in_memory) + " to read it");
    }
    for (const std::string& notice : result.notices) {
        spdlog::info(notice);
    }
    logWarnings(warnings);
}

/// Bakes a mesh, animated or not.
Result<void> runMeshCommand(BakeCommand& command, FileGuard& files) {
    if (command.request.mesh.empty()) {
        return fail(ErrorCode::kUsage, "MESH is required; name a mesh file, or see relief bake --help");
    }
    const Stopwatch total;
    Progress progress({quotedPath(command.request.mesh), !command.common.quiet, command.request.timeout});
    static_cast<void>(RELIEF_TRY(settingsOf(command.request)));
    RELIEF_TRY(preflightBake(command, files));
    command.request.repair.examine = command.outputs.json || !command.common.quiet;
    BakeResult result = RELIEF_TRY(bake(command.request, watcherOf(progress, files)));
    Stopwatch writing;
    progress.begin("packing the collider");
    const std::vector<std::byte> bytes =
        RELIEF_TRY(writeContainer(result.baked.collider, {static_cast<int>(command.outputs.compress)}));
    progress.finish();
    showNotices(result, bytes.size());
    RELIEF_TRY(writeFile(command.output, bytes));
    RELIEF_TRY(writeDepfile(command, command.output, result.inputs));
    result.times.write_ms = writing.ms();
    result.times.total_ms = total.ms();
    const ContainerInfo info = command.outputs.json ? RELIEF_TRY(readContainerInfo(bytes)) : ContainerInfo();
    return printReport(command, BakeJson{result, info, command.output, command.outputs.compress}, [&] {
        return bakeText(result, command.output, bytes.size(), command.common.verbose);
    });
}

/// Bakes a recipe, a height map, a level or a mesh.
Result<void> runBake(BakeCommand& command, const CLI::App& verb, FileGuard& files) {
    if (!command.recipe.recipe.empty()) {
        return runRecipeCommand(command, verb, files);
    }
    if (command.output.empty() && command.world.empty()) {
        // A path that ends in a slash gives ".relief"; the bake then rejects the folder.
        const std::filesystem::path mesh(command.request.mesh);
        command.output = mesh.filename().replace_extension(kColliderExtension).string();
    }
    return !command.request.heights.empty() ? runGroundCommand(command, files)
           : !command.world.empty()         ? runWorldCommand(command, files)
                                            : runMeshCommand(command, files);
}

}  // namespace

Result<void> preflightBake(const BakeCommand& command, FileGuard& files) {
    const BakeOutputs& outputs = command.outputs;
    if (!outputs.depfile.empty() && (outputs.depfile == "-" || command.output == "-")) {
        return fail(ErrorCode::kUsage,
                    "--depfile cannot be used with standard output; name files for --output and --depfile");
    }
    RELIEF_TRY(files.reads(command.request.mesh));
    for (const std::string& clips : command.request.clips) {
        RELIEF_TRY(files.reads(clips));
    }
    if (outputs.json) {
        RELIEF_TRY(files.writes("-", "--json"));
    }
    RELIEF_TRY(files.writes(command.output, "-o"));
    return files.writes(outputs.depfile, "--depfile");
}

Result<void> writeDepfile(const BakeCommand& command, const std::string& target,
                          const std::vector<InputFile>& inputs) {
    if (command.outputs.depfile.empty()) {
        return {};
    }
    std::vector<std::string> names;
    for (const InputFile& input : inputs) {
        names.push_back(input.path);
    }
    return writeDepfile(command.outputs.depfile, {target}, names);
}

Result<void> printReport(const BakeCommand& command, FieldRef json,
                         const std::function<std::string()>& text) {
    if (command.outputs.json) {
        return printOut(jsonTextOf(json));
    }
    if (!command.common.quiet) {
        std::fputs(text().c_str(), stderr);
    }
    return {};
}

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
    addOption(
        verb, "--world", command->world,
        withDetails("Bake a level into this folder: a collider for each distinct mesh, and world.json, "
                    "which places them",
                    "Each distinct mesh is baked once, however many nodes place it. A repeated run "
                    "skips meshes that are up to date. Options that choose maps, such as --map, --holes keep "
                    "and --max-error, are excluded; all others apply to every mesh."))
        ->valueText("DIR")
        ->excludes("--recipe");
    addKeyDetails(verb);
    groupBakeOptions(verb);
    setAction(verb, action, [command, &verb](FileGuard& files) { return runBake(*command, verb, files); });
}

void fields(FieldVisitor& visit, BakeOutputs& outputs) {
    visit("compress", outputs.compress,
          {.help = "zstd compression level of the texels, from 0 (none) to 19",
           .range = {0.0, 19.0},
           .value = "LEVEL",
           .must = "0 (none) to 19 (smallest)"});
    visit("json", outputs.json, {.help = "Print a report as JSON to standard output"});
    visit("depfile", outputs.depfile,
          {.help = "Also write a dependency file for Make and Ninja, which lists every file read",
           .value = "FILE"});
}

}  // namespace relief
