// SPDX-License-Identifier: Apache-2.0
// Platforms and devices that provide a context, present and missing; and errors without a context.
#include "runtime/gl/gl_context.h"

#include <epoxy/egl.h>
#include <gtest/gtest.h>

#include "runtime/bodies/world_textures.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/frame.h"
#include "runtime/picture/particle_renderer.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

std::string ending(const std::string& text) {
    return text.substr(text.rfind(", ") + 2);
}

EGLDisplay noPlatform(EGLenum /*platform*/, void* /*native*/, const EGLint* /*attributes*/) {
    return EGL_NO_DISPLAY;
}
EGLDisplay noDisplay(EGLNativeDisplayType /*native*/) {
    return EGL_NO_DISPLAY;
}
decltype(epoxy_eglCreateContext) real_create_context = nullptr;
int refused = 0;
EGLContext noRobustContext(EGLDisplay display, EGLConfig config, EGLContext share, const EGLint* attributes) {
    for (const EGLint* at = attributes; *at != EGL_NONE; at += 2) {
        if (*at == EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT ||
            *at == EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_KHR) {
            ++refused;
            return EGL_NO_CONTEXT;
        }
    }
    return real_create_context(display, config, share, attributes);
}

using GlDeviceTest = GlTest;

TEST_P(GlDeviceTest, DescriptionNamesThePlatform) {
    const auto any = required(GlContext::create(GetParam()));
    EXPECT_EQ(ending(any->description()), "surfaceless") << "the first available platform";
    EXPECT_EQ(any->api(), GetParam());
}

TEST_P(GlDeviceTest, MissingPlatformsAreNamed) {
    const auto platform = epoxy_eglGetPlatformDisplayEXT;
    static_cast<void>(eglGetDisplay(EGL_DEFAULT_DISPLAY));  // libepoxy resolves it at the first call
    const auto real_display = epoxy_eglGetDisplay;
    epoxy_eglGetPlatformDisplayEXT = noPlatform;
    epoxy_eglGetDisplay = noDisplay;
    const auto any = GlContext::create(GetParam());
    for (const char* name :
         {"surfaceless: not available", "device 0: not available", "default: not available"}) {
        expectError(any, ErrorCode::kUnsupported, name);
    }
    expectError(GlContext::create({.api = GetParam(), .device = std::size_t{0}}), ErrorCode::kUnsupported,
                "device 0");
    epoxy_eglGetPlatformDisplayEXT = platform;
    epoxy_eglGetDisplay = real_display;
}

TEST_P(GlDeviceTest, DevicesAreOpenedByNumber) {
    std::size_t opened = 0;
    std::size_t number = 0;
    for (;; ++number) {
        const auto context = GlContext::create({.api = GetParam(), .device = number});
        if (context) {
            ++opened;
            EXPECT_EQ(ending((*context)->description()), "device " + std::to_string(number));
        } else if (context.error().code == ErrorCode::kUsage) {
            expectError(context, ErrorCode::kUsage, "EGL has " + std::to_string(number));
            break;
        }
    }
    EXPECT_GT(opened, 0U) << "at least Mesa's llvmpipe is a device";
}

TEST_P(GlDeviceTest, DriversWithoutResetNotificationGiveAContext) {
    real_create_context = epoxy_eglCreateContext;
    refused = 0;
    epoxy_eglCreateContext = noRobustContext;
    const auto context = GlContext::create(GetParam());
    epoxy_eglCreateContext = real_create_context;
    ASSERT_TRUE(context) << context.error().message;
    EXPECT_EQ(refused, 1) << "Mesa's llvmpipe supports the attribute, which is requested first";
}

TEST(NoContext, IsAnError) {
    const auto expectNamed = [](const auto& result) {
        expectError(result, ErrorCode::kUsage, "no OpenGL context is current");
    };
    SharedGlContexts::instance().drop();
    for (const bool had_one : {false, true}) {
        ASSERT_TRUE(!had_one || GlContext::create());
        expectNamed(WorldTextures::create(Collider{}));
        expectNamed(ParticleSystem::create());
        expectNamed(DepthSorter::create(1024));
        expectNamed(Frame::create(64, 64));
        expectNamed(ParticleRenderer::create(std::nullopt));
    }
}

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(GlDeviceTest);

}  // namespace relief
