// SPDX-License-Identifier: Apache-2.0
// GPU failures that occur even if all calls are valid: a reset, out of memory, textures beyond the size limit. All
// functions except checkContext() need a current context. clearGlErrors() and checkAllocated() clear the GL's error
// flags.
#pragma once

#include <cstdint>
#include <string>

#include "formats/base/result.h"

namespace relief {

/// Fails with kUsage if no context is current. Call it first in functions that create GL objects.
[[nodiscard]] Result<void> checkContext();

/// Checks that the context still works; cheap. Call it after read-backs and waits: without it, a reset only shows as
/// wrong results.
/// \param during  for the message: "reading a picture".
/// Errors: kFailure if the GPU was reset: all objects of the context are lost. Only contexts created with reset
/// notification can report this; GlContext requests it if EGL supports it.
[[nodiscard]] Result<void> checkGpu(const std::string& during);

/// Clears the error flags. Call it before allocations that checkAllocated() covers.
void clearGlErrors();

/// Checks that textures and buffers created since clearGlErrors() were allocated.
/// \param what  for the message: "a picture of 960x720 pixels".
/// \param fix  "choose a smaller size".
/// Errors: kLimit (out of GPU memory), kFailure (a reset, another GL error).
[[nodiscard]] Result<void> checkAllocated(const std::string& what, const std::string& fix);

/// Checks that the GL supports 2-D textures of this size.
/// Errors: kLimit, with the size and the GL's limit.
[[nodiscard]] Result<void> checkTextureSize(std::uint64_t width, std::uint64_t height,
                                            const std::string& what, const std::string& fix);

/// Waits until the GPU has completed all commands.
/// \param what  for messages: "steps 1 to 16".
/// Errors: kFailure (a reset, or a GL error while waiting). Waits forever for a GPU that hangs; to avoid this, use a
/// watchdog (watchdog.h) or your own GlFence.
[[nodiscard]] Result<void> waitForGpu(const std::string& what);

}  // namespace relief
