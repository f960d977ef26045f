// SPDX-License-Identifier: Apache-2.0
#include "runtime/gl/gl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <cstdio>
#include <vector>

#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_object.h"

namespace relief {
namespace {

bool loads(const char* library) {
    // Leave it open: libepoxy opens it again, and closing it would initialise the driver twice.
    return ::dlopen(library, RTLD_LAZY | RTLD_LOCAL) != nullptr;
}

bool hasClientExtension(const char* name) {
    // Check client extensions first: without them the entry points may not exist.
    return epoxy_has_egl_extension(EGL_NO_DISPLAY, name);
}

/// Returns the name of a missing library that EGL or this API requires; "" if there is none. Call it before EGL or the
/// GL, because libepoxy aborts if a library is missing.
std::string missingGlLibrary(GlApi api) {
    if (!loads("libEGL.so.1")) {
        return "libEGL.so.1";
    }
    if (api == GlApi::kGles30) {
        return loads("libGLESv2.so.2") ? "" : "libGLESv2.so.2";
    }
    return loads("libOpenGL.so.0") || loads("libGL.so.1") ? "" : "libOpenGL.so.0";
}

/// Returns EGL's devices in order; empty if EGL cannot enumerate them.
std::vector<EGLDeviceEXT> eglDevices() {
    if (!hasClientExtension("EGL_EXT_device_enumeration") && !hasClientExtension("EGL_EXT_device_base")) {
        return {};
    }
    std::vector<EGLDeviceEXT> devices(64);
    EGLint count = 0;
    if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) != EGL_TRUE) {
        return {};
    }
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

/// Returns an uninitialised display, or EGL_NO_DISPLAY if the platform is not supported.
EGLDisplay platformDisplay(const char* extension, EGLenum platform, void* native) {
    return hasClientExtension(extension) && hasClientExtension("EGL_EXT_platform_base")
               ? eglGetPlatformDisplayEXT(platform, native, nullptr)
               : EGL_NO_DISPLAY;
}

EGLDisplay deviceDisplay(EGLDeviceEXT device) {
    return platformDisplay("EGL_EXT_platform_device", EGL_PLATFORM_DEVICE_EXT, device);
}

/// Returns a GL string, or "" for null.
std::string glText(unsigned what) {
    const GLubyte* text = glGetString(what);
    return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

std::string eglErrorText() {
    char text[32];
    std::snprintf(text, sizeof(text), "EGL error 0x%04x", eglGetError());
    return text;
}

EGLContext createContext(EGLDisplay display, EGLConfig config, bool es) {
    const EGLint on_reset = es ? EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT
                               : EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_KHR;
    // Try the version with compute shaders first: some drivers return exactly the requested version.
    const std::array<EGLint, 2> with_compute = es ? std::array<EGLint, 2>{3, 1} : std::array<EGLint, 2>{4, 3};
    const std::array<EGLint, 2> without = es ? std::array<EGLint, 2>{3, 0} : std::array<EGLint, 2>{3, 3};
    for (const auto& [major, minor] : {with_compute, without}) {
        // Retry without reset notification in case EGL or the driver rejects it.
        for (const bool with_reset : {true, false}) {
            std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION, major, EGL_CONTEXT_MINOR_VERSION,
                                           minor};
            if (with_reset) {
                attributes.insert(attributes.end(), {on_reset, EGL_LOSE_CONTEXT_ON_RESET_KHR});
            }
            if (!es) {
                attributes.insert(attributes.end(),
                                  {EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT});
            }
            attributes.push_back(EGL_NONE);
            const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
            if (context != EGL_NO_CONTEXT) {
                return context;
            }
        }
    }
    return EGL_NO_CONTEXT;
}

}  // namespace

struct GlContext::Impl {
    GlApi api = GlApi::kGl33Core;
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    std::string description;
    bool software = false;

