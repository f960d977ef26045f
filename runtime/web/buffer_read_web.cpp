// Reading back in WebGL2, which maps no buffers and lets nobody wait: getBufferSubData() does both.
#include "runtime/gl/buffer_read.h"

extern "C" void relief_js_read_buffer(unsigned buffer, void* out, unsigned bytes);

namespace relief {

bool waitToRead(const GlFence&, GLuint64) {
    return true;
}

bool readBuffer(const GlBuffer& buffer, std::span<std::byte> out) {
    relief_js_read_buffer(buffer.name(), out.data(), static_cast<unsigned>(out.size()));
    return true;
}

}  // namespace relief
