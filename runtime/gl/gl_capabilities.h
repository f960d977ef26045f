// SPDX-License-Identifier: Apache-2.0
// Capabilities of the current context.
#pragma once

namespace relief {

/// Returns true if the current context is OpenGL ES.
[[nodiscard]] bool isGles();

/// Returns true if the context renders on the CPU.
[[nodiscard]] bool isSoftwareRenderer();

/// Returns true if the current context has compute shaders: OpenGL 4.3, OpenGL ES 3.1, or later.
[[nodiscard]] bool hasCompute();

/// Returns true if the current context has the extension. \param name  such as "GL_EXT_color_buffer_float".
[[nodiscard]] bool hasGlExtension(const char* name);

/// Returns true if the GPU was reset; checkGpu() turns this into an error.
[[nodiscard]] bool gpuWasReset();

}  // namespace relief
