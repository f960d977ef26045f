// SPDX-License-Identifier: Apache-2.0
#include "runtime/gl/gl_fault.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_fence.h"
#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

constexpr int kErrorFlagsMax = 64;            // a lost context may report errors endlessly
constexpr GLuint64 kWaitSlice = 100'000'000;  // nanoseconds per wait

std::string errorText(GLenum error) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "0x%04x", error);
    return text.data();
}

}  // namespace

Result<void> checkContext() {
    if (glGetString(GL_VERSION) == nullptr) {
        return fail(ErrorCode::kUsage, "no OpenGL context is current; make one current on this thread first");
    }
    return {};
}

Result<void> checkGpu(const std::string& during) {
    if (!gpuWasReset()) {
        return {};
    }
    return fail(ErrorCode::kFailure,
                "the GPU was reset while " + during +
                    ", and its contents are lost; run again, with less work at once if it recurs");
}

void clearGlErrors() {
    for (int i = 0; i < kErrorFlagsMax && glGetError() != GL_NO_ERROR; ++i) {
    }
}

Result<void> checkAllocated(const std::string& what, const std::string& fix) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) {
        return {};
    }
    clearGlErrors();
    RELIEF_TRY(checkGpu("allocating " + what));
    if (error == GL_OUT_OF_MEMORY) {
        return fail(ErrorCode::kLimit, what + ": out of GPU memory; " + fix);
    }
    return fail(ErrorCode::kFailure,
                what + ": the GL rejected the textures or buffers (error " + errorText(error) + "); " + fix);
}

Result<void> checkTextureSize(std::uint64_t width, std::uint64_t height, const std::string& what,
                              const std::string& fix) {
    GLint side_max = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side_max);
    if (std::max(width, height) > static_cast<std::uint64_t>(std::max(side_max, 0))) {
        return fail(ErrorCode::kLimit, what + ": a texture of " + std::to_string(width) + "x" +
                                           std::to_string(height) +
                                           " texels is too large; this GL context supports sides up to " +
                                           std::to_string(side_max) + "; " + fix);
    }
    return {};
}

Result<void> waitForGpu(const std::string& what) {
    GlFence fence;
    fence.insert();
    while (!fence.passed(kWaitSlice)) {
        if (fence.failed()) {
            RELIEF_TRY(checkGpu("waiting for " + what));
            return fail(ErrorCode::kFailure, "the GL driver cannot wait for " + what +
                                                 "; try another driver, or another device with --device");
        }
    }
    return checkGpu("waiting for " + what);
}

}  // namespace relief
