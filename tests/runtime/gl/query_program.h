// SPDX-License-Identifier: Apache-2.0
// Programs for tests that evaluate one of Relief's shaders at the texels of a picture.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"
#include "shaders/shader_text.h"
#include "tests/results.h"

namespace relief {

/// Makes a program for GlProgram::drawScreen().
/// \param file  in shaders/. \param text  appended to the file; contains main().
inline Result<GlProgram> makeQueryProgram(std::string_view file, std::string_view text,
                                          const std::string& defines = {}) {
    const std::string head = std::string(isGles() ? "#version 300 es\n" : "#version 330 core\n") + defines +
                             "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
                             "precision highp usampler2D;\nprecision highp sampler3D;\n";
    const std::string vertex = head + RELIEF_TRY(shaderText("base/quad.vert"));
    const std::string fragment = head + RELIEF_TRY(shaderText(file)) + std::string(text);
    GlProgram program(glCreateProgram());
    for (const auto& [stage, source] :
         {std::pair(GL_VERTEX_SHADER, vertex.c_str()), {GL_FRAGMENT_SHADER, fragment.c_str()}}) {
        const GLuint shader = glCreateShader(stage);
        glShaderSource(shader, 1, &source, nullptr);
        glCompileShader(shader);
        glAttachShader(program.name(), shader);
        glDeleteShader(shader);
    }
    glLinkProgram(program.name());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
        std::string log(4096, '\0');
        glGetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
        return fail(ErrorCode::kFailure, log);
    }
    return program;
}

/// Draws a program that writes a vec4 over a picture. \return RGBA of each pixel
inline std::vector<float> drawnFloats(const GlProgram& program, GLsizei width, GLsizei height) {
    const GlTexture output = makeTexture2D(GL_RGBA32F, width, height, GL_RGBA, GL_FLOAT);
    const GlFramebuffer target = required(makeFramebuffer({output.name()}));
    program.drawScreen(target.name(), width, height);
    return required(readTextureFloats(output, width, height));
}

}  // namespace relief
