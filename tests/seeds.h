// SPDX-License-Identifier: Apache-2.0
// The seeds of generated cases. Those of a usual run are always the same; RELIEF_TEST_SEED makes others.
#pragma once

#include <cstdint>
#include <cstdlib>

namespace relief::test {

/// `usual`, a million further on for each unit of RELIEF_TEST_SEED (0 if it is not set): ranges of seeds do not meet.
inline std::uint32_t seedFrom(std::uint32_t usual) {
    const char* const text = std::getenv("RELIEF_TEST_SEED");
    const auto other = static_cast<std::uint32_t>(text == nullptr ? 0UL : std::strtoul(text, nullptr, 10));
    return usual + 1'000'000U * other;
}

}  // namespace relief::test
