// SPDX-License-Identifier: Apache-2.0
// Captures the output of a vertex shader in a buffer by transform feedback; nothing is rasterised.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"

namespace relief {

/// The output for each vertex.
enum class VertexOutput : std::uint8_t {
    kPositions,           ///< v_position: three floats, tightly packed
    kPositionsAndNormals  ///< also v_normal: six floats, like the vertices of ColliderMesh
};

class VertexFeedback {
  public:
    /// Needs a current context and a surrounding PassState, as does run().
    /// \param shader    file name; the shader declares v_normal only if RELIEF_NORMALS is defined.
    /// \param vertices  1 to 2³¹ − 1
    /// Leaves the vertex array of run() bound, so that the caller can set up its attributes.
    /// Errors: kLimit (out of memory), kFailure (shader compilation).
    [[nodiscard]] static Result<VertexFeedback> create(const char* shader, std::size_t vertices,
                                                       VertexOutput output);

    [[nodiscard]] GlProgram& program() { return program_; }
    /// Returns the output: 12 or 24 bytes per vertex, rewritten by every run().
    [[nodiscard]] const GlBuffer& buffer() const { return output_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

    /// The program must be in use, and its uniforms set. Does not wait; the caller must not have transform feedback
    /// active.
    void run() const;

  private:
    GLsizei vertices_ = 0;
    std::size_t bytes_ = 0;
    GlBuffer output_;
    GlVertexArray array_;
    GlTexture pixel_;  // a draw needs a complete framebuffer even if nothing is rasterised
    GlFramebuffer target_;
    GlProgram program_;
};

}  // namespace relief
