// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/collider_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

// Step of a ray in texels; a ray hits every feature that is at least two texels thick.
constexpr float kStepTexels = 1.5F;

// Enough for the diagonal of a box whose finest texel is 1/2048 of its longest side, plus bisections. Larger boxes use
// longer steps.
constexpr int kRayStepsMax = 2560;
constexpr int kBisections = 10;

constexpr GLsizei kBandRows = 64;

}  // namespace

ColliderView worldView(const LoadedWorld& world, const ShaderCollider& textures) {
    std::vector<float> texels;
    for (const Collider& collider : world.colliders) {
        texels.push_back(finestTexel(collider));
    }
    ColliderView view{&textures, worldBounds(world.world), std::numeric_limits<float>::max()};
    for (const WorldBody& body : world.world.bodies) {
        view.texel = std::min(view.texel, body.scale * texels[body.collider]);
    }
    return view;
}

glm::vec3 sunDirection() {
    return glm::normalize(glm::vec3(-0.55F, 0.95F, 0.62F));
}

glm::vec3 linearColor(const glm::vec3& srgb) {
    glm::vec3 linear;
    for (int i = 0; i < 3; ++i) {
        linear[i] = srgb[i] <= 0.04045F ? srgb[i] / 12.92F : std::pow((srgb[i] + 0.055F) / 1.055F, 2.4F);
    }
    return linear;
}

void setCameraUniforms(const GlProgram& program, const CameraMatrices& camera) {
    const glm::mat3 to_world = glm::transpose(glm::mat3(camera.view));
    const glm::mat4& p = camera.projection;
    program.use();
    program.set("u_eye", camera.eye());
    program.set("u_forward", to_world * glm::vec3(p[2][0] / p[0][0], p[2][1] / p[1][1], -1.0F));
    program.set("u_right", to_world[0] / p[0][0]);
    program.set("u_up", to_world[1] / p[1][1]);
    program.set("u_depth", camera.depthOfDistance());
}

void setLightUniforms(const GlProgram& program, const ColliderView& view, const LightRays& rays) {
    program.use();
    program.set("u_bounds_min", view.bounds.min - glm::vec3(2.0F * view.texel));
    program.set("u_bounds_max", view.bounds.max + glm::vec3(2.0F * view.texel));
    program.set("u_scale", view.bounds.longestSide());
    program.set("u_texel", view.texel);
    program.set("u_sun", sunDirection());
    program.set("u_rays", glm::ivec2(rays.sun, rays.sky));
    program.set("u_ray_steps", glm::ivec2(rays.sun_steps, rays.sky_steps));
}

void setRayUniforms(const GlProgram& program, const ColliderView& view) {
    program.use();
    program.set("u_step", kStepTexels * view.texel);
    program.set("u_steps_max", kRayStepsMax);
    program.set("u_bisections", kBisections);
}

void drawInBands(const GlProgram& program, GLuint framebuffer, GLsizei width, GLsizei height) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width, height);
    glEnable(GL_SCISSOR_TEST);
    for (GLsizei y = 0; y < height; y += kBandRows) {
        glScissor(0, y, width, std::min(kBandRows, height - y));
        program.drawScreen();
        glFlush();
    }
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace relief
