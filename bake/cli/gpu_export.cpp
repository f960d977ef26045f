#include "bake/cli/gpu_export.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "formats/base/file_io.h"
#include "runtime/collider/gpu_image.h"
#include "runtime/gl/gl_object.h"
#include "runtime/tool/json_text.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;
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

Result<int> exportForGpu(const Collider& collider, const std::filesystem::path& folder) {
    const GpuImage image = RELIEF_TRY(gpuImage(collider));
    const std::string core = RELIEF_TRY(shaderText("collider.glsl"));
    int count = 3;
    Json textures = Json::array();
    for (const TexelKind kind : {kFloatTexels, kFixedTexels, kFrontBackTexels}) {
        textures.push_back(describe(collider, image, kind));
        if (isUsed(collider, kind)) {
            RELIEF_TRY(writeFile(folder / kFiles[kind], image.textures[kind].texels));
            ++count;
        }
    }
    RELIEF_TRY(writeFile(folder / "block.bin", image.block));
    RELIEF_TRY(writeFile(folder / "collider.glsl", bytesOf(image.defines + core)));
    const Json all{
        {"format", kFormat},
        {"tool", collider.provenance.tool_version},
        {"bounds", {{"min", jsonVector(collider.bounds.min)}, {"max", jsonVector(collider.bounds.max)}}},
        {"unit", collider.unit},
        {"maps", collider.maps.size()},
        {"glsl", "collider.glsl"},
        {"block", {{"name", "ReliefCollider"}, {"file", "block.bin"}, {"bytes", image.block.size()}}},
        {"textures", textures}};
    RELIEF_TRY(writeFile(folder / "gpu.json", bytesOf(jsonText(all))));
    return count;
}

}  // namespace relief
