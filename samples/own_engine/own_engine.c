/* SPDX-License-Identifier: Apache-2.0 */
/* A collider in your own engine: OpenGL ES 3.0, jansson for the JSON, no Relief library.
 *
 *     relief export bunny.relief --gpu bunny/
 *     own_engine bunny/ points.csv            x,y,z,f,nx,ny,nz,map of every point, as `relief query --distance plane`
 *     own_engine bunny/ points.csv --fall     the position of each point after it falls for five seconds
 *
 * runtime/layout/LAYOUT.md describes the files. */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void need(int ok, const char* what) {
    if (!ok) {
        fprintf(stderr, "own_engine: %s\n", what);
        exit(1);
    }
}

static char* readFile(const char* folder, const char* name, long* size) {
    char path[4096];
    snprintf(path, sizeof(path), "%s%s%s", folder, *folder ? "/" : "", name);
    FILE* file = fopen(path, "rb");
    need(file != NULL, path);
    fseek(file, 0, SEEK_END);
    *size = ftell(file);
    rewind(file);
    char* bytes = calloc((size_t)*size + 1, 1);
    need(fread(bytes, 1, (size_t)*size, file) == (size_t)*size, path);
    fclose(file);
    return bytes;
}

static void makeContext(void) {
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    need(eglInitialize(display, NULL, NULL) && eglBindAPI(EGL_OPENGL_ES_API), "cannot initialise EGL");
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    need(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context), "no OpenGL ES 3.0");
}

/* Nearest filtering, one level, as collider.glsl requires. */
static GLuint makeTexture(GLenum internal, GLenum format, GLenum type, int width, int height, const void* texels) {
    GLuint name;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glTexImage2D(GL_TEXTURE_2D, 0, (GLint)internal, width, height, 0, format, type, texels);
    return name;
}

static GLuint compile(GLenum stage, const char* collider, const char* body) {
    const char* parts[] = {"#version 300 es\nprecision highp float;\nprecision highp int;\n"
                           "precision highp sampler2D;\nprecision highp usampler2D;\n",
                           collider, body};
    GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 3, parts, NULL);
    glCompileShader(shader);
    GLint compiled;
    char log[4096] = "";
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    glGetShaderInfoLog(shader, sizeof(log), NULL, log);
    need(compiled, log);
    return shader;
}

static const char* kVertex =
    "void main() { gl_Position = vec4(vec2[](vec2(-1, -1), vec2(3, -1), vec2(-1, 3))[gl_VertexID], 0, 1); }\n";

/* Semi-implicit Euler. A particle inside moves back to the surface, and keeps 0.3 of its tangential velocity. */
static const char* kFragment =
    "uniform sampler2D u_points;\n"
    "uniform int u_steps;\n"
    "uniform float u_size;\n"
    "layout(location = 0) out vec4 o_field;\n"
    "layout(location = 1) out vec4 o_map;\n"
    "void main() {\n"
    "    vec3 p = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0).xyz;\n"
    "    vec3 v = vec3(0.0);\n"
    "    for (int i = 0; i < u_steps; ++i) {\n"
    "        v.y -= u_size / 60.0;\n"
    "        p += v / 60.0;\n"
    "        ReliefField field = reliefEvaluate(p);\n"
    "        if (reliefInside(field)) {\n"
    "            p -= field.distance * field.normal;\n"
    "            v = 0.3 * (v - dot(v, field.normal) * field.normal);\n"
    "        }\n"
    "    }\n"
    "    ReliefField field = reliefEvaluate(p);\n"
    "    o_field = u_steps > 0 ? vec4(p, 0.0) : vec4(field.normal, field.distance);\n"
    "    o_map = vec4(field.map);\n"
    "}\n";

