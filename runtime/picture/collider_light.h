// SPDX-License-Identifier: Apache-2.0
// Cached light around a collider: a shadow map from the sun, and a volume with the visible fraction of the sky. A
// particle reads a few texels (shaders/picture/particle_light.glsl) instead of tracing rays. The light is updated only
// if the collider has moved or deformed.
//
//     bytes on the GPU ≈ 4 · kSunSide² (1.0 MB) + 2 · voxels (0.9 MB for a cube)
//
// Accuracy. Light leaks behind surfaces: sunlight up to sunBias(), sky light up to 1.5 voxels. voxel() is 1/40 of the
// collider's longest side. The sun map may miss details thinner than four of its texels, measured perpendicular to the
// light.
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

    /// Needs a current context, as all members do.
    /// Errors: kFailure (shader compiler), kLimit (out of memory).
    [[nodiscard]] static Result<ColliderLight> create(const ColliderView& collider);

    /// Updates the light if the collider has changed. Call it within a PassState: it changes units 0–3, the framebuffer
    /// and the viewport.
    /// Errors: kLimit (out of memory), kUnsupported (float textures are not renderable).
    [[nodiscard]] Result<void> update();

    /// Sets the uniforms of particle_light.glsl; leaves the program current. \param unit  texture unit of the sun map;
    /// the sky volume uses the next one.
    void attach(const GlProgram& program, int unit) const;
    /// Binds both textures.
    void bind(int unit) const;

    /// Returns the shadow bias along the light, object units. Points less than this distance behind a surface are lit.
    [[nodiscard]] float sunBias() const;
    /// Returns the side of a sky voxel, object units.
    [[nodiscard]] float voxel() const { return voxel_; }
    /// Returns the number of updates that were not skipped.
    [[nodiscard]] std::uint64_t updates() const { return updates_; }

  private:
    /// Voxels, drawn as a 2-D picture of layers (shaders/picture/volume.glsl), then copied to a 3-D texture.
    struct Volume {
        glm::ivec3 size{0};
        glm::vec3 first{0.0F};  // centre of voxel (0, 0, 0)
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
    void drawVolume(const Volume& volume) const;

    ColliderView collider_;
    std::optional<std::uint64_t> revision_;  // ShaderCollider::revision() of the cached light
    std::uint64_t updates_ = 0;

    float sun_texel_ = 0.0F;   // object units
    glm::vec3 sun_corner_{0};  // corner of texel (0, 0), on the plane where rays start
    glm::vec3 sun_across_{0};  // unit vectors along the sides of the map
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
