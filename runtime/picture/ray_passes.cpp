#include "runtime/picture/ray_passes.h"

#include <algorithm>

#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

// A ray's step in texels: it hits whatever is two texels thick.
constexpr float kStepTexels = 1.5F;

// Across the diagonal of a box whose finest texel is 1/2048 of its longest side, with room for the
// bisections.
constexpr int kRayStepsMax = 2560;
constexpr int kBisections = 10;

constexpr GLsizei kBandRows = 64;

}  // namespace

void setRayUniforms(const GlProgram& program, const ColliderView& view) {
    glUseProgram(program.name());
    glUniform1f(uniformLocation(program, "u_step"), kStepTexels * view.texel);
    glUniform1i(uniformLocation(program, "u_steps_max"), kRayStepsMax);
    glUniform1i(uniformLocation(program, "u_bisections"), kBisections);
}

void drawInBands(GLsizei width, GLsizei height) {
    glViewport(0, 0, width, height);
    glEnable(GL_SCISSOR_TEST);
    for (GLsizei y = 0; y < height; y += kBandRows) {
        glScissor(0, y, width, std::min(kBandRows, height - y));
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glFlush();
    }
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace relief
