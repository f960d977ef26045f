// Links a program that includes shaders/picture/light.glsl to a collider: its textures, bounds and the sun.
#pragma once

#include <glm/glm.hpp>

#include "formats/collider.h"
#include "runtime/collider/collider_textures.h"

namespace relief {

/// A collider as the renderers see it. The textures must outlive the renderers.
struct ColliderView {
    const ColliderTextures* textures = nullptr;
    Bounds bounds;       ///< object space; nothing of the collider lies outside
    float texel = 0.0F;  ///< object units across the finest texel of the maps, > 0
};

/// The side, in object units, of the finest texel among the maps, but no less than 1/2048 of the longest
/// side.
[[nodiscard]] float finestTexel(const Collider& collider);

/// Unit vector towards the sun of all pictures: from the upper left, in front.
[[nodiscard]] glm::vec3 sunDirection();

/// sRGB in [0, 1] to the linear colours that shaders take.
[[nodiscard]] glm::vec3 linearColor(const glm::vec3& srgb);

/// How finely a point's light is sampled: rays, and samples of the field on each.
struct LightRays {
    int sun = 1;
    int sky = 1;
    int sun_steps = 1;
    int sky_steps = 1;
};

/// Sets light.glsl's uniforms; leaves the program current.
void setLightUniforms(const GlProgram& program, const ColliderView& view, const LightRays& rays);

}  // namespace relief
