// One Collider on the GPU: three textures and a uniform block, read by shaders/collider.glsl.
//
// Maps of one texel layout share a 2-D texture: RGBA32F for float, RGBA8 for fixed8 and cube, RGBA16UI for
// front-back of either depth. Their texels follow each other as they do in the container, wrapped at the
// texture's width, so that the textures take the maps' bytes and, each, less than a row more:
//
//     bytes on the GPU < Σ texel bytes + Σ over the textures: width · texel size
//
// The width is the least power of two that makes the texture no higher than wide.
#pragma once

#include <cstddef>

#include "formats/collider.h"
#include "formats/result.h"
#include "runtime/gl_object.h"

namespace relief {

class ColliderTextures {
  public:
    /// Texture units and the uniform block binding that bind() uses: `first_unit`, + 1, + 2.
    struct Binding {
        int first_unit = 0;
        int uniform_block = 0;
    };

    /// Uploads a collider. Needs a current context.
    /// Errors: kLimit (the texels or the number of maps above what this GL takes; the message has both
    /// numbers), kUnsupported (no maps).
    [[nodiscard]] static Result<ColliderTextures> create(const Collider& collider);

    /// Connects a program that includes collider.glsl: samplers, block binding. Once after linking; leaves
    /// the program current.
    void attach(const GlProgram& program, const Binding& binding) const;
    /// Binds textures and block for the next draw.
    void bind(const Binding& binding) const;

    [[nodiscard]] int mapCount() const { return map_count_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    /// "#define RELIEF_MAP_CAPACITY n\n" for makeProgram: the length of the block's array.
    [[nodiscard]] const std::string& defines() const { return defines_; }

  private:
    GlTexture float_maps_;
    GlTexture fixed_maps_;
    GlTexture front_back_maps_;
    GlBuffer block_;
    int map_count_ = 0;
    std::size_t bytes_ = 0;
    std::string defines_;
};

}  // namespace relief
