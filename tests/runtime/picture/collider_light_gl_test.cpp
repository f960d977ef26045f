// SPDX-License-Identifier: Apache-2.0
// Light around a collider in closed form: the shade of a sphere and of a plate, also in motion.
#include "runtime/bodies/world_textures.h"
#include "runtime/picture/collider_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/live/live_collider.h"
#include "shaders/picture/constants.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/runtime/gl/query_program.h"

namespace relief {
namespace {

struct Light {
    float sun;
    float sky;
};

/// Evaluates particle_light.glsl at the points of a texture, one per texel.
constexpr const char* kQuery = R"(
uniform highp sampler2D u_points;  // xyz: object space

layout(location = 0) out vec4 o_light;  // visible fractions of sun and sky, means over all rotations and jitters

void main() {
    vec3 point = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0).xyz;
    o_light = vec4(0.0);
    for (int i = 0; i < 64; ++i) {
        ParticleLight light = particleLight(point, (float(i & 7) + 0.5) / 8.0, (float(i >> 3) + 0.5) / 8.0);
        o_light += vec4(light.sun, light.sky, 0.0, 0.0) / 64.0;
    }
}
)";

class ColliderLightGlTest : public GlTest {
  protected:
    void use(WorldTextures textures, const Bounds& bounds, float texel) {
        light_.reset();
        textures_ = std::make_unique<WorldTextures>(std::move(textures));
        light_.emplace(required(ColliderLight::create({textures_.get(), bounds, texel})));
    }
    void use(const Collider& collider) {
        use(required(WorldTextures::create(collider)), collider.bounds, finestTexel(collider));
    }
    /// The light of particles, averaged over their random numbers.
    std::vector<Light> at(const std::vector<glm::vec3>& points) {
        const PassState state;
        EXPECT_TRUE(light_->update());
        std::vector<glm::vec4> texels;
        for (const glm::vec3& p : points) {
            texels.emplace_back(p, 0.0F);
        }
        const auto count = static_cast<GLsizei>(points.size());
        const GlTexture input = makeTexture2D(GL_RGBA32F, count, 1, GL_RGBA, GL_FLOAT, texels.data());
        const GlTexture output = makeTexture2D(GL_RGBA32F, count, 1, GL_RGBA, GL_FLOAT);
        const GlFramebuffer target = required(makeFramebuffer({output.name()}));
        const GlProgram program = required(makeQueryProgram("picture/particle_light.glsl", kQuery));
        light_->attach(program, 1);
        program.set("u_points", 0);
        light_->bind(1);
        useTexture(0, input);
        program.drawScreen(target.name(), count, 1);
        const std::vector<float> values = required(readTextureFloats(output, count, 1));
        std::vector<Light> lights;
        for (std::size_t i = 0; i < points.size(); ++i) {
            lights.push_back({values[4 * i], values[4 * i + 1]});
        }
        return lights;
    }
    Light at(const glm::vec3& point) { return at(std::vector<glm::vec3>{point}).front(); }

    std::unique_ptr<WorldTextures> textures_;  // must not move: the light points at it
    std::optional<ColliderLight> light_;
};

/// The fraction of the sun's disc that a sphere leaves visible from p.
double sunPastSphere(const glm::dvec3& p, const glm::dvec3& center, double radius) {
    const glm::dvec3 sun(sunDirection());
    const glm::dvec3 a = glm::normalize(glm::cross(sun, glm::dvec3(0, 0, 1)));
    const glm::dvec3 b = glm::cross(sun, a);
    int seen = 0;
    constexpr int kRays = 1000;
    for (int i = 0; i < kRays; ++i) {
        const double r = static_cast<double>(kSunWidth) * std::sqrt((i + 0.5) / kRays);
        const double angle = 2.0 * std::numbers::pi * 0.61803398875 * i;
        const glm::dvec3 d = glm::normalize(sun + r * (std::cos(angle) * a + std::sin(angle) * b));
        const glm::dvec3 to = center - p;
        const double along = glm::dot(to, d);
        seen += along > 0.0 && glm::dot(to, to) - along * along < radius * radius ? 0 : 1;
    }
    return static_cast<double>(seen) / kRays;
}

