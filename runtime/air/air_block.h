// SPDX-License-Identifier: Apache-2.0
// AirSettings on the GPU: a uniform block and, for a flow, a 3-D texture, read by shaders/air/air.glsl.
#pragma once

#include <glm/vec4.hpp>
#include <string>

#include "formats/base/result.h"
#include "runtime/air/air.h"
#include "runtime/gl/gl_object.h"

namespace relief {

class AirBlock {
  public:
    /// The texture unit and the uniform block binding that bind() uses.
    struct Binding {
        int flow_unit = 6;  ///< used only with a flow
        int uniform_block = 1;
    };

    /// Uploads settings. Needs a current context. Without any wind, flow, noise, attractor or vortex it makes
    /// nothing, and bind() and attach() do nothing.
    /// Fails as checkAir does, and with kLimit (a flow larger than this GL takes, or out of memory).
    [[nodiscard]] static Result<AirBlock> create(const AirSettings& air);

    /// Changes all but the flow, for draws to come; waits for nothing. Programs stay as they are.
    /// \param air  of the same kinds as at creation, or fewer; its flow is ignored.
    /// Fails as checkAir does, and with kUsage (a kind that the programs were compiled without).
    [[nodiscard]] Result<void> update(const AirSettings& air);

    /// Connects a program that includes air.glsl: sampler, block binding. Once after linking; leaves the
    /// program current.
    void attach(const GlProgram& program, const Binding& binding) const;
    /// Binds block and flow for the next draw. PassState restores them.
    void bind(const Binding& binding) const;

    /// Lines for makeProgram. RELIEF_HAS_AIR if there is anything at all, then any of RELIEF_HAS_FLOW,
    /// RELIEF_HAS_CURL, RELIEF_HAS_ATTRACTORS, RELIEF_HAS_VORTICES; empty if there is nothing.
    [[nodiscard]] const std::string& defines() const { return defines_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }  ///< of the flow on the GPU

  private:
    GlBuffer block_;
    GlTexture flow_;
    glm::vec4 flow_block_[3] = {};  // of the block
    unsigned kinds_ = 0;
    std::size_t bytes_ = 0;
    std::string defines_;
};

}  // namespace relief
