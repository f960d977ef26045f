// SPDX-License-Identifier: Apache-2.0
// Rays of pictures skip empty space: they need few samples of the field, and pass no point inside.
#include <gtest/gtest.h>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <string>
#include <vector>

#include "runtime/bodies/world_textures.h"
#include "runtime/gl/pass_state.h"
#include "tests/formats/random_patches.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/runtime/gl/query_program.h"

namespace relief {
namespace {

constexpr int kStrides = 512;  // of a ray
constexpr GLsizei kRays = 1024;

/// Follows a ray through all that is inside as well.
constexpr const char* kFollow = R"(
uniform highp sampler2D u_rays;  // row 0: start, row 1: end
layout(location = 0) out vec4 o_counts;  // samples outside, strides outside, skipped points that are inside
void main() {
    vec3 origin = texelFetch(u_rays, ivec2(gl_FragCoord.x, 0), 0).xyz;
    vec3 d = texelFetch(u_rays, ivec2(gl_FragCoord.x, 1), 0).xyz - origin;
    float stride = 1.0 / 512.0;
    o_counts = vec4(0.0);
    float t = 0.0;
    while (t < 1.0) {
        ReliefField field = reliefSolid(origin + t * d);
        if (reliefInside(field)) {
            t += stride;
            continue;
        }
        float next = nextTest(field, origin, d, t, stride, 1.0);
        o_counts += vec4(1.0, (next - t) / stride, 0.0, 0.0);
        if (next > t + 1.5 * stride) {
            for (int part = 1; part < 32; ++part) {
                o_counts.z += reliefInside(reliefSolid(origin + mix(t, next, float(part) / 32.0) * d)) ? 1.0 : 0.0;
            }
        }
        t = next;
    }
}
)";

class RayGlTest : public GlTest {
  protected:
    /// Follows rays between random points with coordinates from `low` to `high`.
    /// \return the mean length of a step outside, in strides
    static double followed(const WorldTextures& textures, std::mt19937& random, float low, float high) {
        const PassState state;
        std::uniform_real_distribution<float> place(low, high);
        std::vector<glm::vec4> ends;
        for (int i = 0; i < 2 * kRays; ++i) {
            ends.emplace_back(place(random), place(random), place(random), 0.0F);
        }
        const GlTexture rays = makeTexture2D(GL_RGBA32F, kRays, 2, GL_RGBA, GL_FLOAT, ends.data());
        const std::string text = required(includedShader("picture/ray.glsl")) + kFollow;
        const GlProgram program =
            required(makeQueryProgram("collider/collider.glsl", text, textures.defines()));
        constexpr WorldTextures::Binding kBinding{1, 0};
        textures.attach(program, kBinding);
        program.set("u_rays", 0);
        useTexture(0, rays);
        textures.bind(kBinding);
        const std::vector<float> values = drawnFloats(program, kRays, 1);
        double samples = 0.0;
        double strides = 0.0;
        double passed = 0.0;
        for (std::size_t i = 0; i < values.size(); i += 4) {
            samples += double{values[i]};
            strides += double{values[i + 1]};
            passed += double{values[i + 2]};
        }
        EXPECT_EQ(passed, 0.0);
        EXPECT_GT(strides, 0.05 * kStrides * kRays) << "most of the space is inside";
        return strides / samples;
    }
};

// A former fault: rays crossed empty cells and flat patches in steps of the finest texel.
TEST_P(RayGlTest, EmptyCellsOfOneColliderAreSkipped) {
    std::mt19937 random(3);
    Collider collider;
    collider.maps = {test::randomPatches(random)};
    EXPECT_GT(followed(required(WorldTextures::create(collider)), random, -0.5F, 4.5F), 4.0);
}

TEST_P(RayGlTest, EmptyCellsAndSpaceBetweenBodiesAreSkipped) {
    std::mt19937 random(4);
    std::vector<Collider> colliders(2);
    for (Collider& collider : colliders) {
        collider.maps = {test::randomPatches(random)};
    }
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    for (const std::size_t count : {5U, 20U, 200U}) {  // the broad phase finds the bodies of the last
        SCOPED_TRACE(count);
        std::vector<ColliderBody> bodies;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::vec3 axis = glm::normalize(glm::vec3(unit(random), unit(random), 1.1F));
            const glm::vec3 at(7.0F * unit(random), 7.0F * unit(random), 7.0F * unit(random));
            bodies.push_back({&colliders[i % 2],
                              {at, glm::angleAxis(3.0F * unit(random), axis), count > 32 ? 0.2F : 1.0F}});
        }
        EXPECT_GT(followed(required(WorldTextures::create(bodies)), random, -8.0F, 8.0F), 4.0);
    }
}

RELIEF_INSTANTIATE_GL_TESTS(RayGlTest);

}  // namespace
}  // namespace relief
