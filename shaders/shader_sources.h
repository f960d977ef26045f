// The files of this folder, embedded at build time.
#pragma once

#include <string_view>

namespace relief {

/// The text of a file of shaders/ by its name, "collider.glsl"; empty if there is none.
[[nodiscard]] std::string_view shaderSource(std::string_view name);

}  // namespace relief
