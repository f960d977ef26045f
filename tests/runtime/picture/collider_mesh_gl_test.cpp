// SPDX-License-Identifier: Apache-2.0
// A collider drawn from its mesh, against the same collider drawn from its depth maps and against the closed form.
// Light around a collider: the shade of a sphere and of a plate, also in motion.
#include <gtest/gtest.h>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/bodies/world_textures.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/live/live_collider.h"
#include "runtime/picture/collider_light.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/frame.h"
#include "shaders/picture/constants.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/runtime/gl/query_program.h"

namespace relief::test {
namespace {

constexpr std::uint32_t kViewWidth = 96;
constexpr std::uint32_t kViewHeight = 64;
constexpr double kPi = 3.14159265358979;
constexpr float kRadius = 0.5F;
constexpr float kDistance = 3.0F;

PictureMesh sphereMesh(std::uint32_t around, std::uint32_t rings) {
    PictureMesh mesh;
    for (std::uint32_t j = 0; j <= rings; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double a = 2.0 * kPi * i / around;
            const double b = kPi * j / rings;
            mesh.positions.emplace_back(kRadius * std::sin(b) * std::cos(a), kRadius * std::cos(b),
                                        -kRadius * std::sin(b) * std::sin(a));
            if (j < rings) {
                const std::uint32_t at = j * around + i;
                const std::uint32_t right = j * around + (i + 1) % around;
                mesh.triangles.insert(mesh.triangles.end(),
                                      {at, at + around, right + around, at, right + around, right});
            }
        }
    }
    return mesh;
}

class ColliderMeshGlTest : public GlTest {
  protected:
    /// A picture of the sphere, drawn from its mesh or from its maps, with depths as view distances.
    struct Picture {
        std::vector<std::uint8_t> rgb;
        std::vector<float> distances;
    };
    [[nodiscard]] Picture draw(const Camera& camera, const ColliderStyle& style, const ColliderMesh* mesh) {
        ColliderRenderer renderer =
            required(ColliderRenderer::create({&textures_, collider_.bounds, finestTexel(collider_)}, mesh));
        EXPECT_TRUE(renderer.draw(camera, style, target_));
        Picture picture{frame_.read(), {}};
        const GlProgram program = required(makeScreenProgram("picture/copy_view.frag"));
        const PassState state;
        program.use();
        useTexture(0, renderer.depth());
        const std::vector<float> texels = drawnFloats(program, target_.width, target_.height);
        const glm::vec2 map = camera.depthOfDistance();
        for (std::size_t i = 0; i < texels.size(); i += 4) {
            picture.distances.push_back(texels[i] < 1.0F ? map.y / (texels[i] - map.x)
                                                         : std::numeric_limits<float>::infinity());
        }
        return picture;
    }
    [[nodiscard]] std::size_t pixel(GLsizei x, GLsizei y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(target_.width) +
               static_cast<std::size_t>(x);
    }
    static Camera cameraAt(const glm::vec3& eye) {
        return {.eye = eye, .near_plane = 0.5F, .far_plane = 50.0F};
    }

    const Collider collider_ = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, kRadius), 128);
    WorldTextures textures_ = required(WorldTextures::create(collider_));
    ColliderMesh mesh_ = required(ColliderMesh::create(sphereMesh(128, 64)));
    Frame frame_ = required(Frame::create(kViewWidth, kViewHeight));
    const RenderTarget target_ = frame_.target();
};

TEST_P(ColliderMeshGlTest, SpheresLookTheSameFromMeshAndMaps) {
    const Camera camera = cameraAt({0.0F, 0.0F, kDistance});
    const auto [maps_rgb, maps_depth] = draw(camera, {}, nullptr);
    const auto [mesh_rgb, mesh_depth] = draw(camera, {}, &mesh_);
    EXPECT_NE(maps_rgb, mesh_rgb) << "both pictures were drawn from the maps";
    EXPECT_GT(maps_rgb[3 * (kViewWidth * (kViewHeight / 2 - 5) + kViewWidth / 2 - 5)], 60)
        << "the side towards the sun is lit";

    // Outline: both cover the same pixels except for one pixel of the target along the circle. Depth: facets are off by
    // at most r(1 - cos(π/64)) = 0.0006. A map texel has one depth, so maps may be off by a texel and a ray step, 2.5
    // texels of 1/126, where the surface slopes by 45° or less.
    const float texel = 1.0F / 126.0F;
    const double scale = 0.5 * target_.height / camera.tanHalfFov();
    const double edge = scale * std::tan(std::asin(kRadius / kDistance));
    int covered = 0;
    for (GLsizei y = 0; y < target_.height; ++y) {
        for (GLsizei x = 0; x < target_.width; ++x) {
            const std::size_t i = pixel(x, y);
            const double px = x + 0.5 - 0.5 * target_.width;
            const double py = y + 0.5 - 0.5 * target_.height;
            const double away = std::hypot(px, py);
            if (std::abs(away - edge) > 1.0) {
                ASSERT_EQ(std::isfinite(mesh_depth[i]), away < edge) << x << " " << y;
                ASSERT_EQ(std::isfinite(maps_depth[i]), away < edge) << x << " " << y;
            }
            // The ray (px, py, -scale) t from the eye hits the sphere at t, the view distance divided by the scale.
            const double a = px * px + py * py + scale * scale;
            const double b = kDistance * scale;
            const double rest = b * b - a * (kDistance * kDistance - kRadius * kRadius);
            if (rest <= 0.0 || away > 0.65 * edge) {
                continue;
            }
            const double truth = scale * (b - std::sqrt(rest)) / a;
            ASSERT_NEAR(mesh_depth[i], truth, 8e-4) << x << " " << y;
            ASSERT_NEAR(maps_depth[i], truth, 2.5 * texel) << x << " " << y;
            ++covered;
        }
    }
    EXPECT_GT(covered, 1000);

    // Light is sampled with noise, so only its mean is compared.
    double difference = 0.0;
    for (std::size_t i = 0; i < mesh_rgb.size(); ++i) {
        difference += std::abs(int{mesh_rgb[i]} - int{maps_rgb[i]});
    }
    EXPECT_LT(difference / static_cast<double>(mesh_rgb.size()), 2.0);
}

