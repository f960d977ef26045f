// SPDX-License-Identifier: Apache-2.0
#include "runtime/gl/pass_state.h"

#include <array>
#include <iterator>

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"

namespace relief {
namespace {

struct Switch {
    GLenum name;
    bool desktop_only;
    bool wanted;
};

// All are off during a pass, except GL_PROGRAM_POINT_SIZE, which GL ES implies.
constexpr Switch kSwitches[] = {
    {GL_BLEND, false, false},
    {GL_DEPTH_TEST, false, false},
    {GL_CULL_FACE, false, false},
    {GL_SCISSOR_TEST, false, false},
    {GL_STENCIL_TEST, false, false},
    {GL_DITHER, false, false},
    {GL_SAMPLE_ALPHA_TO_COVERAGE, false, false},
    {GL_SAMPLE_COVERAGE, false, false},
    {GL_RASTERIZER_DISCARD, false, false},
    {GL_POLYGON_OFFSET_FILL, false, false},
    {GL_PRIMITIVE_RESTART_FIXED_INDEX, false, false},
    {GL_PRIMITIVE_RESTART, true, false},
    {GL_COLOR_LOGIC_OP, true, false},
    {GL_FRAMEBUFFER_SRGB, true, false},
    {GL_PROGRAM_POINT_SIZE, true, true},
};

struct PixelStore {
    GLenum name;
    GLint wanted;
};

// Transfers are tightly packed without skips. GL ES 3.0 supports all of these.
constexpr PixelStore kPixelStores[] = {
    {GL_PACK_ALIGNMENT, 1},     {GL_PACK_ROW_LENGTH, 0},    {GL_PACK_SKIP_ROWS, 0},
    {GL_PACK_SKIP_PIXELS, 0},   {GL_UNPACK_ALIGNMENT, 1},   {GL_UNPACK_ROW_LENGTH, 0},
    {GL_UNPACK_SKIP_ROWS, 0},   {GL_UNPACK_SKIP_PIXELS, 0}, {GL_UNPACK_IMAGE_HEIGHT, 0},
    {GL_UNPACK_SKIP_IMAGES, 0},
};

struct Unit {
    GLint texture_2d, texture_3d, sampler;
};

/// The PassStates of this thread. The context must stay current until the outermost one ends.
struct Open {
    int sequences = 0;
    int passes = 0;
    bool gles = false;  // cached isGles() of their context
};
thread_local Open open_states;

void set(GLenum name, bool on) {
    if (on) {
        glEnable(name);
    } else {
        glDisable(name);
    }
}

bool supported(const Switch& one, bool gles) {
    if (one.name == GL_PRIMITIVE_RESTART_FIXED_INDEX) {
        return gles;  // only from OpenGL 4.3 on
    }
    return !(one.desktop_only && gles);
}

}  // namespace

struct PassState::Saved {
    GLint program, vertex_array, array_buffer, uniform_buffer, pack_buffer, unpack_buffer;
    GLint draw_framebuffer, read_framebuffer;
    std::array<GLint, 4> viewport, scissor;
    GLint active_texture;
    std::array<Unit, kUnits> units;
    std::array<SavedRange, 2> blocks{SavedRange(GL_UNIFORM_BUFFER, 0), SavedRange(GL_UNIFORM_BUFFER, 1)};
    std::array<GLboolean, std::size(kSwitches)> switches;
    std::array<GLint, std::size(kPixelStores)> pixel_stores;
    GLint blend_source_rgb, blend_destination_rgb, blend_source_alpha, blend_destination_alpha;
    GLint blend_equation_rgb, blend_equation_alpha;
    GLint depth_function;
    GLboolean depth_mask;
    std::array<GLboolean, 4> color_mask;
    std::array<GLfloat, 4> clear_color;
    GLint polygon_mode, point_origin;

