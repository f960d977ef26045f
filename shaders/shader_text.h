// SPDX-License-Identifier: Apache-2.0
// Shaders as text, with the files that they include.
#pragma once

#include <string>
#include <string_view>

#include "formats/base/result.h"

namespace relief {

/// A file of shaders/, "collider/collider.glsl", with its includes. Fails with kFailure (no such file).
[[nodiscard]] Result<std::string> includedShader(std::string_view file);

/// The first lines of an exported shader.
inline constexpr std::string_view kShaderLicence =
    "// SPDX-License-Identifier: Apache-2.0\n"
    "// From Relief, for any program: no part of it is under the GNU GPL.\n";

/// The same behind those of shaderConstants() that it uses: for
/// programs of one's own, between whose version line and text it goes.
[[nodiscard]] Result<std::string> shaderText(std::string_view file);

}  // namespace relief
