// What the passes share that follow rays through a collider's field (shaders/picture/trace.glsl).
#pragma once

#include "runtime/gl/gl_object.h"
#include "runtime/picture/collider_view.h"

namespace relief {

/// Of the first pass every kCoarseStride-th ray of a row or column is followed.
inline constexpr GLsizei kCoarseStride = 4;

/// Sets trace.glsl's uniforms; leaves the program current.
void setRayUniforms(const GlProgram& program, const ColliderView& view);

/// GlProgram::drawScreen() band by band: a driver may take a draw of several seconds for a hang.
void drawInBands(const GlProgram& program, GLuint framebuffer, GLsizei width, GLsizei height);

}  // namespace relief
