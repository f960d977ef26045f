// SPDX-License-Identifier: Apache-2.0
// Converts fractions to percent.
#pragma once

#include <cstddef>

namespace relief {

/// Returns 100 · part / whole, or 0 if whole is 0.
[[nodiscard]] inline double percent(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace relief
