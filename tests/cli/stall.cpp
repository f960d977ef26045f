// SPDX-License-Identifier: Apache-2.0
// Preloaded into an executable to simulate a GPU that never finishes. libepoxy's entry points are pointers, which are
// replaced here before the first call.
#include <epoxy/gl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace {

[[noreturn]] void stall() {
    for (;;) {
        ::pause();
    }
}

GLenum neverSignalled(GLsync /*sync*/, GLbitfield /*flags*/, GLuint64 nanoseconds) {
    ::usleep(static_cast<useconds_t>(nanoseconds / 1000));
    return GL_TIMEOUT_EXPIRED;
}

void neverRead(GLint /*x*/, GLint /*y*/, GLsizei /*width*/, GLsizei /*height*/, GLenum /*format*/,
               GLenum /*type*/, void* /*data*/) {
    stall();
}

__attribute__((constructor)) void install() {
    const char* what = std::getenv("RELIEF_TEST_STALL");
    const std::string_view where = what == nullptr ? "" : what;
    if (where == "wait") {
        epoxy_glClientWaitSync = neverSignalled;
    } else if (where == "read") {
        epoxy_glReadPixels = neverRead;
    }
}

}  // namespace
