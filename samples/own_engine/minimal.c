/* SPDX-License-Identifier: Apache-2.0 */
/* The minimum an engine needs for a collider: no JSON, no Relief library. Sizes follow from the block and the files.
 *     relief export bunny.relief --gpu bunny/
 *     minimal bunny 0 0.1 0        distance to the deciding plane, normal */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <stdio.h>
#include <stdlib.h>

static char* load(const char* folder, const char* name, long* size) { /* NULL: no map needs the file */
    char path[4096];
    snprintf(path, sizeof(path), "%s/%s", folder, name);
    FILE* file = fopen(path, "rb");
    if (!file) return NULL;
    fseek(file, 0, SEEK_END), *size = ftell(file), rewind(file);
    char* bytes = calloc((size_t)*size + 1, 1);
    if (fread(bytes, 1, (size_t)*size, file) != (size_t)*size) exit(1);
    fclose(file);
    return bytes;
}

static GLuint texture(int unit, GLenum internal, GLenum format, GLenum type, int width, int height, const void* texels) {
    GLuint name;
    glGenTextures(1, &name), glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST); /* one level */
    glTexImage2D(GL_TEXTURE_2D, 0, (GLint)internal, width, height, 0, format, type, texels);
    return name;
}

static void attach(GLuint program, GLenum stage, const char* collider, const char* body) {
    const char* parts[] = {"#version 300 es\nprecision highp float;\nprecision highp int;\n"
                           "precision highp sampler2D;\nprecision highp usampler2D;\n", collider, body};
    GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 3, parts, NULL), glCompileShader(shader);
    glAttachShader(program, shader);
}

int main(int argc, char** argv) {
    long size = 0;
    int* block = argc == 5 ? (int*)load(argv[1], "block.bin", &size) : NULL;
    char* glsl = block ? load(argv[1], "collider.glsl", &(long){0}) : NULL;
    if (!glsl) return fprintf(stderr, "usage: minimal FOLDER X Y Z\n"), 1;
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    eglInitialize(display, NULL, NULL), eglBindAPI(EGL_OPENGL_ES_API);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, eglCreateContext(display, EGL_NO_CONFIG_KHR, NULL, version));
    GLuint program = glCreateProgram(), buffer, framebuffer;
    attach(program, GL_VERTEX_SHADER, "", "void main() { gl_Position = vec4(0, 0, 0, 1); gl_PointSize = 1.0; }\n");
    attach(program, GL_FRAGMENT_SHADER, glsl, "uniform vec3 u_p; layout(location = 0) out vec4 o;\n"
           "void main() { ReliefField f = reliefEvaluate(u_p); o = vec4(f.distance, f.normal); }\n");
    glLinkProgram(program), glUseProgram(program);
    glGenBuffers(1, &buffer), glGenFramebuffers(1, &framebuffer);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer);
    glBufferData(GL_UNIFORM_BUFFER, size, block, GL_STATIC_DRAW);
    glUniformBlockBinding(program, glGetUniformBlockIndex(program, "ReliefMaps"), 0);
    const struct { const char *file, *sampler; GLenum internal, format, type; int bytes; } kinds[3] = {
        {"float.bin", "u_relief_float", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
        {"fixed.bin", "u_relief_fixed", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4},
        {"front_back.bin", "u_relief_front_back", GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, 8}};
    for (int i = 0; i < 3; ++i) {
        const char* texels = load(argv[1], kinds[i].file, &size);
        int width = texels ? 1 << block[1 + i] : 1; /* the block: maps, then log2 of the three widths */
        int height = texels ? (int)(size / kinds[i].bytes / width) : 1;
        texture(i, kinds[i].internal, kinds[i].format, kinds[i].type, width, height, texels);
        glUniform1i(glGetUniformLocation(program, kinds[i].sampler), i);
    }
    GLuint target = texture(3, GL_RGBA32F, GL_RGBA, GL_FLOAT, 1, 1, NULL);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    glUniform3f(glGetUniformLocation(program, "u_p"), (float)atof(argv[2]), (float)atof(argv[3]), (float)atof(argv[4]));
    glViewport(0, 0, 1, 1);
    glDrawArrays(GL_POINTS, 0, 1);
    float field[4];
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_FLOAT, field);
    printf("%.9g,%.9g,%.9g,%.9g\n", field[0], field[1], field[2], field[3]);
    return glGetError() != GL_NO_ERROR;
}
