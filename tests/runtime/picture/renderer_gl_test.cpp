// SPDX-License-Identifier: Apache-2.0
// Pictures: occlusion and positions; and no pass of Relief changes the caller's state or is affected by it.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "runtime/bodies/world_textures.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/frame.h"
#include "runtime/picture/particle_renderer.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/gl/caller_state.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

constexpr std::uint32_t kWidth = 96;
constexpr std::uint32_t kHeight = 64;

struct Rgb {
    int r, g, b;
};

class RendererGlTest : public GlTest {
  protected:
    RendererGlTest() {
        camera_.eye = {0.0F, 0.0F, 3.0F};
        camera_.target = {0.0F, 0.0F, 0.0F};
        camera_.fov = 30.0F;
        camera_.near_plane = 0.5F;
        camera_.far_plane = 50.0F;
    }
    [[nodiscard]] ColliderView view() const { return {&textures_, collider_.bounds, finestTexel(collider_)}; }

    void drawCollider() {
        const auto drawn = collider_renderer_.draw(camera_, style_, frame_.target());
        ASSERT_TRUE(drawn) << drawn.error().message;
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
        const std::array<Birth, 1> births{Birth{p, glm::vec3(0.0F), 100.0F, 0}};
        particles_.spawn(births);
        particles_.step(1.0F);
    }

    const Collider collider_ = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 128);
    WorldTextures textures_ = required(WorldTextures::create(collider_));
    Camera camera_;
    ColliderStyle style_;
    Frame frame_ = required(Frame::create(kWidth, kHeight));
    ColliderRenderer collider_renderer_ = required(ColliderRenderer::create(view()));
    ParticleRenderer points_ = required(ParticleRenderer::create(view()));
    ParticleSystem particles_ = required(ParticleSystem::create({.capacity = 100}));
};

TEST_P(RendererGlTest, ParticlesAreOccludedByDepth) {
    const ParticleStyle style{.diameter = 0.06F, .opacity = 1.0F};
    drawCollider();
    const std::vector<std::uint8_t> bare = frame_.read();
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
    drawCollider();
    const std::vector<std::uint8_t> bare = frame_.read();
    const std::array<Birth, 2> births{Birth{{0.6F, 0.3F, 0.5F}, glm::vec3(0.0F), 0.5F, 0},
                                      Birth{{0.0F, -90.0F, 0.0F}, glm::vec3(0.0F), 100.0F, 0}};
    particles_.spawn(births);
    particles_.step(1.0F);
    ASSERT_EQ(particles_.counts().died, 1U);
    ASSERT_EQ(particles_.extent(), 2U);
    points_.draw(particles_, camera_, {.diameter = 0.1F}, frame_.target());
    EXPECT_EQ(frame_.read(), bare);
}

TEST_P(RendererGlTest, OpacityFadesInAndOut) {
    const ParticleStyle style{.diameter = 0.2F, .opacity = 1.0F, .fade_in = 1.0F, .fade_out = 1.0F};
    const std::array<Birth, 1> births{Birth{{0.0F, 0.0F, 1.0F}, glm::vec3(0.0F), 4.0F, 0}};
    particles_.spawn(births);
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
    drawCollider();
    const std::vector<std::uint8_t> first = frame_.read();
    drawCollider();
    EXPECT_EQ(frame_.read(), first);
    const Camera camera = camera_;
    camera_.eye.x += 0.2F;
    drawCollider();
    EXPECT_NE(frame_.read(), first);
    camera_ = camera;
    drawCollider();
    EXPECT_EQ(frame_.read(), first);
    style_.background = {0.2F, 0.2F, 0.2F};
    drawCollider();
    EXPECT_NE(frame_.read(), first);
}

TEST_P(RendererGlTest, FloorIsShadedBelowTheCollider) {
    style_.ground = -0.5F;
    camera_.eye = {0.0F, 1.5F, 3.0F};
    drawCollider();
    const std::vector<std::uint8_t> rgb = frame_.read();
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
    const auto frame = Frame::create(1, 1);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->read().size(), 3U);
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

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(RendererGlTest);

}  // namespace relief
