// SPDX-License-Identifier: Apache-2.0
#include "runtime/gl/gl_object.h"

#include <algorithm>
#include <cstdio>
#include <glm/glm.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "shaders/shader_sources.h"
#include "shaders/shader_text.h"

namespace relief {
namespace {

std::string infoLog(GLuint name, bool is_program) {
    GLint length = 0;
    (is_program ? glGetProgramiv : glGetShaderiv)(name, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    (is_program ? glGetProgramInfoLog : glGetShaderInfoLog)(name, length, nullptr, log.data());
    while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) {
        log.pop_back();
    }
    std::replace(log.begin(), log.end(), '\n', ' ');  // messages are one line
    return log;
}

/// Starts to compile a shader.
Result<GLuint> compile(GLenum stage, std::string_view file, std::string_view defines) {
    const std::string body = RELIEF_TRY(includedShader(file));
    // Use highp everywhere: state and depth are 32-bit floats, and ES 3.0 requires a precision in fragment shaders.
    const bool compute = stage == GL_COMPUTE_SHADER;
    std::string source = isGles() ? (compute ? "#version 310 es\n" : "#version 300 es\n")
                                  : (compute ? "#version 430 core\n" : "#version 330 core\n");
    source += shaderConstants();
    source += compute ? "#define RELIEF_COMPUTE\n" : "";
    source += defines;
    source +=
        "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
        "precision highp usampler2D;\nprecision highp sampler3D;\n";
    source += "#line 1\n";
    source += body;

    const GLuint shader = glCreateShader(stage);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    return shader;
}

GLuint generate(void (*create)(GLsizei, GLuint*)) {
    GLuint name = 0;
    create(1, &name);
    return name;
}

}  // namespace

namespace gl_detail {

void deleteTexture(GLuint name) {
    glDeleteTextures(1, &name);
}
void deleteFramebuffer(GLuint name) {
    glDeleteFramebuffers(1, &name);
}
void deleteBuffer(GLuint name) {
    glDeleteBuffers(1, &name);
}
void deleteVertexArray(GLuint name) {
    glDeleteVertexArrays(1, &name);
}
void deleteProgram(GLuint name) {
    glDeleteProgram(name);
}
void deleteShader(GLuint name) {
    glDeleteShader(name);  // takes effect once no program uses it
}
void deleteSampler(GLuint name) {
    glDeleteSamplers(1, &name);
}

}  // namespace gl_detail

// libepoxy's entry points are function pointers behind macros, hence the lambdas.
GlFramebuffer makeFramebuffer() {
    return GlFramebuffer(generate([](GLsizei n, GLuint* out) { glGenFramebuffers(n, out); }));
}
GlBuffer makeBuffer() {
    return GlBuffer(generate([](GLsizei n, GLuint* out) { glGenBuffers(n, out); }));
}
void bindPackBuffer(GlBuffer& buffer, GLsizeiptr bytes) {
    if (!buffer) {
        buffer = makeBuffer();
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer.name());
    glBufferData(GL_PIXEL_PACK_BUFFER, bytes, nullptr, GL_STREAM_READ);
}
GlVertexArray makeVertexArray() {
    return GlVertexArray(generate([](GLsizei n, GLuint* out) { glGenVertexArrays(n, out); }));
}
GlSampler makeSampler() {
    GlSampler sampler(generate([](GLsizei n, GLuint* out) { glGenSamplers(n, out); }));
    glSamplerParameteri(sampler.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glSamplerParameteri(sampler.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return sampler;
}
namespace {

/// Creates a texture with nearest filter and clamping, bound to GL_TEXTURE_2D of the active unit during its lifetime.
class NewTexture2D {
  public:
    NewTexture2D() : texture_(generate([](GLsizei n, GLuint* out) { glGenTextures(n, out); })) {
        glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound_);
        glBindTexture(GL_TEXTURE_2D, texture_.name());
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
    GlTexture done() {
        glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound_));
        return std::move(texture_);
    }

  private:
    GlTexture texture_;
    GLint bound_ = 0;
};

}  // namespace

GlTexture makeTexture2D(GLenum internal_format, GLsizei width, GLsizei height, GLenum format, GLenum type,
                        const void* pixels) {
    NewTexture2D texture;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal_format), width, height, 0, format, type,
                 pixels);
    return texture.done();
}

GlTexture makeImageTexture2D(GLenum internal_format, GLsizei width, GLsizei height) {
    NewTexture2D texture;
    glTexStorage2D(GL_TEXTURE_2D, 1, internal_format, width, height);
    return texture.done();
}

