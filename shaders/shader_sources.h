// SPDX-License-Identifier: Apache-2.0
// The files of this folder, embedded at build time.
#pragma once

#include <string_view>

namespace relief {

/// Returns the text of a shader by its path in shaders/, such as "collider/collider.glsl"; empty if there is none.
[[nodiscard]] std::string_view shaderSource(std::string_view path);

/// Returns the constants shared by C++ and GLSL, "#define RELIEF_TILE_SIDE 16\n" and so on (embed.cmake). They are
/// prepended to every shader.
[[nodiscard]] std::string_view shaderConstants();

}  // namespace relief
