// SPDX-License-Identifier: Apache-2.0
// Render targets.
#pragma once

#include "runtime/gl/gl_types.h"

namespace relief {

/// The caller's framebuffer, with colour and depth. Renderers draw to pixels (0, 0) … (width − 1, height − 1).
struct RenderTarget {
    GLuint framebuffer = 0;
    GLsizei width = 0;
    GLsizei height = 0;
    /// Whether the framebuffer stores sRGB values without conversion, as a window does, instead of linear light.
    /// Particles are then also blended in sRGB.
    bool srgb = false;

    [[nodiscard]] float aspect() const { return static_cast<float>(width) / static_cast<float>(height); }
};

}  // namespace relief
