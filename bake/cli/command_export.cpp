// SPDX-License-Identifier: Apache-2.0
// relief export: writes maps and views as OpenEXR, data for other renderers, level sets and meshes.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <span>
#include <string_view>

#include "bake/cli/command.h"
#include "bake/cli/option_details.h"
#include "bake/images/map_image.h"
#include "bake/images/view_image.h"
#include "bake/volume/level_set.h"
#include "formats/base/file_io.h"
#include "formats/base/result.h"
#include "formats/container.h"
#include "formats/fields/json_value.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"
#include "runtime/layout/gpu_image.h"
#include "runtime/vdb/vdb_writer.h"
#include "shaders/shader_text.h"

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
    std::optional<std::uint32_t> resolution;
};

constexpr std::uint32_t kResolution = 512;
constexpr int kFormat = 1;
constexpr const char* kBlock = "block.bin";
constexpr const char* kGlsl = "collider.glsl";
constexpr const char* kSizes = "gpu.json";
constexpr std::array<TexelKind, kTexelKinds> kKinds{kFloatTexels, kFixedTexels, kFrontBackTexels};
constexpr std::array<const char*, kTexelKinds> kFiles{"float.bin", "fixed.bin", "front_back.bin"};

std::span<const std::byte> bytesOf(std::string_view text) {
    return std::as_bytes(std::span(text));
}

Json describe(const Collider& collider, const GpuImage& image, TexelKind kind) {
    const GpuTexture& texture = image.textures[kind];
    const TexelFormat& format = texelFormat(kind);
    return {{"sampler", format.sampler},
            {"file", isUsed(collider, kind) ? Json(kFiles[kind]) : Json()},
            {"width", texture.width},
            {"height", texture.height},
            {"bytes", texture.texels.size()},
            {"internal_format_name", format.name},
            {"internal_format", format.internal_format},
            {"format", format.format},
            {"type", format.type}};
}

/// The files that exportForGpu() writes: gpu.json, block.bin, collider.glsl, and one per texture in use.
std::vector<std::string> gpuFileNames(const Collider& collider) {
    std::vector<std::string> names{kBlock, kGlsl, kSizes};
    for (const TexelKind kind : kKinds) {
        if (isUsed(collider, kind)) {
            names.emplace_back(kFiles[kind]);
        }
    }
    return names;
}

/// Writes the files for other renderers: runtime/layout/LAYOUT.md.
Result<void> exportForGpu(const Collider& collider, const std::filesystem::path& folder) {
    const GpuImage image = RELIEF_TRY(gpuImage(collider));
    const std::string core = RELIEF_TRY(shaderText("collider/collider.glsl"));
    Json textures = Json::array();
    for (const TexelKind kind : kKinds) {
        textures.push_back(describe(collider, image, kind));
        if (isUsed(collider, kind)) {
            RELIEF_TRY(writeFile(folder / kFiles[kind], image.textures[kind].texels));
        }
    }
    RELIEF_TRY(writeFile(folder / kBlock, image.block));
    RELIEF_TRY(writeFile(folder / kGlsl, bytesOf(std::string(kShaderLicence) + image.defines + core)));
    const Json all{{"format", kFormat},
                   {"tool", collider.provenance.tool_version},
                   {"bounds", {{"min", jsonOf(collider.bounds.min)}, {"max", jsonOf(collider.bounds.max)}}},
                   {"unit", collider.unit},
                   {"maps", collider.maps.size()},
                   {"glsl", kGlsl},
                   {"block", {{"name", "ReliefMaps"}, {"file", kBlock}, {"bytes", image.block.size()}}},
                   {"textures", textures}};
    return writeFile(folder / kSizes, bytesOf(jsonText(all)));
}

bool isPatches(const DepthMap& map) {
    return map.format == MapFormat::kPatches;
}

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
        const std::uint32_t faces = isPatches(map) ? 0 : map.faceCount();
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

Result<void> exportImages(const std::vector<NamedImage>& images, const std::filesystem::path& folder) {
    for (const NamedImage& image : images) {
        const ExrImage drawn = RELIEF_TRY(image.draw());
        const std::vector<std::byte> bytes = RELIEF_TRY(encodeExr(drawn));
        RELIEF_TRY(writeFile(folder / image.name, bytes));
        spdlog::debug("wrote {}", quotedPath(folder / image.name));
    }
    return {};
}

/// Creates a folder for these files. Fails if they would overwrite another file of the run.
Result<void> prepareFolder(const std::filesystem::path& folder, const std::vector<std::string>& names,
                           const char* option, FileGuard& files) {
    for (const std::string& name : names) {
        RELIEF_TRY(files.writes(folder / name, option, folder));
    }
    return files.makes(folder, option);
}