GlTexture makeTexture3D(GLenum internal_format, const glm::ivec3& size, GLenum format, GLenum type,
                        GLenum filter, const void* pixels) {
    GlTexture texture(generate([](GLsizei n, GLuint* out) { glGenTextures(n, out); }));
    GLint bound = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_3D, &bound);
    glBindTexture(GL_TEXTURE_3D, texture.name());
    for (const GLenum parameter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
        glTexParameteri(GL_TEXTURE_3D, parameter, static_cast<GLint>(filter));
    }
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
        glTexParameteri(GL_TEXTURE_3D, wrap, GL_CLAMP_TO_EDGE);
    }
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAX_LEVEL, 0);
    glTexImage3D(GL_TEXTURE_3D, 0, static_cast<GLint>(internal_format), size.x, size.y, size.z, 0, format,
                 type, pixels);
    glBindTexture(GL_TEXTURE_3D, static_cast<GLuint>(bound));
    return texture;
}

Result<GlFramebuffer> makeFramebuffer(std::span<const GLuint> color_textures, GLuint depth_texture) {
    GlFramebuffer framebuffer = makeFramebuffer();
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer.name());
    std::vector<GLenum> draw_buffers;
    for (const GLuint texture : color_textures) {
        const auto attachment = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + draw_buffers.size());
        glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
        draw_buffers.push_back(attachment);
    }
    if (depth_texture != 0) {
        glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_texture, 0);
    }
    glDrawBuffers(static_cast<GLsizei>(draw_buffers.size()), draw_buffers.data());
    const GLenum status = glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(bound));
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        char text[96];
        std::snprintf(text, sizeof(text),
                      "this GL context cannot render to the required textures (status 0x%04x)", status);
        return fail(ErrorCode::kUnsupported, text);
    }
    return framebuffer;
}

namespace {

struct Stage {
    GLenum stage;
    std::string_view file;
};

/// Starts to compile and link a program. Reads no status: drivers wait for their compiler before they return one.
/// \param outputs  vertex shader outputs that transform feedback writes, interleaved; empty: none.
Result<StartedProgram> start(std::initializer_list<Stage> stages, std::string_view defines,
                             std::span<const char* const> outputs = {}) {
    StartedProgram started{GlProgram(glCreateProgram()), {}};
    for (const Stage& one : stages) {
        const GLuint shader = RELIEF_TRY(compile(one.stage, one.file, defines));
        started.shaders.push_back({GlName<gl_detail::deleteShader>(shader), std::string(one.file)});
        glAttachShader(started.program.name(), shader);
    }
    if (!outputs.empty()) {
        glTransformFeedbackVaryings(started.program.name(), static_cast<GLsizei>(outputs.size()),
                                    outputs.data(), GL_INTERLEAVED_ATTRIBS);
    }
    glLinkProgram(started.program.name());
    return started;
}

Result<GlProgram> finished(Result<StartedProgram> started) {
    return started ? started->finish() : forward(started);
}

}  // namespace

Result<GlProgram> StartedProgram::finish() {
    GLint linked = GL_FALSE;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
    if (linked == GL_TRUE) {
        return std::move(program);
    }
    std::string files;
    for (const auto& [shader, file] : shaders) {
        GLint compiled = GL_FALSE;
        glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
        if (compiled != GL_TRUE) {
            return fail(ErrorCode::kFailure,
                        "shader " + file + " does not compile: " + infoLog(shader.name(), false));
        }
        files += (files.empty() ? "" : " + ") + file;
    }
    return fail(ErrorCode::kFailure, "program " + files + " does not link: " + infoLog(program.name(), true));
}

void GlProgram::use() const {
    glUseProgram(name());
}

GLint GlProgram::location(const char* uniform) const {
    const auto found = locations_.find(uniform);
    return found != locations_.end()
               ? found->second
               : locations_.emplace(uniform, glGetUniformLocation(name(), uniform)).first->second;
}

