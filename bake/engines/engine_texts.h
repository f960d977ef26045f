// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace relief {

/// Returns a file's text as embedded by embed.cmake; empty if it is not embedded. \param path  of the file, in the
/// project.
[[nodiscard]] std::string_view engineText(std::string_view path);

}  // namespace relief
