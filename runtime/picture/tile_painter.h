// SPDX-License-Identifier: Apache-2.0
// Draws sprites by compute shaders, tile by tile (shaders/picture/tile.glsl), where ParticleRenderer draws them as the GL's points
// or triangles otherwise: GPUs that compute more than they draw are several times as fast so.
//
// The picture is cut into tiles of 16 × 16 pixels. Each sprite is made once; each tile that it reaches gets an entry;
// entries are sorted by tile, and each tile is painted front to back into a layer, which then goes over the target. The
// layer has sixteen bits a channel, so that a pixel may differ from a drawn one by as much as the target rounds, and by what
// a target of eight bits cuts off of sprites brighter than white that others lie before.
//
//     bytes on the GPU = 96 · room + 8 · pixels and up to 3 MB; room for up to 1.5 times the sprites, and at least 65,536
//         sprites   48 bytes each
//         entries   2 × 8 bytes (double-buffered) for 3 a sprite
//         layer     RGBA16F
//
// Nothing is read back. Whether all entries have room is known on the GPU alone; where they have not, as with a thousand
// sprites as large as the picture, or where a tile has more than 65,536, as of a cloud far away, the layer stays empty, and an
// indirect draw draws the sprites.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/render_target.h"

namespace relief {

/// All calls but create() with the state of a pass (PassState), where hasCompute().
class TilePainter {
  public:
    static constexpr std::uint32_t kSpritesMax = 1U << 22;
    /// The unit of the target's window depths in Programs::paint.
    static constexpr int kHidesUnit = 0;

    /// Of sprites of one kind; their uniforms and textures are the caller's.
    struct Programs {
        GlProgram sprites;  ///< makes them (sprite.glsl, sprite_place.glsl)
        GlProgram paint;    ///< paints them (sprite_paint.glsl)
    };

    /// Errors: kUnsupported (work groups of this GL are too small), kFailure (the driver's compiler).
    [[nodiscard]] static Result<TilePainter> create();

    /// Null if they are yet to be made. \param defines  of point.vert and point.frag.
    [[nodiscard]] const Programs* programs(const std::string& defines) const;
    /// Errors: kFailure (the driver's compiler).
    [[nodiscard]] Result<const Programs*> makePrograms(const std::string& defines);

    /// Makes room. \return false if these cannot be painted by tiles: too many sprites or pixels, no memory, a depth range of
    /// the caller's, or the target's depth is not a plain texture, as that of a window.
    [[nodiscard]] bool prepare(std::uint32_t sprites, const RenderTarget& target);

    /// The draw of a sprite where tiles have no room.
    struct Vertices {
        GLenum mode;
        std::uint32_t count;
    };
    /// Fills the layer; what prepare() made room for last. What is bound to kHidesUnit is not kept.
    /// \param adds  Blend::kAdditive.
    void paint(const Programs& programs, const Vertices& vertices, bool adds);
    /// Blends the layer over the target, then draws the sprites if the layer had no room for them. With the target, the
    /// viewport, the blend function and an empty vertex array bound; depth test off, on for the sprites.
    void show(const GlProgram& sprites, const Vertices& vertices) const;

  private:
    TilePainter() = default;
    [[nodiscard]] bool makeRoom(std::uint32_t sprites);
    [[nodiscard]] bool makeLayer(const RenderTarget& target);
    void sortEntries() const;

    std::map<std::string, Programs> programs_;  // by their defines
    GlProgram scan_, entries_, bounds_, count_, digits_, move_, layer_program_;
    GlBuffer sprite_buffer_, counts_, work_, totals_, tile_bounds_;
    GlBuffer entry_buffers_[2];
    GlTexture layer_;
    GlSampler plain_;         // for a texture of the caller's
    std::uint32_t room_ = 0;  // sprites
    std::uint32_t count_of_sprites_ = 0;
    std::uint32_t refused_ = 0xffffffff;    // so many sprites had no memory
    std::uint32_t width_ = 0, height_ = 0;  // of the picture
    std::uint32_t layer_width_ = 0, layer_height_ = 0;
    GLuint depth_ = 0;  // the target's; 0: none
};

}  // namespace relief
