// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/vertex_feedback.h"

#include <array>
#include <span>
#include <string>

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

/// Saves the bindings of transform feedback, which PassState does not.
class FeedbackState {
  public:
    FeedbackState() { glGetIntegerv(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, &generic_); }
    ~FeedbackState() {
        first_.restore();
        glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, static_cast<GLuint>(generic_));
    }
    FeedbackState(const FeedbackState&) = delete;
    FeedbackState& operator=(const FeedbackState&) = delete;

  private:
    GLint generic_ = 0;
    SavedRange first_{GL_TRANSFORM_FEEDBACK_BUFFER, 0};
};

}  // namespace

Result<VertexFeedback> VertexFeedback::create(const char* shader, std::size_t vertices, VertexOutput output) {
    const bool normals = output == VertexOutput::kPositionsAndNormals;
    constexpr std::array<const char*, 2> kOutputs{"v_position", "v_normal"};
    VertexFeedback made;
    made.vertices_ = static_cast<GLsizei>(vertices);
    made.bytes_ = vertices * (normals ? 24 : 12);
    made.program_ = RELIEF_TRY(makeFeedbackProgram(shader, std::span(kOutputs).first(normals ? 2 : 1),
                                                   normals ? "#define RELIEF_NORMALS 1\n" : ""));
    made.output_ = makeBuffer();
    made.array_ = makeVertexArray();
    clearGlErrors();
    made.pixel_ = makeTexture2D(GL_RGBA8, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    glBindVertexArray(made.array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, made.output_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(made.bytes_), nullptr, GL_DYNAMIC_COPY);
    RELIEF_TRY(checkAllocated(std::to_string(vertices) + " moving vertices", "simplify the mesh"));
    made.target_ = RELIEF_TRY(makeFramebuffer({made.pixel_.name()}));
    return made;
}

void VertexFeedback::run() const {
    const FeedbackState feedback;
    glBindVertexArray(array_.name());
    glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
    glEnable(GL_RASTERIZER_DISCARD);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, output_.name());
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, vertices_);
    glEndTransformFeedback();
    // A buffer bound for feedback cannot be read from.
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    glDisable(GL_RASTERIZER_DISCARD);
}

}  // namespace relief