TEST_P(ColliderMeshGlTest, FloorHidesGeometryBelow) {
    const Camera camera = cameraAt({0.0F, 1.5F, 3.0F});
    ColliderStyle style;
    style.ground = 0.0F;
    const std::vector<float> depth = draw(camera, style, &mesh_).distances;
    // Below the picture's centre, the eye sees the floor in front of the sphere's lower half: the ray hits the floor at
    // height 0.
    const int y = target_.height / 2 - static_cast<int>(0.17 * target_.height);
    const float up = (2.0F * (static_cast<float>(y) + 0.5F) / static_cast<float>(target_.height) - 1.0F) *
                     camera.tanHalfFov();
    const glm::vec3 d = camera.forward() + up * camera.up();
    const float floor = -camera.eye.y / d.y;
    ASSERT_GT(camera.eye.z + floor * d.z, kRadius) << "the ray hits the floor before the sphere";
    EXPECT_NEAR(depth[pixel(target_.width / 2, y)], floor, 1e-3F);
}

TEST_P(ColliderMeshGlTest, HostileMeshesAreRejected) {
    EXPECT_TRUE(ColliderMesh::create(sphereMesh(8, 4)));
    const std::vector<std::function<void(PictureMesh&)>> faults{
        [](PictureMesh& mesh) { mesh = {}; }, [](PictureMesh& mesh) { mesh.triangles.push_back(0); },
        [](PictureMesh& mesh) { mesh.triangles[4] = static_cast<std::uint32_t>(mesh.positions.size()); },
        [](PictureMesh& mesh) { mesh.positions[3].y = std::numeric_limits<float>::quiet_NaN(); },
        [](PictureMesh& mesh) { mesh.normals.resize(1); }};
    for (std::size_t i = 0; i < faults.size(); ++i) {
        PictureMesh mesh = sphereMesh(8, 4);
        faults[i](mesh);
        EXPECT_EQ(ColliderMesh::create(mesh).error().code, ErrorCode::kInvalidInput) << i;
    }
}

struct Light {
    float sun;
    float sky;
};

/// Evaluates particle_light.glsl at the points of a texture, one per texel.
constexpr const char* kLightQuery = R"(
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
        const GlProgram program = required(makeQueryProgram("picture/particle_light.glsl", kLightQuery));
        light_->attach(program, 1);
        program.set("u_points", 0);
        light_->bind(1);
        useTexture(0, input);
        const std::vector<float> values = drawnFloats(program, count, 1);
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
        const double angle = 2.0 * kPi * 0.61803398875 * i;
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
    use(analytic::frontBackCollider(analytic::box({-1.0, -0.00125, -1.0}, {1.0, 0.0, 1.0}), 256));
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
    const ColliderBody body{&ball, {}};
    use(required(WorldTextures::create(std::span(&body, 1))), {{-1.5F, -0.5F, -0.5F}, {1.5F, 0.5F, 0.5F}},
        finestTexel(ball));
    // Behind each position of the ball as seen from the sun, and directly below it.
    const auto lightUnder = [&](float x) {
        const glm::vec3 place(x, 0.0F, 0.0F);
        return Light{at(place - 0.6F * sunDirection()).sun, at(place - glm::vec3(0.0F, 0.45F, 0.0F)).sky};
    };
    EXPECT_EQ(lightUnder(0.0F).sun, 0.0F);
    EXPECT_LT(lightUnder(0.0F).sky, 0.8F);
    EXPECT_EQ(light_->updates(), 1U) << "a resting body causes no update";
    for (const float x : {1.0F, -1.0F, 0.0F}) {
        const Pose pose{.position = {x, 0.0F, 0.0F}};
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
    const Bounds box{{-1.2F, -0.3F, -0.7F}, {1.2F, 0.3F, 0.7F}};
    LiveCollider live = required(
        LiveCollider::create(slab(0.3F).positions, slab(0.3F).triangles, required(liveMaps(box, 128))));
    const ColliderBody body{.collider = &live.frames(), .live = true};
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

RELIEF_INSTANTIATE_GL_TESTS(ColliderMeshGlTest);
RELIEF_INSTANTIATE_GL_TESTS(ColliderLightGlTest);

}  // namespace relief::test
