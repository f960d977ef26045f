// SPDX-License-Identifier: Apache-2.0
// The interface of fuzz targets: libFuzzer's entry point. Each target is linked with libFuzzer (clang,
// RELIEF_BUILD_FUZZERS) to find bugs, or with replay.cpp to prevent regressions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

/// Runs one arbitrary input and returns 0. Broken promises abort the process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Aborts if a promise is broken, also in release builds.
inline void mustHold(bool holds, const char* promise) {
    if (!holds) {
        std::fprintf(stderr, "broken promise: %s\n", promise);
        std::abort();
    }
}

/// Checks a message or a warning.
inline void mustBeLine(std::string_view text) {
    mustHold(!text.empty() && text.find_first_of(std::string_view("\n\r\x1b\0", 4)) == text.npos,
             "a message is one line");
}
