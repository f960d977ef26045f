// SPDX-License-Identifier: Apache-2.0
// Paints sprites by compute shaders, tile by tile (shaders/picture/tile.glsl), not as drawn points or triangles. This
// is several times faster on GPUs with much more compute than raster throughput.
//
// The picture is divided into tiles of 16 × 16 pixels. Each sprite is computed once and gets an entry for each tile
// that it overlaps. Entries are sorted by tile; each tile is painted front to back into a layer, which is then blended
// over the target. The layer has 16 bits per channel, so its pixels may differ from those of drawn sprites by the
// rounding of the target. In 8-bit targets they may also differ where sprites brighter than white lie behind others,
// because drawing clamps each sprite to white first.
//
//     bytes on the GPU = 96 · room + 8 · pixels + up to 3 MB; room: up to 1.5 · sprites, at least 65,536
//         sprites   48 bytes each
//         entries   2 × 8 bytes (double-buffered), 3 per sprite
//         layer     RGBA16F
//
// Nothing is read back. Tiles overflow if the sprites need too many entries (a thousand sprites as large as the
// picture) or a tile has more than 65,536 entries (a distant cloud). The GPU then leaves the layer empty, and an
// indirect draw draws the sprites.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/render_target.h"

namespace relief {

/// Requires hasCompute(). All members except create() need the state of a pass (PassState).
class TilePainter {
  public:
    static constexpr std::uint32_t kSpritesMax = 1U << 22;
    /// Texture unit of the target's window depths in Programs::paint.
    static constexpr int kHidesUnit = 0;

    /// Programs for one kind of sprites. The caller sets their uniforms and textures.
    struct Programs {
        GlProgram sprites;  ///< computes sprites (sprite.glsl, sprite_place.glsl)
        GlProgram paint;    ///< paints sprites (sprite_paint.glsl)
    };

    /// Errors: kUnsupported (work groups are too small), kFailure (shader compiler).
    [[nodiscard]] static Result<TilePainter> create();

    /// Returns null if the programs do not exist yet. \param defines  of point.vert and point.frag.
    [[nodiscard]] const Programs* programs(const std::string& defines) const;
    /// Errors: kFailure (shader compiler).
    [[nodiscard]] Result<const Programs*> makePrograms(const std::string& defines);

    /// Allocates buffers. \return false if tiles cannot be used: too many sprites or pixels, out of memory, a
    /// non-default depth range, or a target whose depth is not a plain texture, such as a window.
    [[nodiscard]] bool prepare(std::uint32_t sprites, const RenderTarget& target);

    /// The primitive that draws a sprite if tiles overflow, and its number of vertices.
    struct Vertices {
        GLenum mode;
        std::uint32_t count;
    };
    /// Paints the sprites of the last prepare() into the layer. Changes the binding of kHidesUnit.
    /// \param adds  whether the blend mode is Blend::kAdditive.
    void paint(const Programs& programs, const Vertices& vertices, bool adds);
    /// Blends the layer over the target, and draws the sprites if tiles overflowed. Requires: target, viewport, blend
    /// function and an empty vertex array are set. Disables the depth test for the layer, enables it for the sprites.
    void show(const GlProgram& sprites, const Vertices& vertices) const;

  private:
    TilePainter() = default;
    [[nodiscard]] bool makeRoom(std::uint32_t sprites);
    [[nodiscard]] bool makeLayer(const RenderTarget& target);
    void sortEntries() const;

    std::map<std::string, Programs> programs_;  // by defines
    GlProgram scan_, entries_, bounds_, count_, digits_, move_, layer_program_;
    GlBuffer sprite_buffer_, counts_, work_, totals_, tile_bounds_;
    GlBuffer entry_buffers_[2];
    GlTexture layer_;
    GlSampler plain_;         // for textures of the caller
    std::uint32_t room_ = 0;  // sprites
    std::uint32_t count_of_sprites_ = 0;
    std::uint32_t refused_ = 0xffffffff;    // allocation failed for this number of sprites
    std::uint32_t width_ = 0, height_ = 0;  // picture size
    std::uint32_t layer_width_ = 0, layer_height_ = 0;
    GLuint depth_ = 0;  // depth texture of the target; 0: none
};

}  // namespace relief
