// SPDX-License-Identifier: Apache-2.0
// A collider drawn from its mesh, against the same collider drawn from its depth maps and against the closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>

#include "runtime/bodies/world_textures.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/frame.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

constexpr std::uint32_t kColumns = 96;
constexpr std::uint32_t kRows = 64;
constexpr float kRadius = 0.5F;
constexpr float kDistance = 3.0F;

PictureMesh sphereMesh(std::uint32_t around, std::uint32_t rings) {
    PictureMesh mesh;
    for (std::uint32_t j = 0; j <= rings; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double a = 2.0 * std::numbers::pi * i / around;
            const double b = std::numbers::pi * j / rings;
            mesh.positions.emplace_back(kRadius * std::sin(b) * std::cos(a), kRadius * std::cos(b),
                                        -kRadius * std::sin(b) * std::sin(a));
        }
    }
    for (std::uint32_t j = 0; j < rings; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t right = (i + 1) % around;
            const std::uint32_t a = j * around + i;
            const std::uint32_t b = j * around + right;
            const std::uint32_t c = a + around;
            const std::uint32_t d = b + around;
            mesh.triangles.insert(mesh.triangles.end(), {a, c, d, a, d, b});
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
        const GlTexture copy = makeTexture2D(GL_RGBA32F, target_.width, target_.height, GL_RGBA, GL_FLOAT);
        const GlFramebuffer framebuffer = required(makeFramebuffer({copy.name()}));
        const GlProgram program = required(makeScreenProgram("picture/copy_view.frag"));
        {
            const PassState state;
            program.use();
            useTexture(0, renderer.depth());
            program.drawScreen(framebuffer.name(), target_.width, target_.height);
        }
        const std::vector<float> texels = required(readTextureFloats(copy, target_.width, target_.height));
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
        Camera camera;
        camera.eye = eye;
        camera.near_plane = 0.5F;
        camera.far_plane = 50.0F;
        return camera;
    }

    const Collider collider_ = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, kRadius), 128);
    WorldTextures textures_ = required(WorldTextures::create(collider_));
    ColliderMesh mesh_ = required(ColliderMesh::create(sphereMesh(128, 64)));
    Frame frame_ = required(Frame::create(kColumns, kRows));
    const RenderTarget target_ = frame_.target();
};

TEST_P(ColliderMeshGlTest, SpheresLookTheSameFromMeshAndMaps) {
    const Camera camera = cameraAt({0.0F, 0.0F, kDistance});
    const auto [maps_rgb, maps_depth] = draw(camera, {}, nullptr);
    const auto [mesh_rgb, mesh_depth] = draw(camera, {}, &mesh_);
    EXPECT_NE(maps_rgb, mesh_rgb) << "both pictures were drawn from the maps";
    EXPECT_GT(maps_rgb[3 * (kColumns * (kRows / 2 - 5) + kColumns / 2 - 5)], 60)
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

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(ColliderMeshGlTest);

}  // namespace relief
