// SPDX-License-Identifier: Apache-2.0
// The page of `relief view` without its data, embedded by runtime/web/view/page.cmake.
#pragma once

#include <string>

namespace relief {

[[nodiscard]] std::string viewPage();

}  // namespace relief
