// Draws points by compute shaders, tile by tile (shaders/tile.glsl), where ParticleRenderer draws them as the GL's points
// otherwise: GPUs that compute more than they draw are several times as fast so.
//
// The picture is cut into tiles of 16 × 16 pixels. Each sprite is made once; each tile that it reaches gets an entry;
// entries are sorted by tile, and each tile is painted front to back into a layer, which then goes over the target. The
// layer has more bits than the target, so that a pixel may differ from that of points by as much as these round.
//
//     bytes on the GPU = 80 · sprites (at least 4 MB) + 8 · pixels and up to 2 MB
//         sprites   32 bytes each
//         entries   2 × 8 bytes (double-buffered) for 3 a sprite
//         layer     RGBA16F
//
// Nothing is read back. Whether all entries have room is known on the GPU alone; where they have not, as with a thousand
// sprites as large as the picture, the layer stays empty, and an indirect draw draws the points.
#pragma once

#include <cstdint>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/render_target.h"

namespace relief {

/// All calls but create() with the state of a pass (PassState), where hasCompute().
class TilePainter {
  public:
    static constexpr std::uint32_t kSpritesMax = 1U << 22;
    /// The target's window depths, and `behind` of ParticleRenderer::draw, for paintProgram().
    static constexpr int kHidesUnit = 4;
    static constexpr int kBehindUnit = 5;

    /// \param lit  particles are shaded by a collider.
    /// Errors: kUnsupported (work groups of this GL are too small), kFailure (the driver's compiler).
    [[nodiscard]] static Result<TilePainter> create(bool lit);

    /// Makes room. \return false if these cannot be painted by tiles: too many sprites or pixels, no memory, or the target's
    /// depth is not a plain texture, as that of a window.
    [[nodiscard]] bool prepare(std::uint32_t sprites, const RenderTarget& target);

    /// Makes sprites, as grain_make.glsl and grain_place.glsl say. Its uniforms and textures are the caller's.
    [[nodiscard]] const GlProgram& spriteProgram() const { return sprites_; }
    /// Paints them, as grain_paint.glsl says; the same.
    [[nodiscard]] const GlProgram& paintProgram() const { return paint_; }

    /// Fills the layer; what prepare() made room for last.
    /// \param adds    Blend::kAdditive.
    void paint(bool adds);
    /// Blends the layer over the target, then draws the points if the layer had no room for them. With the target, the
    /// viewport, the blend function and an empty vertex array bound; depth test off, on for the points.
    /// \param points  draws a point a sprite.
    void show(const GlProgram& points) const;

  private:
    TilePainter() = default;
    [[nodiscard]] Result<void> makePrograms(bool lit);
    [[nodiscard]] bool makeRoom(std::uint32_t sprites);
    [[nodiscard]] bool makeLayer(const RenderTarget& target);
    void sortEntries() const;

    GlProgram sprites_, scan_, entries_, count_, digits_, move_, paint_, layer_program_;
    GlBuffer sprite_buffer_, counts_, work_, totals_;
    GlBuffer entry_buffers_[2];
    GlTexture layer_;
    GlSampler plain_;         // for a texture of the caller's
    std::uint32_t room_ = 0;  // sprites
    std::uint32_t count_of_sprites_ = 0;
    std::uint32_t width_ = 0, height_ = 0;  // of the layer
    GLuint depth_ = 0;                      // the target's; 0: none
};

}  // namespace relief
