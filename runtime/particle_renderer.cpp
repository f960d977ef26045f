#include "runtime/particle_renderer.h"

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>

#include "runtime/pass_state.h"

namespace relief {
namespace {

constexpr int kPositionUnit = 0;
constexpr int kBirthUnit = 1;
constexpr ColliderTextures::Binding kColliderBinding{2, 0};

// A smaller sprite would miss the centres of most pixels.
constexpr float kPixelsMin = 1.5F;

// A few for each grain, each with its own noise: neighbours make up for it.
constexpr LightRays kLightRays{.sun = 1, .sky = 2, .sun_steps = 16, .sky_steps = 3};

}  // namespace

Result<ParticleRenderer> ParticleRenderer::create(const std::optional<ColliderView>& collider) {
    const PassState state;
    const std::string defines =
        collider ? "#define RELIEF_LIT 1\n" + collider->textures->defines() : std::string();
    auto program = makeProgram("point.vert", "point.frag", defines);
    if (!program) {
        return forward(program);
    }
    ParticleRenderer renderer;
    renderer.collider_ = collider;
    renderer.program_ = std::move(*program);
    renderer.no_attributes_ = makeVertexArray();
    if (collider) {
        collider->textures->attach(renderer.program_, kColliderBinding);
        setLightUniforms(renderer.program_, *collider, kLightRays);
    }
    glUseProgram(renderer.program_.name());
    glUniform1i(uniformLocation(renderer.program_, "u_position"), kPositionUnit);
    glUniform1i(uniformLocation(renderer.program_, "u_birth"), kBirthUnit);
    return renderer;
}

void ParticleRenderer::draw(const ParticleSystem& particles, const Camera& camera, const ParticleStyle& style,
                            const RenderTarget& target) const {
    if (particles.extent() == 0) {
        return;
    }
    const PassState state;
    const auto at = [&](const char* name) { return uniformLocation(program_, name); };
    const glm::mat4 view = camera.view();
    const glm::mat4 projection = camera.projection(target.aspect());
    const glm::vec3 sun = glm::mat3(view) * sunDirection();
    const glm::vec3 up = glm::mat3(view) * glm::vec3(0.0F, 1.0F, 0.0F);
    const glm::vec3 color = linearColor(style.color);
    std::array<GLfloat, 2> sizes{1.0F, 1.0F};
    glGetFloatv(GL_ALIASED_POINT_SIZE_RANGE, sizes.data());

    glUseProgram(program_.name());
    glUniform1i(at("u_width"), static_cast<GLint>(particles.textureWidth()));
    glUniform1f(at("u_now"), particles.clock());
    glUniformMatrix4fv(at("u_view"), 1, GL_FALSE, glm::value_ptr(view));
    glUniformMatrix4fv(at("u_projection"), 1, GL_FALSE, glm::value_ptr(projection));
    glUniform1f(at("u_pixels_per_unit"), 0.5F * static_cast<float>(target.height) / camera.tanHalfFov());
    glUniform1f(at("u_diameter"), style.diameter);
    glUniform2f(at("u_pixels"), std::min(kPixelsMin, sizes[1]), sizes[1]);
    glUniform2f(at("u_fade"), style.fade_in, style.fade_out);
    glUniform1f(at("u_opacity"), style.opacity);
    glUniform3f(at("u_color"), color.x, color.y, color.z);
    glUniform3f(at("u_sun_view"), sun.x, sun.y, sun.z);
    glUniform3f(at("u_up_view"), up.x, up.y, up.z);
    glActiveTexture(GL_TEXTURE0 + kPositionUnit);
    glBindTexture(GL_TEXTURE_2D, particles.positions().name());
    glActiveTexture(GL_TEXTURE0 + kBirthUnit);
    glBindTexture(GL_TEXTURE_2D, particles.births().name());
    if (collider_) {
        collider_->textures->bind(kColliderBinding);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glViewport(0, 0, target.width, target.height);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glBindVertexArray(no_attributes_.name());
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(particles.extent()));
}

}  // namespace relief
