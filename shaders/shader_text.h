// SPDX-License-Identifier: Apache-2.0
// Shader text with includes resolved.
#pragma once

#include <string>
#include <string_view>

#include "formats/base/result.h"

namespace relief {

/// Returns a file in shaders/, such as "collider/collider.glsl", with its includes. Errors: kFailure (no such file).
[[nodiscard]] Result<std::string> includedShader(std::string_view file);

/// The first lines of an exported shader.
inline constexpr std::string_view kShaderLicence =
    "// SPDX-License-Identifier: Apache-2.0\n"
    "// From Relief, for any program: no part of it is under the GNU GPL.\n";

/// Returns the shader's text, preceded by the licence and the entries of shaderConstants() that it uses. Insert it
/// after the version line of your own program.
[[nodiscard]] Result<std::string> shaderText(std::string_view file);

}  // namespace relief
