// SPDX-License-Identifier: Apache-2.0
// Shares as people read them.
#pragma once

#include <cstddef>

namespace relief {

/// 100 part / whole, and 0 of nothing.
[[nodiscard]] inline double percent(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace relief
