// SPDX-License-Identifier: Apache-2.0
// Collider data for renderers, and helpers of passes that trace its field (shaders/picture/light.glsl, trace.glsl).
#pragma once

#include <glm/glm.hpp>

#include "formats/collider.h"
#include "runtime/bodies/world_bodies.h"
#include "runtime/collider/shader_collider.h"
#include "runtime/picture/camera.h"

namespace relief {

/// A collider for renderers. The textures must outlive the renderers.
struct ColliderView {
    const ShaderCollider* textures = nullptr;
    Bounds bounds;       ///< object space; contains the whole collider
    float texel = 0.0F;  ///< side of the finest texel, object units, > 0
};

/// Returns the view of a world with the initial bounds of its bodies; enlarge the bounds if bodies leave them.
/// \param textures  created from worldBodies(world); must outlive the renderers.
[[nodiscard]] ColliderView worldView(const LoadedWorld& world, const ShaderCollider& textures);

/// Returns the unit vector towards the sun in all pictures: upper left, in front.
[[nodiscard]] glm::vec3 sunDirection();

/// Converts sRGB in [0, 1] to linear light.
[[nodiscard]] glm::vec3 linearColor(const glm::vec3& srgb);

/// Sets u_eye, u_depth, u_forward, u_right and u_up, which define the ray of each pixel. Leaves the program current.
void setCameraUniforms(const GlProgram& program, const CameraMatrices& camera);

/// Number of rays per lit point, and of field samples per ray.
struct LightRays {
    int sun = 1;
    int sky = 1;
    int sun_steps = 1;
    int sky_steps = 1;
};

/// Sets the uniforms of light.glsl; leaves the program current.
void setLightUniforms(const GlProgram& program, const ColliderView& view, const LightRays& rays);

/// A coarse first pass traces one ray per kCoarseStride² pixels.
inline constexpr GLsizei kCoarseStride = 4;

/// Sets the uniforms of trace.glsl; leaves the program current.
void setRayUniforms(const GlProgram& program, const ColliderView& view);

/// Calls GlProgram::drawScreen() in bands, because a driver may treat a draw of several seconds as a hang.
void drawInBands(const GlProgram& program, GLuint framebuffer, GLsizei width, GLsizei height);

}  // namespace relief
