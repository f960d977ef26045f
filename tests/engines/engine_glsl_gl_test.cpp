// SPDX-License-Identifier: Apache-2.0
// shaders/engines/relief.glsl compiled without the runtime's other shaders, as an engine would, under #version 330 and
// #version 300 es, against the CPU's field.

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"
#include "runtime/gl/pass_state.h"
#include "tests/engines/engine_agreement.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/runtime/gl/query_program.h"

namespace relief::engines {
namespace {

constexpr const char* kMain = R"(
uniform highp usampler2D u_texels;
layout(std140) uniform u_constants { ReliefCollider u_collider; };
uniform highp sampler2D u_points;
uniform highp sampler2D u_velocities;
uniform highp sampler2D u_reactions;
layout(location = 0) out vec4 o_surface;
layout(location = 1) out vec4 o_position;
layout(location = 2) out vec4 o_velocity;
layout(location = 3) out vec4 o_normal;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 p = texelFetch(u_points, at, 0).xyz;
    vec3 v = texelFetch(u_velocities, at, 0).xyz;
    vec3 by = texelFetch(u_reactions, at, 0).xyz;
    ReliefSurface s = reliefDistance(u_texels, u_collider, p);
    ReliefMotion m = reliefCollide(u_texels, u_collider, p, v, by.x, by.y, by.z);
    o_surface = vec4(s.normal, s.distance);
    o_position = vec4(m.position, m.distance);
    o_velocity = vec4(m.velocity, 0.0);
    o_normal = vec4(m.normal, 0.0);
}
)";

constexpr GLsizei kRow = 512;  // queries per row of pixels

Result<std::vector<Answer>> evaluateOnGpu(const GlProgram& program, const Case& one) {
    const PassState state;
    const auto height = static_cast<GLsizei>((one.queries.size() + kRow - 1) / kRow);
    const std::size_t pixels = std::size_t{kRow} * static_cast<std::size_t>(height);
    const GlTexture texels = makeTexture2D(GL_RGBA16UI, kWidth, static_cast<GLsizei>(one.height()),
                                           GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, one.texels.data());
    const auto input = [&](glm::vec4 Query::*part) {
        std::vector<glm::vec4> values(pixels);
        std::ranges::transform(one.queries, values.begin(), [&](const Query& query) { return query.*part; });
        return makeTexture2D(GL_RGBA32F, kRow, height, GL_RGBA, GL_FLOAT, values.data());
    };
    const std::array inputs{input(&Query::point), input(&Query::velocity), input(&Query::reaction)};
    const auto output = [&] { return makeTexture2D(GL_RGBA32F, kRow, height, GL_RGBA, GL_FLOAT); };
    const std::array outputs{output(), output(), output(), output()};
    const GlFramebuffer framebuffer = RELIEF_TRY(
        makeFramebuffer({outputs[0].name(), outputs[1].name(), outputs[2].name(), outputs[3].name()}));
    const GlBuffer constants = makeBuffer();
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, constants.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(one.constants), &one.constants, GL_STATIC_DRAW);
    useTexture(0, texels);
    for (int i = 0; i < 3; ++i) {
        useTexture(1 + i, inputs[static_cast<std::size_t>(i)]);
    }
    program.drawScreen(framebuffer.name(), kRow, height);
    std::vector<Answer> answers(one.queries.size());
    glm::vec4 Answer::*const parts[] = {&Answer::surface, &Answer::position, &Answer::velocity,
                                        &Answer::normal};
    for (std::size_t part = 0; part < 4; ++part) {
        const auto values = RELIEF_TRY(readTextureFloats(outputs[part], kRow, height));
        for (std::size_t i = 0; i < answers.size(); ++i) {
            std::memcpy(&(answers[i].*parts[part]), &values[4 * i], sizeof(glm::vec4));
        }
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, 0);
    return answers;
}

class EngineGlTest : public GlTest {};

void expectTheCpuField(std::size_t points, const std::string& defines, Match match) {
    const GlProgram program = required(makeQueryProgram("engines/relief.glsl", kMain, defines));
    glUniformBlockBinding(program.name(), glGetUniformBlockIndex(program.name(), "u_constants"), 0);
    program.use();
    const char* const names[] = {"u_texels", "u_points", "u_velocities", "u_reactions"};
    for (int i = 0; i < 4; ++i) {
        program.set(names[i], i);
    }
    glUseProgram(0);
    for (const Case& one : makeCases(points)) {
        SCOPED_TRACE(one.name);
        expectEqualFields(one, required(evaluateOnGpu(program, one)), match);
    }
}

/// Also precise, with the extension that adds this qualifier to GLSL 330. GPUs fuse operations, and do not round
/// divisions and roots correctly; Mesa's llvmpipe does neither.
void expectTheCpuField(std::size_t points) {
    const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    const bool is_cpu = renderer.find("llvmpipe") != std::string::npos;
    expectTheCpuField(points, "", is_cpu ? Match::kRounded : Match::kFused);
    if (!isGles()) {
        expectTheCpuField(points, "#extension GL_ARB_gpu_shader5 : require\n#define RELIEF_PRECISE precise\n",
                          is_cpu ? Match::kBits : Match::kCells);
    }
}

TEST_P(EngineGlTest, EqualsTheCpuAt4000Points) {
    expectTheCpuField(4'000);
}

TEST_P(EngineGlTest, EqualsTheCpuAt100000Points) {
    expectTheCpuField(100'000);
}

RELIEF_INSTANTIATE_GL_TESTS(EngineGlTest);

}  // namespace
}  // namespace relief::engines
