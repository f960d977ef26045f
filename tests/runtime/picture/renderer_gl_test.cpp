// SPDX-License-Identifier: Apache-2.0
// Pictures: occlusion and positions; no pass of Relief changes the caller's state or is affected by it; and meshes,
// checked at points of the world: a roof above a meadow, in sun, rain, snow and fog.
#include <gtest/gtest.h>
#include <array>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "runtime/bodies/world_textures.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/collider_view.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/frame.h"
#include "runtime/picture/mesh_renderer.h"
#include "runtime/picture/particle_renderer.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/gl/caller_state.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief::test {
namespace {

constexpr std::uint32_t kWidth = 96;
constexpr std::uint32_t kHeight = 64;

struct Rgb {
    int r, g, b;
};

class RendererGlTest : public GlTest {
  protected:
    [[nodiscard]] ColliderView view() const { return {&textures_, collider_.bounds, finestTexel(collider_)}; }

    std::vector<std::uint8_t> drawCollider() {
        const auto drawn = collider_renderer_.draw(camera_, style_, frame_.target());
        EXPECT_TRUE(drawn) << drawn.error().message;
        return frame_.read();
    }
    Rgb pixel(const std::vector<std::uint8_t>& rgb, std::uint32_t x, std::uint32_t y) const {
        const std::size_t at = 3 * (std::size_t{kWidth} * y + x);
        return {rgb[at], rgb[at + 1], rgb[at + 2]};
    }
    /// The pixel, from the top left, of a point in object space.
    std::pair<std::uint32_t, std::uint32_t> project(const glm::vec3& p) const {
        const glm::vec4 clip = camera_.projection(1.5F) * camera_.view() * glm::vec4(p, 1.0F);
        return {static_cast<std::uint32_t>((0.5F + 0.5F * clip.x / clip.w) * static_cast<float>(kWidth)),
                static_cast<std::uint32_t>((0.5F - 0.5F * clip.y / clip.w) * static_cast<float>(kHeight))};
    }
    void spawnAt(const glm::vec3& p) {
        particles_.spawn(std::vector<Birth>{{p, glm::vec3(0.0F), 100.0F, 0}});
        particles_.step(1.0F);
    }

    const Collider collider_ = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 128);
    WorldTextures textures_ = required(WorldTextures::create(collider_));
    Camera camera_{.eye = {0.0F, 0.0F, 3.0F}, .near_plane = 0.5F, .far_plane = 50.0F};
    ColliderStyle style_;
    Frame frame_ = required(Frame::create(kWidth, kHeight));
    ColliderRenderer collider_renderer_ = required(ColliderRenderer::create(view()));
    ParticleRenderer points_ = required(ParticleRenderer::create(view()));
    ParticleSystem particles_ = required(ParticleSystem::create({.capacity = 100}));
};

TEST_P(RendererGlTest, ParticlesAreOccludedByDepth) {
    const ParticleStyle style{.diameter = 0.06F, .opacity = 1.0F};
    const std::vector<std::uint8_t> bare = drawCollider();
    // In front, behind, half a diameter in front of and behind the surface, beside, and behind the eye.
    for (const auto& [place, shown] :
         {std::pair(glm::vec3(0.0F, 0.0F, 1.0F), true), std::pair(glm::vec3(0.0F, 0.0F, -1.0F), false),
          std::pair(glm::vec3(0.1F, 0.05F, 0.51F), true), std::pair(glm::vec3(0.1F, 0.05F, 0.40F), false),
          std::pair(glm::vec3(0.7F, 0.4F, -1.0F), true), std::pair(glm::vec3(0.0F, 0.0F, 4.0F), false)}) {
        particles_ = required(ParticleSystem::create({.capacity = 4}));
        spawnAt(place);
        drawCollider();
        points_.draw(particles_, camera_, style, frame_.target());
        const std::vector<std::uint8_t> rgb = frame_.read();
        if (!shown) {
            EXPECT_EQ(rgb, bare) << place.z;
            continue;
        }
        const auto [x, y] = project(place);
        const Rgb c = pixel(rgb, x, y);
        EXPECT_GT(std::min({c.r, c.g, c.b}), 170) << place.z;
    }
}

TEST_P(RendererGlTest, DeadParticlesAreNotDrawn) {
    const std::vector<std::uint8_t> bare = drawCollider();
    particles_.spawn(std::vector<Birth>{{{0.6F, 0.3F, 0.5F}, glm::vec3(0.0F), 0.5F, 0},
                                        {{0.0F, -90.0F, 0.0F}, glm::vec3(0.0F), 100.0F, 0}});
    particles_.step(1.0F);
    ASSERT_EQ(particles_.counts().died, 1U);
    ASSERT_EQ(particles_.extent(), 2U);
    points_.draw(particles_, camera_, {.diameter = 0.1F}, frame_.target());
    EXPECT_EQ(frame_.read(), bare);
}

