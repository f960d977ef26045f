// relief export: every map as OpenEXR; or what a program of one's own uploads.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "bake/cli/command.h"
#include "bake/cli/gpu_export.h"
#include "bake/picture/map_image.h"
#include "bake/volume/level_set.h"
#include "formats/base/error_context.h"
#include "formats/base/file_io.h"
#include "formats/base/preflight.h"
#include "formats/container.h"
#include "runtime/command_line/memory_option.h"
#include "runtime/command_line/option_values.h"
#include "runtime/vdb/vdb_writer.h"

namespace relief {
namespace {

struct ExportCommand {
    CommonOptions common;
    std::string file;
    std::string output;
    ContainerLimits limits;
    std::string gpu;
    std::string vdb;
    std::string mesh;
    std::optional<std::uint32_t> voxels;
};

/// The names of what exportMaps() writes.
std::vector<std::string> mapFileNames(const Collider& collider) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        for (std::uint32_t face = 0; face < collider.maps[i].faceCount(); ++face) {
            names.push_back(mapImageName(collider.maps[i], i, face));
        }
    }
    return names;
}

Result<void> exportMaps(const Collider& collider, const std::filesystem::path& folder) {
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        const DepthMap& map = collider.maps[i];
        for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
            const std::filesystem::path path = folder / mapImageName(map, i, face);
            const std::vector<std::byte> bytes = RELIEF_TRY(encodeExr(mapImage(map, face, collider.unit)));
            RELIEF_TRY(writeFile(path, bytes));
            spdlog::debug("wrote {}", quotedPath(path));
        }
    }
    return {};
}

/// Makes a folder for these files, which must replace no other file of the run.
Result<void> prepareFolder(const std::filesystem::path& folder, const std::vector<std::string>& names,
                           const char* option, FileGuard& files) {
    RELIEF_TRY(preflightFolder(folder, option));
    for (const std::string& name : names) {
        RELIEF_TRY(files.writes(folder / name, option));
    }
    return {};
}

Result<void> checkTogether(const ExportCommand& command) {
    const bool grids = !command.vdb.empty() || !command.mesh.empty();
    if (command.output.empty() && command.gpu.empty() && !grids) {
        return fail(ErrorCode::kUsage,
                    "nothing to write; give a folder with -o or --gpu, or a file with --vdb or --mesh");
    }
    if (command.voxels && !grids) {
        return fail(ErrorCode::kUsage, "--voxels does nothing without --vdb or --mesh; add one of them");
    }
    return {};
}

/// Below that share, what is missing is a texel here and there.
constexpr double kMissingShown = 1e-3;

/// The field on a grid, and its surface.
Result<void> exportGrids(const Collider& collider, const ExportCommand& command) {
    FieldGridOptions options;
    options.voxels = command.voxels.value_or(options.voxels);
    options.level_set = !command.vdb.empty();
    options.surface = !command.mesh.empty();
    if (!options.level_set && !options.surface) {
        return {};
    }
    const FieldGrids grids = RELIEF_TRY(inFront(shownInput(command.file), encodeGrids(collider, options)));
    if (grids.missing >= kMissingShown) {
        spdlog::warn(
            "{}: some {:.2g} % of its surface is missing: parts thinner than a voxel, {:.3g} wide; "
            "ask for more voxels than --voxels {}",
            shownInput(command.file), 100.0 * grids.missing, grids.voxel, options.voxels);
    }
    if (options.level_set) {
        RELIEF_TRY(writeFile(command.vdb, grids.level_set));
    }
    if (options.surface) {
        RELIEF_TRY(writeFile(command.mesh, grids.surface));
    }
    return {};
}

Result<void> runExport(const ExportCommand& command, FileGuard& files) {
    startLogging(command.common);
    RELIEF_TRY(checkTogether(command));
    RELIEF_TRY(files.reads(command.file));
    if (!command.vdb.empty() || !command.mesh.empty()) {
        RELIEF_TRY(checkVdb());
    }
    RELIEF_TRY(files.writes(command.vdb, "--vdb"));
    RELIEF_TRY(files.writes(command.mesh, "--mesh"));
    const Collider collider = RELIEF_TRY(loadCollider(command.file, command.limits));
    const std::vector<std::string> maps = mapFileNames(collider);
    const std::vector<std::string> gpu = gpuFileNames(collider);
    if (!command.output.empty()) {
        RELIEF_TRY(prepareFolder(command.output, maps, "-o", files));
    }
    if (!command.gpu.empty()) {
        RELIEF_TRY(prepareFolder(command.gpu, gpu, "--gpu", files));
    }
    if (!command.output.empty()) {
        RELIEF_TRY(exportMaps(collider, command.output));
        spdlog::info("wrote {} images into {}", maps.size(),
                     quotedPath(std::filesystem::path(command.output)));
    }
    if (!command.gpu.empty()) {
        RELIEF_TRY(exportForGpu(collider, command.gpu));
        spdlog::info("wrote {} files into {}", gpu.size(), quotedPath(std::filesystem::path(command.gpu)));
    }
    return exportGrids(collider, command);
}

}  // namespace

void addExport(CLI::App& app, Action& action) {
    auto command = std::make_shared<ExportCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "export",
        "Writes the maps as pictures, the field as a level set, the surface as a mesh\n\n-o: every map as "
        "OpenEXR. Files are map0_front-back.exr, and map3_cube_+x.exr to "
        "map3_cube_-z.exr for the "
        "six faces\nof a cube. Channels Z and N.X N.Y N.Z, and ZBack and NBack.X NBack.Y NBack.Z of "
        "front-back maps;\nZ is in object units from the near plane or the cube's centre, +inf where "
        "there is no surface.\nWith --gpu it writes what a program without "
        "Relief uploads: raw textures, the uniform block, GLSL, and\nthe sizes of all as JSON "
        "(runtime/collider/LAYOUT.md).\nWith --vdb it writes signed distances as a level set of OpenVDB, "
        "and with --mesh the surface of that as PLY",
        "relief export bunny.relief -o maps/\nrelief export bunny.relief --gpu engine/bunny/\n"
        "relief export bunny.relief --vdb bunny.vdb --voxels 256\nrelief export bunny.relief --mesh "
        "bunny.ply");
    verb.add_option("FILE", command->file, "The collider; - for standard input")->type_name("")->required();
    verb.add_option("-o,--output", command->output, "The folder; made if it is missing")->option_text("DIR");
    verb.add_option("--gpu", command->gpu, "The folder for textures, block and GLSL; made if it is missing")
        ->option_text("DIR");
    verb.add_option("--vdb", command->vdb, "The level set, \"surface\"; - for standard output")
        ->option_text("OUT.vdb");
    verb.add_option("--mesh", command->mesh, "The surface as PLY; - for standard output")
        ->option_text("OUT.ply");
    verb.add_option("--voxels", command->voxels, "Of --vdb and --mesh, along the longest side; default 128")
        ->option_text("N")
        ->transform(wholeNumber(kVoxelsMin, kVoxelsMax));
    addMemoryOption(verb, command->limits);
    verb.callback(
        [command, &action] { action = [command](FileGuard& files) { return runExport(*command, files); }; });
}

}  // namespace relief
