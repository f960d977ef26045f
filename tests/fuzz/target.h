// What every fuzz target is: libFuzzer's entry point. The same file is linked with libFuzzer (clang,
// RELIEF_BUILD_FUZZERS) to look for trouble, and with replay.cpp to see that what was found stays mended.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

/// Runs one input, which may be anything. Returns 0. What must never happen ends the process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Ends the process if a promise is broken; release builds, too.
inline void mustHold(bool holds, const char* promise) {
    if (!holds) {
        std::fprintf(stderr, "broken promise: %s\n", promise);
        std::abort();
    }
}