    void read(bool gles);
};

void PassState::Saved::read(bool gles) {
    glGetIntegerv(GL_CURRENT_PROGRAM, &program);
    glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &vertex_array);
    glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &array_buffer);
    glGetIntegerv(GL_UNIFORM_BUFFER_BINDING, &uniform_buffer);
    glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &pack_buffer);
    glGetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &unpack_buffer);
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_framebuffer);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_framebuffer);
    glGetIntegerv(GL_VIEWPORT, viewport.data());
    glGetIntegerv(GL_SCISSOR_BOX, scissor.data());
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active_texture);
    for (GLuint i = 0; i < units.size(); ++i) {
        glActiveTexture(GL_TEXTURE0 + i);
        glGetIntegerv(GL_TEXTURE_BINDING_2D, &units[i].texture_2d);
        glGetIntegerv(GL_TEXTURE_BINDING_3D, &units[i].texture_3d);
        glGetIntegerv(GL_SAMPLER_BINDING, &units[i].sampler);
    }
    glActiveTexture(static_cast<GLenum>(active_texture));
    for (std::size_t i = 0; i < switches.size(); ++i) {
        if (supported(kSwitches[i], gles)) {
            switches[i] = glIsEnabled(kSwitches[i].name);
        }
    }
    for (std::size_t i = 0; i < pixel_stores.size(); ++i) {
        glGetIntegerv(kPixelStores[i].name, &pixel_stores[i]);
    }
    glGetIntegerv(GL_BLEND_SRC_RGB, &blend_source_rgb);
    glGetIntegerv(GL_BLEND_DST_RGB, &blend_destination_rgb);
    glGetIntegerv(GL_BLEND_SRC_ALPHA, &blend_source_alpha);
    glGetIntegerv(GL_BLEND_DST_ALPHA, &blend_destination_alpha);
    glGetIntegerv(GL_BLEND_EQUATION_RGB, &blend_equation_rgb);
    glGetIntegerv(GL_BLEND_EQUATION_ALPHA, &blend_equation_alpha);
    glGetIntegerv(GL_DEPTH_FUNC, &depth_function);
    glGetBooleanv(GL_DEPTH_WRITEMASK, &depth_mask);
    glGetBooleanv(GL_COLOR_WRITEMASK, color_mask.data());
    glGetFloatv(GL_COLOR_CLEAR_VALUE, clear_color.data());
    if (!gles) {
        GLint modes[2] = {};  // some drivers return front and back modes in compatibility contexts
        glGetIntegerv(GL_POLYGON_MODE, modes);
        polygon_mode = modes[0];
        glGetIntegerv(GL_POINT_SPRITE_COORD_ORIGIN, &point_origin);
    }
}

PassState::PassState(Scope scope) : scope_(scope) {
    if (open_states.sequences + open_states.passes == 0) {
        open_states.gles = isGles();
    }
    const bool gles = open_states.gles;
    if (scope == Scope::kSequence || open_states.sequences == 0 || open_states.passes > 0) {
        saved_ = std::make_unique<Saved>();
        saved_->read(gles);
    }
    ++(scope == Scope::kSequence ? open_states.sequences : open_states.passes);
    if (scope == Scope::kSequence) {
        return;
    }
    for (GLuint i = 0; i < kUnits; ++i) {
        glBindSampler(i, 0);
    }
    for (const Switch& one : kSwitches) {
        if (supported(one, gles)) {
            set(one.name, one.wanted);
        }
    }
    for (const PixelStore& one : kPixelStores) {
        glPixelStorei(one.name, one.wanted);
    }
    if (!gles) {
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
        glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, GL_UPPER_LEFT);
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
}

PassState::~PassState() {
    --(scope_ == Scope::kSequence ? open_states.sequences : open_states.passes);
    if (!saved_) {
        return;
    }
    const Saved& s = *saved_;
    const bool gles = open_states.gles;
    const auto name = [](GLint value) { return static_cast<GLuint>(value); };
    const auto word = [](GLint value) { return static_cast<GLenum>(value); };
    glUseProgram(name(s.program));
    glBindVertexArray(name(s.vertex_array));
    glBindBuffer(GL_ARRAY_BUFFER, name(s.array_buffer));
    glBindBuffer(GL_PIXEL_PACK_BUFFER, name(s.pack_buffer));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, name(s.unpack_buffer));
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name(s.draw_framebuffer));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, name(s.read_framebuffer));
    glViewport(s.viewport[0], s.viewport[1], s.viewport[2], s.viewport[3]);
    glScissor(s.scissor[0], s.scissor[1], s.scissor[2], s.scissor[3]);
    for (GLuint i = 0; i < s.units.size(); ++i) {
        useTexture(static_cast<int>(i), name(s.units[i].texture_2d));
        glBindTexture(GL_TEXTURE_3D, name(s.units[i].texture_3d));
        glBindSampler(i, name(s.units[i].sampler));
    }
    glActiveTexture(word(s.active_texture));
    for (const SavedRange& block : s.blocks) {
        block.restore();
    }
    glBindBuffer(GL_UNIFORM_BUFFER, name(s.uniform_buffer));  // binding a block also sets the generic binding
    for (std::size_t i = 0; i < s.switches.size(); ++i) {
        if (supported(kSwitches[i], gles)) {
            set(kSwitches[i].name, s.switches[i] == GL_TRUE);
        }
    }
    for (std::size_t i = 0; i < s.pixel_stores.size(); ++i) {
        glPixelStorei(kPixelStores[i].name, s.pixel_stores[i]);
    }
    glBlendFuncSeparate(word(s.blend_source_rgb), word(s.blend_destination_rgb), word(s.blend_source_alpha),
                        word(s.blend_destination_alpha));
    glBlendEquationSeparate(word(s.blend_equation_rgb), word(s.blend_equation_alpha));
    glDepthFunc(word(s.depth_function));
    glDepthMask(s.depth_mask);
    glColorMask(s.color_mask[0], s.color_mask[1], s.color_mask[2], s.color_mask[3]);
    glClearColor(s.clear_color[0], s.clear_color[1], s.clear_color[2], s.clear_color[3]);
    if (!gles) {
        glPolygonMode(GL_FRONT_AND_BACK, word(s.polygon_mode));
        glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, s.point_origin);
    }
}

}  // namespace relief
