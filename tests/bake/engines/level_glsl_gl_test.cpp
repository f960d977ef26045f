// SPDX-License-Identifier: Apache-2.0
// The function of bake/engines/README.md that collides with a level, run on the exported files.
#include <cmath>
#include <fstream>
#include <sstream>

#include "bake/engines/body_cells.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "tests/bake/engines/many_balls.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/runtime/gl/query_program.h"

namespace relief::test {
namespace {

constexpr const char* kQuery = R"(
uniform highp sampler2D u_points;
layout(location = 0) out vec4 o_surface;
layout(location = 1) out vec4 o_motion;
void main() {
    vec3 p = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0).xyz;
    ReliefSurface surface = levelDistance(p);
    o_surface = vec4(surface.normal, surface.distance);
    ReliefMotion motion = levelCollide(p, vec3(0.0), 0.25, 0.5, 0.25);
    o_motion = vec4(motion.position, motion.distance);
}
)";

/// The code of the page.
std::string levelGlsl() {
    std::ostringstream page;
    page << std::ifstream(std::string(RELIEF_SOURCE_DIR) + "/bake/engines/README.md").rdbuf();
    const std::string text = page.str();
    const std::string begin = "```glsl\n";
    const std::size_t at = text.find(begin, text.find("<!-- glsl: level -->")) + begin.size();
    return text.substr(at, text.find("```", at) - at);
}

class LevelGlslGlTest : public GlTest {};

TEST_P(LevelGlslGlTest, GivesTheDistancesOfTheWorld) {
    const LoadedWorld level = manyBalls();
    const std::vector<EngineFile> files = required(engineFiles(level, "level", Engine::kC));
    const auto bytes = [&](const char* name) { return fileNamed(files, name).bytes; };
    const PassState state;
    const GlProgram program = required(makeQueryProgram("engines/relief.glsl", levelGlsl() + kQuery));
    program.use();
    const auto texels = bytes("level.texels");
    const GlTexture tree = makeTexture2D(GL_RGBA16UI, 2048, static_cast<GLsizei>(texels.size() / 16384),
                                         GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, texels.data());
    const GlTexture bodies =
        makeTexture2D(GL_RGBA32UI, 1792, 2, GL_RGBA_INTEGER, GL_UNSIGNED_INT, bytes("level.bodies").data());
    const auto words = bytes("level.cells");
    const GlTexture cells = makeTexture2D(GL_R32UI, 2048, static_cast<GLsizei>(words.size() / 8192),
                                          GL_RED_INTEGER, GL_UNSIGNED_INT, words.data());
    constexpr GLsizei kWidth = 256;
    const std::vector<glm::vec3> points = pointsAmongBalls(std::size_t{kWidth} * 64);
    std::vector<glm::vec4> input;
    for (const glm::vec3& p : points) {
        input.emplace_back(p, 0.0F);
    }
    const GlTexture places = makeTexture2D(GL_RGBA32F, kWidth, 64, GL_RGBA, GL_FLOAT, input.data());
    const GlTexture output = makeTexture2D(GL_RGBA32F, kWidth, 64, GL_RGBA, GL_FLOAT);
    const GlTexture moved = makeTexture2D(GL_RGBA32F, kWidth, 64, GL_RGBA, GL_FLOAT);
    int unit = 0;
    for (const auto& [name, texture] :
         {std::pair("u_texels", &tree), {"u_bodies", &bodies}, {"u_cells", &cells}, {"u_points", &places}}) {
        useTexture(unit, *texture);
        program.set(name, unit++);
    }
    const GlFramebuffer target = required(makeFramebuffer({output.name(), moved.name()}));
    program.drawScreen(target.name(), kWidth, 64);
    const std::vector<float> surfaces = required(readTextureFloats(output, kWidth, 64));
    const std::vector<float> motions = required(readTextureFloats(moved, kWidth, 64));
    int inside = 0;
    int touching = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float* motion = &motions[4 * i];
        const float gap = distanceToBalls(level, points[i]);
        const bool hit = motion[3] < 0.0F;
        // Away from the surface, the plane of a cell is nearer than the ball.
        EXPECT_TRUE(hit || gap > 0.2F) << gap;
        EXPECT_TRUE(!hit || gap < 0.45F) << gap;
        EXPECT_TRUE(hit || glm::vec3(motion[0], motion[1], motion[2]) == points[i]);
        touching += hit && gap > 0.0F ? 1 : 0;
        const float expected = depthIn(level, points[i]);
        const float* surface = &surfaces[4 * i];
        if (std::abs(expected) > 1e-4F) {  // rows are rounded again for each body
            EXPECT_EQ(surface[3] < 0.0F, expected < 0.0F);
        }
        if (expected < -1e-4F) {
            ++inside;
            EXPECT_NEAR(surface[3], expected, 1e-4F);
            EXPECT_NEAR(glm::length(glm::vec3(surface[0], surface[1], surface[2])), 1.0F, 1e-4F);
        }
    }
    EXPECT_GT(inside, 300);
    EXPECT_GT(touching, 100);
}

RELIEF_INSTANTIATE_GL_TESTS(LevelGlslGlTest);

}  // namespace
}  // namespace relief::test
