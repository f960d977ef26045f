// SPDX-License-Identifier: Apache-2.0
// Draws the particles of a ParticleSystem as camera-facing sprites, directly from its state textures.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
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
    kPoint,  ///< one vertex, up to GL's maximum point size; on the fragment path, some drivers drop it when its
             ///< centre leaves the picture
    kQuad,  ///< six vertices, of any size; looks can stretch it
};
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Sprite>{"point", "quad"};

enum class Blend : std::uint8_t {
    kAlpha,     ///< alpha blending; needs back-to-front order
    kAdditive,  ///< additive blending, in any order
};
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Blend>{"alpha", "additive"};

struct ParticleStyle {
    float diameter = 0.01F;               ///< object units
    glm::vec3 color{0.97F, 0.98F, 1.0F};  ///< sRGB
    float opacity = 0.95F;                ///< 0…1
    float fade_in = 0.2F;                 ///< fade times after birth and before death, seconds
    float fade_out = 0.5F;
    /// Looks of types 0, 1, …; at most kLooksMax. Empty fields use the values above. Further types use the last look.
    std::vector<ParticleLook> looks{};
    Sprite sprite = Sprite::kPoint;
    Blend blend = Blend::kAlpha;
    /// Distance over which a sprite fades in front of surfaces, object units, ≥ 0.
    float soft_distance = 0.0F;
    const SpriteAtlas* atlas = nullptr;  ///< for the cells of looks; null: all particles are round dots
};

/// Drawing order, as from DepthSorter: RG32UI. Texel (i mod width, i / width) describes the i-th particle to draw: x is
/// its index, and y is 0 if there is no particle. Indices from ParticleSystem::extent() on are skipped.
struct ParticleOrder {
    const GlTexture* texture = nullptr;
    std::uint32_t count = 0;  ///< number of texels to draw
};

/// Returns the path for ParticleRenderer::create(), given the path of simulation steps: kFragment for kFragment,
/// otherwise kAuto. kAuto does not paint by tiles on software renderers, where tiles take ten times as long as points.
[[nodiscard]] inline StepPath picturePath(StepPath steps) {
    return steps == StepPath::kFragment ? steps : StepPath::kAuto;
}

class ParticleRenderer {
  public:
    /// Needs a current context, as draw() does.
    /// \param collider  shades the particles; nullopt: no shading.
    /// \param path      kCompute: paint by compute shaders if the depth of the target is a plain texture; pictures then
    ///                  differ slightly (tile_painter.h). kAuto: kCompute on GPUs whose drivers compile the compute
    ///                  shaders. Normally picturePath() of the path of the particle system.
    /// Errors: kUnsupported (kCompute without compute shaders), kFailure (shader compiler), kLimit (out of memory).
    [[nodiscard]] static Result<ParticleRenderer> create(const std::optional<ColliderView>& collider,
                                                         StepPath path = StepPath::kAuto);

    /// Draws over the target's contents (linear or sRGB, as the target requires), tested against its depth buffer.
    /// Writes no depth. Does not read back or wait for the GPU.
    /// \param order   drawing order; without a texture, particles are drawn in order of index.
    /// \param behind  for style.soft_distance: window depths of a picture with the same camera and size, not attached
    ///                to the target, such as ColliderRenderer::depth(). Null: style.soft_distance has no effect.
    /// Errors: kUsage (looks, see packLooks(); a stretched look with Sprite::kPoint; an invalid soft_distance; a camera
    /// that is not finite), kUnsupported, kFailure (shader compiler), kLimit (out of memory for the looks, or for
    /// the light around the collider).
    Result<void> draw(const ParticleSystem& particles, const CameraMatrices& camera,
                      const ParticleStyle& style, const RenderTarget& target, const ParticleOrder& order = {},
                      const GlTexture* behind = nullptr);
    /// Draws with a Camera and the aspect ratio of the target.
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
    /// Returns the program of the style, compiled on first use.
    [[nodiscard]] Result<const GlProgram*> programFor(const ParticleStyle& style);
    /// Paints by tiles. \return false if the particles must be drawn as points or quads.
    [[nodiscard]] Result<bool> paintTiles(const ParticleSystem& particles, const CameraMatrices& camera,
                                          const ParticleStyle& style, const RenderTarget& target,
                                          const ParticleOrder& order, const GlTexture* behind);
    void bindTextures(const ParticleSystem& particles, const ParticleStyle& style, const ParticleOrder& order,
                      const GlTexture* behind) const;

    std::optional<ColliderLight> light_;
    std::optional<TilePainter> tiles_;
    bool needs_tiles_ = false;                   // fail if TilePainter does not compile
    std::map<std::string, GlProgram> programs_;  // by definesOf()
    GlVertexArray no_attributes_;
    GlTexture no_order_;
    GlTexture nothing_;  // placeholder for unused textures
    GlTexture looks_;
    PackedLooks packed_;  // contents of looks_
};

}  // namespace relief
