// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace relief {

/// Returns the text that embed.cmake makes of a file; empty for other files. \param path  of the file, in the project.
[[nodiscard]] std::string_view engineText(std::string_view path);

}  // namespace relief