// On a plane below a sphere: full light and full shade as in the geometry, and the visible fraction of the disc between
// them. Fails if a map is rotated, shifted or scaled, if the penumbra has another width, or if shade has no cause.
TEST_P(ColliderLightGlTest, SpheresCastShade) {
    use(analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 128));
    for (const float height : {-0.55F, -1.0F, -2.5F}) {
        std::vector<glm::vec3> points;
        for (int z = 0; z < 28; ++z) {
            for (int x = 0; x < 28; ++x) {
                // Along the light direction, below the sphere.
                const glm::vec3 under = sunDirection() * (height / sunDirection().y);
                points.push_back(under + glm::vec3(0.07F * static_cast<float>(x) - 1.0F, 0.0F,
                                                   0.07F * static_cast<float>(z) - 1.0F));
            }
        }
        const std::vector<Light> lights = at(points);
        int full = 0;
        int dark = 0;
        double in_dark = 0.0;
        double sum = 0.0;
        int between = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            // One texel of the shade map plus one of the collider's maps.
            const double least = sunPastSphere(points[i], glm::dvec3(0.0), 0.515);
            const double most = sunPastSphere(points[i], glm::dvec3(0.0), 0.485);
            if (least == 1.0) {
                EXPECT_EQ(lights[i].sun, 1.0F) << points[i].x << " " << points[i].y << " " << points[i].z;
                ++full;
            } else if (most == 0.0) {
                EXPECT_LT(lights[i].sun, 0.1F) << points[i].x << " " << points[i].y << " " << points[i].z;
                in_dark += static_cast<double>(lights[i].sun);
                ++dark;
            } else {
                const double expected = sunPastSphere(points[i], glm::dvec3(0.0), 0.5);
                EXPECT_NEAR(lights[i].sun, expected, 0.3) << points[i].x << " " << points[i].z;
                sum += lights[i].sun - expected;
                ++between;
            }
        }
        EXPECT_GT(full, 150) << height;
        EXPECT_GT(dark, 15) << height;
        EXPECT_LT(in_dark / dark, 0.01) << height;
        EXPECT_GT(between, 25) << height;
        EXPECT_NEAR(sum / between, 0.0, 0.06) << height;
    }
}

// On the sphere itself: its own texels do not shade the side towards the sun, but they do shade the other side.
TEST_P(ColliderLightGlTest, SurfacesDoNotShadeThemselves) {
    use(analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 128));
    std::vector<glm::vec3> points;
    std::vector<float> facing;
    for (int i = 0; i < 2000; ++i) {
        const float y = 1.0F - (static_cast<float>(i) + 0.5F) / 1000.0F;
        const float around = 2.3999632F * static_cast<float>(i);
        const glm::vec3 n(std::sqrt(1.0F - y * y) * std::cos(around), y,
                          std::sqrt(1.0F - y * y) * std::sin(around));
        points.push_back(0.505F * n);
        facing.push_back(glm::dot(n, sunDirection()));
    }
    const std::vector<Light> lights = at(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (facing[i] > 0.3F) {
            EXPECT_EQ(lights[i].sun, 1.0F) << facing[i];
        } else if (facing[i] < -0.3F) {
            EXPECT_LT(lights[i].sun, 0.1F) << facing[i];
        }
    }
}

