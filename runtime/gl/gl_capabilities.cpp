#include "runtime/gl/gl_capabilities.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

/// libepoxy ends the process where a GL has no such function under any of its names.
bool hasResetStatus() {
    const int version = epoxy_gl_version();
    if (epoxy_is_desktop_gl()) {
        return version >= 45 || epoxy_has_gl_extension("GL_KHR_robustness") ||
               epoxy_has_gl_extension("GL_ARB_robustness");
    }
    return version >= 32 || epoxy_has_gl_extension("GL_KHR_robustness") ||
           epoxy_has_gl_extension("GL_EXT_robustness");
}

}  // namespace

bool isGles() {
    return !epoxy_is_desktop_gl();
}

bool isSoftwareRenderer() {
    const auto* const text = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    const std::string_view renderer = text == nullptr ? "" : text;
    constexpr std::array<std::string_view, 5> kNames{"llvmpipe", "softpipe", "swrast", "SwiftShader",
                                                     "Software Rasterizer"};
    return std::any_of(kNames.begin(), kNames.end(),
                       [&](std::string_view name) { return renderer.find(name) != std::string_view::npos; });
}

bool hasCompute() {
    return epoxy_gl_version() >= (isGles() ? 31 : 43);
}

bool hasGlExtension(const char* name) {
    return epoxy_has_gl_extension(name);
}

bool gpuWasReset() {
    return hasResetStatus() && glGetGraphicsResetStatus() != GL_NO_ERROR;
}

}  // namespace relief
