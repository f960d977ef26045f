// SPDX-License-Identifier: Apache-2.0
// The GL state of a caller that shares its context with Relief.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"
#include "runtime/gl/pass_state.h"

namespace relief {

/// Sets all state that a pass changes or depends on to unusual values, so that a pass that relies on defaults draws
/// nothing or garbage.
class CallerState {
  public:
    CallerState() {
        framebuffer_ = makeFramebuffer(std::array<GLuint, 1>{texture_.name()}).value();
        program_ = makeScreenProgram("picture/resolve.frag").value();
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
        glUseProgram(program_.name());
        glBindVertexArray(array_.name());
        glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, feedback_.name());
        glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, 256, nullptr, GL_STATIC_DRAW);
        glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, feedback_.name(), 64, 128);
        glBindBuffer(GL_UNIFORM_BUFFER, buffer_.name());
        glBufferData(GL_UNIFORM_BUFFER, 4096, nullptr, GL_STATIC_DRAW);
        glBindBufferRange(GL_UNIFORM_BUFFER, 0, buffer_.name(), 0, 1024);
        glBindBufferRange(GL_UNIFORM_BUFFER, 1, buffer_.name(), 1024, 512);
        for (const GLenum target : {GL_ARRAY_BUFFER, GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER,
                                    GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER}) {
            glBindBuffer(target, buffer_.name());
        }
        if (hasCompute()) {
            image_ = makeImageTexture2D(GL_R32F, 4, 4);
            glBindImageTexture(0, image_.name(), 0, GL_FALSE, 0, GL_READ_ONLY, GL_R32F);
            glBindImageTexture(2, image_.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32F);
            glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffer_.name());
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer_.name());
            glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 2, buffer_.name(), 1024, 512);
        }
        glGenTextures(1, &volume_);
        glGenSamplers(1, &sampler_);
        for (GLenum unit = 0; unit < PassState::kUnits; ++unit) {
            glActiveTexture(GL_TEXTURE0 + unit);
            glBindTexture(GL_TEXTURE_2D, texture_.name());
            glBindTexture(GL_TEXTURE_3D, volume_);
            glBindSampler(unit, sampler_);
        }
        glActiveTexture(GL_TEXTURE5);
        for (const GLenum capability : capabilities()) {
            if (capability != GL_PROGRAM_POINT_SIZE) {
                glEnable(capability);
            }
        }
        if (!isGles()) {
            glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
            glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, GL_LOWER_LEFT);
            glPointSize(7.0F);
        }
        glViewport(1, 2, 3, 4);
        glScissor(5, 6, 1, 1);
        glStencilFunc(GL_NEVER, 1, 1);
        glCullFace(GL_FRONT_AND_BACK);
        glBlendFuncSeparate(GL_ZERO, GL_ZERO, GL_ONE, GL_DST_COLOR);
        glBlendEquationSeparate(GL_FUNC_SUBTRACT, GL_MAX);
        glDepthFunc(GL_NEVER);
        glDepthMask(GL_FALSE);
        glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
        glClearColor(0.25F, 0.5F, 0.75F, 1.0F);
        glPixelStorei(GL_PACK_ALIGNMENT, 8);
        glPixelStorei(GL_PACK_ROW_LENGTH, 17);
        glPixelStorei(GL_PACK_SKIP_ROWS, 3);
        glPixelStorei(GL_PACK_SKIP_PIXELS, 5);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 9);
        glPixelStorei(GL_UNPACK_SKIP_IMAGES, 2);
        before_ = now();
    }
    ~CallerState() {
        glDeleteTextures(1, &volume_);
        glDeleteSamplers(1, &sampler_);
    }
    CallerState(const CallerState&) = delete;
    CallerState& operator=(const CallerState&) = delete;

    void expectKept(const char* after) const {
        EXPECT_EQ(now(), before_) << after;
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << after;
    }

  private:
    using State = std::map<std::pair<GLenum, GLuint>, std::vector<GLint64>>;  // by name, and unit or block

    static std::vector<GLenum> capabilities() {
        std::vector<GLenum> names{GL_BLEND,           GL_DEPTH_TEST,         GL_CULL_FACE,
                                  GL_SCISSOR_TEST,    GL_STENCIL_TEST,       GL_SAMPLE_ALPHA_TO_COVERAGE,
                                  GL_SAMPLE_COVERAGE, GL_RASTERIZER_DISCARD, GL_POLYGON_OFFSET_FILL};
        if (!isGles()) {
            names.insert(names.end(), {GL_COLOR_LOGIC_OP, GL_FRAMEBUFFER_SRGB, GL_PRIMITIVE_RESTART,
                                       GL_PROGRAM_POINT_SIZE});
        }
        return names;
    }

    static State now() {
        State state;
        const auto add = [&](GLuint unit, std::initializer_list<GLenum> names) {
            for (const GLenum what : names) {
                std::vector<GLint64>& values = state[{what, unit}];
                values.resize(4);
                glGetInteger64v(what, values.data());
            }
        };
        const auto indexed = [&](GLuint index, std::initializer_list<GLenum> names) {
            for (const GLenum what : names) {
                glGetInteger64i_v(what, index, &state[{what, index}].emplace_back());
            }
        };
        add(0, {GL_VERTEX_ARRAY_BINDING, GL_ARRAY_BUFFER_BINDING, GL_UNIFORM_BUFFER_BINDING,
                GL_PIXEL_PACK_BUFFER_BINDING, GL_PIXEL_UNPACK_BUFFER_BINDING, GL_COPY_READ_BUFFER_BINDING,
                GL_COPY_WRITE_BUFFER_BINDING, GL_DRAW_FRAMEBUFFER_BINDING, GL_READ_FRAMEBUFFER_BINDING});
        add(0, {GL_CURRENT_PROGRAM,      GL_VIEWPORT,           GL_SCISSOR_BOX,      GL_BLEND_SRC_RGB,
                GL_BLEND_DST_RGB,        GL_BLEND_SRC_ALPHA,    GL_BLEND_DST_ALPHA,  GL_BLEND_EQUATION_RGB,
                GL_BLEND_EQUATION_ALPHA, GL_DEPTH_FUNC,         GL_DEPTH_WRITEMASK,  GL_COLOR_WRITEMASK,
                GL_COLOR_CLEAR_VALUE,    GL_CULL_FACE_MODE,     GL_PACK_ALIGNMENT,   GL_PACK_ROW_LENGTH,
                GL_PACK_SKIP_ROWS,       GL_PACK_SKIP_PIXELS,   GL_UNPACK_ALIGNMENT, GL_UNPACK_ROW_LENGTH,
                GL_UNPACK_SKIP_ROWS,     GL_UNPACK_SKIP_IMAGES, GL_ACTIVE_TEXTURE,   GL_DITHER});
        add(0, {GL_TRANSFORM_FEEDBACK_BUFFER_BINDING});
        for (const GLenum capability : capabilities()) {
            state[{capability, 0}] = {glIsEnabled(capability)};
        }
        if (!isGles()) {
            add(0, {GL_POINT_SPRITE_COORD_ORIGIN});
            std::array<GLint, 2> modes{};
            glGetIntegerv(GL_POLYGON_MODE, modes.data());
            state[{GL_POLYGON_MODE, 0}] = {modes[0]};
        }
        for (const GLuint block : {0U, 1U}) {
            indexed(block, {GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE});
        }
        indexed(0, {GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, GL_TRANSFORM_FEEDBACK_BUFFER_START,
                    GL_TRANSFORM_FEEDBACK_BUFFER_SIZE});
        if (hasCompute()) {
            add(0, {GL_DRAW_INDIRECT_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_BINDING});
            for (GLuint unit = 0; unit < StorageUnits::kUnits; ++unit) {
                indexed(unit, {GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                               GL_SHADER_STORAGE_BUFFER_SIZE, GL_IMAGE_BINDING_NAME, GL_IMAGE_BINDING_ACCESS,
                               GL_IMAGE_BINDING_FORMAT});
            }
        }
        GLint active = 0;
        glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
        for (GLenum unit = 0; unit < PassState::kUnits; ++unit) {
            glActiveTexture(GL_TEXTURE0 + unit);
            add(unit, {GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_2D_ARRAY, GL_TEXTURE_BINDING_3D,
                       GL_SAMPLER_BINDING});
        }
        glActiveTexture(static_cast<GLenum>(active));
        return state;
    }

    GlBuffer buffer_ = makeBuffer();
    GlBuffer feedback_ = makeBuffer();
    GlVertexArray array_ = makeVertexArray();
    GlTexture texture_ = makeTexture2D(GL_RGBA8, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE);
    GlTexture image_;
    GlFramebuffer framebuffer_;
    GlProgram program_;
    GLuint volume_ = 0;
    GLuint sampler_ = 0;
    State before_;
};

}  // namespace relief