TEST_P(RendererGlTest, OpacityFadesInAndOut) {
    const ParticleStyle style{.diameter = 0.2F, .opacity = 1.0F, .fade_in = 1.0F, .fade_out = 1.0F};
    particles_.spawn(std::vector<Birth>{{{0.0F, 0.0F, 1.0F}, glm::vec3(0.0F), 4.0F, 0}});
    std::vector<int> brightness;
    for (int step = 0; step < 15; ++step) {  // ages 0.25 … 3.75
        particles_.step(0.25F);
        drawCollider();
        points_.draw(particles_, camera_, style, frame_.target());
        brightness.push_back(pixel(frame_.read(), kWidth / 2, kHeight / 2).b);
    }
    EXPECT_LT(brightness[0] + 10, brightness[1]);
    EXPECT_LT(brightness[1] + 10, brightness[3]);
    EXPECT_EQ(brightness[3], brightness[11]);
    EXPECT_GT(brightness[11], brightness[13] + 10);
    EXPECT_GT(brightness[13], brightness[14] + 10);
}

TEST_P(RendererGlTest, CachedPicturesMatchNewOnes) {
    style_.ground = -0.5F;
    const std::vector<std::uint8_t> first = drawCollider();
    EXPECT_EQ(drawCollider(), first);
    const Camera camera = camera_;
    camera_.eye.x += 0.2F;
    EXPECT_NE(drawCollider(), first);
    camera_ = camera;
    EXPECT_EQ(drawCollider(), first);
    style_.background = {0.2F, 0.2F, 0.2F};
    EXPECT_NE(drawCollider(), first);
}

TEST_P(RendererGlTest, FloorIsShadedBelowTheCollider) {
    style_.ground = -0.5F;
    camera_.eye = {0.0F, 1.5F, 3.0F};
    const std::vector<std::uint8_t> rgb = drawCollider();
    const auto [x, y] = project({0.6F, -0.5F, -0.3F});     // the sphere's shadow by sunDirection()
    const auto [ox, oy] = project({-0.9F, -0.5F, -0.3F});  // unshaded
    EXPECT_LT(pixel(rgb, x, y).b + 20, pixel(rgb, ox, oy).b);
}

// The finest body of a world determines the ray step, however large the others are. Rays must still cross the whole
// box.
TEST_P(RendererGlTest, RaysCrossBoxesOfManyTexels) {
    const auto clay = [&](float texel) {
        auto renderer = required(ColliderRenderer::create({&textures_, collider_.bounds, texel}));
        EXPECT_TRUE(renderer.draw(camera_, style_, frame_.target()));
        const std::vector<std::uint8_t> rgb = frame_.read();
        int count = 0;
        for (std::size_t i = 0; i < rgb.size(); i += 3) {
            count += rgb[i] > rgb[i + 2] ? 1 : 0;
        }
        return count;
    };
    const int all = clay(view().texel);
    EXPECT_GT(all, 500);
    EXPECT_NEAR(clay(1e-5F), all, 0.02 * all);
}

TEST_P(RendererGlTest, FrameSizesAreValidated) {
    EXPECT_EQ(Frame::create(0, 5).error().code, ErrorCode::kUsage);
    EXPECT_EQ(Frame::create(5, 0).error().code, ErrorCode::kUsage);
    EXPECT_EQ(Frame::create(1000000, 5).error().code, ErrorCode::kLimit);
    EXPECT_EQ(Frame::create(0xffffffffU, 0xffffffffU).error().code, ErrorCode::kLimit);
    EXPECT_EQ(required(Frame::create(1, 1)).read().size(), 3U);
}

