// EGL's displays and devices, for gl_context.cpp and gl_device.cpp: the libraries that libepoxy would end
// the process without, and the platforms to open.
#pragma once

#include <epoxy/egl.h>

#include <string>
#include <vector>

#include "runtime/gl/gl_api.h"

namespace relief {

/// The name of a library that EGL, or this API, needs and that cannot be loaded; "" if all are there.
/// libepoxy ends the process where it misses one, so call this before EGL or the GL.
[[nodiscard]] std::string missingGlLibrary(GlApi api);

/// EGL's devices in its order; none where it does not enumerate them.
[[nodiscard]] std::vector<EGLDeviceEXT> eglDevices();

// EGL_NO_DISPLAY where there is no such platform. The display is not yet initialised.
[[nodiscard]] EGLDisplay surfacelessDisplay();
[[nodiscard]] EGLDisplay deviceDisplay(EGLDeviceEXT device);
[[nodiscard]] EGLDisplay defaultDisplay();

/// glGetString as a string; "" for null.
[[nodiscard]] std::string glText(unsigned what);

}  // namespace relief
