// SPDX-License-Identifier: Apache-2.0
#include "formats/row_spans.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace relief {
namespace {

bool isSet(std::byte b) {
    return b != std::byte{0};
}

bool isEmpty(std::span<const std::byte> texel) {
    return std::none_of(texel.begin(), texel.end(), isSet);
}

/// The texels of a row, one behind the other.
std::span<const std::byte> rowOf(const DepthMap& map, std::uint32_t y) {
    const std::size_t bytes = map.width * texelSize(map.format);
    return std::span(map.texels).subspan(y * bytes, bytes);
}

std::uint16_t loadWord(std::span<const std::byte> bytes, std::size_t at) {
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[at]) |
                                      std::to_integer<unsigned>(bytes[at + 1]) << 8U);
}

void storeWord(std::vector<std::byte>& bytes, std::uint16_t word) {
    bytes.push_back(static_cast<std::byte>(word & 0xffU));
    bytes.push_back(static_cast<std::byte>(word >> 8U));
}

tl::unexpected<Error> invalidRow(std::size_t row, const std::string& fault) {
    return fail(ErrorCode::kInvalidInput, "row " + std::to_string(row) + " of its packed texels " + fault);
}

}  // namespace

std::vector<RowSpan> rowSpans(const DepthMap& map) {
    std::vector<RowSpan> spans(map.height);
    const auto texel = static_cast<std::ptrdiff_t>(texelSize(map.format));
    for (std::uint32_t y = 0; y < map.height; ++y) {
        const std::span<const std::byte> row = rowOf(map, y);
        const auto first = std::find_if(row.begin(), row.end(), isSet);
        if (first != row.end()) {
            const auto end = std::find_if(row.rbegin(), row.rend(), isSet).base();
            spans[y] = {static_cast<std::uint16_t>((first - row.begin()) / texel),
                        static_cast<std::uint16_t>((end - row.begin() + texel - 1) / texel)};
        }
    }
    return spans;
}

std::uint64_t texelsOf(std::span<const RowSpan> spans) {
    std::uint64_t texels = 0;
    for (const RowSpan& span : spans) {
        texels += span.texels();
    }
    return texels;
}

std::uint64_t gpuBytes(const DepthMap& map) {
    return isFrontBack(map.format) ? (map.height + texelsOf(rowSpans(map))) * texelSize(map.format)
                                   : map.texelBytes();
}

std::vector<std::byte> packRows(const DepthMap& map) {
    const std::vector<RowSpan> spans = rowSpans(map);
    std::vector<std::byte> packed;
    packed.reserve(spans.size() * kRowSpanBytes +
                   static_cast<std::size_t>(texelsOf(spans)) * texelSize(map.format));
    for (const RowSpan& span : spans) {
        storeWord(packed, span.first);
        storeWord(packed, span.end);
    }
    const std::size_t size = texelSize(map.format);
    for (std::uint32_t y = 0; y < map.height; ++y) {
        const auto texels = rowOf(map, y).subspan(spans[y].first * size, spans[y].texels() * size);
        packed.insert(packed.end(), texels.begin(), texels.end());
    }
    return packed;
}

Result<std::vector<std::byte>> unpackRows(std::span<const std::byte> packed, const DepthMap& map) {
    const std::size_t size = texelSize(map.format);
    if (packed.size() < map.height * kRowSpanBytes) {
        return fail(ErrorCode::kInvalidInput, "its " + std::to_string(packed.size()) +
                                                  " bytes of packed texels cannot hold its " +
                                                  std::to_string(map.height) + " rows");
    }
    // All spans first: nothing of the map's size is allocated for what does not fit.
    std::vector<RowSpan> spans(map.height);
    for (std::size_t y = 0; y < spans.size(); ++y) {
        spans[y] = {loadWord(packed, y * kRowSpanBytes), loadWord(packed, y * kRowSpanBytes + 2)};
        if (spans[y].first > spans[y].end || spans[y].end > map.width ||
            (spans[y].first == spans[y].end && spans[y].end != 0)) {
            return invalidRow(y, "goes from " + std::to_string(spans[y].first) + " to " +
                                     std::to_string(spans[y].end) + " of " + std::to_string(map.width));
        }
    }
    std::span<const std::byte> left = packed.subspan(spans.size() * kRowSpanBytes);
    if (left.size() != texelsOf(spans) * size) {
        return fail(ErrorCode::kInvalidInput, "its rows have " + std::to_string(texelsOf(spans) * size) +
                                                  " bytes of texels, its payload " +
                                                  std::to_string(left.size()));
    }
    std::vector<std::byte> texels(static_cast<std::size_t>(map.texelBytes()));
    for (std::size_t y = 0; y < spans.size(); ++y) {
        const auto row = left.first(spans[y].texels() * size);
        left = left.subspan(row.size());
        if (row.empty()) {
            continue;
        }
        // One map, one file.
        if (isEmpty(row.first(size)) || isEmpty(row.last(size))) {
            return invalidRow(y, "begins or ends with an empty texel");
        }
        std::memcpy(&texels[(y * map.width + spans[y].first) * size], row.data(), row.size());
    }
    return texels;
}

}  // namespace relief
