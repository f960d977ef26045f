#include "runtime/gl/gl_display.h"

#include <dlfcn.h>
#include <epoxy/gl.h>

namespace relief {
namespace {

bool loads(const char* library) {
    // Left open: libepoxy opens it again, and a driver would be initialised twice.
    return ::dlopen(library, RTLD_LAZY | RTLD_LOCAL) != nullptr;
}

bool hasClientExtension(const char* name) {
    // Client extensions come first: without them the entry points may not exist.
    return epoxy_has_egl_extension(EGL_NO_DISPLAY, name);
}

}  // namespace

std::string missingGlLibrary(GlApi api) {
    if (!loads("libEGL.so.1")) {
        return "libEGL.so.1";
    }
    if (api == GlApi::kGles30) {
        return loads("libGLESv2.so.2") ? "" : "libGLESv2.so.2";
    }
    return loads("libOpenGL.so.0") || loads("libGL.so.1") ? "" : "libOpenGL.so.0";
}

std::vector<EGLDeviceEXT> eglDevices() {
    if (!hasClientExtension("EGL_EXT_device_enumeration") && !hasClientExtension("EGL_EXT_device_base")) {
        return {};
    }
    EGLint count = 0;
    if (eglQueryDevicesEXT(0, nullptr, &count) != EGL_TRUE || count < 1) {
        return {};
    }
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    if (eglQueryDevicesEXT(count, devices.data(), &count) != EGL_TRUE || count < 1) {
        return {};
    }
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

EGLDisplay surfacelessDisplay() {
    if (!hasClientExtension("EGL_MESA_platform_surfaceless") ||
        !hasClientExtension("EGL_EXT_platform_base")) {
        return EGL_NO_DISPLAY;
    }
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

EGLDisplay deviceDisplay(EGLDeviceEXT device) {
    if (!hasClientExtension("EGL_EXT_platform_device") || !hasClientExtension("EGL_EXT_platform_base")) {
        return EGL_NO_DISPLAY;
    }
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
}

EGLDisplay defaultDisplay() {
    return eglGetDisplay(EGL_DEFAULT_DISPLAY);
}

std::string glText(unsigned what) {
    const GLubyte* text = glGetString(what);
    return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

}  // namespace relief
