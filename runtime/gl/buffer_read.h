// SPDX-License-Identifier: Apache-2.0
// Reads back buffers that the GPU has written.
#pragma once

#include <cstddef>
#include <span>

#include "runtime/gl/gl_fence.h"
#include "runtime/gl/gl_object.h"

namespace relief {

/// Waits until the GPU has passed the fence, at most for the given time.
/// \return GlFence::passed(); in a browser, true without waiting, because readBuffer() waits instead.
[[nodiscard]] bool waitToRead(const GlFence& fence, GLuint64 nanoseconds);

/// Copies `out.size()` bytes, at least 1, from `offset` in the buffer, through GL_PIXEL_PACK_BUFFER. Waits for the GPU.
/// \return false if the buffer's memory was lost.
[[nodiscard]] bool readBuffer(const GlBuffer& buffer, std::size_t offset, std::span<std::byte> out);

}  // namespace relief