Result<void> checkTogether(const ExportCommand& command) {
    const bool grids = !command.vdb.empty() || !command.mesh.empty();
    if (command.output.empty() && command.gpu.empty() && !grids) {
        return fail(ErrorCode::kUsage, "no output; add -o DIR, --gpu DIR, --vdb FILE or --mesh FILE");
    }
    if (command.voxels && !grids) {
        return fail(ErrorCode::kUsage, "--voxels has no effect without --vdb or --mesh; add one of them");
    }
    if (command.resolution && command.output.empty()) {
        return fail(ErrorCode::kUsage, "--resolution has no effect without -o; add -o DIR");
    }
    return {};
}

/// Smaller missing fractions are single texels, and not reported.
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
    const FieldGrids grids = RELIEF_TRY(withPrefix(shownInput(command.file), encodeGrids(collider, options)));
    if (grids.missing >= kMissingShown) {
        spdlog::warn(
            "{}: about {:.2g} % of the surface is missing, where parts are thinner than a voxel of {:.3g}; "
            "raise --voxels above {}",
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
    RELIEF_TRY(checkTogether(command));
    RELIEF_TRY(files.reads(command.file));
    RELIEF_TRY(files.writes(command.vdb, "--vdb"));
    RELIEF_TRY(files.writes(command.mesh, "--mesh"));
    if (!command.vdb.empty() || !command.mesh.empty()) {
        RELIEF_TRY(checkVdb());
    }
    const Collider collider = RELIEF_TRY(loadCollider(command.file, command.limits));
    if (command.resolution && !collider.hasPatches()) {
        return fail(
            ErrorCode::kUsage,
            shownInput(command.file) + " has no patches, and its maps have fixed sizes; remove --resolution");
    }
    const std::vector<NamedImage> images = imagesOf(collider, command.resolution.value_or(kResolution));
    const std::vector<std::string> gpu = gpuFileNames(collider);
    if (!command.output.empty()) {
        std::vector<std::string> names;
        std::ranges::transform(images, std::back_inserter(names), &NamedImage::name);
        RELIEF_TRY(prepareFolder(command.output, names, "-o", files));
    }
    if (!command.gpu.empty()) {
        RELIEF_TRY(prepareFolder(command.gpu, gpu, "--gpu", files));
    }
    if (!command.output.empty()) {
        RELIEF_TRY(exportImages(images, command.output));
        spdlog::info("wrote {} images into {}", images.size(),
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
        withDetails(
            "Write maps as images, data for your renderer, a level set or a mesh\n\n"
            "Choose at least one of -o (OpenEXR images), --gpu (textures and GLSL for your engine), --vdb "
            "(OpenVDB level set) and --mesh (PLY).",
            "-o writes one image per map, such as map0_front-back.exr, and per face of a cube, "
            "map3_cube_+x.exr to map3_cube_-z.exr. Channels are Z and N.X, N.Y, N.Z; front-back maps also "
            "have ZBack and NBack.X, NBack.Y, NBack.Z. Z is the distance from the near plane or the cube's "
            "centre, in object units.\n"
            "For patches, -o writes six orthographic views, view_+x.exr to view_-z.exr, named by their "
            "direction. depth.front and depth.back are the distances of the first and last surface from the "
            "near face of the bounds, in object units; normal.X, normal.Y and normal.Z are the normal of the "
            "first surface. Z and depth are +inf without a surface.\n"
            "--gpu writes raw textures, the uniform block, GLSL, and their sizes as JSON "
            "(runtime/layout/LAYOUT.md)."),
        "relief export bunny.relief -o maps/ --resolution 1024\n"
        "relief export bunny.relief --gpu engine/bunny/\n"
        "relief export bunny.relief --vdb bunny.vdb --voxels 256\n"
        "relief export bunny.relief --mesh bunny.ply");
    addOption(verb, "FILE", command->file, "Collider; - for standard input")->typeName("")->required();
    addOption(verb, "-o,--output", command->output, "Folder for OpenEXR images; created if missing")
        ->valueText("DIR");
    addOption(verb, "--resolution", command->resolution,
              "Texels along the longer side of each view of patches (default: 512)")
        ->valueText("N")
        ->transform(wholeNumber(kViewSizeMin, kViewSizeMax));
    addOption(verb, "--gpu", command->gpu,
              "Folder for the data that your own renderer uploads; created if missing")
        ->valueText("DIR");
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
    groupVerbOptions(verb, {{"Output", {"--output", "--gpu", "--vdb", "--mesh"}},
                            {"Quality", {"--resolution", "--voxels"}}});
    onVerb(verb, [command, &action] {
        action = [command](FileGuard& files) { return runExport(*command, files); };
    });
}

}  // namespace relief
