// SPDX-License-Identifier: Apache-2.0
// Seeds of generated cases: fixed by default, varied by RELIEF_TEST_SEED.
#pragma once

#include <cstdint>
#include <cstdlib>

namespace relief::test {

/// `usual` plus a million times RELIEF_TEST_SEED (default 0), so that ranges of seeds do not overlap.
inline std::uint32_t seedFrom(std::uint32_t usual) {
    const char* const text = std::getenv("RELIEF_TEST_SEED");
    const auto other = static_cast<std::uint32_t>(text == nullptr ? 0UL : std::strtoul(text, nullptr, 10));
    return usual + 1'000'000U * other;
}

}  // namespace relief::test
