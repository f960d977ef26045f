// SPDX-License-Identifier: Apache-2.0
// OpenGL names as move-only values. Every constructor needs a current context, and so does every destructor
// of a non-empty object. Nothing here binds more than it must; what is bound is restored.
#pragma once

#include <glm/fwd.hpp>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/base/result.h"
#include "runtime/gl/gl_types.h"

namespace relief {

/// Owns one GL name; `Delete` frees it. Name 0 means empty.
template <void (*Delete)(GLuint)>
class GlName {
  public:
    GlName() = default;
    explicit GlName(GLuint name) : name_(name) {}
    GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlName& operator=(GlName&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    GlName(const GlName&) = delete;
    GlName& operator=(const GlName&) = delete;
    ~GlName() {
        if (name_ != 0) {
            Delete(name_);
        }
    }
    [[nodiscard]] GLuint name() const { return name_; }
    [[nodiscard]] explicit operator bool() const { return name_ != 0; }

  private:
    GLuint name_ = 0;
};

namespace gl_detail {
void deleteTexture(GLuint name);
void deleteFramebuffer(GLuint name);
void deleteBuffer(GLuint name);
void deleteVertexArray(GLuint name);
void deleteProgram(GLuint name);
void deleteSampler(GLuint name);
}  // namespace gl_detail

using GlTexture = GlName<gl_detail::deleteTexture>;
using GlFramebuffer = GlName<gl_detail::deleteFramebuffer>;
using GlBuffer = GlName<gl_detail::deleteBuffer>;
using GlVertexArray = GlName<gl_detail::deleteVertexArray>;
using GlSampler = GlName<gl_detail::deleteSampler>;

/// A linked program.
class GlProgram : public GlName<gl_detail::deleteProgram> {
  public:
    using GlName::GlName;
    /// Makes it current, as set() needs it.
    void use() const;
    /// Location of a uniform; −1 where the program does not use it, which the GL's setters ignore.
    [[nodiscard]] GLint location(const char* uniform) const;
    /// Sets a uniform; without effect where the program does not use it.
    void set(const char* uniform, bool value) const;
    void set(const char* uniform, GLint value) const;
    void set(const char* uniform, GLuint value) const;
    void set(const char* uniform, float value) const;
    void set(const char* uniform, const glm::vec2& value) const;
    void set(const char* uniform, const glm::vec3& value) const;
    void set(const char* uniform, const glm::ivec2& value) const;
    void set(const char* uniform, const glm::ivec3& value) const;
    void set(const char* uniform, const glm::mat3& value) const;
    void set(const char* uniform, const glm::mat4& value) const;
    void set(const char* uniform, std::span<const GLint> values) const;
    void set(const char* uniform, std::span<const float> values) const;
    void set(const char* uniform, std::span<const glm::vec4> values) const;

    /// Runs the fragment shader of makeScreenProgram() over the viewport of the bound framebuffer, or over the pixels
    /// (0, 0) … (width − 1, height − 1) of one, which it leaves bound. Leaves program and vertex array bound.
    void drawScreen() const;
    void drawScreen(GLuint framebuffer, GLsizei width, GLsizei height) const;

  private:
    mutable std::map<std::string, GLint, std::less<>> locations_;  // of uniforms so far
    mutable GlVertexArray no_attributes_;                          // of drawScreen()
};

[[nodiscard]] GlFramebuffer makeFramebuffer();
[[nodiscard]] GlBuffer makeBuffer();
/// Binds it as GL_PIXEL_PACK_BUFFER, made if it is empty, with new memory that the GPU writes and the CPU reads once.
void bindPackBuffer(GlBuffer& buffer, GLsizeiptr bytes);
[[nodiscard]] GlVertexArray makeVertexArray();
/// Nearest filter, clamped, and no comparing: to read a texture of the caller's as it is.
[[nodiscard]] GlSampler makeSampler();

/// A 2-D texture of one level, nearest filter, clamped to its edge; contents undefined unless given.
/// \param format, type  of `pixels`, tightly packed rows from y = 0; used for allocation alone if it is null.
[[nodiscard]] GlTexture makeTexture2D(GLenum internal_format, GLsizei width, GLsizei height, GLenum format,
                                      GLenum type, const void* pixels = nullptr);

/// The same, immutable, for compute shaders to write to; where hasCompute().
[[nodiscard]] GlTexture makeImageTexture2D(GLenum internal_format, GLsizei width, GLsizei height);

/// The same in 3-D. \param filter  GL_NEAREST or GL_LINEAR.
[[nodiscard]] GlTexture makeTexture3D(GLenum internal_format, const glm::ivec3& size, GLenum format,
                                      GLenum type, GLenum filter, const void* pixels = nullptr);

/// A framebuffer with these colour attachments, in order, and an optional depth texture, as draw buffers.
/// Errors: kUnsupported, with the status, if the GL does not render to that combination.
[[nodiscard]] Result<GlFramebuffer> makeFramebuffer(std::span<const GLuint> color_textures,
                                                    GLuint depth_texture = 0);
[[nodiscard]] inline Result<GlFramebuffer> makeFramebuffer(std::initializer_list<GLuint> color_textures,
                                                           GLuint depth_texture = 0) {
    return makeFramebuffer(std::span(color_textures.begin(), color_textures.size()), depth_texture);
}

/// Compiles and links a program from GLSL ES 3.00 subset sources. In front come the version line of the current
/// context, `#version 330 core` or `#version 300 es`, shaderConstants() and precision statements.
/// \param vertex, fragment  paths in shaders/, for example "base/quad.vert".
/// \param defines  lines put behind the constants, such as "#define RELIEF_X 1\n".
/// Fails with kFailure, the driver's log and the file's name.
[[nodiscard]] Result<GlProgram> makeProgram(std::string_view vertex, std::string_view fragment,
                                            std::string_view defines = {});

/// The same of a fragment shader over whole rectangles of pixels, by "base/quad.vert": for GlProgram::drawScreen().
[[nodiscard]] Result<GlProgram> makeScreenProgram(std::string_view fragment, std::string_view defines = {});

/// A program of a compute shader, from the same subset of GLSL; its version line is `#version 430 core` or
/// `#version 310 es`, and RELIEF_COMPUTE is defined. Where hasCompute(). Fails as makeProgram does.
[[nodiscard]] Result<GlProgram> makeComputeProgram(std::string_view compute, std::string_view defines = {});

/// A program of a vertex shader alone, whose outputs transform feedback writes, interleaved in their order.
/// Fails as makeProgram does.
[[nodiscard]] Result<GlProgram> makeFeedbackProgram(std::string_view vertex,
                                                    std::span<const char* const> outputs,
                                                    std::string_view defines = {});

/// Reads a texture (level 0 of a 2-D texture of a float format) back as RGBA floats, 4 · width · height.
[[nodiscard]] Result<std::vector<float>> readTextureFloats(const GlTexture& texture, GLsizei width,
                                                           GLsizei height);

/// Copies bytes of one buffer to another on the GPU.
void copyBuffer(const GlBuffer& from, const GlBuffer& to, GLsizeiptr to_offset, GLsizeiptr bytes);

/// Binds a 3-D texture to texture unit `unit` and leaves that unit active.
void useTexture3D(int unit, const GlTexture& texture);

/// Binds a 2-D texture to texture unit `unit` and leaves that unit active.
void useTexture(int unit, GLuint texture);
inline void useTexture(int unit, const GlTexture& texture) {
    useTexture(unit, texture.name());
}

}  // namespace relief
