// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/collider_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "shaders/picture/constants.h"

namespace relief {
namespace {

constexpr ShaderCollider::Binding kColliderBinding{0, 0};
constexpr int kInputUnit = 3;  // after the three units of the collider

constexpr int kVoxelsPerSide = 40;  // along the longest side of the collider
constexpr int kSkyRays = 16;
constexpr float kSunBiasTexels = 1.5F;

constexpr const char* kFix = "close other programs that use the GPU";

/// Sets the transform from object space to texture coordinates of a volume: scale · (p - shift).
void setVolumeFrame(const GlProgram& program, const char* shift, const char* scale, const glm::vec3& first,
                    const glm::ivec3& size, float voxel) {
    program.set(shift, first - glm::vec3(0.5F * voxel));
    program.set(scale, 1.0F / (voxel * glm::vec3(size)));
}

}  // namespace

GLsizei ColliderLight::Volume::tiles() const {
    return static_cast<GLsizei>(std::ceil(std::sqrt(static_cast<double>(size.z))));
}

Result<void> ColliderLight::Volume::allocate() {
    const GLsizei rows = (size.z + tiles() - 1) / tiles();
    layers = makeTexture2D(GL_R8, tiles() * size.x, rows * size.y, GL_RED, GL_UNSIGNED_BYTE);
    texture = makeTexture3D(GL_R8, size, GL_RED, GL_UNSIGNED_BYTE, GL_LINEAR);
    RELIEF_TRY(checkAllocated("the light around the collider", kFix));
    target = RELIEF_TRY(makeFramebuffer({layers.name()}));
    return {};
}

Result<ColliderLight> ColliderLight::create(const ColliderView& collider) {
    RELIEF_TRY(checkContext());
    const PassState state;
    ColliderLight light;
    light.collider_ = collider;
    light.frameSun();
    light.frameVolumes();
    RELIEF_TRY(light.createPrograms());
    return light;
}

// Places the plane of the map between the sun and the collider, with a square that covers the whole collider.
void ColliderLight::frameSun() {
    const glm::vec3 sun = sunDirection();
    sun_across_ = glm::normalize(glm::cross(glm::vec3(0.0F, 1.0F, 0.0F), sun));
    sun_along_ = glm::cross(sun, sun_across_);
    const glm::vec3 half = 0.5F * collider_.bounds.size() + glm::vec3(2.0F * collider_.texel);
    const auto reach = [&](const glm::vec3& axis) { return glm::dot(glm::abs(axis), half); };
    const float side = 2.0F * std::max(reach(sun_across_), reach(sun_along_));
    sun_texel_ = side / static_cast<float>(kSunSide);
    sun_corner_ = collider_.bounds.center() + reach(sun) * sun - 0.5F * side * (sun_across_ + sun_along_);
}

// The collider occludes the sky beside and below it, within kSkyReach times its longest side, but not above it.
void ColliderLight::frameVolumes() {
    const float side = collider_.bounds.longestSide();
    voxel_ = side / static_cast<float>(kVoxelsPerSide);
    const auto frame = [&](Volume& volume, const glm::vec3& low, const glm::vec3& high) {
        volume.first = low;
        volume.size = glm::ivec3(glm::ceil((high - low) / voxel_)) + 1;
    };
    const glm::vec3 margin(voxel_);
    frame(occupied_, collider_.bounds.min - margin, collider_.bounds.max + margin);
    // Outside the volume, the outermost voxels apply.
    const glm::vec3 shade(kSkyReach * side + 2.0F * voxel_);
    frame(sky_, collider_.bounds.min - shade,
          collider_.bounds.max + glm::vec3(shade.x, 2.0F * voxel_, shade.z));
}

Result<void> ColliderLight::createPrograms() {
    const std::string defines = collider_.textures->defines();
    StartedProgram sun = RELIEF_TRY(startScreenProgram("picture/sun_map.frag", defines));
    StartedProgram coarse =
        RELIEF_TRY(startScreenProgram("picture/sun_map.frag", "#define RELIEF_COARSE 1\n" + defines));
    StartedProgram occupied = RELIEF_TRY(startScreenProgram("picture/occupancy.frag", defines));
    sky_.program = RELIEF_TRY(makeScreenProgram("picture/sky_share.frag"));
    occupied_.program = RELIEF_TRY(occupied.finish());
    coarse_program_ = RELIEF_TRY(coarse.finish());
    sun_program_ = RELIEF_TRY(sun.finish());
    const float side = sun_texel_ * static_cast<float>(kSunSide);
    for (const GlProgram* program : {&coarse_program_, &sun_program_}) {
        collider_.textures->attach(*program, kColliderBinding);
        setLightUniforms(*program, collider_, {});
        setRayUniforms(*program, collider_);
        program->set("u_corner", sun_corner_);
        program->set("u_across", side * sun_across_);
        program->set("u_along", side * sun_along_);
    }
    sun_program_.set("u_coarse", kInputUnit);
    collider_.textures->attach(occupied_.program, kColliderBinding);
    for (const Volume* volume : {&occupied_, &sky_}) {
        volume->program.use();
        volume->program.set("u_first", volume->first);
        volume->program.set("u_voxel", voxel_);
        volume->program.set("u_size", volume->size);
        volume->program.set("u_tiles", volume->tiles());
    }
    setVolumeFrame(sky_.program, "u_occupied_shift", "u_occupied_scale", occupied_.first, occupied_.size,
                   voxel_);
    sky_.program.set("u_occupied", kInputUnit);
    sky_.program.set("u_sky_rays", kSkyRays);
    sky_.program.set("u_sky_steps", static_cast<GLint>(kSkyReach * static_cast<float>(kVoxelsPerSide)));
    return {};
}

Result<void> ColliderLight::createTextures() {
    clearGlErrors();
    constexpr GLsizei kCoarseSide = kSunSide / kCoarseStride;
    coarse_ = makeTexture2D(GL_R32F, kCoarseSide, kCoarseSide, GL_RED, GL_FLOAT);
    sun_map_ = makeTexture2D(GL_R32F, kSunSide, kSunSide, GL_RED, GL_FLOAT);
    RELIEF_TRY(checkAllocated("the sun map of the collider", kFix));
    coarse_target_ = RELIEF_TRY(makeFramebuffer({coarse_.name()}));
    RELIEF_TRY(occupied_.allocate());
    RELIEF_TRY(sky_.allocate());
    // Created last, because update() creates all textures unless this framebuffer exists.
    sun_target_ = RELIEF_TRY(makeFramebuffer({sun_map_.name()}));
    return {};
}

Result<void> ColliderLight::update() {
    const std::uint64_t revision = collider_.textures->revision();
    if (revision_ == revision) {
        return {};
    }
    if (!sun_target_) {
        RELIEF_TRY(createTextures());
    }
    collider_.textures->bind(kColliderBinding);
    drawInBands(coarse_program_, coarse_target_.name(), kSunSide / kCoarseStride, kSunSide / kCoarseStride);
    useTexture(kInputUnit, coarse_);
    drawInBands(sun_program_, sun_target_.name(), kSunSide, kSunSide);
    drawVolume(occupied_);
    useTexture3D(kInputUnit, occupied_.texture);
    drawVolume(sky_);
    revision_ = revision;
    ++updates_;
    return {};
}

void ColliderLight::drawVolume(const Volume& volume) const {
    const GLsizei tiles = volume.tiles();
    const glm::ivec3& size = volume.size;
    volume.program.drawScreen(volume.target.name(), tiles * size.x, (size.z + tiles - 1) / tiles * size.y);
    useTexture3D(kInputUnit, volume.texture);
    for (GLint z = 0; z < size.z; ++z) {
        glCopyTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, z, z % tiles * size.x, z / tiles * size.y, size.x,
                            size.y);
    }
}

float ColliderLight::sunBias() const {
    return kSunBiasTexels * sun_texel_;
}

void ColliderLight::attach(const GlProgram& program, int unit) const {
    program.use();
    program.set("u_sun_map", unit);
    program.set("u_sky_fraction", unit + 1);
    const glm::vec3 sun = sunDirection();
    const glm::vec3 across = sun_across_ / sun_texel_;
    const glm::vec3 along = sun_along_ / sun_texel_;
    const std::array<glm::vec4, 3> rows{glm::vec4(across, -glm::dot(across, sun_corner_)),
                                        glm::vec4(along, -glm::dot(along, sun_corner_)),
                                        glm::vec4(-sun, glm::dot(sun, sun_corner_))};
    program.set("u_sun_rows", rows);
    program.set("u_sun_bias", sunBias());
    program.set("u_sun_cone", kSunWidth / sun_texel_);
    setVolumeFrame(program, "u_sky_shift", "u_sky_scale", sky_.first, sky_.size, voxel_);
    program.set("u_texel", collider_.texel);
}

void ColliderLight::bind(int unit) const {
    useTexture(unit, sun_map_);
    useTexture3D(unit + 1, sky_.texture);
}

}  // namespace relief