// A sheet as thick as 1/40 voxel. Behind it there is no sun beyond the bias, and only as much sky as in the geometry.
// An infinite plate at height h blocks rays steeper than h / reach, and so hides 1 - (h / reach)² of the
// cosine-weighted sky.
TEST_P(ColliderLightGlTest, NoLightLeaksThroughAThinSheet) {
    const Collider sheet =
        analytic::frontBackCollider(analytic::box({-1.0, -0.00125, -1.0}, {1.0, 0.0, 1.0}), 256);
    use(sheet);
    EXPECT_NEAR(light_->voxel(), 0.05F, 1e-6F);
    std::vector<glm::vec3> points;
    const float behind = light_->sunBias() / sunDirection().y + 0.01F;
    const float under = 1.5F * light_->voxel() + 0.002F;
    EXPECT_LT(behind, 0.03F) << "for a side of 2";
    for (int i = 0; i < 400; ++i) {  // random central points, at the bias and deeper
        const float x = -0.2F + 0.02F * static_cast<float>(i % 20);
        const float z = -0.2F + 0.02F * static_cast<float>(i / 20);
        const float depth = behind + 0.001F * static_cast<float>(i % 37);
        points.emplace_back(x, -depth, z);
        points.emplace_back(x, -under - 0.001F * static_cast<float>(i % 37), z);
        points.emplace_back(x, 0.01F, z);
    }
    const std::vector<Light> lights = at(points);
    for (std::size_t i = 0; i < points.size(); i += 3) {
        EXPECT_EQ(lights[i].sun, 0.0F) << points[i].y;
        EXPECT_LT(lights[i + 1].sky, 0.08F) << points[i + 1].y;
        EXPECT_EQ(lights[i + 2].sun, 1.0F);
        EXPECT_GT(lights[i + 2].sky, 0.92F);
    }
    const float reach = kSkyReach * 2.0F;
    for (const float share : {0.3F, 0.5F, 0.7F, 0.85F}) {
        EXPECT_NEAR(at({0.0F, -share * reach, 0.0F}).sky, share * share, 0.12F) << share;
    }
    EXPECT_GT(at({0.0F, -1.2F * reach, 0.0F}).sky, 0.95F) << "beyond the reach";
    EXPECT_EQ(at({0.0F, 3.0F, 0.0F}).sky, 1.0F);
    EXPECT_EQ(at({30.0F, -0.3F, 0.0F}).sun, 1.0F);
    EXPECT_EQ(at({30.0F, -0.3F, 0.0F}).sky, 1.0F);
}

TEST_P(ColliderLightGlTest, LightFollowsMovingBodies) {
    const Collider ball = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.25), 64);
    ColliderBody body;
    body.collider = &ball;
    Bounds bounds;
    bounds.add(glm::vec3(-1.5F, -0.5F, -0.5F));
    bounds.add(glm::vec3(1.5F, 0.5F, 0.5F));
    use(required(WorldTextures::create(std::span(&body, 1))), bounds, finestTexel(ball));
    // Behind each position of the ball as seen from the sun, and directly below it.
    const auto lightUnder = [&](float x) {
        const glm::vec3 place(x, 0.0F, 0.0F);
        return Light{at(place - 0.6F * sunDirection()).sun, at(place - glm::vec3(0.0F, 0.45F, 0.0F)).sky};
    };
    EXPECT_EQ(lightUnder(0.0F).sun, 0.0F);
    EXPECT_LT(lightUnder(0.0F).sky, 0.8F);
    EXPECT_EQ(light_->updates(), 1U) << "a resting body causes no update";
    for (const float x : {1.0F, -1.0F, 0.0F}) {
        Pose pose;
        pose.position = {x, 0.0F, 0.0F};
        textures_->setPoses(std::span(&pose, 1));
        for (const float other : {-1.0F, 0.0F, 1.0F}) {
            const Light light = lightUnder(other);
            EXPECT_EQ(light.sun, other == x ? 0.0F : 1.0F) << x << " " << other;
            EXPECT_EQ(light.sky < 0.8F, other == x) << x << " " << other << " " << light.sky;
        }
    }
    EXPECT_EQ(light_->updates(), 4U);
}

TEST_P(ColliderLightGlTest, LightFollowsDeformingBodies) {
    // A slab that grows on both sides.
    const auto slab = [](float half) { return movingBox({half, 0.1F, 0.5F}); };
    Bounds box;
    box.add(glm::vec3(-1.2F, -0.3F, -0.7F));
    box.add(glm::vec3(1.2F, 0.3F, 0.7F));
    LiveCollider live = required(
        LiveCollider::create(slab(0.3F).positions, slab(0.3F).triangles, required(liveFrames(box, 128))));
    ColliderBody body;
    body.collider = &live.frames();
    body.live = true;
    use(required(WorldTextures::create(std::span(&body, 1))), box, finestTexel(live.frames()));
    ASSERT_TRUE(live.update(*textures_, 0));
    const glm::vec3 behind = glm::vec3(0.8F, 0.0F, 0.0F) - 0.5F * sunDirection();
    const glm::vec3 below(0.8F, -0.4F, 0.0F);
    EXPECT_EQ(at(behind).sun, 1.0F);
    EXPECT_GT(at(below).sky, 0.7F);
    ASSERT_TRUE(live.setPositions(slab(1.1F).positions));
    ASSERT_TRUE(live.update(*textures_, 0));
    EXPECT_EQ(at(behind).sun, 0.0F);
    EXPECT_LT(at(below).sky, 0.5F);
}

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(ColliderLightGlTest);

}  // namespace relief
