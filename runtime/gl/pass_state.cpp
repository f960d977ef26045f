#include "runtime/gl/pass_state.h"

#include <iterator>

namespace relief {
namespace {

struct Switch {
    GLenum name;
    bool desktop_only;
    bool wanted;
};

// Off during a pass, but for point sizes, which come from the vertex shader (as they always do on GL ES).
constexpr Switch kSwitches[] = {
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

// The parts of a picture that transfers step over; GL ES 3.0 has them all.
constexpr GLenum kWindows[] = {GL_PACK_ROW_LENGTH,     GL_PACK_SKIP_ROWS,    GL_PACK_SKIP_PIXELS,
                               GL_UNPACK_ROW_LENGTH,   GL_UNPACK_SKIP_ROWS,  GL_UNPACK_SKIP_PIXELS,
                               GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_IMAGES};

void set(GLenum name, bool on) {
    if (on) {
        glEnable(name);
    } else {
        glDisable(name);
    }
}

bool known(const Switch& one, bool gles) {
    if (one.name == GL_PRIMITIVE_RESTART_FIXED_INDEX) {
        return gles;  // OpenGL has it from 4.3 only
    }
    return !(one.desktop_only && gles);
}

}  // namespace

PassState::PassState() {
    static_assert(std::size(kSwitches) == kSwitchCount);
    const bool gles = isGles();
    for (int i = 0; i < kSwitchCount; ++i) {
        if (known(kSwitches[i], gles)) {
            switches_[i] = glIsEnabled(kSwitches[i].name);
            set(kSwitches[i].name, kSwitches[i].wanted);
        }
    }
    GLint active = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    for (int i = 0; i < GlStateGuard::kUnits; ++i) {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
        glGetIntegerv(GL_SAMPLER_BINDING, &samplers_[i]);
        glBindSampler(static_cast<GLuint>(i), 0);
        glGetIntegerv(GL_TEXTURE_BINDING_3D, &textures_3d_[i]);
    }
    glActiveTexture(static_cast<GLenum>(active));
    if (!gles) {
        GLint modes[2] = {};  // some drivers of compatibility contexts answer for front and back
        glGetIntegerv(GL_POLYGON_MODE, modes);
        polygon_mode_ = modes[0];
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
        glGetIntegerv(GL_POINT_SPRITE_COORD_ORIGIN, &point_origin_);
        glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, GL_UPPER_LEFT);
    }
    static_assert(std::size(kWindows) == kWindowCount);
    for (int i = 0; i < kWindowCount; ++i) {
        glGetIntegerv(kWindows[i], &windows_[i]);
        glPixelStorei(kWindows[i], 0);
    }
    glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &pack_buffer_);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    for (int i = 0; i < kBlockCount; ++i) {
        const auto binding = static_cast<GLuint>(i);
        glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, binding, &block_buffer_[i]);
        glGetInteger64i_v(GL_UNIFORM_BUFFER_START, binding, &block_offset_[i]);
        glGetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, binding, &block_size_[i]);
    }
}

PassState::~PassState() {
    const bool gles = isGles();
    for (int i = 0; i < kSwitchCount; ++i) {
        if (known(kSwitches[i], gles)) {
            set(kSwitches[i].name, switches_[i] == GL_TRUE);
        }
    }
    for (int i = 0; i < GlStateGuard::kUnits; ++i) {
        glBindSampler(static_cast<GLuint>(i), static_cast<GLuint>(samplers_[i]));
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));  // GlStateGuard restores which is active
        glBindTexture(GL_TEXTURE_3D, static_cast<GLuint>(textures_3d_[i]));
    }
    for (int i = 0; i < kWindowCount; ++i) {
        glPixelStorei(kWindows[i], windows_[i]);
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(pack_buffer_));
    // Size 0 stands for "the whole buffer" or for none. GlStateGuard then restores the plain binding.
    for (int i = 0; i < kBlockCount; ++i) {
        const auto binding = static_cast<GLuint>(i);
        const auto buffer = static_cast<GLuint>(block_buffer_[i]);
        if (block_size_[i] > 0) {
            glBindBufferRange(GL_UNIFORM_BUFFER, binding, buffer, static_cast<GLintptr>(block_offset_[i]),
                              static_cast<GLsizeiptr>(block_size_[i]));
        } else {
            glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer);
        }
    }
    if (!gles) {
        glPolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygon_mode_));
        glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, point_origin_);
    }
}

}  // namespace relief
