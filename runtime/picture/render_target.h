// SPDX-License-Identifier: Apache-2.0
// The target of a renderer.
#pragma once

#include "runtime/gl/gl_types.h"

namespace relief {

/// A framebuffer of the caller's with colour and depth, and the part of it that is drawn to: pixels
/// (0, 0) … (width − 1, height − 1).
struct RenderTarget {
    GLuint framebuffer = 0;
    GLsizei width = 0;
    GLsizei height = 0;
    /// The framebuffer takes sRGB values as they are, as that of a window does; else linear light. Particles are then blended
    /// in sRGB values, too.
    bool srgb = false;

    [[nodiscard]] float aspect() const { return static_cast<float>(width) / static_cast<float>(height); }
};

}  // namespace relief
