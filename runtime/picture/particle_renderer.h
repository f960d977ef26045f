// SPDX-License-Identifier: Apache-2.0
// Draws the particles of a ParticleSystem as sprites that face the viewer, straight from its state textures.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/collider_light.h"
#include "runtime/picture/collider_view.h"
#include "runtime/picture/particle_look.h"
#include "runtime/picture/render_target.h"
#include "runtime/picture/sprite_atlas.h"
#include "runtime/picture/tile_painter.h"

namespace relief {

enum class Sprite : std::uint8_t {
    kPoint,  ///< one vertex, but no larger than the GL's points; on the fragment path some drivers drop it where its
             ///< centre leaves the picture
    kQuad,  ///< six vertices, of any size, and stretched by looks
};
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Sprite>{"point", "quad"};

enum class Blend : std::uint8_t {
    kAlpha,     ///< over what is there: right where the farther is drawn first
    kAdditive,  ///< added to what is there, in whatever order
};
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Blend>{"alpha", "additive"};

struct ParticleStyle {
    float diameter = 0.01F;               ///< object units
    glm::vec3 color{0.97F, 0.98F, 1.0F};  ///< sRGB
    float opacity = 0.95F;                ///< 0…1
    float fade_in = 0.2F;  ///< seconds after birth, and before death, over which opacity rises and falls
    float fade_out = 0.5F;
    std::vector<ParticleLook> looks{};  ///< of type 0, 1, …, kLooksMax at most; what they leave open is
                                        ///< above. A type beyond the last has the last one's
    Sprite sprite = Sprite::kPoint;
    Blend blend = Blend::kAlpha;
    float soft = 0.0F;  ///< object units, ≥ 0: a sprite fades out so far before what lies behind it
    const SpriteAtlas* atlas = nullptr;  ///< for the cells of looks; null: every particle is a round grain
};

/// Ranks, as DepthSorter has them: RG32UI, texel (i mod width, i / width), width being the texture's, holds
/// the index of the i-th particle to draw in x, and 0 in y where there is none. Indices beyond extent() are
/// left out.
struct ParticleOrder {
    const GlTexture* texture = nullptr;
    std::uint32_t count = 0;  ///< ranks
};

/// The path of ParticleRenderer beside steps of a path: kCompute on a GPU alone. A software renderer paints tiles ten times
/// as slowly as it draws points, but takes steps by either path in the same time.
[[nodiscard]] inline StepPath picturePath(StepPath steps) {
    return steps == StepPath::kFragment ? steps : StepPath::kAuto;
}

class ParticleRenderer {
  public:
    /// \param collider  shades the particles; nullopt: they lie in the open.
    /// \param path      kCompute: particles are painted by compute shaders (tile_painter.h) where the target's depth is a
    ///                  plain texture, which stays as it is; the same picture but for rounding (tile_painter.h). kAuto where
    ///                  a GPU draws whose driver compiles that. picturePath() of the system's,
    ///                  as a rule.
    /// Errors: kUnsupported (kCompute without compute shaders), kFailure (the driver's compiler).
    [[nodiscard]] static Result<ParticleRenderer> create(const std::optional<ColliderView>& collider,
                                                         StepPath path = StepPath::kAuto);

    /// Draws over what the target shows, in linear light or sRGB as the target has it, hidden where its depth is nearer; depth stays as it
    /// is. Nothing is read back, nothing waits for the GPU.
    /// \param order   in which they are drawn; without a texture that of their texels.
    /// \param behind  what style.soft compares with: window depths of a picture by the same camera and of the
    ///                target's size, not attached to the target, such as ColliderRenderer::depth(). Null:
    ///                style.soft has no effect.
    /// Errors: kUsage (looks, see packLooks; a stretched look of points; soft; a camera that is not finite), kUnsupported, kFailure (the driver's compiler), kLimit (no room for
    /// the light among the collider).
    Result<void> draw(const ParticleSystem& particles, const CameraMatrices& camera,
                      const ParticleStyle& style, const RenderTarget& target, const ParticleOrder& order = {},
                      const GlTexture* behind = nullptr);
    /// By a camera whose picture has the target's shape.
    Result<void> draw(const ParticleSystem& particles, const Camera& camera, const ParticleStyle& style,
                      const RenderTarget& target, const ParticleOrder& order = {},
                      const GlTexture* behind = nullptr) {
        return draw(particles, CameraMatrices(camera, target.aspect()), style, target, order, behind);
    }

  private:
    [[nodiscard]] std::string definesOf(const ParticleStyle& style) const;
    /// Leaves the program in use.
    void setSamplers(const GlProgram& program) const;
    [[nodiscard]] Result<void> uploadLooks(const ParticleStyle& style);
    /// The program of the style, compiled when it is first wanted.
    [[nodiscard]] Result<const GlProgram*> programFor(const ParticleStyle& style);
    /// By tiles. \return false if these are to be drawn otherwise.
    [[nodiscard]] Result<bool> paintTiles(const ParticleSystem& particles, const CameraMatrices& camera,
                                          const ParticleStyle& style, const RenderTarget& target,
                                          const ParticleOrder& order, const GlTexture* behind);
    void bindTextures(const ParticleSystem& particles, const ParticleStyle& style, const ParticleOrder& order,
                      const GlTexture* behind) const;

    std::optional<ColliderLight> light_;
    std::optional<TilePainter> tiles_;
    bool needs_tiles_ = false;           // a driver that cannot compile them is an error
    std::array<GlProgram, 8> programs_;  // points or quads, of an atlas, stretched
    GlVertexArray no_attributes_;
    GlTexture no_order_;
    GlTexture nothing_;  // stands for a texture that a draw does without
    GlTexture looks_;
    PackedLooks packed_;  // what looks_ holds
};

}  // namespace relief
