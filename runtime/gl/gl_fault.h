// SPDX-License-Identifier: Apache-2.0
// Failures of the GPU although the calls are right: a reset, no room, a side beyond the limit. All functions need a
// current context, and read the GL's error flags: those of the caller are lost.
#pragma once

#include <cstdint>
#include <string>

#include "formats/base/result.h"

namespace relief {

/// Fails with kUsage if no context is current. First in whatever makes objects of the GL.
[[nodiscard]] Result<void> checkContext();

/// Checks that the context still works; cheap. Call after read-backs and waits: until then a reset shows in
/// nothing but pictures and numbers that are wrong.
/// \param during  for the message: "reading a picture".
/// Errors: kFailure, the GPU was reset: every object of the context is lost. Only contexts that were made to
/// tell can tell: GlContext's are, where EGL can.
[[nodiscard]] Result<void> checkGpu(const std::string& during);

/// Clears the error flags. Call before allocations that checkAllocated() covers.
void forgetGlErrors();

/// Checks that textures and buffers since forgetGlErrors() were allocated.
/// \param what  for the message: "a picture of 960x720 pixels".
/// \param cure  "choose a smaller size".
/// Errors: kLimit (no room on the GPU), kFailure (a reset, another GL error).
[[nodiscard]] Result<void> checkAllocated(const std::string& what, const std::string& cure);

/// Checks that 2-D textures may have these sides.
/// Errors: kLimit, with the sides and the GL's limit.
[[nodiscard]] Result<void> checkTextureSize(std::uint64_t width, std::uint64_t height,
                                            const std::string& what, const std::string& cure);

/// Waits until the GPU has completed all commands.
/// \param what  for messages: "steps 1 to 16".
/// Errors: kFailure (a reset, or the GL reports an error while waiting). A GPU that hangs is waited for
/// without end: a program that minds has a watchdog (watchdog.h), or a GlFence of its own.
[[nodiscard]] Result<void> waitForGpu(const std::string& what);

}  // namespace relief
