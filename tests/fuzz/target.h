// SPDX-License-Identifier: Apache-2.0
// The interface of fuzz targets: libFuzzer's entry point. Each target is linked with libFuzzer (clang,
// RELIEF_BUILD_FUZZERS) to find bugs, or with replay.cpp to prevent regressions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

/// Runs one arbitrary input and returns 0. A violated guarantee aborts the process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Aborts if a guarantee is violated, also in release builds.
inline void mustHold(bool holds, const char* guarantee) {
    if (!holds) {
        std::fprintf(stderr, "violated guarantee: %s\n", guarantee);
        std::abort();
    }
}

/// Checks a message or a warning.
inline void mustBeLine(std::string_view text) {
    mustHold(!text.empty() && text.find_first_of(std::string_view("\n\r\x1b\0", 4)) == text.npos,
             "a message is one line");
}