    /// Returns "" on success. Otherwise releases everything and returns the reason for the failure.
    std::string open(EGLDisplay opened) {
        display = opened;
        if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
            display = EGL_NO_DISPLAY;
            return "not available";
        }
        std::string problem = makeContext();
        if (!problem.empty()) {
            close();
        }
        return problem;
    }

    std::string makeContext() {
        const bool es = api == GlApi::kGles30;
        const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE,
                                 es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API) != EGL_TRUE ||
            eglChooseConfig(display, wanted, &config, 1, &count) != EGL_TRUE) {
            return eglErrorText();
        }
        // A context needs no configuration if nothing is drawn to a surface.
        context = createContext(display, count > 0 ? config : nullptr, es);
        if (context == EGL_NO_CONTEXT ||
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
            return eglErrorText();
        }
        if (es && !epoxy_has_gl_extension("GL_EXT_color_buffer_float")) {
            return "GL_EXT_color_buffer_float is missing, so float textures are not renderable";
        }
        // NVIDIA's driver compiles in the background only after this call.
        if (epoxy_has_gl_extension("GL_KHR_parallel_shader_compile")) {
            glMaxShaderCompilerThreadsKHR(0xffffffffU);
        }
        return {};
    }

    void close() {
        if (display == EGL_NO_DISPLAY) {
            return;
        }
        // Another context may have become current.
        if (context != EGL_NO_CONTEXT && eglGetCurrentContext() == context) {
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        }
        if (context != EGL_NO_CONTEXT) {
            eglDestroyContext(display, context);
        }
        // Leave the display open: by EGL's rules it belongs to the process and may be in use elsewhere.
        display = EGL_NO_DISPLAY;
        context = EGL_NO_CONTEXT;
    }

    void describe(const std::string& where) {
        const std::string renderer = glText(GL_RENDERER);
        description =
            (api == GlApi::kGles30 ? "" : "OpenGL ") + glText(GL_VERSION) + ", " + renderer + ", " + where;
        software = isSoftwareRenderer();
    }

    /// Returns the failed attempts; "" once a context is open.
    std::string openAny() {
        std::string tried;
        const auto opens = [&](EGLDisplay opened, const std::string& name) {
            const std::string problem = open(opened);
            if (problem.empty()) {
                describe(name);
                return true;
            }
            tried += (tried.empty() ? "" : "; ") + name + ": " + problem;
            return false;
        };
        const EGLDisplay surfaceless = platformDisplay("EGL_MESA_platform_surfaceless",
                                                       EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
        if (opens(surfaceless, "surfaceless")) {
            return {};
        }
        const std::vector<EGLDeviceEXT> devices = eglDevices();
        for (std::size_t i = 0; i < devices.size(); ++i) {
            if (opens(deviceDisplay(devices[i]), "device " + std::to_string(i))) {
                return {};
            }
        }
        return opens(eglGetDisplay(EGL_DEFAULT_DISPLAY), "default") ? "" : tried;
    }

    Result<void> openDevice(std::size_t index) {
        const std::vector<EGLDeviceEXT> devices = eglDevices();
        const std::string name = "device " + std::to_string(index);
        if (index >= devices.size()) {
            return fail(ErrorCode::kUsage,
                        "there is no " + name + ": EGL has " + std::to_string(devices.size()) +
                            (devices.empty()       ? "; omit the device"
                             : devices.size() == 1 ? ", device 0"
                                                   : " (0-" + std::to_string(devices.size() - 1) + ")") +
                            (devices.empty() ? "" : "; 'eglinfo -B' lists them"));
        }
        const std::string problem = open(deviceDisplay(devices[index]));
        if (!problem.empty()) {
            return fail(ErrorCode::kUnsupported, name + " provides no " + apiName() + " context (" + problem +
                                                     "); choose another, or omit the device");
        }
        describe(name);
        return {};
    }

    [[nodiscard]] std::string apiName() const {
        return api == GlApi::kGles30 ? "OpenGL ES 3.0" : "OpenGL 3.3";
    }
};

GlContext::GlContext() : impl_(std::make_unique<Impl>()) {}

GlContext::~GlContext() {
    impl_->close();
}

Result<std::unique_ptr<GlContext>> GlContext::create(const GlContextOptions& options) {
    std::unique_ptr<GlContext> context(new GlContext);
    Impl& impl = *context->impl_;
    impl.api = options.api;
    constexpr const char* kFix =
        "; install a driver, for example libegl1 with libopengl0 (OpenGL ES: libgles2), libegl-mesa0 and "
        "libgl1-mesa-dri";
    if (const std::string missing = missingGlLibrary(options.api); !missing.empty()) {
        return fail(ErrorCode::kUnsupported,
                    "no " + impl.apiName() + " context: " + missing + " cannot be loaded" + kFix);
    }
    if (options.device) {
        RELIEF_TRY(impl.openDevice(*options.device));
        return context;
    }
    if (const std::string tried = impl.openAny(); !tried.empty()) {
        return fail(ErrorCode::kUnsupported,
                    "no " + impl.apiName() + " context through EGL (" + tried + ")" + kFix);
    }
    return context;
}

Result<std::unique_ptr<GlContext>> GlContext::create(GlApi api) {
    return create(GlContextOptions{.api = api, .device = std::nullopt});
}

Result<void> GlContext::makeCurrent() {
    // The bound API is per thread and determines which context is current.
    if (eglBindAPI(impl_->api == GlApi::kGles30 ? EGL_OPENGL_ES_API : EGL_OPENGL_API) != EGL_TRUE ||
        (eglGetCurrentContext() != impl_->context &&
         eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context) != EGL_TRUE)) {
        return fail(ErrorCode::kUsage, "the OpenGL context cannot be made current on this thread (" +
                                           eglErrorText() + "); use it on the thread that created it");
    }
    return {};
}

GlApi GlContext::api() const {
    return impl_->api;
}

const std::string& GlContext::description() const {
    return impl_->description;
}

bool GlContext::software() const {
    return impl_->software;
}

}  // namespace relief
