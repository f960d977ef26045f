// SPDX-License-Identifier: Apache-2.0
#include "runtime/particles/step_pass.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "runtime/gl/gl_functions.h"
#include "shaders/collider/constants.h"

namespace relief {
namespace {

/// Maps that a work group copies at most. OpenGL ES 3.1 promises 16 KB of shared memory: room for 113 maps of 144 bytes; but
/// each group of 64 particles makes a copy, and what many maps cost then was not measured.
constexpr int kTourMapsMax = 64;

/// True if lanes proceed on their own along their paths (shaders/collider/collider_tour.glsl). For one point this gains nothing,
/// and a ball's points are as well asked in loops.
bool toursMaps(const StepFeatures& features) {
    return features.compute && features.collider != nullptr && !features.radius && features.sweep &&
           features.collider->bodyCount() == 0 && features.collider->mapCount() <= kTourMapsMax;
}

}  // namespace

float dragRate(const Forces& forces, const ParticleType& type) {
    return forces.viscosity > 0.0F ? stokesRate(forces.viscosity, type.radius, type.mass)
                                   : forces.drag / type.mass;
}

Result<StepPass> StepPass::create(const StepFeatures& features, const StepShader& shader) {
    std::string defines = shader.defines + "#define RELIEF_TYPES " + std::to_string(features.types) + "\n";
    const auto defineIf = [&](bool wanted, const std::string& what) {
        defines += wanted ? "#define " + what + "\n" : "";
    };
    defineIf(features.verlet, "RELIEF_VERLET");
    defineIf(features.sweep, "RELIEF_SWEEP " + std::to_string(kSweepPieces));
    defineIf(features.radius, "RELIEF_RADIUS");
    defineIf(features.events, "RELIEF_EVENTS");
    defineIf(features.masks, "RELIEF_MASKS");
    if (features.air != nullptr) {
        defines += features.air->defines();
    }
    StepPass pass;
    pass.features_ = features;
    if (features.collider != nullptr) {
        defines += "#define RELIEF_COLLIDER\n";
        defines += features.collider->defines();
        if (features.events || features.collider->materialsRespond()) {
            defines += features.collider->materialDefines();
        }
    }
    pass.tours_ = toursMaps(features);
    defineIf(pass.tours_, "RELIEF_TOUR");
    pass.program_ = RELIEF_TRY(features.compute ? makeComputeProgram(shader.file, defines)
                                                : makeScreenProgram(shader.file, defines));
    pass.program_.use();
    pass.program_.set("u_position", kPositionUnit);
    pass.program_.set("u_velocity", kVelocityUnit);
    pass.program_.set("u_birth", kBirthUnit);
    if (features.collider != nullptr) {
        features.collider->attach(pass.program_, kColliderBinding);
    }
    if (features.air != nullptr) {
        features.air->attach(pass.program_, kAirBinding);
    }
    return pass;
}

void StepPass::use(const Values& values) const {
    program_.use();
    if (features_.collider != nullptr) {
        float radius = 0.0F;
        for (const ParticleType& type : values.types) {
            radius = std::max(radius, type.radius);
        }
        features_.collider->reach(radius);
        features_.collider->bind(kColliderBinding);
        features_.collider->bindMaterials(kColliderBinding);
        if (tours_) {
            features_.collider->bindStorage(kTourStorage);
        }
    }
    if (features_.air != nullptr) {
        features_.air->bind(kAirBinding);
    }
    const Forces& forces = values.forces;
    program_.set("u_now", values.now);
    program_.set("u_dt", values.dt);
    program_.set("u_rate", 1.0F / values.dt);
    program_.set("u_gravity", forces.gravity);
    program_.set("u_wind", forces.wind);
    program_.set("u_still", 1e-3F * values.dt * glm::length(forces.gravity));
    program_.set("u_ground", values.ground);
    program_.set("u_sweep", values.sweep);
    program_.set("u_air_time", values.air_time);
    std::vector<glm::vec4> types;
    std::vector<GLint> collides;
    for (const ParticleType& type : values.types) {
        types.emplace_back(type.radius, type.restitution, 1.0F - type.friction, type.friction_threshold);
        types.emplace_back(dragRate(forces, type), static_cast<float>(type.on_collision), type.lifetime_loss,
                           type.gravity);
        collides.push_back(static_cast<GLint>(type.collides));
    }
    program_.set("u_types", types);
    program_.set("u_collides", collides);
}

void StepPass::draw(GLuint framebuffer, std::uint32_t width, std::uint32_t rows) const {
    program_.drawScreen(framebuffer, static_cast<GLsizei>(width), static_cast<GLsizei>(rows));
}

void StepPass::dispatch(std::uint32_t width, std::uint32_t rows) const {
    program_.set("u_size", glm::ivec2(width, rows));
    glDispatchCompute((width + kStepGroupWidth - 1) / kStepGroupWidth,
                      (rows + kStepGroupHeight - 1) / kStepGroupHeight, 1);
}

}  // namespace relief
