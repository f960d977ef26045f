#include "runtime/gl_context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <cstdio>

namespace relief {
namespace {

constexpr EGLint kContext33[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 3,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 3,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
constexpr EGLint kContext30[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};

struct Platform {
    const char* name;
    EGLDisplay (*open)();
};

EGLDisplay openSurfaceless() {
    // Client extensions first: without the platform the entry point may not exist.
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless") ||
        !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) {
        return EGL_NO_DISPLAY;
    }
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

EGLDisplay openFirstDevice() {
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") ||
        !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
        return EGL_NO_DISPLAY;
    }
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) != EGL_TRUE ||
        count < 1) {
        return EGL_NO_DISPLAY;
    }
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[0], nullptr);
}

EGLDisplay openDefault() {
    return eglGetDisplay(EGL_DEFAULT_DISPLAY);
}

constexpr Platform kPlatforms[] = {
    {"surfaceless", openSurfaceless}, {"device", openFirstDevice}, {"default", openDefault}};

std::string eglErrorText() {
    char text[32];
    std::snprintf(text, sizeof(text), "EGL error 0x%04x", eglGetError());
    return text;
}

}  // namespace

struct GlContext::Impl {
    GlApi api = GlApi::kGl33Core;
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    std::string description;

    /// Empty on success, else what failed. Leaves nothing behind on failure.
    std::string open(const Platform& platform) {
        display = platform.open();
        if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
            display = EGL_NO_DISPLAY;
            return "not available";
        }
        std::string problem = makeCurrent();
        if (!problem.empty()) {
            close();
        }
        return problem;
    }

    std::string makeCurrent() {
        const bool es = api == GlApi::kGles30;
        const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE,
                                 es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API) != EGL_TRUE ||
            eglChooseConfig(display, wanted, &config, 1, &count) != EGL_TRUE) {
            return eglErrorText();
        }
        // A context needs no configuration where nothing is drawn to a surface.
        context = eglCreateContext(display, count > 0 ? config : nullptr, EGL_NO_CONTEXT,
                                   es ? kContext30 : kContext33);
        if (context == EGL_NO_CONTEXT ||
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
            return eglErrorText();
        }
        if (es && !epoxy_has_gl_extension("GL_EXT_color_buffer_float")) {
            return "GL_EXT_color_buffer_float is missing, particle state cannot be rendered to";
        }
        return {};
    }

    void close() {
        if (display == EGL_NO_DISPLAY) {
            return;
        }
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context != EGL_NO_CONTEXT) {
            eglDestroyContext(display, context);
        }
        // The display stays open: it is the process's, by EGL's rules, and someone else may be using it.
        display = EGL_NO_DISPLAY;
        context = EGL_NO_CONTEXT;
    }
};

GlContext::GlContext() : impl_(std::make_unique<Impl>()) {}

GlContext::~GlContext() {
    impl_->close();
}

Result<std::unique_ptr<GlContext>> GlContext::create(GlApi api) {
    std::unique_ptr<GlContext> context(new GlContext);
    Impl& impl = *context->impl_;
    impl.api = api;
    std::string tried;
    for (const Platform& platform : kPlatforms) {
        const std::string problem = impl.open(platform);
        if (problem.empty()) {
            const auto text = [](GLenum what) {
                return std::string(reinterpret_cast<const char*>(glGetString(what)));
            };
            impl.description = (api == GlApi::kGles30 ? "" : "OpenGL ") + text(GL_VERSION) + ", " +
                               text(GL_RENDERER) + ", " + platform.name;
            return context;
        }
        tried += std::string(tried.empty() ? "" : "; ") + platform.name + ": " + problem;
    }
    return fail(ErrorCode::kUnsupported,
                std::string("no ") + (api == GlApi::kGles30 ? "OpenGL ES 3.0" : "OpenGL 3.3") +
                    " context through EGL (" + tried +
                    "); install a driver, for example libegl1 with libegl-mesa0 and libgl1-mesa-dri");
}

GlApi GlContext::api() const {
    return impl_->api;
}

const std::string& GlContext::description() const {
    return impl_->description;
}

}  // namespace relief