void GlProgram::set(const char* uniform, bool value) const {
    glUniform1i(location(uniform), value ? 1 : 0);
}
void GlProgram::set(const char* uniform, GLint value) const {
    glUniform1i(location(uniform), value);
}
void GlProgram::set(const char* uniform, GLuint value) const {
    glUniform1ui(location(uniform), value);
}
void GlProgram::set(const char* uniform, float value) const {
    glUniform1f(location(uniform), value);
}
void GlProgram::set(const char* uniform, const glm::vec2& value) const {
    glUniform2fv(location(uniform), 1, glm::value_ptr(value));
}
void GlProgram::set(const char* uniform, const glm::vec3& value) const {
    glUniform3fv(location(uniform), 1, glm::value_ptr(value));
}
void GlProgram::set(const char* uniform, const glm::ivec2& value) const {
    glUniform2iv(location(uniform), 1, glm::value_ptr(value));
}
void GlProgram::set(const char* uniform, const glm::ivec3& value) const {
    glUniform3iv(location(uniform), 1, glm::value_ptr(value));
}
void GlProgram::set(const char* uniform, const glm::mat3& value) const {
    glUniformMatrix3fv(location(uniform), 1, GL_FALSE, glm::value_ptr(value));
}
void GlProgram::set(const char* uniform, const glm::mat4& value) const {
    glUniformMatrix4fv(location(uniform), 1, GL_FALSE, glm::value_ptr(value));
}
void GlProgram::set(const char* uniform, std::span<const GLint> values) const {
    glUniform1iv(location(uniform), static_cast<GLsizei>(values.size()), values.data());
}
void GlProgram::set(const char* uniform, std::span<const float> values) const {
    glUniform1fv(location(uniform), static_cast<GLsizei>(values.size()), values.data());
}
void GlProgram::set(const char* uniform, std::span<const glm::vec4> values) const {
    glUniform4fv(location(uniform), static_cast<GLsizei>(values.size()), &values[0].x);
}

void GlProgram::drawScreen() const {
    if (!no_attributes_) {
        no_attributes_ = makeVertexArray();
    }
    use();
    glBindVertexArray(no_attributes_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void GlProgram::drawScreen(GLuint framebuffer, GLsizei width, GLsizei height) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width, height);
    drawScreen();
}

Result<GlProgram> makeProgram(std::string_view vertex, std::string_view fragment, std::string_view defines) {
    return finished(start({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}}, defines));
}

Result<StartedProgram> startScreenProgram(std::string_view fragment, std::string_view defines) {
    return start({{GL_VERTEX_SHADER, "base/quad.vert"}, {GL_FRAGMENT_SHADER, fragment}}, defines);
}

Result<GlProgram> makeScreenProgram(std::string_view fragment, std::string_view defines) {
    return finished(startScreenProgram(fragment, defines));
}

Result<StartedProgram> startComputeProgram(std::string_view compute, std::string_view defines) {
    return start({{GL_COMPUTE_SHADER, compute}}, defines);
}

Result<GlProgram> makeComputeProgram(std::string_view compute, std::string_view defines) {
    return finished(startComputeProgram(compute, defines));
}

Result<GlProgram> makeFeedbackProgram(std::string_view vertex, std::span<const char* const> outputs,
                                      std::string_view defines) {
    return finished(
        start({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, "base/nothing.frag"}}, defines, outputs));
}

void copyBuffer(const GlBuffer& from, const GlBuffer& to, GLsizeiptr to_offset, GLsizeiptr bytes) {
    GLint bound[2] = {};
    glGetIntegerv(GL_COPY_READ_BUFFER_BINDING, &bound[0]);
    glGetIntegerv(GL_COPY_WRITE_BUFFER_BINDING, &bound[1]);
    glBindBuffer(GL_COPY_READ_BUFFER, from.name());
    glBindBuffer(GL_COPY_WRITE_BUFFER, to.name());
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, to_offset, bytes);
    glBindBuffer(GL_COPY_READ_BUFFER, static_cast<GLuint>(bound[0]));
    glBindBuffer(GL_COPY_WRITE_BUFFER, static_cast<GLuint>(bound[1]));
}

void useTexture3D(int unit, const GlTexture& texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_3D, texture.name());
}

void useTexture(int unit, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture);
}

Result<std::vector<float>> readTextureFloats(const GlTexture& texture, GLsizei width, GLsizei height) {
    GlFramebuffer framebuffer = makeFramebuffer();
    GLint bound = 0;
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &bound);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.name());
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.name(), 0);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    std::vector<float> values(std::size_t{4} * static_cast<std::size_t>(width) *
                              static_cast<std::size_t>(height));
    const bool complete = glCheckFramebufferStatus(GL_READ_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    if (complete) {
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, values.data());
    }
    const Result<void> alive = checkGpu("reading a texture back");
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(bound));
    if (!complete) {
        return fail(ErrorCode::kUnsupported, "this GL context cannot read back float textures");
    }
    if (!alive) {
        return forward(alive);
    }
    return values;
}

}  // namespace relief
