// SPDX-License-Identifier: Apache-2.0
// A current OpenGL context for each test, once for OpenGL 3.3 core and once for OpenGL ES 3.0. Without a context a test
// fails; it is never skipped. Mesa's llvmpipe provides one on every machine.
#pragma once

#include <gtest/gtest.h>

#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "runtime/gl/gl_context.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"
#include "tests/results.h"

namespace relief {

inline std::string glApiTestName(const testing::TestParamInfo<GlApi>& info) {
    return info.param == GlApi::kGles30 ? "Gles30" : "Gl33Core";
}

inline GlApi apiOf(GlApi api) {
    return api;
}

/// Sets a picture's colour, and its depth to far. Binds the default framebuffer.
inline void clearPicture(GLuint framebuffer, const glm::vec4& color) {
    const GLfloat far = 1.0F;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glClearBufferfv(GL_COLOR, 0, &color.x);
    glClearBufferfv(GL_DEPTH, 0, &far);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

/// The contexts shared by a program's tests, one per API, so that drivers start and compile only once.
class SharedGlContexts : public testing::Environment {
  public:
    [[nodiscard]] static SharedGlContexts& instance() {
        static auto* const shared =
            static_cast<SharedGlContexts*>(testing::AddGlobalTestEnvironment(new SharedGlContexts));
        return *shared;
    }

    /// Makes the context of an API current, with the state of a new context. Throws without one, which ends the test.
    [[nodiscard]] const GlContext* use(GlApi api) {
        std::unique_ptr<GlContext>& context = contexts_[api];
        if (!context) {
            context = required(GlContext::create(api));
        }
        if (const Result<void> current = context->makeCurrent(); !current) {
            throw std::runtime_error(current.error().message);
        }
        resetState(api);
        return context.get();
    }

    /// For tests that need a process without a context. The next use() creates a new one.
    void drop() { contexts_.clear(); }
    void TearDown() override { drop(); }

  private:
    /// Resets state set by tests; passes of the library restore their own.
    static void resetState(GlApi api) {
        while (glGetError() != GL_NO_ERROR) {
        }
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glBindRenderbuffer(GL_RENDERBUFFER, 0);
        glBindVertexArray(0);
        glUseProgram(0);
        for (GLenum unit = 16; unit-- > 0;) {
            glActiveTexture(GL_TEXTURE0 + unit);
            for (const GLenum target :
                 {GL_TEXTURE_2D, GL_TEXTURE_2D_ARRAY, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP}) {
                glBindTexture(target, 0);
            }
            glBindSampler(unit, 0);
        }
        for (const GLenum target :
             {GL_ARRAY_BUFFER, GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER, GL_COPY_READ_BUFFER,
              GL_COPY_WRITE_BUFFER, GL_UNIFORM_BUFFER, GL_TRANSFORM_FEEDBACK_BUFFER}) {
            glBindBuffer(target, 0);
        }
        for (const GLenum capability :
             {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_POLYGON_OFFSET_FILL,
              GL_RASTERIZER_DISCARD, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE}) {
            glDisable(capability);
        }
        if (api == GlApi::kGl33Core) {
            for (const GLenum capability : {GL_PROGRAM_POINT_SIZE, GL_COLOR_LOGIC_OP, GL_DEPTH_CLAMP,
                                            GL_FRAMEBUFFER_SRGB, GL_PRIMITIVE_RESTART}) {
                glDisable(capability);
            }
            glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
            glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, GL_UPPER_LEFT);
            glPointSize(1.0F);
            glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
        }
        glDepthRangef(0.0F, 1.0F);
        glStencilFunc(GL_ALWAYS, 0, ~GLuint{0});
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glDepthMask(GL_TRUE);
        glDepthFunc(GL_LESS);
        glFrontFace(GL_CCW);
        glCullFace(GL_BACK);
        glBlendFunc(GL_ONE, GL_ZERO);
        glBlendEquation(GL_FUNC_ADD);
        glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
        glViewport(0, 0, 0, 0);
        glScissor(0, 0, 0, 0);
        for (const GLenum store :
             {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_UNPACK_ROW_LENGTH,
              GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_IMAGES}) {
            glPixelStorei(store, 0);
        }
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    }

    std::map<GlApi, std::unique_ptr<GlContext>> contexts_;
};

/// For tests whose parameter has an API, returned by apiOf().
template <class Param>
class GlTestOf : public testing::TestWithParam<Param> {
  protected:
    /// The context is current before members of derived fixtures are constructed.
    GlTestOf() : context_(SharedGlContexts::instance().use(apiOf(this->GetParam()))) {
        this->RecordProperty("context", context_->description());
    }
    void TearDown() override { EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)); }

    const GlContext* context_;
};

using GlTest = GlTestOf<GlApi>;

#define RELIEF_INSTANTIATE_GL_TESTS(suite) \
    INSTANTIATE_TEST_SUITE_P(Apis, suite, testing::Values(GlApi::kGl33Core, GlApi::kGles30), glApiTestName)

}  // namespace relief
