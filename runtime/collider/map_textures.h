// SPDX-License-Identifier: Apache-2.0
// The maps of colliders on the GPU: three textures and a uniform block, read by shaders/collider/collider.glsl.
//
// Maps of one texel layout share a 2-D texture: RGBA32F for float, RGBA8 for fixed8 and cube, RGBA16UI for
// front-back of either depth and patches. Their texels (runtime/layout/gpu_image.h) follow each other as they do in the
// container, wrapped at the texture's width. So a texture takes the bytes of its maps and less than a row more:
//
//     bytes on the GPU < Σ texel bytes + Σ over the textures: width · texel size
//
// The width is the least power of two that makes the texture no higher than wide.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "formats/base/result.h"
#include "runtime/collider/shader_collider.h"
#include "runtime/gl/gl_object.h"
#include "runtime/layout/map_layout.h"

namespace relief {

class MapTextures {
  public:
    /// The longest side of a texture of this GL, texels.
    [[nodiscard]] static GLint sideMax();

    MapTextures() = default;
    /// Uploads the maps that are not live, with the state of a pass (PassState). The block is empty at first. Its caller checks
    /// that the GL had the memory (checkAllocated).
    MapTextures(std::span<const PlacedMap> maps, const MapLayout& layout);

    void setBlock(std::span<const std::byte> block) const;
    /// The functions of ShaderCollider with these names, for the maps and the block.
    void attach(GLuint program, const ShaderCollider::Binding& binding) const;
    void bind(const ShaderCollider::Binding& binding) const;
    void bindStorage(int binding) const;

    [[nodiscard]] const GlTexture& operator[](TexelKind kind) const { return textures_[kind]; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    [[nodiscard]] int count() const { return count_; }

  private:
    std::array<GlTexture, kTexelKinds> textures_;
    GlBuffer block_;
    std::size_t bytes_ = 0;
    int count_ = 0;
};

}  // namespace relief
