// SPDX-License-Identifier: Apache-2.0
// A picture of meshes, checked at points of the world: a roof above a meadow, in sun, rain, snow and fog.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "runtime/picture/collider_view.h"
#include "runtime/picture/frame.h"
#include "runtime/picture/mesh_renderer.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

constexpr std::uint32_t kSceneWidth = 240;
constexpr std::uint32_t kSceneHeight = 180;
constexpr std::array<std::uint8_t, 4> kGreen{90, 140, 60, 255};
constexpr std::array<std::uint8_t, 4> kRed{170, 60, 50, 255};
constexpr float kRoofHeight = 2.0F;

PictureMesh box(const glm::vec3& low, const glm::vec3& high, const std::array<std::uint8_t, 4>& color) {
    PictureMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.positions.emplace_back((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                                    (i & 4) != 0 ? high.z : low.z);
        mesh.colors.push_back(color);
    }
    mesh.triangles = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                      2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    return mesh;
}

struct ShadedPixel {
    float r, g, b;
    [[nodiscard]] float light() const { return (r + g + b) / 3.0F; }
    [[nodiscard]] bool white() const {
        return std::min({r, g, b}) > 0.55F * 255.0F && std::abs(r - b) < 30.0F;
    }
};

class MeshRendererGlTest : public GlTest {
  protected:
    MeshRendererGlTest() {
        camera_.eye = {0.0F, 5.0F, 11.0F};
        camera_.target = {0.0F, 0.5F, 0.0F};
        camera_.fov = 40.0F;
        camera_.far_plane = 200.0F;
    }

    void draw(const MeshStyle& style, const std::vector<MeshPlace>& places) {
        const auto drawn =
            renderer_.draw({camera_, frame_.target().aspect()}, style, places, around_, frame_.target());
        ASSERT_TRUE(drawn) << drawn.error().message;
        rgb_ = frame_.read();
    }
    [[nodiscard]] std::vector<MeshPlace> meadow() const { return {{0, {}, false}, {1, {}, false}}; }

    /// The mean of 3 × 3 pixels around a point of the world.
    [[nodiscard]] ShadedPixel at(const glm::vec3& p) const {
        const glm::vec4 clip = camera_.projection(float{kSceneWidth} / float{kSceneHeight}) * camera_.view() *
                               glm::vec4(p, 1.0F);
        const auto x = static_cast<int>((0.5F + 0.5F * clip.x / clip.w) * float{kSceneWidth});
        const auto y = static_cast<int>((0.5F - 0.5F * clip.y / clip.w) * float{kSceneHeight});
        std::array<float, 3> sum{};
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                for (std::size_t k = 0; k < 3; ++k) {
                    sum[k] += rgb_.at(3 * (static_cast<std::size_t>(y + dy) * kSceneWidth +
                                           static_cast<std::size_t>(x + dx)) +
                                      k);
                }
            }
        }
        return {sum[0] / 9, sum[1] / 9, sum[2] / 9};
    }

    const Bounds around_{{-8.0F, -1.0F, -8.0F}, {8.0F, 3.0F, 8.0F}};
    Camera camera_;
    MeshRenderer renderer_ = required(MeshRenderer::create(std::vector<PictureMesh>{
        box({-8, -1, -8}, {8, 0, 8}, kGreen), box({-1, kRoofHeight, -1}, {1, kRoofHeight + 0.1F, 1}, kRed),
        box({-0.4F, 0.0F, -0.4F}, {0.4F, 0.5F, 0.4F}, kRed)}));
    Frame frame_ = required(Frame::create(kSceneWidth, kSceneHeight));
    std::vector<std::uint8_t> rgb_;
    const glm::vec3 open_{3.0F, 0.0F, 1.0F};
    const glm::vec3 below_{0.0F, 0.0F, 0.0F};  // below the roof's centre
    const glm::vec3 roof_{0.0F, kRoofHeight + 0.1F, 0.0F};
};

TEST_P(MeshRendererGlTest, MeshesHaveTheirColorsAndTheSunCastsShadows) {
    draw({}, meadow());
    const ShadedPixel open = at(open_);
    EXPECT_GT(open.g, open.r + 10.0F);
    EXPECT_GT(open.g, open.b + 10.0F);
    EXPECT_GT(at(roof_).r, at(roof_).g + 30.0F);
    const glm::vec3 sun = sunDirection();
    const glm::vec3 shadow = glm::vec3(0.0F, kRoofHeight, 0.0F) - sun * (kRoofHeight / sun.y);
    EXPECT_LT(at(shadow).light(), 0.75F * open.light());
    EXPECT_GT(at({-3.0F, 0.0F, 1.0F}).light(), 0.85F * open.light());

    draw({.sun = 0.0F}, meadow());
    EXPECT_GT(at(shadow).light(), 0.8F * at(open_).light()) << "there is no shadow without a sun";
}

TEST_P(MeshRendererGlTest, SnowLiesOnLevelSurfacesBelowTheSky) {
    draw({.snow = 1.0F}, meadow());
    EXPECT_TRUE(at(open_).white());
    EXPECT_TRUE(at(roof_).white());
    const ShadedPixel below = at(below_);
    EXPECT_GT(below.g, below.b + 10.0F);
    EXPECT_FALSE(below.white());
    draw({.snow = 1.0F}, {{0, {}, false}, {1, {}, true}});
    EXPECT_TRUE(at(below_).white()) << "moving meshes give no shelter";
}

