// SPDX-License-Identifier: Apache-2.0
// OpenGL names as move-only values. Constructors need a current context, as do destructors of non-empty objects.
// Functions restore all bindings that they change unless documented otherwise.
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
void deleteShader(GLuint name);
void deleteSampler(GLuint name);
}  // namespace gl_detail

using GlTexture = GlName<gl_detail::deleteTexture>;
using GlFramebuffer = GlName<gl_detail::deleteFramebuffer>;
using GlBuffer = GlName<gl_detail::deleteBuffer>;
using GlVertexArray = GlName<gl_detail::deleteVertexArray>;
using GlSampler = GlName<gl_detail::deleteSampler>;

/// A program; linked, unless it belongs to a StartedProgram.
class GlProgram : public GlName<gl_detail::deleteProgram> {
  public:
    using GlName::GlName;
    /// Makes the program current, as required by set().
    void use() const;
    /// Returns the location of a uniform; −1, which the GL's setters ignore, if the program does not use it.
    [[nodiscard]] GLint location(const char* uniform) const;
    /// Sets a uniform; no effect if the program does not use it.
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
    /// (0, 0) … (width − 1, height − 1) of a framebuffer, which stays bound. Leaves program and vertex array bound.
    void drawScreen() const;
    void drawScreen(GLuint framebuffer, GLsizei width, GLsizei height) const;

  private:
    mutable std::map<std::string, GLint, std::less<>> locations_;  // cached so far
    mutable GlVertexArray no_attributes_;                          // for drawScreen()
};

/// A program that the driver may still compile in the background.
struct StartedProgram {
    struct Shader {
        GlName<gl_detail::deleteShader> shader;
        std::string file;
    };
    GlProgram program;
    std::vector<Shader> shaders;

    /// Waits for the driver. Call it once. Errors: kFailure, with the file name and the driver's log.
    [[nodiscard]] Result<GlProgram> finish();
};

[[nodiscard]] GlFramebuffer makeFramebuffer();
[[nodiscard]] GlBuffer makeBuffer();
/// Binds the buffer as GL_PIXEL_PACK_BUFFER, with new memory for one read-back; creates it if empty.
void bindPackBuffer(GlBuffer& buffer, GLsizeiptr bytes);
[[nodiscard]] GlVertexArray makeVertexArray();
/// Returns a sampler with nearest filter, clamping and no comparison, to read a caller's texture unmodified.
[[nodiscard]] GlSampler makeSampler();

/// Creates a 2-D texture with one level, nearest filter and clamping; contents are undefined if `pixels` is null.
/// \param format, type  of `pixels`, tightly packed rows from y = 0. Must be valid even if `pixels` is null.
[[nodiscard]] GlTexture makeTexture2D(GLenum internal_format, GLsizei width, GLsizei height, GLenum format,
                                      GLenum type, const void* pixels = nullptr);

/// Creates an immutable 2-D texture for compute shaders to write to. Requires hasCompute().
[[nodiscard]] GlTexture makeImageTexture2D(GLenum internal_format, GLsizei width, GLsizei height);

/// Creates a 3-D texture. \param filter  GL_NEAREST or GL_LINEAR.
[[nodiscard]] GlTexture makeTexture3D(GLenum internal_format, const glm::ivec3& size, GLenum format,
                                      GLenum type, GLenum filter, const void* pixels = nullptr);

/// Creates a framebuffer with these colour attachments as draw buffers, in order, and an optional depth texture.
/// Errors: kUnsupported, with the status, if the GL cannot render to that combination.
[[nodiscard]] Result<GlFramebuffer> makeFramebuffer(std::span<const GLuint> color_textures,
                                                    GLuint depth_texture = 0);
[[nodiscard]] inline Result<GlFramebuffer> makeFramebuffer(std::initializer_list<GLuint> color_textures,
                                                           GLuint depth_texture = 0) {
    return makeFramebuffer(std::span(color_textures.begin(), color_textures.size()), depth_texture);
}

/// Compiles and links a program from sources in a subset of GLSL ES 3.00. Prepends the version line of the current
/// context (`#version 330 core` or `#version 300 es`), shaderConstants() and precision statements.
/// \param vertex, fragment  paths in shaders/, for example "base/quad.vert".
/// \param defines  lines inserted after the constants, such as "#define RELIEF_X 1\n".
/// Errors: kFailure, with the file name and the driver's log.
[[nodiscard]] Result<GlProgram> makeProgram(std::string_view vertex, std::string_view fragment,
                                            std::string_view defines = {});

/// Creates a program from "base/quad.vert" and a fragment shader. GlProgram::drawScreen() runs it over a rectangle of
/// pixels.
[[nodiscard]] Result<GlProgram> makeScreenProgram(std::string_view fragment, std::string_view defines = {});
[[nodiscard]] Result<StartedProgram> startScreenProgram(std::string_view fragment,
                                                        std::string_view defines = {});

/// Creates a program from a compute shader in the same subset of GLSL. Its version line is `#version 430 core` or
/// `#version 310 es`, and RELIEF_COMPUTE is defined. Requires hasCompute(). Errors: those of makeProgram.
[[nodiscard]] Result<GlProgram> makeComputeProgram(std::string_view compute, std::string_view defines = {});
[[nodiscard]] Result<StartedProgram> startComputeProgram(std::string_view compute,
                                                         std::string_view defines = {});

/// Creates a program with only a vertex shader. Transform feedback writes its `outputs` interleaved, in order. Errors:
/// those of makeProgram.
[[nodiscard]] Result<GlProgram> makeFeedbackProgram(std::string_view vertex,
                                                    std::span<const char* const> outputs,
                                                    std::string_view defines = {});

/// Reads level 0 of a 2-D float texture back as RGBA: 4 · width · height floats.
[[nodiscard]] Result<std::vector<float>> readTextureFloats(const GlTexture& texture, GLsizei width,
                                                           GLsizei height);

/// Copies bytes on the GPU, from the start of buffer `from` to `to_offset` in buffer `to`.
void copyBuffer(const GlBuffer& from, const GlBuffer& to, GLsizeiptr to_offset, GLsizeiptr bytes);

/// Binds a 3-D texture to a texture unit and leaves that unit active.
void useTexture3D(int unit, const GlTexture& texture);

/// Binds a 2-D texture to a texture unit and leaves that unit active.
void useTexture(int unit, GLuint texture);
inline void useTexture(int unit, const GlTexture& texture) {
    useTexture(unit, texture.name());
}

}  // namespace relief
