// SPDX-License-Identifier: Apache-2.0
#include "runtime/particles/step_pass.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runtime/gl/gl_functions.h"
#include "shaders/collider/constants.h"

namespace relief {
namespace {

/// Maximum maps that a work group copies to shared memory. OpenGL ES 3.1 guarantees 16 KB, enough for 113 maps of 144
/// bytes. The cost of more maps was not measured; each group of 64 particles makes a copy.
constexpr int kTourMapsMax = 64;

/// Returns true if lanes should advance independently (shaders/collider/collider_tour.glsl). Only sweeps gain from it:
/// without a sweep a step queries one point, and the points of a ball are queried in loops in either case.
bool toursMaps(const StepVariant& variant) {
    return variant.compute && variant.collider != nullptr && !variant.radius && variant.sweep &&
           variant.collider->bodyCount() == 0 && variant.collider->mapCount() <= kTourMapsMax;
}

}  // namespace

float dragRate(const Forces& forces, const ParticleType& type) {
    return forces.viscosity > 0.0F ? stokesRate(forces.viscosity, type.radius, type.mass)
                                   : forces.drag / type.mass;
}

float stokesRate(float viscosity, float radius, float mass) {
    constexpr float kSixPi = 18.849556F;
    return kSixPi * viscosity * radius / mass;
}

Result<StepPass> StepPass::start(StepVariant variant, const StepShader& shader) {
    std::string defines = shader.defines + "#define RELIEF_TYPES " + std::to_string(variant.types) + "\n";
    const auto defineIf = [&](bool wanted, const std::string& what) {
        defines += wanted ? "#define " + what + "\n" : "";
    };
    defineIf(variant.verlet, "RELIEF_VERLET");
    defineIf(variant.sweep, "RELIEF_SWEEP " + std::to_string(kSweepPieces));
    defineIf(variant.radius, "RELIEF_RADIUS");
    defineIf(variant.masks, "RELIEF_MASKS");
    bool materials = variant.collider != nullptr && variant.collider->materialsAffectReaction();
    for (const StepFeature* feature : variant.features) {
        defines += feature->defines();
        materials = materials || feature->readsMaterials();
    }
    if (variant.collider != nullptr) {
        defines += "#define RELIEF_COLLIDER\n" + variant.collider->defines();
        defines += materials ? variant.collider->materialDefines() : "";
    }
    StepPass pass;
    pass.tours_ = toursMaps(variant);
    defineIf(pass.tours_, "RELIEF_TOUR");
    pass.started_ = RELIEF_TRY(variant.compute ? startComputeProgram(shader.file, defines)
                                               : startScreenProgram(shader.file, defines));
    pass.variant_ = std::move(variant);
    return pass;
}

Result<void> StepPass::finish() {
    if (program_) {
        return {};
    }
    program_ = RELIEF_TRY(started_.finish());
    program_.use();
    program_.set("u_position", kPositionUnit);
    program_.set("u_velocity", kVelocityUnit);
    program_.set("u_birth", kBirthUnit);
    if (variant_.collider != nullptr) {
        variant_.collider->attach(program_, kColliderBinding);
    }
    for (const StepFeature* feature : variant_.features) {
        feature->attach(program_);
    }
    return {};
}

void StepPass::use(const Values& values) const {
    program_.use();
    if (variant_.collider != nullptr) {
        float radius = 0.0F;
        for (const ParticleType& type : values.types) {
            radius = std::max(radius, type.radius);
        }
        variant_.collider->reach(radius);
        variant_.collider->bind(kColliderBinding);
        variant_.collider->bindMaterials(kColliderBinding);
        if (tours_) {
            variant_.collider->bindStorage(kTourStorage);
        }
    }
    for (const StepFeature* feature : variant_.features) {
        feature->bind(program_, values.time);
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
    std::vector<glm::vec4> types;
    std::vector<GLint> collides;
    for (const ParticleType& type : values.types) {
        types.emplace_back(type.radius, type.restitution, 1.0F - type.friction, type.friction_threshold);
        types.emplace_back(dragRate(forces, type), static_cast<float>(type.on_collision), type.lifetime_loss,
                           type.gravity);
        collides.push_back(static_cast<GLint>(type.collides_with));
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
