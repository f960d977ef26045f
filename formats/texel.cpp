// SPDX-License-Identifier: Apache-2.0
#include "formats/texel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "formats/normal_index.h"

namespace relief {
namespace {

static_assert(std::endian::native == std::endian::little, "texels are little-endian and copied as they are");

template <class T>
void store(std::span<std::byte> bytes, std::size_t index, T value) {
    std::memcpy(bytes.data() + index * sizeof(T), &value, sizeof(T));
}

template <class T>
T load(std::span<const std::byte> bytes, std::size_t index) {
    T value;
    std::memcpy(&value, bytes.data() + index * sizeof(T), sizeof(T));
    return value;
}

constexpr float kSmallestHalfDepth = 6.103515625e-5F;  // 2^-14, the smallest normal half

void encodeFixed(const std::optional<IndexedSurface>& front, float depth_max, std::span<std::byte> bytes) {
    std::uint8_t channels[4] = {0, 0, 0, 0};
    if (front) {
        const std::uint16_t depth = encodeFixedDepth(front->surface.depth, depth_max);
        channels[0] = front->index.s;
        channels[1] = front->index.t;
        channels[2] = static_cast<std::uint8_t>(depth >> 8);
        channels[3] = static_cast<std::uint8_t>(depth & 0xff);
    }
    std::memcpy(bytes.data(), channels, sizeof(channels));
}

Texel decodeFixed(std::span<const std::byte> bytes, float depth_max) {
    const auto channel = [&](std::size_t i) { return std::to_integer<std::uint8_t>(bytes[i]); };
    const auto code = static_cast<std::uint16_t>(channel(2) << 8 | channel(3));
    if (code == 0) {
        return {};
    }
    return {Surface{decodeFixedDepth(code, depth_max), decodeNormal({channel(0), channel(1)})}, std::nullopt};
}

void encodeEnd(const std::optional<IndexedSurface>& end, std::size_t index, bool half,
               std::span<std::byte> bytes) {
    const auto depth = [&](float d) { return half ? encodeHalfDepth(d) : encodeFixedDepth(d, 1.0F); };
    store(bytes, index, end ? packNormal(end->index) : std::uint16_t{0});
    store(bytes, 2 + index, end ? depth(end->surface.depth) : std::uint16_t{0});
}

Texel decodeFrontBack(std::span<const std::byte> bytes, bool half) {
    Texel texel;
    for (std::size_t end = 0; end < 2; ++end) {
        const auto code = load<std::uint16_t>(bytes, 2 + end);
        if (code != 0) {
            const float depth = half ? decodeHalfDepth(code) : decodeFixedDepth(code, 1.0F);
            const NormalIndex normal = unpackNormal(load<std::uint16_t>(bytes, end));
            (end == 0 ? texel.front : texel.back) = Surface{depth, decodeNormal(normal)};
        }
    }
    return texel;
}

}  // namespace

std::uint16_t encodeFixedDepth(float depth, float depth_max) {
    const double unit = std::clamp(static_cast<double>(depth) / depth_max, 0.0, 1.0);
    return static_cast<std::uint16_t>(1 + static_cast<int>(std::floor(unit * kDepthSteps + 0.5)));
}

float decodeFixedDepth(std::uint16_t code, float depth_max) {
    return (static_cast<float>(code) - 1.0F) * (depth_max / static_cast<float>(kDepthSteps));
}

std::uint16_t encodeHalfDepth(float depth) {
    return glm::packHalf1x16(std::clamp(depth, kSmallestHalfDepth, 1.0F));
}

float decodeHalfDepth(std::uint16_t bits) {
    return glm::unpackHalf1x16(bits);
}

void encodeTexel(MapFormat format, const Texel& texel, std::span<std::byte> bytes) {
    const auto indexed = [&](const std::optional<Surface>& surface) -> std::optional<IndexedSurface> {
        if (!surface) {
            return std::nullopt;
        }
        return IndexedSurface{*surface,
                              format == MapFormat::kFloat32 ? NormalIndex{} : encodeNormal(surface->normal)};
    };
    const bool two = isFrontBack(format);
    encodeTexel(format, indexed(texel.front), two ? indexed(texel.back) : std::nullopt, bytes);
}

void encodeTexel(MapFormat format, const std::optional<IndexedSurface>& front,
                 const std::optional<IndexedSurface>& back, std::span<std::byte> bytes) {
    switch (format) {
        case MapFormat::kFloat32: {
            const Surface surface = front ? front->surface : Surface{-1.0F, glm::vec3(0.0F)};
            const float channels[4] = {surface.normal.x, surface.normal.y, surface.normal.z, surface.depth};
            std::memcpy(bytes.data(), channels, sizeof(channels));
            return;
        }
        case MapFormat::kFixed8:
            encodeFixed(front, 1.0F, bytes);
            return;
        case MapFormat::kCube8:
            encodeFixed(front, kCubeDepthMax, bytes);
            return;
        case MapFormat::kFrontBackHalf:
        case MapFormat::kFrontBackFixed:
            encodeEnd(front, 0, format == MapFormat::kFrontBackHalf, bytes);
            encodeEnd(back, 1, format == MapFormat::kFrontBackHalf, bytes);
            return;
        case MapFormat::kPatches:
            return;
    }
}

Texel decodeTexel(MapFormat format, std::span<const std::byte> bytes) {
    Texel texel;
    switch (format) {
        case MapFormat::kFloat32:
            if (const float depth = load<float>(bytes, 3); depth >= 0.0F) {
                texel.front =
                    Surface{depth, {load<float>(bytes, 0), load<float>(bytes, 1), load<float>(bytes, 2)}};
            }
            return texel;
        case MapFormat::kFixed8:
            return decodeFixed(bytes, 1.0F);
        case MapFormat::kCube8:
            return decodeFixed(bytes, kCubeDepthMax);
        case MapFormat::kFrontBackHalf:
        case MapFormat::kFrontBackFixed:
            return decodeFrontBack(bytes, format == MapFormat::kFrontBackHalf);
        case MapFormat::kPatches:
            break;
    }
    return texel;
}

}  // namespace relief