TEST_P(MeshRendererGlTest, ColorsCanExcludeSnow) {
    PictureMesh warm = box({-8, -1, -8}, {8, 0, 8}, kGreen);
    for (auto& color : warm.colors) {
        color[3] = 0;
    }
    const std::vector<PictureMesh> meshes{warm};
    renderer_ = required(MeshRenderer::create(meshes));
    draw({.snow = 1.0F}, {{0, {}, false}});
    EXPECT_FALSE(at(open_).white());
    EXPECT_GT(at(open_).g, at(open_).b + 10.0F);
}

TEST_P(MeshRendererGlTest, RainDarkensSurfaces) {
    draw({.sun = 0.0F}, meadow());
    const ShadedPixel dry = at(open_);
    const ShadedPixel dry_below = at(below_);
    draw({.sun = 0.0F, .wet = 1.0F}, meadow());
    EXPECT_LT(at(open_).light(), 0.95F * dry.light());
    EXPECT_NEAR(at(below_).light(), dry_below.light(), 2.0F);
}

TEST_P(MeshRendererGlTest, FogHasTheBackgroundColor) {
    MeshStyle style{.background = {0.2F, 0.3F, 0.9F}, .fog_distance = 0.1F};
    draw(style, meadow());
    const ShadedPixel far = at(open_);
    EXPECT_GT(far.b, far.r + 80.0F);
    EXPECT_GT(far.b, far.g + 60.0F);
}

TEST_P(MeshRendererGlTest, FeetLeavePrintsOnlyInSnow) {
    const glm::vec3 pressed(3.0F, 0.0F, -1.0F);
    const glm::vec3 lifted(3.0F, 0.3F, 3.5F);
    const glm::vec3 untouched(4.5F, 0.0F, 1.0F);
    const glm::vec3 away(-3.0F, 5.0F, 1.0F);
    std::vector<MeshPlace> places = meadow();
    places.push_back({2, {pressed, {1.0F, 0.0F, 0.0F, 0.0F}, 1.0F}, true});
    ASSERT_TRUE(renderer_.press(places, 1.0F, around_));  // before the first picture
    for (const glm::vec3& place : {open_, lifted, away}) {
        places.back().pose.position = place;
        draw({.snow = 1.0F}, places);
    }
    const float fresh = at(untouched).light();
    EXPECT_LT(at(pressed).light(), 0.93F * fresh);
    EXPECT_LT(at(open_).light(), 0.93F * fresh);
    EXPECT_NEAR(at({3.0F, 0.0F, 3.5F}).light(), fresh, 0.06F * fresh);
    EXPECT_NEAR(at({-3.0F, 0.0F, 1.0F}).light(), fresh, 0.06F * fresh);
    places.back().pose.position = {-3.0F, 0.0F, 3.5F};
    ASSERT_TRUE(renderer_.press(places, 1.0F, around_));
    places.back().pose.position = away;
    draw({.snow = 1.0F}, places);
    EXPECT_LT(at({-3.0F, 0.0F, 3.5F}).light(), 0.93F * at(untouched).light())
        << "pressed between two pictures";
    draw({}, places);
    EXPECT_NEAR(at(open_).light(), at(untouched).light(), 0.1F * fresh);
    places.back().mesh = 3;
    EXPECT_EQ(renderer_.press(places, 1.0F, around_).error().code, ErrorCode::kUsage);
}

TEST_P(MeshRendererGlTest, VerticesMove) {
    std::vector<glm::vec3> moved = box({-0.4F, 0.0F, -0.4F}, {0.4F, 0.5F, 0.4F}, kRed).positions;
    for (glm::vec3& p : moved) {
        p.x += 3.0F;
    }
    for (const float there : {0.0F, 3.0F}) {
        draw({}, {{0, {}, false}, {2, {}, false}});
        for (const float x : {0.0F, 3.0F}) {
            const ShadedPixel seen = at({x, 0.45F, 0.4F});
            EXPECT_EQ(seen.r > seen.g, x == there) << x;
        }
        ASSERT_TRUE(renderer_.setPositions(2, moved));
    }

    const glm::vec3 last = std::exchange(moved.back(), glm::vec3(std::numeric_limits<float>::infinity()));
    EXPECT_EQ(renderer_.setPositions(2, moved).error().code, ErrorCode::kInvalidInput);
    moved.back() = last;
    EXPECT_TRUE(renderer_.setPositions(2, moved)) << "again, with existing buffers";
    moved.pop_back();
    EXPECT_EQ(renderer_.setPositions(2, moved).error().code, ErrorCode::kUsage);
    EXPECT_EQ(renderer_.setPositions(3, moved).error().code, ErrorCode::kUsage);
}

TEST_P(MeshRendererGlTest, InvalidMeshesAreErrors) {
    const std::vector<MeshPlace> places{{3, {}, false}};
    EXPECT_EQ(renderer_.draw({camera_, 1.0F}, {}, places, around_, frame_.target()).error().code,
              ErrorCode::kUsage);
    std::vector<PictureMesh> meshes{box({0, 0, 0}, {1, 1, 1}, kRed)};
    meshes[0].colors.pop_back();
    EXPECT_EQ(MeshRenderer::create(meshes).error().code, ErrorCode::kInvalidInput);
    meshes[0] = box({0, 0, 0}, {1, std::numeric_limits<float>::infinity(), 1}, kRed);
    EXPECT_EQ(MeshRenderer::create(meshes).error().code, ErrorCode::kInvalidInput);
}

RELIEF_INSTANTIATE_GL_TESTS(MeshRendererGlTest);

}  // namespace
}  // namespace relief
