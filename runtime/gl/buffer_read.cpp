// SPDX-License-Identifier: Apache-2.0
#include "runtime/gl/buffer_read.h"

#include <cstring>

#include "runtime/gl/gl_functions.h"

namespace relief {

bool waitToRead(const GlFence& fence, GLuint64 nanoseconds) {
    return fence.passed(nanoseconds);
}

bool readBuffer(const GlBuffer& buffer, std::size_t offset, std::span<std::byte> out) {
    GLint bound = 0;
    glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &bound);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer.name());
    const void* mapped = glMapBufferRange(GL_PIXEL_PACK_BUFFER, static_cast<GLintptr>(offset),
                                          static_cast<GLsizeiptr>(out.size()), GL_MAP_READ_BIT);
    if (mapped != nullptr) {
        std::memcpy(out.data(), mapped, out.size());
    }
    // GL_FALSE if the memory was lost while it was mapped.
    const bool whole = mapped != nullptr && glUnmapBuffer(GL_PIXEL_PACK_BUFFER) == GL_TRUE;
    glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(bound));
    return whole;
}

}  // namespace relief
