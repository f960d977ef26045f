#include "runtime/particles/state_sums.h"

#include <algorithm>
#include <string>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/storage_units.h"

namespace relief {
namespace {

// Storage units, as the shaders have them.
constexpr GLuint kReducedUnit = 0;
constexpr GLuint kReducingUnit = 1;

// Texels a side that a work group sums.
constexpr std::uint32_t kGroupSide = kReducedSide * kReducedGroup;

std::uint32_t reduced(std::uint32_t side) {
    return (side + kGroupSide - 1) / kGroupSide;
}

}  // namespace

Result<StateSums::Program> StateSums::makePart(const char* file) {
    Program part;
    part.program = RELIEF_TRY(makeComputeProgram(file, "#define RELIEF_COMPUTE\n"));
    part.size = uniformLocation(part.program, "u_size");
    part.rate = uniformLocation(part.program, "u_rate_before");
    part.extent = uniformLocation(part.program, "u_extent");
    return part;
}

Result<StateSums> StateSums::create(std::uint32_t capacity) {
    const StorageUnits storage;
    StateSums sums;
    const std::uint32_t width = std::min(capacity, ParticleSystem::kStateWidth);
    const std::uint32_t parts = reduced(width) * reduced((capacity + width - 1) / width);
    for (GlBuffer& buffer : sums.parts_) {
        buffer = StorageUnits::make(static_cast<GLsizeiptr>(parts) * kBytes);
        RELIEF_TRY(checkAllocated("the statistics of " + std::to_string(capacity) + " particles",
                                  "choose a smaller capacity"));
    }
    sums.state_ = RELIEF_TRY(makePart("reduce_state.comp"));
    sums.sum_ = RELIEF_TRY(makePart("reduce_sum.comp"));
    glUseProgram(sums.state_.program.name());
    const auto sampler = [&](const char* name, GLint unit) {
        glUniform1i(uniformLocation(sums.state_.program, name), unit);
    };
    sampler("u_position", StepPass::kPositionUnit);
    sampler("u_velocity", StepPass::kVelocityUnit);
    sampler("u_birth", StepPass::kBirthUnit);
    return sums;
}

void StateSums::sum(const ParticleSystem& particles, const GlBuffer& result) const {
    std::uint32_t width = particles.textureWidth();
    std::uint32_t height = (particles.extent() + width - 1) / width;
    const StorageUnits storage;
    glUseProgram(state_.program.name());
    glUniform1i(state_.extent, static_cast<GLint>(particles.extent()));
    glUniform1f(state_.rate, particles.rateBefore());
    useTexture(StepPass::kPositionUnit, particles.positions());
    useTexture(StepPass::kVelocityUnit, particles.secondState());
    useTexture(StepPass::kBirthUnit, particles.births());
    GLint size = state_.size;
    for (int pass = 0;; ++pass) {
        glUniform2i(size, static_cast<GLint>(width), static_cast<GLint>(height));
        width = reduced(width);
        height = reduced(height);
        const bool last = width == 1 && height == 1;
        StorageUnits::bind(kReducingUnit, parts_[pass % 2]);
        StorageUnits::bind(kReducedUnit, last ? result : parts_[1 - pass % 2]);
        StorageUnits::order();
        glDispatchCompute(width, height, 1);
        if (last) {
            break;
        }
        glUseProgram(sum_.program.name());
        size = sum_.size;
    }
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);  // that the buffer may be mapped
}

}  // namespace relief
