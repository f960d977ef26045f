// SPDX-License-Identifier: Apache-2.0
// The light among a collider, kept so that a particle looks up a few texels (shaders/picture/particle_light.glsl) instead of
// following rays: the collider seen from the sun, and the share of the sky that each place sees. Both are made anew
// only when the collider has moved or changed its shape.
//
//     bytes on the GPU ≈ 4 · kSunSide² + 2 · voxels: 1.0 MB and, of a cube, 0.9 MB
//
// Accuracy. Behind a sheet, however thin, the sun may shine as far as sunBias(), and the sky as far as 1.5
// voxels: voxel() is 1/40 of the collider's longest side. The sun's map misses what is thinner than four of its texels
// across the light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/collider_view.h"

namespace relief {

class ColliderLight {
  public:
    static constexpr GLsizei kSunSide = 512;  ///< texels

    /// Needs a current context, as every call does.
    /// Errors: kFailure (the driver's compiler), kLimit (no room).
    [[nodiscard]] static Result<ColliderLight> create(const ColliderView& collider);

    /// Makes the light anew if the collider has changed. Called within a PassState of the caller's: binds units
    /// 0–3, the framebuffer and the viewport, and leaves them so.
    /// Errors: kLimit (no room), kUnsupported (float textures that cannot be drawn to).
    [[nodiscard]] Result<void> update();

    /// Sets particle_light.glsl's uniforms; leaves the program current. `unit`: of the sun's map; the sky's is the
    /// next one.
    void attach(const GlProgram& program, int unit) const;
    /// Binds both textures for the next draw.
    void bind(int unit) const;

    /// Object units: nothing shades what lies less far behind it, along the light.
    [[nodiscard]] float sunBias() const;
    /// Side of a voxel of the sky, object units.
    [[nodiscard]] float voxel() const { return voxel_; }
    /// Updates so far that had something to do.
    [[nodiscard]] std::uint64_t updates() const { return updates_; }

  private:
    /// Voxels that are drawn as a picture of layers (shaders/picture/volume.glsl), then copied into a 3-D texture.
    struct Volume {
        glm::ivec3 size{0};
        glm::vec3 first{0.0F};  // the middle of voxel (0, 0, 0)
        GlProgram program;
        GlTexture layers;
        GlFramebuffer target;
        GlTexture texture;

        [[nodiscard]] GLsizei tiles() const;
        [[nodiscard]] Result<void> allocate();
    };

    void frameSun();
    void frameVolumes();
    [[nodiscard]] Result<void> createPrograms();
    [[nodiscard]] Result<void> createTextures();
    void drawSun();
    void drawVolume(const Volume& volume) const;

    ColliderView collider_;
    std::optional<std::uint64_t> revision_;  // ShaderCollider::revision() of what is kept
    std::uint64_t updates_ = 0;

    float sun_texel_ = 0.0F;   // object units
    glm::vec3 sun_corner_{0};  // of texel (0, 0), on the plane where the rays start
    glm::vec3 sun_across_{0};  // unit vectors of the map's sides
    glm::vec3 sun_along_{0};
    GlProgram coarse_program_;
    GlProgram sun_program_;
    GlTexture coarse_;
    GlTexture sun_map_;
    GlFramebuffer coarse_target_;
    GlFramebuffer sun_target_;

    float voxel_ = 0.0F;
    Volume occupied_;
    Volume sky_;
};

}  // namespace relief
