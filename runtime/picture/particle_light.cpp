#include "runtime/picture/particle_light.h"

#include <algorithm>
#include <array>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr ColliderTextures::Binding kColliderBinding{0, 0};
constexpr int kPositionUnit = 3;  // after the collider's three
constexpr int kBirthUnit = 4;
constexpr int kLooksUnit = 5;

// A few rays for each grain, with noise of its own: neighbours even it out.
constexpr LightRays kLightRays{.sun = 1, .sky = 2, .sun_steps = 16, .sky_steps = 3};

}  // namespace

Result<ParticleLight> ParticleLight::create(const ColliderView& collider) {
    const PassState state;
    ParticleLight light;
    light.collider_ = collider;
    light.program_ =
        RELIEF_TRY(makeProgram("quad.vert", "particle_light.frag", collider.textures->defines()));
    light.no_attributes_ = makeVertexArray();
    collider.textures->attach(light.program_, kColliderBinding);
    setLightUniforms(light.program_, collider, kLightRays);
    glUniform1i(uniformLocation(light.program_, "u_position"), kPositionUnit);
    glUniform1i(uniformLocation(light.program_, "u_birth"), kBirthUnit);
    glUniform1i(uniformLocation(light.program_, "u_looks"), kLooksUnit);
    return light;
}

Result<void> ParticleLight::update(const ParticleSystem& particles, const GlTexture& looks) {
    const auto width = static_cast<GLsizei>(particles.textureWidth());
    const auto extent = static_cast<GLsizei>(particles.extent());
    const GLsizei rows = (extent + width - 1) / width;
    if (!target_ || width_ != width || height_ < rows) {
        // Large enough for the full capacity, so that it is made once.
        const auto capacity = static_cast<GLsizei>(particles.capacity());
        target_ = GlFramebuffer();
        width_ = width;
        height_ = std::max(rows, (capacity + width - 1) / width);
        const std::string what = "the light of " + std::to_string(capacity) + " particles";
        constexpr const char* kCure = "choose a smaller capacity";
        RELIEF_TRY(checkTextureSize(static_cast<std::uint64_t>(width_), static_cast<std::uint64_t>(height_),
                                    what, kCure));
        forgetGlErrors();
        light_ = makeTexture2D(GL_RGBA32F, width_, height_, GL_RGBA, GL_FLOAT);
        RELIEF_TRY(checkAllocated(what, kCure));
        const std::array<GLuint, 1> colors{light_.name()};
        target_ = RELIEF_TRY(makeFramebuffer(colors));
    }
    glUseProgram(program_.name());
    glUniform1i(uniformLocation(program_, "u_extent"), extent);
    glUniform1f(uniformLocation(program_, "u_now"), particles.clock());
    collider_.textures->bind(kColliderBinding);
    useTexture(kPositionUnit, particles.positions());
    useTexture(kBirthUnit, particles.births());
    useTexture(kLooksUnit, looks);
    glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
    glViewport(0, 0, width, rows);
    glBindVertexArray(no_attributes_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return {};
}

}  // namespace relief
