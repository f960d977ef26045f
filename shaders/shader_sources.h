// SPDX-License-Identifier: Apache-2.0
// The files of this folder, embedded at build time.
#pragma once

#include <string_view>

namespace relief {

/// The text of a shader by its path in shaders/, "collider/collider.glsl"; empty if there is none.
[[nodiscard]] std::string_view shaderSource(std::string_view path);

/// The numbers that C++ and GLSL share, "#define RELIEF_TILE_SIDE 16\n" and so on (embed.cmake). They stand in front of every
/// shader.
[[nodiscard]] std::string_view shaderConstants();

}  // namespace relief
