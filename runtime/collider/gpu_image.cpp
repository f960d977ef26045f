#include "runtime/collider/gpu_image.h"

#include <algorithm>

#include "runtime/collider/collider_block.h"
#include "runtime/collider/shader_texels.h"
#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

constexpr std::array<TexelFormat, kTexelKinds> kFormats = {{
    {"u_relief_float", "GL_RGBA32F", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    {"u_relief_fixed", "GL_RGBA8", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4},
    {"u_relief_front_back", "GL_RGBA16UI", GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, 8},
}};

}  // namespace

const TexelFormat& texelFormat(TexelKind kind) {
    return kFormats[kind];
}

Result<GpuImage> gpuImage(const Collider& collider, std::int32_t side_max) {
    if (collider.maps.empty()) {
        return fail(ErrorCode::kUnsupported, "a collider without maps has nothing to collide with");
    }
    std::vector<PlacedMap> maps;
    for (const DepthMap& map : collider.maps) {
        maps.push_back({&map, false});
    }
    const MapLayout layout = RELIEF_TRY(MapLayout::create(maps, side_max));
    GpuImage image;
    for (std::size_t kind = 0; kind < kTexelKinds; ++kind) {
        GpuTexture& texture = image.textures[kind];
        texture.width = static_cast<std::uint32_t>(layout.textures[kind].width());
        texture.height = static_cast<std::uint32_t>(std::max(layout.textures[kind].height(), 1));
        texture.texels.resize(std::size_t{texture.width} * texture.height * kFormats[kind].texel_size);
    }
    for (std::size_t m = 0; m < maps.size(); ++m) {
        const MapPlace& place = layout.places[m];
        const std::vector<std::byte> texels = shaderTexels(*maps[m].map);
        std::copy(texels.begin(), texels.end(),
                  image.textures[place.kind].texels.begin() +
                      static_cast<std::ptrdiff_t>(place.first * kFormats[place.kind].texel_size));
    }
    image.block = colliderBlock({}, maps, layout);
    image.defines = colliderDefines(0, maps);
    return image;
}

}  // namespace relief
