#include "runtime/gl/gl_device.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include "runtime/gl/gl_display.h"

namespace relief {
namespace {

constexpr EGLint kRenderer = 0x335F;  // EGL_RENDERER_EXT of EGL_EXT_device_query_name; headers lag behind

/// The context that is current on this thread, put back at the end.
class CurrentContext {
  public:
    CurrentContext() = default;
    CurrentContext(const CurrentContext&) = delete;
    CurrentContext& operator=(const CurrentContext&) = delete;
    ~CurrentContext() {
        if (context_ != EGL_NO_CONTEXT) {
            eglBindAPI(api_);
            eglMakeCurrent(display_, draw_, read_, context_);
        } else {
            eglBindAPI(api_);
        }
    }

  private:
    EGLenum api_ = eglQueryAPI();
    EGLDisplay display_ = eglGetCurrentDisplay();
    EGLContext context_ = eglGetCurrentContext();
    EGLSurface draw_ = eglGetCurrentSurface(EGL_DRAW);
    EGLSurface read_ = eglGetCurrentSurface(EGL_READ);
};

std::string deviceString(EGLDeviceEXT device, EGLint what) {
    const char* text = eglQueryDeviceStringEXT(device, what);
    return text == nullptr ? "" : text;
}

GlDevice describe(EGLDeviceEXT device, std::size_t index, GlApi api) {
    GlDevice result;
    result.index = index;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_query") ||
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base")) {
        const std::string extensions = deviceString(device, EGL_EXTENSIONS);
        result.software = epoxy_extension_in_string(extensions.c_str(), "EGL_MESA_device_software");
        if (epoxy_extension_in_string(extensions.c_str(), "EGL_EXT_device_query_name")) {
            result.name = deviceString(device, kRenderer);
        }
        if (epoxy_extension_in_string(extensions.c_str(), "EGL_EXT_device_drm")) {
            result.drm_device = deviceString(device, EGL_DRM_DEVICE_FILE_EXT);
        }
    }
    const auto context = GlContext::create({.api = api, .device = index});
    if (!context) {
        result.problem = context.error().message;
        return result;
    }
    result.vendor = glText(GL_VENDOR);
    result.renderer = glText(GL_RENDERER);
    result.version = glText(GL_VERSION);
    result.software = result.software || (*context)->software();
    return result;
}

}  // namespace

Result<std::vector<GlDevice>> listGlDevices(GlApi api) {
    if (const std::string missing = missingGlLibrary(api); !missing.empty()) {
        return fail(ErrorCode::kUnsupported,
                    "no devices: " + missing +
                        " cannot be loaded; install a driver, for example libegl1 with libegl-mesa0");
    }
    const CurrentContext current;
    const std::vector<EGLDeviceEXT> devices = eglDevices();
    std::vector<GlDevice> list;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        list.push_back(describe(devices[i], i, api));
    }
    return list;
}

}  // namespace relief
