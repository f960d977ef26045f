// SPDX-License-Identifier: Apache-2.0
// relief export: maps and views of patches as OpenEXR; or what a program of one's own uploads.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <span>
#include <string_view>

#include "bake/cli/command.h"
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

/// gpu.json, block.bin, collider.glsl and a file for each texture that holds something: what exportForGpu() writes.
std::vector<std::string> gpuFileNames(const Collider& collider) {
    std::vector<std::string> names{kBlock, kGlsl, kSizes};
    for (const TexelKind kind : kKinds) {
        if (isUsed(collider, kind)) {
            names.emplace_back(kFiles[kind]);
        }
    }
    return names;
}

/// Writes the files that a program of one's own uploads: runtime/layout/LAYOUT.md.
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
                   {"block", {{"name", "ReliefCollider"}, {"file", kBlock}, {"bytes", image.block.size()}}},
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

/// One for each face of a map, and the six views if any map is of patches. \param collider  must outlive them.
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

/// Makes a folder for these files, which must replace no other file of the run.
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
        return fail(ErrorCode::kUsage,
                    "nothing to write; give a folder with -o or --gpu, or a file with --vdb or --mesh");
    }
    if (command.voxels && !grids) {
        return fail(ErrorCode::kUsage, "--voxels does nothing without --vdb or --mesh; add one of them");
    }
    if (command.resolution && command.output.empty()) {
        return fail(ErrorCode::kUsage, "--resolution does nothing without -o; add it");
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
    const FieldGrids grids = RELIEF_TRY(withPrefix(shownInput(command.file), encodeGrids(collider, options)));
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
            shownInput(command.file) +
                " has no patches, and the images of its maps have their sizes; leave out --resolution");
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
        "Writes the maps as pictures, the field as a level set, the surface as a mesh\n\n"
        "-o writes OpenEXR images. Maps: map0_front-back.exr, and map3_cube_+x.exr to map3_cube_-z.exr for\n"
        "the faces of a cube, with the channels Z and N.X N.Y N.Z, and ZBack and NBack.X NBack.Y NBack.Z\n"
        "of front-back maps. Z is in object units from the near plane or the cube's centre.\n"
        "Patches: six orthographic views of the collider, view_+x.exr to view_-z.exr, named by their\n"
        "direction, with the channels depth.front and depth.back of the first and the last surface, in\n"
        "object units from the near face of the bounds, and normal.X normal.Y normal.Z of the first one.\n"
        "Z and depth are +inf where there is no surface.\n"
        "--gpu writes what a program without Relief uploads: raw textures, the uniform block, GLSL, and the\n"
        "sizes of all as JSON (runtime/layout/LAYOUT.md).\n"
        "--vdb writes signed distances as a level set of OpenVDB, and --mesh the surface of that as PLY",
        "relief export bunny.relief -o maps/ --resolution 1024\n"
        "relief export bunny.relief --gpu engine/bunny/\n"
        "relief export bunny.relief --vdb bunny.vdb --voxels 256\n"
        "relief export bunny.relief --mesh bunny.ply");
    addOption(verb, "FILE", command->file, "The collider; - for standard input")->typeName("")->required();
    addOption(verb, "-o,--output", command->output, "The folder; made if it is missing")->valueText("DIR");
    addOption(verb, "--resolution", command->resolution,
              "Texels along the longer side of each view of -o; default 512")
        ->valueText("N")
        ->transform(wholeNumber(kViewSizeMin, kViewSizeMax));
    addOption(verb, "--gpu", command->gpu, "The folder for textures, block and GLSL; made if it is missing")
        ->valueText("DIR");
    addOption(verb, "--vdb", command->vdb, "The level set, \"surface\"; - for standard output")
        ->valueText("OUT.vdb");
    addOption(verb, "--mesh", command->mesh, "The surface as PLY; - for standard output")
        ->valueText("OUT.ply");
    addOption(verb, "--voxels", command->voxels, "Of --vdb and --mesh, along the longest side; default 128")
        ->valueText("N")
        ->transform(wholeNumber(kVoxelsMin, kVoxelsMax));
    addMemoryOption(verb, command->limits);
    onVerb(verb, [command, &action] {
        action = [command](FileGuard& files) { return runExport(*command, files); };
    });
}

}  // namespace relief
