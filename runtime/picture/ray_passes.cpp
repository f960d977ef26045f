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
    program.use();
    program.set("u_step", kStepTexels * view.texel);
    program.set("u_steps_max", kRayStepsMax);
    program.set("u_bisections", kBisections);
}

void drawInBands(const GlProgram& program, GLuint framebuffer, GLsizei width, GLsizei height) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width, height);
    glEnable(GL_SCISSOR_TEST);
    for (GLsizei y = 0; y < height; y += kBandRows) {
        glScissor(0, y, width, std::min(kBandRows, height - y));
        program.drawScreen();
        glFlush();
    }
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace relief
