// SPDX-License-Identifier: Apache-2.0
// The data that ColliderTextures uploads, as bytes, for HTML pages (runtime/page). Independent of GL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/layout/map_layout.h"

namespace relief {

/// The texel format of a texture.
struct TexelFormat {
    const char* sampler;            ///< uniform name in collider.glsl
    std::uint32_t internal_format;  ///< GL constant; likewise the next two
    std::uint32_t format;
    std::uint32_t type;
    std::size_t texel_size;  ///< bytes
};

[[nodiscard]] const TexelFormat& texelFormat(TexelKind kind);

struct GpuTexture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;       ///< at least 1: samplers need a texture
    std::vector<std::byte> texels;  ///< width · height · texel_size bytes; zero outside maps
};

struct GpuImage {
    std::array<GpuTexture, kTexelKinds> textures;  ///< indexed by TexelKind
    std::vector<std::byte> block;                  ///< ReliefMaps, std140
    std::string defines;                           ///< `#define` lines for collider.glsl
};

/// Returns the textures of placed maps. Zero where live maps and their motion are drawn.
[[nodiscard]] std::array<GpuTexture, kTexelKinds> mapTextures(std::span<const PlacedMap> maps,
                                                              const MapLayout& layout);

/// Returns a collider in its own object space, as uploaded by ColliderTextures::create(collider).
/// \param side_max  maximum side of a texture, texels.
/// Errors: kUnsupported (no maps), kLimit (a texture would exceed side_max).
[[nodiscard]] Result<GpuImage> gpuImage(const Collider& collider, std::int32_t side_max = 16384);

/// Returns whether a map uses this kind of texel. The texture of an unused kind is one texel, whose contents
/// do not matter.
[[nodiscard]] bool isUsed(const Collider& collider, TexelKind kind);

}  // namespace relief
