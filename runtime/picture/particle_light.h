// The light that each particle receives among the collider, one texel a particle: made by a pass before the
// draw, so that the six vertices of a quad do not follow six times the rays.
//
//     bytes on the GPU = 16 · texels of a state texture   (RGBA32F: sun, sky)
#pragma once

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/collider_view.h"

namespace relief {

class ParticleLight {
  public:
    /// Errors: kFailure (the driver's compiler).
    [[nodiscard]] static Result<ParticleLight> create(const ColliderView& collider);

    /// Fills texture() for the particles below the extent. Called within a PassState of the caller's: binds
    /// units 0–5, the framebuffer and the viewport, and leaves them so.
    /// \param looks  the texture that shaders/look.glsl reads.
    /// Errors: kLimit (no room), kUnsupported (float textures that cannot be drawn to).
    [[nodiscard]] Result<void> update(const ParticleSystem& particles, const GlTexture& looks);

    /// x: the share of the sun seen; yzw: the sky's light. Particle i lies where it does in the state
    /// textures.
    [[nodiscard]] const GlTexture& texture() const { return light_; }

  private:
    ColliderView collider_;
    GlProgram program_;
    GlVertexArray no_attributes_;
    GlTexture light_;
    GlFramebuffer target_;
    GLsizei width_ = 0;
    GLsizei height_ = 0;
};

}  // namespace relief
