// SPDX-License-Identifier: Apache-2.0
// The upload of ColliderTextures as bytes: for loaders of your own (LAYOUT.md). Needs no GL.
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

/// The format of the texels of a texture.
struct TexelFormat {
    const char* sampler;            ///< that reads it in collider.glsl
    const char* name;               ///< of the internal format: "GL_RGBA32F"
    std::uint32_t internal_format;  ///< the GL's numbers, as are the next two
    std::uint32_t format;
    std::uint32_t type;
    std::size_t texel_size;  ///< bytes
};

[[nodiscard]] const TexelFormat& texelFormat(TexelKind kind);

struct GpuTexture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;       ///< at least 1: a sampler must have something bound
    std::vector<std::byte> texels;  ///< width · height · texel_size; zero where no map lies
};

struct GpuImage {
    std::array<GpuTexture, kTexelKinds> textures;  ///< by TexelKind
    std::vector<std::byte> block;                  ///< ReliefCollider, std140
    std::string defines;                           ///< lines that collider.glsl is compiled with
};

/// The textures of maps in their places. Of a live one: nothing on any ray, and nothing moves.
[[nodiscard]] std::array<GpuTexture, kTexelKinds> mapTextures(std::span<const PlacedMap> maps,
                                                              const MapLayout& layout);

/// A collider by itself, in its own object space, as ColliderTextures::create(collider) has it.
/// \param side_max  of a texture, texels.
/// Fails with kUnsupported (no maps) or kLimit (a texture would have to be larger).
[[nodiscard]] Result<GpuImage> gpuImage(const Collider& collider, std::int32_t side_max = 16384);

/// Whether some map has such texels. A texture of one texel stands for one that no map uses: a GL fills it with anything.
[[nodiscard]] bool isUsed(const Collider& collider, TexelKind kind);

}  // namespace relief
