// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/particle_renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

// Sampler k uses unit k.
constexpr std::array<const char*, 6> kSamplers{"u_position", "u_birth", "u_looks",
                                               "u_order",    "u_atlas", "u_behind"};
// Only programs with cells use the atlas; only programs for stretched sprites use velocities.
constexpr int kLightUnit = kSamplers.size();  // two units
constexpr int kVelocityUnit = kLightUnit + 2;
static_assert(kVelocityUnit + 1 <= PassState::kUnits);

// Smaller sprites would miss most pixel centres.
constexpr float kPixelsMin = 1.5F;

bool isFinite(const glm::mat4& matrix) {
    const float* numbers = glm::value_ptr(matrix);
    return std::all_of(numbers, numbers + 16, [](float number) { return std::isfinite(number); });
}

bool anyLit(const ParticleStyle& style) {
    return style.looks.empty() || std::any_of(style.looks.begin(), style.looks.end(),
                                              [](const ParticleLook& look) { return look.lit; });
}

bool anyStretched(const ParticleStyle& style) {
    return std::any_of(style.looks.begin(), style.looks.end(),
                       [](const ParticleLook& look) { return look.needsQuads() != nullptr; });
}

std::uint32_t spriteCount(const ParticleSystem& particles, const ParticleOrder& order) {
    return order.texture != nullptr && particles.extent() > 0 ? order.count : particles.extent();
}

TilePainter::Vertices verticesOf(const ParticleStyle& style) {
    return style.sprite == Sprite::kQuad ? TilePainter::Vertices{GL_TRIANGLES, kQuadVertices}
                                         : TilePainter::Vertices{GL_POINTS, 1};
}

/// Leaves the program in use.
void setUniforms(const GlProgram& program, const ParticleSystem& particles, const CameraMatrices& camera,
                 const ParticleStyle& style, const RenderTarget& target, bool ordered, bool soft) {
    std::array<GLfloat, 2> sizes{1.0F, 1.0F};
    glGetFloatv(GL_ALIASED_POINT_SIZE_RANGE, sizes.data());
    const float largest = style.sprite == Sprite::kQuad ? 1e30F : sizes[1];

    program.use();
    program.set("u_width", static_cast<GLint>(particles.textureWidth()));
    program.set("u_extent", static_cast<GLint>(particles.extent()));
    program.set("u_now", particles.clock());
    program.set("u_view", camera.view);
    program.set("u_projection", camera.projection);
    program.set("u_pixels_per_unit", 0.5F * static_cast<float>(target.height) / camera.tanHalfFov());
    program.set("u_pixels", glm::vec2(std::min(kPixelsMin, largest), largest));
    program.set("u_target", glm::vec2(target.width, target.height));
    program.set("u_depth", camera.depthOfDistance());
    program.set("u_sun_view", glm::mat3(camera.view) * sunDirection());
    program.set("u_up_view", glm::mat3(camera.view) * glm::vec3(0.0F, 1.0F, 0.0F));
    program.set("u_ordered", ordered);
    program.set("u_srgb", target.srgb);
    program.set("u_soft", soft ? style.soft_distance : 0.0F);
    if (style.atlas != nullptr) {
        program.set("u_cells", glm::ivec2(style.atlas->columns(), style.atlas->rows()));
        program.set("u_levels_max", static_cast<float>(style.atlas->lastLevel()));
    }
}

}  // namespace

Result<ParticleRenderer> ParticleRenderer::create(const std::optional<ColliderView>& collider,
                                                  StepPath path) {
    RELIEF_TRY(checkContext());
    const PassState state;
    ParticleRenderer renderer;
    if (collider) {
        renderer.light_ = RELIEF_TRY(ColliderLight::create(*collider));
    }
    for (const Sprite sprite : {Sprite::kPoint, Sprite::kQuad}) {
        [[maybe_unused]] const GlProgram* made = RELIEF_TRY(renderer.programFor({.sprite = sprite}));
    }
    if (RELIEF_TRY(resolvePath(path)) == StepPath::kCompute) {
        renderer.needs_tiles_ = path == StepPath::kCompute;
        auto tiles = TilePainter::create();
        if (tiles || renderer.needs_tiles_) {
            renderer.tiles_ = RELIEF_TRY(std::move(tiles));
        }
    }
    renderer.no_attributes_ = makeVertexArray();
    clearGlErrors();
    const std::array<GLubyte, 4> zero{};
    renderer.nothing_ = makeTexture2D(GL_RGBA8, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, zero.data());
    constexpr std::array<std::uint32_t, 2> kNoRank{};
    renderer.no_order_ = makeTexture2D(GL_RG32UI, 1, 1, GL_RG_INTEGER, GL_UNSIGNED_INT, kNoRank.data());
    RELIEF_TRY(checkAllocated("the renderer of the particles", "close other programs that use the GPU"));
    return renderer;
}

std::string ParticleRenderer::definesOf(const ParticleStyle& style) const {
    const bool quads = style.sprite == Sprite::kQuad;
    return std::string(light_ ? "#define RELIEF_LIT 1\n" : "") + (quads ? "#define RELIEF_QUADS 1\n" : "") +
           (style.atlas != nullptr ? "#define RELIEF_CELLS 1\n" : "") +
           (quads && anyStretched(style) ? "#define RELIEF_STRETCH 1\n" : "");
}