int main(int argc, char** argv) {
    need(argc >= 3, "usage: own_engine FOLDER points.csv [--fall]");
    makeContext();
    long size;
    json_t* all = json_loads(readFile(argv[1], "gpu.json", &size), 0, NULL);
    need(all && json_integer_value(json_object_get(all, "format")) == 1, "gpu.json is not of format 1");

    char* glsl = readFile(argv[1], json_string_value(json_object_get(all, "glsl")), &size);
    GLuint program = glCreateProgram();
    glAttachShader(program, compile(GL_VERTEX_SHADER, "", kVertex));
    glAttachShader(program, compile(GL_FRAGMENT_SHADER, glsl, kFragment));
    glLinkProgram(program);
    glUseProgram(program);

    size_t unit;
    json_t* one;
    json_array_foreach(json_object_get(all, "textures"), unit, one) {
        const char* file = json_string_value(json_object_get(one, "file")); /* NULL if no map uses this texture */
#define NUMBER(key) (int)json_integer_value(json_object_get(one, key))
        glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
        makeTexture((GLenum)NUMBER("internal_format"), (GLenum)NUMBER("format"), (GLenum)NUMBER("type"),
                    NUMBER("width"), NUMBER("height"), file ? readFile(argv[1], file, &size) : NULL);
        const char* sampler = json_string_value(json_object_get(one, "sampler"));
        glUniform1i(glGetUniformLocation(program, sampler), (GLint)unit);
    }
    json_t* block = json_object_get(all, "block");
    char* bytes = readFile(argv[1], json_string_value(json_object_get(block, "file")), &size);
    GLuint buffer;
    glGenBuffers(1, &buffer);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer);
    glBufferData(GL_UNIFORM_BUFFER, size, bytes, GL_STATIC_DRAW);
    const char* name = json_string_value(json_object_get(block, "name"));
    glUniformBlockBinding(program, glGetUniformBlockIndex(program, name), 0);

    enum { kSide = 128 };
    static float points[kSide * kSide][4], fields[kSide * kSide][4], maps[kSide * kSide][4];
    char* line = strtok(readFile("", argv[2], &size), "\n");
    int count = 0;
    for (; line && count < kSide * kSide; line = strtok(NULL, "\n")) {
        count += sscanf(line, "%f,%f,%f", &points[count][0], &points[count][1], &points[count][2]) == 3;
    }
    glActiveTexture(GL_TEXTURE3);
    makeTexture(GL_RGBA32F, GL_RGBA, GL_FLOAT, kSide, kSide, points);
    GLuint target[2], framebuffer;
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glActiveTexture(GL_TEXTURE4);
    for (int i = 0; i < 2; ++i) {
        target[i] = makeTexture(GL_RGBA32F, GL_RGBA, GL_FLOAT, kSide, kSide, NULL);
        glFramebufferTexture2D(GL_FRAMEBUFFER, both[i], GL_TEXTURE_2D, target[i], 0);
    }
    glDrawBuffers(2, both);
    json_t* bounds = json_object_get(all, "bounds");
#define EDGE(end, i) json_number_value(json_array_get(json_object_get(bounds, end), i))
    glUniform1i(glGetUniformLocation(program, "u_points"), 3);
    glUniform1i(glGetUniformLocation(program, "u_steps"), argc > 3 ? 300 : 0);
    glUniform1f(glGetUniformLocation(program, "u_size"), (float)(EDGE("max", 1) - EDGE("min", 1)));
    glViewport(0, 0, kSide, kSide);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glReadPixels(0, 0, kSide, kSide, GL_RGBA, GL_FLOAT, fields);
    glReadBuffer(both[1]);
    glReadPixels(0, 0, kSide, kSide, GL_RGBA, GL_FLOAT, maps);
    need(glGetError() == GL_NO_ERROR, "GL error");
    for (int i = 0; i < count; ++i) {
        if (argc > 3) {
            printf("%.9g,%.9g,%.9g\n", fields[i][0], fields[i][1], fields[i][2]);
        } else {
            printf("%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.0f\n", points[i][0], points[i][1], points[i][2], fields[i][3],
                   fields[i][0], fields[i][1], fields[i][2], maps[i][0]);
        }
    }
    return 0;
}
