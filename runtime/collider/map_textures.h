// SPDX-License-Identifier: Apache-2.0
// The maps of colliders on the GPU: three textures and a uniform block, read by shaders/collider/collider.glsl.
//
// Maps with the same texel size share a 2-D texture: RGBA32F, RGBA8 or RGBA16UI. Texels are in container order
// (runtime/layout/gpu_image.h), wrapped at the texture's width. A texture therefore takes the bytes of its maps plus
// less than one row:
//
//     bytes on the GPU < Σ texel bytes + Σ over the textures: width · texel size
//
// The width is the smallest power of two for which the height does not exceed the width.
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
    /// Returns the maximum texture side of this GL context, in texels.
    [[nodiscard]] static GLint sideMax();

    MapTextures() = default;
    /// Uploads the maps that are not live (PlacedMap::live). Call it inside a PassState. The block is empty at first.
    /// The caller checks for out-of-memory errors (checkAllocated).
    MapTextures(std::span<const PlacedMap> maps, const MapLayout& layout);

    void setBlock(std::span<const std::byte> block) const;
    /// These functions implement those of ShaderCollider with the same names, for maps and block.
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
