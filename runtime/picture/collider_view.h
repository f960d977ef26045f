// SPDX-License-Identifier: Apache-2.0
// A collider as renderers see it, and the passes that follow rays through its field (shaders/picture/light.glsl,
// trace.glsl).
#pragma once

#include <glm/glm.hpp>

#include "formats/collider.h"
#include "runtime/bodies/world_bodies.h"
#include "runtime/collider/shader_collider.h"
#include "runtime/picture/camera.h"

namespace relief {

/// A collider as the renderers see it. The textures must outlive the renderers.
struct ColliderView {
    const ShaderCollider* textures = nullptr;
    Bounds bounds;       ///< object space; nothing of the collider lies outside
    float texel = 0.0F;  ///< object units across the finest texel of the maps, > 0
};

/// A world as the renderers see it while its bodies are in the box of where they stand at the beginning; those that move out of
/// it need larger bounds. \param textures  of worldBodies(world); must outlive the renderers.
[[nodiscard]] ColliderView worldView(const LoadedWorld& world, const ShaderCollider& textures);

/// Unit vector towards the sun of all pictures: from the upper left, in front.
[[nodiscard]] glm::vec3 sunDirection();

/// sRGB in [0, 1] to the linear colours that shaders take.
[[nodiscard]] glm::vec3 linearColor(const glm::vec3& srgb);

/// Sets u_eye, u_depth, and what makes the ray of each pixel: u_forward, u_right and u_up. Leaves the program current.
void setCameraUniforms(const GlProgram& program, const CameraMatrices& camera);

/// The sampling of a point's light: rays, and samples of the field on each.
struct LightRays {
    int sun = 1;
    int sky = 1;
    int sun_steps = 1;
    int sky_steps = 1;
};

/// Sets light.glsl's uniforms; leaves the program current.
void setLightUniforms(const GlProgram& program, const ColliderView& view, const LightRays& rays);

/// Of the first pass every kCoarseStride-th ray of a row or column is followed.
inline constexpr GLsizei kCoarseStride = 4;

/// Sets trace.glsl's uniforms; leaves the program current.
void setRayUniforms(const GlProgram& program, const ColliderView& view);

/// GlProgram::drawScreen() band by band: a driver may take a draw of several seconds for a hang.
void drawInBands(const GlProgram& program, GLuint framebuffer, GLsizei width, GLsizei height);

}  // namespace relief
