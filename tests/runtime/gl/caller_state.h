// The GL state of a caller that shares its context with Relief.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"
#include "runtime/gl/pass_state.h"

namespace relief {

/// Sets everything that a pass sets, or that could spoil one, to something else.
class CallerState {
  public:
    CallerState() {
        glBindBuffer(GL_UNIFORM_BUFFER, buffer_.name());
        glBufferData(GL_UNIFORM_BUFFER, 4096, nullptr, GL_STATIC_DRAW);
        glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer_.name());
        glBindBufferRange(GL_UNIFORM_BUFFER, 1, buffer_.name(), 1024, 512);
        glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, feedback_.name());
        glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, 256, nullptr, GL_STATIC_DRAW);
        glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, feedback_.name(), 64, 128);
        glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
        glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer_.name());
        glBindVertexArray(array_.name());
        glGenTextures(1, &volume_);
        for (GLenum unit = 0; unit < PassState::kUnits; ++unit) {
            glActiveTexture(GL_TEXTURE0 + unit);
            glBindTexture(GL_TEXTURE_2D, texture_.name());
            glBindTexture(GL_TEXTURE_3D, volume_);
        }
        glActiveTexture(GL_TEXTURE3);
        for (const GLenum capability : kCapabilities) {
            glEnable(capability);
        }
        glDepthMask(GL_FALSE);
        glDepthFunc(GL_NEVER);
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        glScissor(0, 0, 0, 0);
        glViewport(1, 2, 3, 4);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 8);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 3);
        glPixelStorei(GL_UNPACK_SKIP_IMAGES, 2);
        before_ = now();
    }
    ~CallerState() { glDeleteTextures(1, &volume_); }
    CallerState(const CallerState&) = delete;
    CallerState& operator=(const CallerState&) = delete;

    void expectKept(const char* after) const {
        EXPECT_EQ(now(), before_) << after;
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << after;
    }

  private:
    static constexpr std::array<GLenum, 5> kCapabilities{GL_SCISSOR_TEST, GL_RASTERIZER_DISCARD, GL_BLEND,
                                                         GL_CULL_FACE, GL_DEPTH_TEST};

    static std::vector<GLint64> now() {
        std::vector<GLint64> values;
        const auto add = [&](GLenum what) {
            std::array<GLint, 4> some{};
            glGetIntegerv(what, some.data());
            values.insert(values.end(), some.begin(), some.end());
        };
        for (const GLenum what :
             {GL_CURRENT_PROGRAM, GL_VERTEX_ARRAY_BINDING, GL_ARRAY_BUFFER_BINDING,
              GL_PIXEL_UNPACK_BUFFER_BINDING, GL_UNIFORM_BUFFER_BINDING, GL_TRANSFORM_FEEDBACK_BUFFER_BINDING,
              GL_DRAW_FRAMEBUFFER_BINDING, GL_READ_FRAMEBUFFER_BINDING, GL_VIEWPORT, GL_SCISSOR_BOX,
              GL_DEPTH_WRITEMASK, GL_DEPTH_FUNC, GL_COLOR_WRITEMASK, GL_UNPACK_ALIGNMENT,
              GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_IMAGES, GL_ACTIVE_TEXTURE}) {
            add(what);
        }
        for (const GLenum capability : kCapabilities) {
            values.push_back(glIsEnabled(capability));
        }
        const auto indexed = [&](GLenum binding, GLenum start, GLenum size, GLuint index) {
            GLint name = 0;
            std::array<GLint64, 2> range{};
            glGetIntegeri_v(binding, index, &name);
            glGetInteger64i_v(start, index, &range[0]);
            glGetInteger64i_v(size, index, &range[1]);
            values.insert(values.end(), {GLint64{name}, range[0], range[1]});
        };
        indexed(GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE, 0);
        indexed(GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE, 1);
        indexed(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, GL_TRANSFORM_FEEDBACK_BUFFER_START,
                GL_TRANSFORM_FEEDBACK_BUFFER_SIZE, 0);
        GLint active = 0;
        glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
        for (GLenum unit = 0; unit < PassState::kUnits; ++unit) {
            glActiveTexture(GL_TEXTURE0 + unit);
            add(GL_TEXTURE_BINDING_2D);
            add(GL_TEXTURE_BINDING_3D);
            add(GL_SAMPLER_BINDING);
        }
        glActiveTexture(static_cast<GLenum>(active));
        return values;
    }

    GlBuffer buffer_ = makeBuffer();
    GlBuffer feedback_ = makeBuffer();
    GlVertexArray array_ = makeVertexArray();
    GlTexture texture_ = makeTexture2D(GL_RGBA8, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE);
    GLuint volume_ = 0;
    std::vector<GLint64> before_;
};

}  // namespace relief
