// SPDX-License-Identifier: Apache-2.0
// Vertices that a vertex shader makes on the GPU, by transform feedback into a buffer; nothing is rasterised.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"

namespace relief {

/// The output of a vertex.
enum class VertexOutput : std::uint8_t {
    kPositions,           ///< v_position: three floats, tightly packed
    kPositionsAndNormals  ///< and v_normal: six, as ColliderMesh's vertices
};

class VertexFeedback {
  public:
    /// Needs a current context, and a PassState around it, as run() does.
    /// \param shader    its file, which has v_normal only where RELIEF_NORMALS is defined.
    /// \param vertices  1 to 2³¹ − 1
    /// Leaves the array that run() draws from bound, for its attributes.
    /// Errors: kLimit (no room), kFailure (the driver's compiler).
    [[nodiscard]] static Result<VertexFeedback> create(const char* shader, std::size_t vertices,
                                                       VertexOutput output);

    [[nodiscard]] GlProgram& program() { return program_; }
    /// Of 12 or 24 bytes a vertex, rewritten by every run().
    [[nodiscard]] const GlBuffer& buffer() const { return output_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

    /// With the program in use and its uniforms set. Waits for nothing; no transform feedback of the caller's may be active.
    void run() const;

  private:
    GLsizei vertices_ = 0;
    std::size_t bytes_ = 0;
    GlBuffer output_;
    GlVertexArray array_;
    GlTexture pixel_;  // a draw needs a whole framebuffer, even one that rasterises nothing
    GlFramebuffer target_;
    GlProgram program_;
};

}  // namespace relief
