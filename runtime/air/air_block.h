// SPDX-License-Identifier: Apache-2.0
// AirSettings on the GPU: a uniform block and, with a flow, a 3-D texture, read by shaders/air/air.glsl.
#pragma once

#include <glm/vec4.hpp>
#include <string>

#include "formats/base/result.h"
#include "runtime/air/air.h"
#include "runtime/gl/gl_object.h"

namespace relief {

class AirBlock {
  public:
    /// Texture unit and uniform block binding used by bind().
    struct Binding {
        int flow_unit = 6;  ///< used only with a flow
        int uniform_block = 1;
    };

    /// Uploads settings. Needs a current context. Without forces it allocates nothing, and bind() and attach() do
    /// nothing.
    /// Errors: those of checkAir; kLimit (out of memory, or a flow larger than this GL context supports).
    [[nodiscard]] static Result<AirBlock> create(const AirSettings& air);

    /// Changes everything except the flow, for subsequent draws. Does not wait; programs remain valid.
    /// \param air  may only contain kinds of forces that were present at creation; its flow is ignored.
    /// Errors: those of checkAir; kUsage (a kind that the programs were compiled without).
    [[nodiscard]] Result<void> update(const AirSettings& air);

    /// Connects a program that includes air.glsl: sampler and block binding. Call it once after linking; it leaves the
    /// program current.
    void attach(const GlProgram& program, const Binding& binding) const;
    /// Binds block and flow for the next draw. PassState restores the previous bindings.
    void bind(const Binding& binding) const;

    /// Returns lines for makeProgram: RELIEF_HAS_AIR if there are any forces, and RELIEF_HAS_… for each kind of force;
    /// otherwise "".
    [[nodiscard]] const std::string& defines() const { return defines_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }  ///< size of the flow on the GPU

  private:
    GlBuffer block_;
    GlTexture flow_;
    glm::vec4 flow_block_[3] = {};  // blockHead() of the flow
    unsigned kinds_ = 0;
    std::size_t bytes_ = 0;
    std::string defines_;
};

}  // namespace relief
