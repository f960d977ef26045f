// What a WebGL2 context can do, and the calls of OpenGL ES 3.1 that it has not: hasCompute() is false, and nothing
// reaches them.
#include <cstdlib>
#include <string>

#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_functions.h"

extern "C" int relief_js_has_extension(const char* name);
extern "C" int relief_js_is_lost();
extern "C" int relief_js_is_software();

namespace relief {

bool isGles() {
    return true;
}

bool isSoftwareRenderer() {
    return relief_js_is_software() != 0;
}

bool hasCompute() {
    return false;
}

bool hasGlExtension(const char* name) {
    return relief_js_has_extension(name) != 0;
}

GpuReset gpuReset() {
    return relief_js_is_lost() != 0 ? GpuReset::kUnknown : GpuReset::kNone;
}

}  // namespace relief

extern "C" {
void glDispatchCompute(GLuint, GLuint, GLuint) {
    std::abort();
}
void glMemoryBarrier(GLbitfield) {
    std::abort();
}
void glDrawArraysIndirect(GLenum, const void*) {
    std::abort();
}
void glBindImageTexture(GLuint, GLuint, GLint, GLboolean, GLint, GLenum, GLenum) {
    std::abort();
}
}
