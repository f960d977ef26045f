// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace relief {

/// Returns a text that embed.cmake lists, by its path in the project; empty if there is none.
[[nodiscard]] std::string_view engineText(std::string_view path);

}  // namespace relief
