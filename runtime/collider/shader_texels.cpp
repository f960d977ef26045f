#include "runtime/collider/shader_texels.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>

#include "formats/normal_index.h"
#include "formats/row_spans.h"

namespace relief {
namespace {

constexpr std::byte kLastIndex{2 * kNormalHalfRange};

void clampIndices(std::span<std::byte> normal) {
    for (std::byte& index : normal) {
        index = std::min(index, kLastIndex);
    }
}

/// The spans of a front-back map's rows, and then their texels.
std::vector<std::byte> withRows(const DepthMap& map, std::span<const std::byte> texels) {
    const std::vector<RowSpan> spans = rowSpans(map);
    const std::size_t size = texelSize(map.format);
    std::vector<std::byte> bytes;
    bytes.reserve((spans.size() + static_cast<std::size_t>(texelsOf(spans))) * size);
    auto next = static_cast<std::uint32_t>(spans.size());
    for (const RowSpan& span : spans) {
        // Less than 0 for the first rows of maps that are wider than high: modulo 2^32, as the shader adds.
        const std::uint32_t origin = next - span.first;
        const std::array<std::uint16_t, 4> words = {span.first, span.end,
                                                    static_cast<std::uint16_t>(origin & 0xffffU),
                                                    static_cast<std::uint16_t>(origin >> 16U)};
        const auto row = std::as_bytes(std::span(words));
        bytes.insert(bytes.end(), row.begin(), row.end());
        next += span.texels();
    }
    for (std::size_t y = 0; y < spans.size(); ++y) {
        const auto row = texels.subspan((y * map.width + spans[y].first) * size, spans[y].texels() * size);
        bytes.insert(bytes.end(), row.begin(), row.end());
    }
    return bytes;
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
            if (map.compare == Compare::kGap) {
                if (isEmpty(0) || isEmpty(1)) {
                    std::fill(texel.begin(), texel.end(), std::byte{0});
                }
            } else if (map.decode == Decode::kPlane && isEmpty(0) != isEmpty(1)) {
                const std::size_t full = isEmpty(0) ? 1 : 0;
                for (const std::size_t word : {std::size_t{0}, std::size_t{4}}) {
                    std::memcpy(&texel[word + 2 * (1 - full)], &texel[word + 2 * full], 2);
                }
            }
        }
    }
    return isFrontBack(map.format) ? withRows(map, texels) : texels;
}

}  // namespace relief
