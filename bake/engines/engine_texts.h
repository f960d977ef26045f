// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace relief {

/// Returns the text of a file that embed.cmake embeds; empty for other files. \param path  in the project.
[[nodiscard]] std::string_view engineText(std::string_view path);

}  // namespace relief
