#include "runtime/particles/step_pass.h"

#include <array>
#include <string>

#include "runtime/gl/gl_functions.h"
#include "shaders/shader_constants.h"

namespace relief {
namespace {

/// Maps that a work group copies at most. OpenGL ES 3.1 promises 16 KB of shared memory: room for 106 maps of 144 bytes beside
/// eight bodies of 128; but each group of 64 particles makes a copy, and what many maps cost then was not measured.
constexpr int kTourMapsMax = 64;

/// Whether lanes go on by themselves, from body to body or along their ways (shaders/collider_tour.glsl). For one point of one
/// collider this gains nothing, and a ball's points are as well asked in loops.
bool toursMaps(const StepFeatures& features) {
    return features.compute && features.collider != nullptr && !features.radius &&
           (features.sweep || features.collider->bodyCount() > 1) &&
           features.collider->mapCount() <= kTourMapsMax;
}

}  // namespace

float dragRate(const Forces& forces, const ParticleType& type) {
    return forces.viscosity > 0.0F ? stokesRate(forces.viscosity, type.radius, type.mass)
                                   : forces.drag / type.mass;
}

Result<StepPass> StepPass::create(const StepFeatures& features) {
    std::string defines = "#define RELIEF_TYPES " + std::to_string(features.types) + "\n";
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
    defineIf(features.compute, "RELIEF_COMPUTE");
    const bool among = features.collider != nullptr;
    if (among) {
        defines += features.collider->defines();
    }
    pass.tours_ = toursMaps(features);
    defineIf(pass.tours_, "RELIEF_TOUR");
    pass.program_ = RELIEF_TRY(
        features.compute ? makeComputeProgram(among ? "step.comp" : "step_free.comp", defines)
                         : makeProgram("quad.vert", among ? "step.frag" : "step_free.frag", defines));
    const auto at = [&](const char* name) { return glGetUniformLocation(pass.program_.name(), name); };
    pass.now_ = at("u_now");
    pass.dt_ = at("u_dt");
    pass.rate_before_ = at("u_rate_before");
    pass.gravity_ = at("u_gravity");
    pass.wind_ = at("u_wind");
    pass.still_ = at("u_still");
    pass.ground_ = at("u_ground");
    pass.sweep_ = at("u_sweep");
    pass.air_time_ = at("u_air_time");
    pass.types_ = at("u_types");
    pass.collides_ = at("u_collides");
    pass.size_ = at("u_size");
    glUseProgram(pass.program_.name());
    glUniform1i(at("u_position"), kPositionUnit);
    glUniform1i(at(features.verlet ? "u_position_before" : "u_velocity"), kVelocityUnit);
    glUniform1i(at("u_birth"), kBirthUnit);
    if (features.collider != nullptr) {
        features.collider->attach(pass.program_, kColliderBinding);
    }
    if (features.air != nullptr) {
        features.air->attach(pass.program_, kAirBinding);
    }
    return pass;
}

void StepPass::use(const Values& values) const {
    glUseProgram(program_.name());
    if (features_.collider != nullptr) {
        features_.collider->bind(kColliderBinding);
        if (tours_) {
            features_.collider->bindStorage(kTourStorage);
        }
    }
    if (features_.air != nullptr) {
        features_.air->bind(kAirBinding);
    }
    const Forces& forces = values.forces;
    glUniform1f(now_, values.now);
    glUniform1f(dt_, values.dt);
    glUniform1f(rate_before_, values.dt_before > 0.0F ? 1.0F / values.dt_before : 0.0F);
    glUniform3f(gravity_, forces.gravity.x, forces.gravity.y, forces.gravity.z);
    glUniform3f(wind_, forces.wind.x, forces.wind.y, forces.wind.z);
    glUniform1f(still_, 1e-3F * values.dt * glm::length(forces.gravity));
    glUniform1f(ground_, values.ground);
    glUniform1f(sweep_, values.sweep);
    glUniform1f(air_time_, values.air_time);
    std::array<float, 8 * kParticleTypesMax> types{};
    std::array<GLint, kParticleTypesMax> collides{};
    for (std::size_t i = 0; i < values.types.size(); ++i) {
        const ParticleType& type = values.types[i];
        const std::array<float, 8> row{type.radius,
                                       type.restitution,
                                       1.0F - type.friction,
                                       type.friction_threshold,
                                       dragRate(forces, type),
                                       static_cast<float>(type.on_collision),
                                       type.lifetime_loss,
                                       type.gravity};
        collides[i] = static_cast<GLint>(type.collides);
        std::copy(row.begin(), row.end(), types.begin() + static_cast<std::ptrdiff_t>(8 * i));
    }
    glUniform4fv(types_, 2 * features_.types, types.data());
    if (features_.masks) {
        glUniform1iv(collides_, features_.types, collides.data());
    }
}

void StepPass::dispatch(std::uint32_t width, std::uint32_t rows) const {
    glUniform2i(size_, static_cast<GLint>(width), static_cast<GLint>(rows));
    glDispatchCompute((width + kStepGroupWidth - 1) / kStepGroupWidth,
                      (rows + kStepGroupHeight - 1) / kStepGroupHeight, 1);
}

}  // namespace relief
