// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/wobble_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "formats/base/portable_math.h"
#include "formats/collider.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

// Step of the finite differences for normals, relative to the mesh's box: large enough for float precision, small
// enough to resolve the curvature.
constexpr float kDifferenceStep = 1e-3F;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Returns the phases of the three waves at a time, reduced to one period.
glm::vec3 phasesAt(const Wobble& wobble, double time) {
    constexpr std::array<double, 3> kRates{1.0, 1.25, 0.8};
    const double turns = static_cast<double>(wobble.frequency) * time;
    glm::vec3 phases(0.0F);
    for (int k = 0; k < 3; ++k) {
        phases[k] = static_cast<float>(std::fmod(
            static_cast<double>(wobble.phase) + k - kTurn * kRates[static_cast<std::size_t>(k)] * turns,
            kTurn));
    }
    return phases;
}

struct WobbleVertex {
    glm::vec3 position;
    glm::vec3 normal;
};

}  // namespace

std::vector<glm::vec3> wobbled(const Wobble& wobble, std::span<const glm::vec3> positions,
                               std::span<const glm::vec3> normals, double time) {
    const glm::vec3 phases = phasesAt(wobble, time);
    const double number = kTurn / double{wobble.wavelength};
    std::vector<glm::vec3> moved(positions.begin(), positions.end());
    for (std::size_t i = 0; i < moved.size(); ++i) {
        double waves = 0.0;
        for (int k = 0; k < 3; ++k) {
            waves += portable::sin(std::fmod(number * double{positions[i][k]} + double{phases[k]}, kTurn));
        }
        moved[i] += static_cast<float>(double{wobble.amplitude} / 3.0 * waves) * normals[i];
    }
    return moved;
}

Result<WobblePass> WobblePass::create(const Wobble& wobble, std::span<const glm::vec3> positions,
                                      std::span<const glm::vec3> normals, VertexOutput output) {
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
    std::vector<WobbleVertex> rest(positions.size());
    Bounds bounds;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        rest[i] = {positions[i], normals[i]};
        bounds.add(positions[i]);
    }

    const PassState state;
    WobblePass pass;
    pass.wobble_ = wobble;
    pass.step_ = std::max(kDifferenceStep * bounds.longestSide(), std::numeric_limits<float>::min());
    pass.feedback_ = RELIEF_TRY(VertexFeedback::create("live/wobble.vert", positions.size(), output));
    pass.rest_ = makeBuffer();
    glBindBuffer(GL_ARRAY_BUFFER, pass.rest_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(rest.size() * sizeof(WobbleVertex)), rest.data(),
                 GL_STATIC_DRAW);
    for (const auto& [location, offset] :
         {std::pair(0U, offsetof(WobbleVertex, position)), {1U, offsetof(WobbleVertex, normal)}}) {
        glEnableVertexAttribArray(location);
        glVertexAttribPointer(location, 3, GL_FLOAT, GL_FALSE, sizeof(WobbleVertex),
                              reinterpret_cast<const void*>(offset));
    }
    RELIEF_TRY(checkAllocated("the vertices of the wobbling mesh", "simplify it"));
    return pass;
}

void WobblePass::run(double time) {
    const PassState state;
    GlProgram& program = feedback_.program();
    program.use();
    program.set("u_step", step_);
    program.set("u_phases", phasesAt(wobble_, time));
    program.set("u_amplitude", wobble_.amplitude);
    program.set("u_number", static_cast<float>(kTurn) / wobble_.wavelength);
    feedback_.run();
}

}  // namespace relief