// Pictures do not depend on the caller's state, which is kept. The maps are uploaded in that state as well: its unpack
// parameters must have no effect.
TEST_P(RendererGlTest, CallerStateIsKeptAndIgnored) {
    style_.ground = -0.5F;
    spawnAt({0.0F, 0.8F, 0.9F});
    spawnAt({0.0F, 0.7F, 0.0F});
    const auto run = [&](const std::function<void(const char*)>& check) {
        const auto textures = WorldTextures::create(collider_);
        check("WorldTextures::create");
        const ColliderView seen{&*textures, collider_.bounds, finestTexel(collider_)};
        auto frame = Frame::create(kWidth, kHeight);
        check("Frame::create");
        auto renderer = ColliderRenderer::create(seen);
        check("ColliderRenderer::create");
        auto points = ParticleRenderer::create(seen);
        check("ParticleRenderer::create");
        EXPECT_TRUE(renderer->draw(camera_, style_, frame->target()));
        check("ColliderRenderer::draw");
        const ParticleStyle style{.diameter = 0.1F};
        EXPECT_TRUE(points->draw(particles_, camera_, style, frame->target()));
        check("ParticleRenderer::draw");
        auto tiles = ParticleRenderer::create(seen, StepPath::kCompute);
        check("ParticleRenderer::create, tiles");
        for (const StepPath path : {StepPath::kFragment, StepPath::kCompute}) {
            auto sorter = DepthSorter::create(2000, path);
            check("DepthSorter::create");
            sorter->update(particles_.positions(), particles_.textureWidth(), particles_.extent(),
                           camera_.eye, DepthSorter::sequencePasses(2000));
            check("DepthSorter::update");
            EXPECT_TRUE(tiles->draw(particles_, camera_, style, frame->target(),
                                    {&sorter->order(), sorter->count()}));
            check("ParticleRenderer::draw, tiles");
        }
        const auto atlas = SpriteAtlas::create(std::vector<std::uint8_t>(16, 200), 2, 2, 2, 1);
        check("SpriteAtlas::create");
        ParticleStyle quads{.diameter = 0.3F, .sprite = Sprite::kQuad, .blend = Blend::kAdditive};
        quads.soft_distance = 0.1F;
        quads.atlas = &*atlas;
        quads.looks.resize(1);
        quads.looks[0].cell_first = 0;
        EXPECT_TRUE(points->draw(particles_, camera_, quads, frame->target(), {}, &renderer->depth()));
        check("ParticleRenderer::draw, quads");
        std::vector<std::uint8_t> both = frame->read();
        check("Frame::read");
        const auto mesh = ColliderMesh::create(
            {{{-0.5F, 0.5F, 0.5F}, {-0.2F, 0.5F, 0.5F}, {-0.3F, 0.9F, 0.5F}}, {}, {0, 1, 2}});
        check("ColliderMesh::create");
        auto with_mesh = ColliderRenderer::create(seen, &*mesh);
        check("ColliderRenderer::create, mesh");
        EXPECT_TRUE(with_mesh->draw(camera_, style_, frame->target()));
        check("ColliderRenderer::draw, mesh");
        const std::vector<std::uint8_t> of_mesh = frame->read();
        both.insert(both.end(), of_mesh.begin(), of_mesh.end());
        return both;
    };
    const std::vector<std::uint8_t> plain = run([](const char*) {});
    const CallerState caller;
    EXPECT_EQ(run([&](const char* call) { caller.expectKept(call); }), plain);
}

constexpr std::uint32_t kMeadowWidth = 240;
constexpr std::uint32_t kMeadowHeight = 180;
constexpr std::array<std::uint8_t, 4> kMeadowGreen{90, 140, 60, 255};
constexpr std::array<std::uint8_t, 4> kRoofRed{170, 60, 50, 255};
constexpr float kRoofHeight = 2.0F;

PictureMesh box(const glm::vec3& low, const glm::vec3& high, const std::array<std::uint8_t, 4>& color) {
    PictureMesh mesh;
    for (unsigned i = 0; i < 8; ++i) {
        mesh.positions.push_back(Bounds{low, high}.corner(i));
        mesh.colors.push_back(color);
    }
    mesh.triangles = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                      2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    return mesh;
}

struct MeanRgb {
    float r, g, b;
    [[nodiscard]] float light() const { return (r + g + b) / 3.0F; }
    [[nodiscard]] bool white() const {
        return std::min({r, g, b}) > 0.55F * 255.0F && std::abs(r - b) < 30.0F;
    }
};

class MeshRendererGlTest : public GlTest {
  protected:
    void draw(const MeshStyle& style, const std::vector<MeshInstance>& places) {
        const auto drawn =
            renderer_.draw({camera_, frame_.target().aspect()}, style, places, around_, frame_.target());
        ASSERT_TRUE(drawn) << drawn.error().message;
        rgb_ = frame_.read();
    }
    [[nodiscard]] std::vector<MeshInstance> meadow() const { return {{0, {}, false}, {1, {}, false}}; }

    /// The mean of 3 × 3 pixels around a point of the world.
    [[nodiscard]] MeanRgb at(const glm::vec3& p) const {
        const glm::vec4 clip = camera_.projection(float{kMeadowWidth} / float{kMeadowHeight}) *
                               camera_.view() * glm::vec4(p, 1.0F);
        const auto x = static_cast<int>((0.5F + 0.5F * clip.x / clip.w) * float{kMeadowWidth});
        const auto y = static_cast<int>((0.5F - 0.5F * clip.y / clip.w) * float{kMeadowHeight});
        glm::vec3 sum(0.0F);
        for (int i = 0; i < 9; ++i) {
            const auto red =
                3 * static_cast<std::size_t>((y + i / 3 - 1) * int{kMeadowWidth} + x + i % 3 - 1);
            sum += glm::vec3(rgb_.at(red), rgb_.at(red + 1), rgb_.at(red + 2));
        }
        return {sum.x / 9, sum.y / 9, sum.z / 9};
    }

