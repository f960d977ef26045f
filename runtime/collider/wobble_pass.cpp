#include "runtime/collider/wobble_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "formats/collider.h"
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

Result<WobblePass> WobblePass::create(const Wobble& wobble, std::span<const glm::vec3> positions,
                                      std::span<const glm::vec3> normals, Output output) {
    RELIEF_TRY(checkContext());
    const bool numbers = std::isfinite(wobble.amplitude) && std::isfinite(wobble.phase) &&
                         wobble.frequency >= 0.0F && std::isfinite(wobble.frequency) &&
                         wobble.wavelength > 0.0F && std::isfinite(wobble.wavelength);
    if (!numbers) {
        return fail(ErrorCode::kUsage,
                    "a wobble needs finite numbers, a frequency of at least 0 and a wavelength above 0");
    }
    if (positions.empty() || positions.size() > std::numeric_limits<std::int32_t>::max() ||
        normals.size() != positions.size()) {
        return fail(ErrorCode::kUsage, "a wobble needs 1 to 2^31 - 1 vertices and as many normals; it has " +
                                           std::to_string(positions.size()) + " and " +
                                           std::to_string(normals.size()));
    }
    const bool wants_normals = output == Output::kPositionsAndNormals;
    std::vector<RestVertex> rest(positions.size());
    Bounds bounds;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        rest[i] = {positions[i], normals[i]};
        bounds.add(positions[i]);
    }

    const PassState state;
    constexpr std::array<const char*, 2> kOutputs{"v_position", "v_normal"};
    WobblePass pass;
    pass.wobble_ = wobble;
    pass.what_ = output;
    pass.vertices_ = static_cast<GLsizei>(positions.size());
    pass.inch_ = std::max(kInch * bounds.longestSide(), std::numeric_limits<float>::min());
    pass.program_ = RELIEF_TRY(makeFeedbackProgram("collider/wobble.vert",
                                                   std::span(kOutputs).first(wants_normals ? 2 : 1),
                                                   wants_normals ? "#define RELIEF_WOBBLE_NORMALS 1\n" : ""));
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

std::size_t WobblePass::bytes() const {
    return static_cast<std::size_t>(vertices_) * (what_ == Output::kPositions ? 12 : 24);
}

void WobblePass::run(double time) {
    const PassState state;
    const FeedbackState feedback;
    constexpr double kTurn = 2.0 * std::numbers::pi;
    constexpr std::array<double, 3> kRates{1.0, 1.25, 0.8};
    const double turns = static_cast<double>(wobble_.frequency) * time;
    glm::vec3 phases(0.0F);
    for (int k = 0; k < 3; ++k) {
        phases[k] = static_cast<float>(std::fmod(
            static_cast<double>(wobble_.phase) + k - kTurn * kRates[static_cast<std::size_t>(k)] * turns,
            kTurn));
    }
    program_.use();
    program_.set("u_inch", inch_);
    program_.set("u_phases", phases);
    program_.set("u_amplitude", wobble_.amplitude);
    program_.set("u_number", static_cast<float>(kTurn) / wobble_.wavelength);
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