void ParticleRenderer::setSamplers(const GlProgram& program) const {
    program.use();
    for (std::size_t unit = 0; unit < kSamplers.size(); ++unit) {
        program.set(kSamplers[unit], static_cast<GLint>(unit));
    }
    program.set("u_velocity", kVelocityUnit);
    if (light_) {
        light_->attach(program, kLightUnit);
    }
}

Result<const GlProgram*> ParticleRenderer::programFor(const ParticleStyle& style) {
    const std::string defines = definesOf(style);
    GlProgram& program = programs_[defines];
    if (!program) {
        program = RELIEF_TRY(makeProgram("picture/point.vert", "picture/point.frag", defines));
        setSamplers(program);
    }
    return &program;
}

Result<void> ParticleRenderer::uploadLooks(const ParticleStyle& style) {
    auto packed = RELIEF_TRY(
        packLooks(style.looks, {style.diameter, style.color, style.opacity, style.fade_in, style.fade_out}));
    if (!looks_ || packed != packed_) {
        clearGlErrors();
        packed_ = std::move(packed);
        looks_ = makeTexture2D(GL_RGBA32F, static_cast<GLsizei>(packed_.width),
                               static_cast<GLsizei>(packed_.texels.size() / packed_.width), GL_RGBA, GL_FLOAT,
                               packed_.texels.data());
        if (auto done = checkAllocated("the looks of the particles", "choose fewer types"); !done) {
            looks_ = {};
            return done;
        }
    }
    return {};
}

Result<bool> ParticleRenderer::paintTiles(const ParticleSystem& particles, const CameraMatrices& camera,
                                          const ParticleStyle& style, const RenderTarget& target,
                                          const ParticleOrder& order, const GlTexture* behind) {
    if (!tiles_ || !tiles_->prepare(spriteCount(particles, order), target)) {
        return false;
    }
    const std::string defines = definesOf(style);
    const TilePainter::Programs* programs = tiles_->programs(defines);
    if (programs == nullptr) {
        auto made = tiles_->makePrograms(defines);
        if (!made && !needs_tiles_) {
            tiles_.reset();
            return false;
        }
        programs = RELIEF_TRY(std::move(made));
        setSamplers(programs->sprites);
        setSamplers(programs->paint);
    }
    for (const GlProgram* program : {&programs->sprites, &programs->paint}) {
        setUniforms(*program, particles, camera, style, target, order.texture != nullptr, behind != nullptr);
    }
    bindTextures(particles, style, order, behind);
    tiles_->paint(*programs, verticesOf(style), style.blend == Blend::kAdditive);
    return true;
}

void ParticleRenderer::bindTextures(const ParticleSystem& particles, const ParticleStyle& style,
                                    const ParticleOrder& order, const GlTexture* behind) const {
    const std::array<const GlTexture*, kSamplers.size()> textures{
        &particles.positions(),
        &particles.births(),
        &looks_,
        order.texture != nullptr ? order.texture : &no_order_,
        style.atlas != nullptr ? &style.atlas->texture() : &nothing_,
        behind != nullptr ? behind : &nothing_};
    for (std::size_t unit = 0; unit < textures.size(); ++unit) {
        useTexture(static_cast<int>(unit), *textures[unit]);
    }
    if (light_) {
        light_->bind(kLightUnit);
    }
    if (anyStretched(style)) {
        useTexture(kVelocityUnit, particles.velocities());
    }
}

Result<void> ParticleRenderer::draw(const ParticleSystem& particles, const CameraMatrices& camera,
                                    const ParticleStyle& style, const RenderTarget& target,
                                    const ParticleOrder& order, const GlTexture* behind) {
    if (!(style.soft_distance >= 0.0F && style.soft_distance < 1e30F)) {
        return fail(ErrorCode::kUsage, "the soft distance of particles must be 0 or more");
    }
    if (!isFinite(camera.view) || !isFinite(camera.projection)) {
        return fail(ErrorCode::kUsage, "the matrices of a camera must be finite");
    }
    if (style.sprite == Sprite::kPoint && anyStretched(style)) {
        return fail(ErrorCode::kUsage, "points cannot be stretched; use quads as sprites");
    }
    const PassState state;
    RELIEF_TRY(uploadLooks(style));
    if (particles.extent() == 0) {
        return {};
    }
    if (light_ && anyLit(style)) {
        RELIEF_TRY(light_->update());
    }
    const GlProgram& program = *RELIEF_TRY(programFor(style));
    const bool tiled = RELIEF_TRY(paintTiles(particles, camera, style, target, order, behind));
    bindTextures(particles, style, order, behind);
    setUniforms(program, particles, camera, style, target, order.texture != nullptr, behind != nullptr);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glViewport(0, 0, target.width, target.height);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, style.blend == Blend::kAdditive ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glBindVertexArray(no_attributes_.name());
    const TilePainter::Vertices vertices = verticesOf(style);
    if (tiled) {
        tiles_->show(program, vertices);
    } else {
        const std::uint32_t count = vertices.count * spriteCount(particles, order);
        glDrawArrays(vertices.mode, 0, static_cast<GLsizei>(count));
    }
    return {};
}

}  // namespace relief
