// Draws the particles of a ParticleSystem as soft round point sprites, straight from its state textures.
#pragma once

#include <optional>

#include "formats/result.h"
#include "runtime/camera.h"
#include "runtime/collider_view.h"
#include "runtime/gl_object.h"
#include "runtime/particle_system.h"
#include "runtime/render_target.h"

namespace relief {

struct ParticleStyle {
    float diameter = 0.01F;               ///< object units
    glm::vec3 color{0.97F, 0.98F, 1.0F};  ///< sRGB
    float opacity = 0.95F;                ///< 0…1
    float fade_in = 0.2F;  ///< seconds after birth, and before death, over which opacity rises and falls
    float fade_out = 0.5F;
};

class ParticleRenderer {
  public:
    /// \param collider  shades the particles; nullopt: they lie in the open.
    /// Errors: kFailure (the driver's compiler).
    [[nodiscard]] static Result<ParticleRenderer> create(const std::optional<ColliderView>& collider);

    /// Draws over what the target shows, in linear light, hidden where its depth is nearer; depth stays as it
    /// is. Particles are not sorted.
    void draw(const ParticleSystem& particles, const Camera& camera, const ParticleStyle& style,
              const RenderTarget& target) const;

  private:
    std::optional<ColliderView> collider_;
    GlProgram program_;
    GlVertexArray no_attributes_;
};

}  // namespace relief
