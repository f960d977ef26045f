// SPDX-License-Identifier: Apache-2.0
#include "runtime/gl/gl_capabilities.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

/// Returns GL_NO_ERROR if the GL cannot report resets. libepoxy aborts if the GL lacks the called function. It treats
/// the functions of KHR_robustness and EXT_robustness as aliases of the core function, but not that of ARB_robustness.
GLenum resetStatus() {
    const bool desktop = epoxy_is_desktop_gl();
    if (epoxy_gl_version() >= (desktop ? 45 : 32) || epoxy_has_gl_extension("GL_KHR_robustness") ||
        (!desktop && epoxy_has_gl_extension("GL_EXT_robustness"))) {
        return glGetGraphicsResetStatus();
    }
    return desktop && epoxy_has_gl_extension("GL_ARB_robustness") ? glGetGraphicsResetStatusARB()
                                                                  : GL_NO_ERROR;
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
    return resetStatus() != GL_NO_ERROR;
}

}  // namespace relief