    const Bounds around_{{-8.0F, -1.0F, -8.0F}, {8.0F, 3.0F, 8.0F}};
    Camera camera_{
        .eye = {0.0F, 5.0F, 11.0F}, .target = {0.0F, 0.5F, 0.0F}, .fov = 40.0F, .far_plane = 200.0F};
    MeshRenderer renderer_ = required(MeshRenderer::create(
        std::vector<PictureMesh>{box({-8, -1, -8}, {8, 0, 8}, kMeadowGreen),
                                 box({-1, kRoofHeight, -1}, {1, kRoofHeight + 0.1F, 1}, kRoofRed),
                                 box({-0.4F, 0.0F, -0.4F}, {0.4F, 0.5F, 0.4F}, kRoofRed)}));
    Frame frame_ = required(Frame::create(kMeadowWidth, kMeadowHeight));
    std::vector<std::uint8_t> rgb_;
    const glm::vec3 open_{3.0F, 0.0F, 1.0F};
    const glm::vec3 below_{0.0F, 0.0F, 0.0F};  // below the roof's centre
    const glm::vec3 roof_{0.0F, kRoofHeight + 0.1F, 0.0F};
};

TEST_P(MeshRendererGlTest, MeshesHaveTheirColorsAndTheSunCastsShadows) {
    draw({}, meadow());
    const MeanRgb open = at(open_);
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
    const MeanRgb below = at(below_);
    EXPECT_GT(below.g, below.b + 10.0F);
    EXPECT_FALSE(below.white());
    draw({.snow = 1.0F}, {{0, {}, false}, {1, {}, true}});
    EXPECT_TRUE(at(below_).white()) << "moving meshes give no shelter";
}

TEST_P(MeshRendererGlTest, ColorsCanExcludeSnow) {
    PictureMesh warm = box({-8, -1, -8}, {8, 0, 8}, kMeadowGreen);
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
    const MeanRgb dry = at(open_);
    const MeanRgb dry_below = at(below_);
    draw({.sun = 0.0F, .wet = 1.0F}, meadow());
    EXPECT_LT(at(open_).light(), 0.95F * dry.light());
    EXPECT_NEAR(at(below_).light(), dry_below.light(), 2.0F);
}

TEST_P(MeshRendererGlTest, FogHasTheBackgroundColor) {
    MeshStyle style{.background = {0.2F, 0.3F, 0.9F}, .fog_distance = 0.1F};
    draw(style, meadow());
    const MeanRgb far = at(open_);
    EXPECT_GT(far.b, far.r + 80.0F);
    EXPECT_GT(far.b, far.g + 60.0F);
}

TEST_P(MeshRendererGlTest, FeetLeavePrintsOnlyInSnow) {
    const glm::vec3 pressed(3.0F, 0.0F, -1.0F);
    const glm::vec3 lifted(3.0F, 0.3F, 3.5F);
    const glm::vec3 untouched(4.5F, 0.0F, 1.0F);
    const glm::vec3 away(-3.0F, 5.0F, 1.0F);
    std::vector<MeshInstance> places = meadow();
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
    std::vector<glm::vec3> moved = box({-0.4F, 0.0F, -0.4F}, {0.4F, 0.5F, 0.4F}, kRoofRed).positions;
    for (glm::vec3& p : moved) {
        p.x += 3.0F;
    }
    for (const float there : {0.0F, 3.0F}) {
        draw({}, {{0, {}, false}, {2, {}, false}});
        for (const float x : {0.0F, 3.0F}) {
            const MeanRgb seen = at({x, 0.45F, 0.4F});
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
    const std::vector<MeshInstance> places{{3, {}, false}};
    EXPECT_EQ(renderer_.draw({camera_, 1.0F}, {}, places, around_, frame_.target()).error().code,
              ErrorCode::kUsage);
    std::vector<PictureMesh> meshes{box({0, 0, 0}, {1, 1, 1}, kRoofRed)};
    meshes[0].colors.pop_back();
    EXPECT_EQ(MeshRenderer::create(meshes).error().code, ErrorCode::kInvalidInput);
    meshes[0] = box({0, 0, 0}, {1, std::numeric_limits<float>::infinity(), 1}, kRoofRed);
    EXPECT_EQ(MeshRenderer::create(meshes).error().code, ErrorCode::kInvalidInput);
}

RELIEF_INSTANTIATE_GL_TESTS(MeshRendererGlTest);

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(RendererGlTest);

}  // namespace relief::test
