// SPDX-License-Identifier: Apache-2.0
// Capabilities of the current context.
#pragma once

namespace relief {

/// True if the current context is OpenGL ES.
[[nodiscard]] bool isGles();

/// True if the processor draws, not a GPU.
[[nodiscard]] bool isSoftwareRenderer();

/// True if the current context has compute shaders: OpenGL 4.3, OpenGL ES 3.1, or later.
[[nodiscard]] bool hasCompute();

/// \param name  "GL_EXT_color_buffer_float"
[[nodiscard]] bool hasGlExtension(const char* name);

/// True if the GPU was reset; checkGpu() makes an error of it.
[[nodiscard]] bool gpuWasReset();

}  // namespace relief
