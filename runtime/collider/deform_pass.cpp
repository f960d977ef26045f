#include "runtime/collider/deform_pass.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

// Differences that normals are made of reach this share of the mesh's box: wide enough for floats, and narrow
// enough to see a curvature.
constexpr float kInch = 1e-3F;

struct RestVertex {
    glm::vec3 position;
    glm::vec3 normal;
};

/// The bindings of transform feedback, which PassState leaves alone.
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

Result<DeformPass> DeformPass::create(const Deformation& deformation, std::span<const glm::vec3> positions,
                                      std::span<const glm::vec3> normals, Output output) {
    RELIEF_TRY(checkContext());
    RELIEF_TRY(checkDeformation(deformation));
    if (deformation.kind == DeformKind::kWobble && normals.empty()) {
        return fail(ErrorCode::kUsage, "a wobble goes along the normals of the mesh; give them");
    }
    if (positions.empty() || positions.size() > std::numeric_limits<std::int32_t>::max()) {
        return fail(ErrorCode::kUsage, "a deformation needs 1 to 2^31 - 1 vertices");
    }
    const bool wants_normals = output == Output::kPositionsAndNormals;
    if (normals.size() != positions.size() && (wants_normals || !normals.empty())) {
        return fail(ErrorCode::kUsage, std::to_string(positions.size()) + " vertices to deform have " +
                                           std::to_string(normals.size()) + " normals; give as many");
    }
    std::vector<RestVertex> rest(positions.size());
    Bounds bounds;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        rest[i] = {positions[i], normals.empty() ? glm::vec3(0.0F) : normals[i]};
        bounds.add(positions[i]);
    }

    const PassState state;
    constexpr std::array<const char*, 2> kOutputs{"v_position", "v_normal"};
    DeformPass pass;
    pass.deformation_ = deformation;
    pass.what_ = output;
    pass.vertices_ = static_cast<GLsizei>(positions.size());
    pass.inch_ = std::max(kInch * bounds.longestSide(), std::numeric_limits<float>::min());
    pass.program_ = RELIEF_TRY(makeFeedbackProgram("collider/deform.vert",
                                                   std::span(kOutputs).first(wants_normals ? 2 : 1),
                                                   wants_normals ? "#define RELIEF_DEFORM_NORMALS 1\n" : ""));
    pass.rest_ = makeBuffer();
    pass.output_ = makeBuffer();
    pass.array_ = makeVertexArray();
    pass.pixel_ = makeTexture2D(GL_RGBA8, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    pass.target_ = RELIEF_TRY(makeFramebuffer({pass.pixel_.name()}));
    glBindVertexArray(pass.array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, pass.output_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(pass.bytes()), nullptr, GL_DYNAMIC_COPY);
    glBindBuffer(GL_ARRAY_BUFFER, pass.rest_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(rest.size() * sizeof(RestVertex)), rest.data(),
                 GL_STATIC_DRAW);
    for (const auto& [location, offset] :
         {std::pair(0U, offsetof(RestVertex, position)), {1U, offsetof(RestVertex, normal)}}) {
        glEnableVertexAttribArray(location);
        glVertexAttribPointer(location, 3, GL_FLOAT, GL_FALSE, sizeof(RestVertex),
                              reinterpret_cast<const void*>(offset));
    }
    return pass;
}

std::size_t DeformPass::bytes() const {
    return static_cast<std::size_t>(vertices_) * (what_ == Output::kPositions ? 12 : 24);
}

void DeformPass::run(double time, const Pose& pose) {
    const PassState state;
    const FeedbackState feedback;
    program_.use();
    const glm::mat3 turn = glm::mat3_cast(pose.rotation);
    std::array<glm::vec4, 3> rows;
    for (int i = 0; i < 3; ++i) {
        rows[static_cast<std::size_t>(i)] =
            glm::vec4(pose.scale * glm::vec3(turn[0][i], turn[1][i], turn[2][i]), pose.position[i]);
    }
    program_.set("u_row", rows);
    program_.set("u_inch", inch_);
    const DeformMoment moment = momentOf(deformation_, time);
    program_.set("u_kind", static_cast<GLint>(deformation_.kind));
    program_.set("u_angle", moment.angle);
    program_.set("u_phases", moment.phases);
    program_.set("u_amplitude", deformation_.amplitude);
    program_.set("u_number", 2.0F * std::numbers::pi_v<float> / deformation_.wavelength);
    program_.set("u_center", deformation_.center);
    program_.set("u_axis", deformation_.axis);
    program_.set("u_along", deformation_.along);
    program_.set("u_range", glm::vec2(deformation_.range_low, deformation_.range_high));
    glBindVertexArray(array_.name());
    glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
    glEnable(GL_RASTERIZER_DISCARD);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, output_.name());
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, vertices_);
    glEndTransformFeedback();
    // Bound for feedback it could not be read from.
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    glDisable(GL_RASTERIZER_DISCARD);
}

}  // namespace relief
