// SPDX-License-Identifier: Apache-2.0
#include "runtime/air/air_block.h"

#include <algorithm>
#include <cstring>
#include <glm/glm.hpp>
#include <iterator>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

/// The shader's ReliefAir, std140.
struct Block {
    glm::vec4 wind{0.0F};
    std::int32_t count[4] = {};
    glm::vec4 curl{0.0F};
    glm::vec4 flow[3] = {};
    glm::vec4 attractor[2 * AirSettings::kAttractorsMax] = {};
    glm::vec4 vortex[3 * AirSettings::kVorticesMax] = {};
};
static_assert(sizeof(Block) == (6 + 16 + 24) * 16);

// Kinds of forces that a program may be compiled without.
enum Kind : unsigned { kAir = 1, kFlow = 2, kCurl = 4, kAttractors = 8, kVortices = 16 };
constexpr const char* kKindNames[] = {"AIR", "FLOW", "CURL", "ATTRACTORS", "VORTICES"};

unsigned kindsOf(const AirSettings& air) {
    const bool curl = air.curl_noise && air.curl_noise->amplitude > 0.0F;
    const unsigned kinds = (air.flow ? kFlow : 0U) | (curl ? kCurl : 0U) |
                           (air.attractors.empty() ? 0U : kAttractors) |
                           (air.vortices.empty() ? 0U : kVortices);
    return kinds | (kinds != 0 || air.wind != glm::vec3(0.0F) ? kAir : 0U);
}

Block blockOf(const AirSettings& air, const glm::vec4 (&flow)[3]) {
    Block block;
    block.wind = glm::vec4(air.wind, 0.0F);
    block.count[0] = static_cast<std::int32_t>(air.attractors.size());
    block.count[1] = static_cast<std::int32_t>(air.vortices.size());
    if (air.curl_noise) {
        const CurlNoise& noise = *air.curl_noise;
        block.count[2] = noise.octaves;
        std::memcpy(&block.count[3], &noise.seed, sizeof(noise.seed));
        block.curl = glm::vec4(curlGain(noise), curlUnits(noise), noise.drift / noise.scale, 1.0F);
    }
    std::copy(std::begin(flow), std::end(flow), std::begin(block.flow));
    for (std::size_t i = 0; i < air.attractors.size(); ++i) {
        const Attractor& one = air.attractors[i];
        block.attractor[2 * i] = glm::vec4(one.position, one.strength);
        block.attractor[2 * i + 1] = glm::vec4(one.radius, static_cast<float>(one.falloff), one.reach, 0.0F);
    }
    for (std::size_t i = 0; i < air.vortices.size(); ++i) {
        const Vortex& one = air.vortices[i];
        block.vortex[3 * i] = glm::vec4(one.center, one.strength);
        block.vortex[3 * i + 1] = glm::vec4(glm::normalize(one.axis), one.radius);
        block.vortex[3 * i + 2] = glm::vec4(static_cast<float>(one.falloff), 0.0F, 0.0F, 0.0F);
    }
    return block;
}

}  // namespace

Result<AirBlock> AirBlock::create(const AirSettings& air) {
    RELIEF_TRY(checkAir(air));
    AirBlock result;
    result.kinds_ = kindsOf(air);
    if (result.kinds_ == 0) {
        return result;
    }
    for (std::size_t i = 0; i < std::size(kKindNames); ++i) {
        if ((result.kinds_ >> i & 1U) != 0) {
            result.defines_ += std::string("#define RELIEF_HAS_") + kKindNames[i] + "\n";
        }
    }

    const PassState state;  // so that texels are tightly packed
    clearGlErrors();
    if (air.flow) {
        const FlowField& flow = *air.flow;
        GLint side_max = 0;
        glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &side_max);
        const std::uint32_t side = *std::max_element(flow.size.begin(), flow.size.end());
        if (side > static_cast<std::uint32_t>(side_max)) {
            return fail(ErrorCode::kLimit, "the flow has " + std::to_string(side) +
                                               " nodes along an axis; this GL context supports " +
                                               std::to_string(side_max) + "; resample it");
        }
        static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
        result.flow_ = makeTexture3D(GL_RGB32F, {flow.size[0], flow.size[1], flow.size[2]}, GL_RGB, GL_FLOAT,
                                     GL_NEAREST, flow.nodes.data());
        result.bytes_ = flow.nodes.size() * FlowField::kNodeBytes;
        result.flow_block_[0] = glm::vec4(flow.box_min, flow.gain);
        result.flow_block_[1] = glm::vec4(flow.box_max, flow.outside == FlowOutside::kEdge ? 1.0F : 0.0F);
        result.flow_block_[2] = glm::vec4(flowNodesPerUnit(flow), 0.0F);
    }
    const Block block = blockOf(air, result.flow_block_);
    result.block_ = makeBuffer();
    glBindBuffer(GL_UNIFORM_BUFFER, result.block_.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_DYNAMIC_DRAW);
    RELIEF_TRY(checkAllocated("the flow's " + std::to_string(result.bytes_) + " bytes", "resample it"));
    return result;
}

Result<void> AirBlock::update(const AirSettings& air) {
    AirSettings changed = air;
    changed.flow = nullptr;
    RELIEF_TRY(checkAir(changed));
    if (const unsigned missing = kindsOf(changed) & ~kinds_; missing != 0) {
        return fail(
            ErrorCode::kUsage,
            "the settings add a kind of force after the air was created; recreate it and its programs");
    }
    if (!block_) {
        return {};
    }
    const PassState state;
    const Block block = blockOf(changed, flow_block_);
    glBindBuffer(GL_UNIFORM_BUFFER, block_.name());
    // Replace the whole buffer: the driver then need not wait for draws that still read the old contents.
    glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_DYNAMIC_DRAW);
    return {};
}

void AirBlock::attach(const GlProgram& program, const Binding& binding) const {
    if (!block_) {
        return;
    }
    program.use();
    program.set("u_relief_flow", binding.flow_unit);
    const GLuint index = glGetUniformBlockIndex(program.name(), "ReliefAir");
    if (index != GL_INVALID_INDEX) {
        glUniformBlockBinding(program.name(), index, static_cast<GLuint>(binding.uniform_block));
    }
}

void AirBlock::bind(const Binding& binding) const {
    if (!block_) {
        return;
    }
    if (flow_) {
        useTexture3D(binding.flow_unit, flow_);
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(binding.uniform_block), block_.name());
}

}  // namespace relief
