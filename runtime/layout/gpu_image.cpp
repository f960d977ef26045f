// SPDX-License-Identifier: Apache-2.0
#include "runtime/layout/gpu_image.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "formats/normal_index.h"
#include "runtime/layout/collider_block.h"

namespace relief {
namespace {

constexpr std::array<TexelFormat, kTexelKinds> kFormats = {{
    {"u_relief_float", 0x8814, 0x1908, 0x1406, 16},      // GL_RGBA, GL_FLOAT
    {"u_relief_fixed", 0x8058, 0x1908, 0x1401, 4},       // GL_RGBA, GL_UNSIGNED_BYTE
    {"u_relief_front_back", 0x8D76, 0x8D99, 0x1403, 8},  // GL_RGBA_INTEGER, GL_UNSIGNED_SHORT
}};

constexpr std::byte kLastIndex{2 * kNormalHalfRange};

/// Returns the map's texels, with changes that save the shader tests but do not change any vote:
///
/// - a normal index of 255, which decodes like 254, becomes 254;
/// - in front-back maps of planes, if only one surface of a texel is empty, it gets the plane of the other, because two
///   equal votes count once;
/// - texels of float maps are unchanged.
std::vector<std::byte> shaderTexels(const DepthMap& map) {
    std::vector<std::byte> texels = map.texels;
    const MapFormatInfo& format = kMapFormats[static_cast<std::size_t>(map.format)];
    if (format.normal_bytes == 0) {
        return texels;
    }
    const std::size_t size = format.texel_size;
    for (std::size_t at = 0; at + size <= texels.size(); at += size) {
        const std::span<std::byte> texel(texels.data() + at, size);
        for (std::byte& index : texel.first(format.normal_bytes)) {
            index = std::min(index, kLastIndex);
        }
        if (isFrontBack(map.format) && map.decode == Decode::kPlane) {
            // Front normal, back normal, front depth and back depth, 16 bits each.
            const auto isEmpty = [&](std::size_t end) {
                return texel[4 + 2 * end] == std::byte{0} && texel[5 + 2 * end] == std::byte{0};
            };
            if (isEmpty(0) != isEmpty(1)) {
                const std::size_t full = isEmpty(0) ? 1 : 0;
                for (const std::size_t word : {std::size_t{0}, std::size_t{4}}) {
                    std::memcpy(&texel[word + 2 * (1 - full)], &texel[word + 2 * full], 2);
                }
            }
        }
    }
    return texels;
}

}  // namespace

const TexelFormat& texelFormat(TexelKind kind) {
    return kFormats[kind];
}

std::array<GpuTexture, kTexelKinds> mapTextures(std::span<const PlacedMap> maps, const MapLayout& layout) {
    std::array<GpuTexture, kTexelKinds> textures;
    for (std::size_t kind = 0; kind < kTexelKinds; ++kind) {
        GpuTexture& texture = textures[kind];
        texture.width = static_cast<std::uint32_t>(layout.textures[kind].width());
        texture.height = static_cast<std::uint32_t>(std::max(layout.textures[kind].height(), 1));
        texture.texels.resize(std::size_t{texture.width} * texture.height * kFormats[kind].texel_size);
    }
    for (std::size_t m = 0; m < maps.size(); ++m) {
        const MapPlace& place = layout.places[m];
        if (!maps[m].live) {
            const std::vector<std::byte> texels = shaderTexels(*maps[m].map);
            std::copy(texels.begin(), texels.end(),
                      textures[place.kind].texels.begin() +
                          static_cast<std::ptrdiff_t>(place.first * kFormats[place.kind].texel_size));
        }
    }
    return textures;
}

bool isUsed(const Collider& collider, TexelKind kind) {
    return std::any_of(collider.maps.begin(), collider.maps.end(),
                       [&](const DepthMap& map) { return texelKindOf(map.format) == kind; });
}

Result<GpuImage> gpuImage(const Collider& collider, std::int32_t side_max) {
    const std::vector<PlacedMap> maps = placedMaps(collider);
    const MapLayout layout = RELIEF_TRY(MapLayout::create(maps, side_max));
    return GpuImage{mapTextures(maps, layout), colliderBlock(maps, layout), colliderDefines(maps, layout)};
}

}  // namespace relief
