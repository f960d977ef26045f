#include "bake/cli/gpu_export.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "formats/base/file_io.h"
#include "formats/fields/json.h"
#include "runtime/collider/gpu_image.h"
#include "runtime/gl/gl_object.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;
constexpr const char* kBlock = "block.bin";
constexpr const char* kGlsl = "collider.glsl";
constexpr const char* kSizes = "gpu.json";
constexpr std::array<TexelKind, kTexelKinds> kKinds{kFloatTexels, kFixedTexels, kFrontBackTexels};
constexpr std::array<const char*, kTexelKinds> kFiles{"float.bin", "fixed.bin", "front_back.bin"};

std::span<const std::byte> bytesOf(std::string_view text) {
    return std::as_bytes(std::span(text));
}

/// A texture of one texel stands for one that no map uses: it needs no file, a GL fills it with anything.
bool isUsed(const Collider& collider, TexelKind kind) {
    return std::any_of(collider.maps.begin(), collider.maps.end(),
                       [&](const DepthMap& map) { return texelKindOf(map.format) == kind; });
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

}  // namespace

std::vector<std::string> gpuFileNames(const Collider& collider) {
    std::vector<std::string> names{kBlock, kGlsl, kSizes};
    for (const TexelKind kind : kKinds) {
        if (isUsed(collider, kind)) {
            names.emplace_back(kFiles[kind]);
        }
    }
    return names;
}

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
    RELIEF_TRY(writeFile(folder / kGlsl, bytesOf(image.defines + core)));
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

}  // namespace relief
