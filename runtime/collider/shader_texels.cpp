#include "runtime/collider/shader_texels.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "formats/normal_index.h"

namespace relief {
namespace {

constexpr std::byte kLastIndex{2 * kNormalHalfRange};

void clampIndices(std::span<std::byte> normal) {
    for (std::byte& index : normal) {
        index = std::min(index, kLastIndex);
    }
}

}  // namespace

std::vector<std::byte> shaderTexels(const DepthMap& map) {
    std::vector<std::byte> texels = map.texels;
    if (map.format == MapFormat::kFloat32) {  // whose normals are no indices
        return texels;
    }
    const std::size_t size = texelSize(map.format);
    for (std::size_t at = 0; at + size <= texels.size(); at += size) {
        const std::span<std::byte> texel(texels.data() + at, size);
        if (map.format == MapFormat::kFixed8 || map.format == MapFormat::kCube8) {
            clampIndices(texel.first(2));
        } else if (isFrontBack(map.format)) {
            // Front normal, back normal, front depth, back depth, of 16 bits each.
            clampIndices(texel.first(4));
            const auto isEmpty = [&](std::size_t end) {
                return texel[4 + 2 * end] == std::byte{0} && texel[5 + 2 * end] == std::byte{0};
            };
            if (map.decode == Decode::kPlane && isEmpty(0) != isEmpty(1)) {
                const std::size_t full = isEmpty(0) ? 1 : 0;
                for (const std::size_t word : {std::size_t{0}, std::size_t{4}}) {
                    std::memcpy(&texel[word + 2 * (1 - full)], &texel[word + 2 * full], 2);
                }
            }
        }
    }
    return texels;
}

}  // namespace relief
