// SPDX-License-Identifier: Apache-2.0
// relief export: writes maps and views as OpenEXR, data for other renderers, level sets and meshes.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <functional>

#include "bake/cli/command.h"
#include "bake/cli/option_details.h"
#include "bake/engines/engine_export.h"
#include "bake/images/map_image.h"
#include "bake/images/view_image.h"
#include "bake/volume/level_set.h"
#include "formats/base/file_io.h"
#include "formats/base/result.h"
#include "formats/container.h"
#include "formats/world/world.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"
#include "runtime/vdb/vdb_writer.h"

namespace relief {
namespace {

struct ExportCommand {
    CommonOptions common;
    std::string file;
    std::string output;
    ContainerLimits limits;
    std::vector<std::string> engine;  ///< its name and the folder; empty: none
    std::string vdb;
    std::string mesh;
    std::optional<std::uint32_t> voxels;
    std::optional<std::uint32_t> resolution;
};

constexpr std::uint32_t kResolution = 512;

/// An image of -o.
struct NamedImage {
    std::string name;
    std::function<Result<ExrImage>()> draw;
};

/// One image per face of a map, and six views if any map consists of patches. \param collider  must outlive the images
std::vector<NamedImage> imagesOf(const Collider& collider, std::uint32_t resolution) {
    std::vector<NamedImage> images;
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        const DepthMap& map = collider.maps[i];
        const std::uint32_t faces = map.format == MapFormat::kPatches ? 0 : map.faceCount();
        for (std::uint32_t face = 0; face < faces; ++face) {
            images.push_back({mapImageName(map, i, face),
                              [&map, face, &collider] { return mapImage(map, face, collider.unit); }});
        }
    }
    const int views = collider.hasPatches() ? 6 : 0;
    for (int view = 0; view < views; ++view) {
        images.push_back({viewImageName(view),
                          [&collider, view, resolution] { return viewImage(collider, view, resolution); }});
    }
    return images;
}

/// Creates the folders of these files. Fails if the files would overwrite another file of the run.
/// \param outputs  of type NamedImage or EngineFile.
template <class Outputs>
Result<void> prepareFolder(const std::filesystem::path& folder, const Outputs& outputs, const char* option,
                           FileGuard& files) {
    for (const auto& output : outputs) {
        RELIEF_TRY(files.writes(folder / output.name, option, (folder / output.name).parent_path()));
    }
    for (const auto& output : outputs) {
        RELIEF_TRY(files.makes((folder / output.name).parent_path(), option));
    }
    return {};
}

Result<void> checkTogether(const ExportCommand& command) {
    const bool grids = !command.vdb.empty() || !command.mesh.empty();
    if (command.output.empty() && command.engine.empty() && !grids) {
        return fail(ErrorCode::kUsage, "no output; add -o DIR, --engine NAME DIR, --vdb FILE or --mesh FILE");
    }
    if (isWorldFile(command.file) && (!command.output.empty() || grids)) {
        return fail(ErrorCode::kUsage,
                    quotedPath(command.file) + " is a world; only --engine exports worlds");
    }
    if (command.voxels && !grids) {
        return fail(ErrorCode::kUsage, "--voxels has no effect without --vdb or --mesh; add one of them");
    }
    if (command.resolution && command.output.empty()) {
        return fail(ErrorCode::kUsage, "--resolution has no effect without -o; add -o DIR");
    }
    return {};
}

/// The engine of --engine, or nullopt without that option.
Result<std::optional<Engine>> engineOf(const ExportCommand& command) {
    if (command.engine.empty()) {
        return std::nullopt;
    }
    const auto* const found = std::ranges::find(kEngineNames, command.engine.front());
    if (found == kEngineNames.end()) {
        return fail(ErrorCode::kUsage,
                    "--engine " + expectedOneOfMessage(command.engine.front(), kEngineNames));
    }
    return static_cast<Engine>(found - kEngineNames.begin());
}

/// Writes the files of --engine. \param source  a Collider or a LoadedWorld
template <class Source>
Result<void> exportForEngine(const Source& source, Engine engine, const ExportCommand& command,
                             FileGuard& files) {
    const std::filesystem::path input = command.file;
    // Every world is named world.json, so its folder gives the name.
    std::string name =
        isWorldFile(command.file)
            ? std::filesystem::absolute(input).lexically_normal().parent_path().filename().string()
            : input.stem().string();
    name = cleanUtf8(name).empty() || command.file == "-" ? "collider" : cleanUtf8(name);
    const std::vector<EngineFile> exported =
        RELIEF_TRY(withPrefix(inputText(command.file), engineFiles(source, name, engine)));
    const std::filesystem::path folder = command.engine.back();
    RELIEF_TRY(prepareFolder(folder, exported, "--engine", files));
    for (const EngineFile& file : exported) {
        RELIEF_TRY(writeFile(folder / file.name, file.bytes));
    }
    spdlog::info("wrote {} files into {}; RELIEF.md there lists the next steps", exported.size(),
                 quotedPath(folder));
    return {};
}

/// Smaller missing fractions come from single texels and are not reported.
constexpr double kMissingShown = 1e-3;

/// Samples the field on a grid, and writes the level set and its surface.
Result<void> exportGrids(const Collider& collider, const ExportCommand& command) {
    FieldGridOptions options;
    options.voxels = command.voxels.value_or(options.voxels);
    options.level_set = !command.vdb.empty();
    options.surface = !command.mesh.empty();
    if (!options.level_set && !options.surface) {
        return {};
    }
    const FieldGrids grids = RELIEF_TRY(withPrefix(inputText(command.file), encodeGrids(collider, options)));
    if (grids.missing >= kMissingShown) {
        spdlog::warn(
            "{}: about {:.2g} % of the surface is missing, where parts are thinner than a voxel of {:.3g}; "
            "raise --voxels above {}",
            inputText(command.file), 100.0 * grids.missing, grids.voxel, options.voxels);
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
    RELIEF_TRY(checkTogether(command));
    RELIEF_TRY(files.reads(command.file));
    RELIEF_TRY(files.writes(command.vdb, "--vdb"));
    RELIEF_TRY(files.writes(command.mesh, "--mesh"));
    if (!command.vdb.empty() || !command.mesh.empty()) {
        RELIEF_TRY(checkVdb());
    }
    const std::optional<Engine> engine = RELIEF_TRY(engineOf(command));
    if (isWorldFile(command.file)) {
        return exportForEngine(RELIEF_TRY(loadWorld(command.file, command.limits)), *engine, command, files);
    }
    const Collider collider = RELIEF_TRY(loadCollider(command.file, command.limits));
    if (command.resolution && !collider.hasPatches()) {
        return fail(
            ErrorCode::kUsage,
            inputText(command.file) + " has no patches, and its maps have fixed sizes; remove --resolution");
    }
    const std::filesystem::path folder = command.output;
    const std::vector<NamedImage> images = imagesOf(collider, command.resolution.value_or(kResolution));
    if (!command.output.empty()) {
        RELIEF_TRY(prepareFolder(folder, images, "-o", files));
    }
    if (engine) {
        RELIEF_TRY(exportForEngine(collider, *engine, command, files));
    }
    if (!command.output.empty()) {
        for (const NamedImage& image : images) {
            const ExrImage drawn = RELIEF_TRY(image.draw());
            const std::vector<std::byte> bytes = RELIEF_TRY(encodeExr(drawn));
            RELIEF_TRY(writeFile(folder / image.name, bytes));
            spdlog::debug("wrote {}", quotedPath(folder / image.name));
        }
        spdlog::info("wrote {} images into {}", images.size(), quotedPath(folder));
    }
    return exportGrids(collider, command);
}

}  // namespace

void addExport(CLI::App& app, Action& action) {
    auto command = std::make_shared<ExportCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "export",
        withDetails(
            "Write maps as images, files for your engine, a level set or a mesh\n\n"
            "Choose at least one of -o (OpenEXR images), --engine (data and shaders for your engine), --vdb "
            "(OpenVDB level set) and --mesh (PLY).",
            "-o writes one image per map, such as map0_front-back.exr, and per face of a cube, "
            "map3_cube_+x.exr to map3_cube_-z.exr. Channels are Z and N.X, N.Y, N.Z; front-back maps also "
            "have ZBack and NBack.X, NBack.Y, NBack.Z. Z is the distance from the near plane or the cube's "
            "centre, in object units.\n"
            "For patches, -o writes six orthographic views, view_+x.exr to view_-z.exr, named by their "
            "direction. depth.front and depth.back are the distances of the first and last surface from the "
            "near face of the bounds, in object units; normal.X, normal.Y and normal.Z are the normal of the "
            "first surface. Z and depth are +inf without a surface.\n"
            "--engine writes an uncompressed collider, its texels and constants, the collision function in "
            "the engine's shading language, and RELIEF.md with the steps that remain. It needs a collider of "
            "patches, the default of relief bake. For the world.json of a level, it writes the texels of all "
            "colliders, a table of the bodies, and a grid to find them."),
        "relief export bunny.relief -o maps/ --resolution 1024\n"
        "relief export bunny.relief --engine unity Assets/Bunny\n"
        "relief export level/world.json --engine c level_data\n"
        "relief export bunny.relief --vdb bunny.vdb --voxels 256\n"
        "relief export bunny.relief --mesh bunny.ply");
    addOption(verb, "FILE", command->file, "Collider, or world.json with --engine; - for standard input")
        ->typeName("")
        ->required();
    addOption(verb, "-o,--output", command->output, "Folder for OpenEXR images; created if missing")
        ->valueText("DIR");
    addOption(verb, "--resolution", command->resolution,
              "Texels along the longer side of each view of patches (default: 512)")
        ->valueText("N")
        ->transform(wholeNumber(kViewSizeMin, kViewSizeMax));
    addOption(verb, "--engine", command->engine, "Engine, and the folder for its files; created if missing")
        ->valueText(choices(kEngineNames) + " DIR")
        ->values(2);
    addOption(verb, "--vdb", command->vdb,
              "Level set of signed distances, named \"surface\"; - for standard output")
        ->valueText("OUT.vdb");
    addOption(verb, "--mesh", command->mesh, "Surface of that level set, as PLY; - for standard output")
        ->valueText("OUT.ply");
    addOption(verb, "--voxels", command->voxels,
              "Voxels of --vdb and --mesh along the longest side (default: 128)")
        ->valueText("N")
        ->transform(wholeNumber(kVoxelsMin, kVoxelsMax));
    addMemoryOption(verb, command->limits);
    groupVerbOptions(verb, {{"Output", {"--output", "--engine", "--vdb", "--mesh"}},
                            {"Quality", {"--resolution", "--voxels"}}});
    setAction(verb, action, [command](FileGuard& files) { return runExport(*command, files); });
}

}  // namespace relief
