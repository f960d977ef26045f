// SPDX-License-Identifier: Apache-2.0
// What every fuzz target is: libFuzzer's entry point. The same file is linked with libFuzzer (clang,
// RELIEF_BUILD_FUZZERS) to look for trouble, and with replay.cpp to see that what was found stays mended.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

/// Runs one input, which may be anything. Returns 0. What must never happen ends the process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Ends the process if a promise is broken; release builds, too.
inline void mustHold(bool holds, const char* promise) {
    if (!holds) {
        std::fprintf(stderr, "broken promise: %s\n", promise);
        std::abort();
    }
}

/// A message or a warning.
inline void mustBeLine(std::string_view text) {
    mustHold(!text.empty() && text.find_first_of(std::string_view("\n\r\x1b\0", 4)) == text.npos,
             "a message is one line");
}
