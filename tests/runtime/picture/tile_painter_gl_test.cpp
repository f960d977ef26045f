// SPDX-License-Identifier: Apache-2.0
// Sprites painted by tiles against the same sprites drawn by the GL, in OpenGL 4.3 and OpenGL ES 3.1: every style, in
// front of and behind a collider, at the picture's edges, all sizes, and without tile memory.
#include "runtime/bodies/world_textures.h"
#include "runtime/gl/compute_units.h"
#include "runtime/picture/tile_painter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/particles/random.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/particle_renderer.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

// Not multiples of a tile's side.
constexpr GLsizei kTargetWidth = 150;
constexpr GLsizei kTargetHeight = 101;
constexpr int kMargin = 7;  // half a sprite's pixels

class TilePainterGlTest : public GlTest {
  protected:
    TilePainterGlTest() {
        for (const StepPath path : {StepPath::kFragment, StepPath::kCompute}) {
            renderers_.push_back(required(ParticleRenderer::create(view(), path)));
        }
    }

    [[nodiscard]] ColliderView view() const { return {&textures_, collider_.bounds, finestTexel(collider_)}; }
    [[nodiscard]] RenderTarget target() const {
        return {framebuffer_.name(), kTargetWidth, kTargetHeight, srgb_};
    }

    /// All around the sphere, and beyond the picture. One in nine has died.
    void spawn(std::uint32_t count, float reach = 1.2F) {
        particles_.emplace(required(ParticleSystem::create({.capacity = count})));
        Pcg32 random(7);
        std::vector<Birth> births;
        for (std::uint32_t i = 0; i < count; ++i) {
            const float x = random.between(-reach, reach);
            const float y = random.between(-reach, reach);
            const float z = random.between(-reach, reach);
            births.push_back({{x, y, z}, 0.2F * glm::vec3(z, x, y), i % 9 == 0 ? 0.1F : 8.0F, i % 3});
        }
        particles_->spawn(births);
        particles_->step(1.0F);
        sorter_.emplace(required(DepthSorter::create(count, StepPath::kCompute)));
    }

    std::vector<float> draw(ParticleRenderer& renderer, bool ordered, bool among_collider) {
        clearPicture(framebuffer_.name(), {0.1F, 0.2F, 0.4F, 1.0F});
        if (among_collider) {
            EXPECT_TRUE(collider_renderer_.draw(camera_, ColliderStyle{}, target()));
        }
        ParticleOrder order;
        if (ordered) {
            sorter_->update(particles_->positions(), particles_->textureWidth(), particles_->extent(),
                            camera_.eye, 0);
            order = {&sorter_->order(), sorter_->count()};
        }
        const auto drawn = renderer.draw(*particles_, camera_, style_, target(), order,
                                         among_collider ? &collider_renderer_.depth() : nullptr);
        EXPECT_TRUE(drawn) << drawn.error().message;
        return required(readTextureFloats(color_, kTargetWidth, kTargetHeight));
    }

    struct Difference {
        double mean = 0.0;
        double most = 0.0;
    };
    /// \param width, height  of both pictures.
    /// \param margin  pixels at the edges that are ignored: some drivers drop points whose centre is outside the
    /// picture.
    static Difference between(const std::vector<float>& a, const std::vector<float>& b, int margin = 0,
                              int width = kTargetWidth, int height = kTargetHeight) {
        Difference difference;
        const int parts = 4 * (width - 2 * margin) * (height - 2 * margin);
        for (int y = margin; y < height - margin; ++y) {
            for (int i = 4 * (y * width + margin); i < 4 * ((y + 1) * width - margin); ++i) {
                const auto at = static_cast<std::size_t>(i);
                const double apart = std::abs(static_cast<double>(a[at]) - static_cast<double>(b[at]));
                EXPECT_FALSE(std::isnan(apart));
                difference.mean += apart / parts;
                difference.most = std::max(difference.most, apart);
            }
        }
        return difference;
    }

    /// Both methods give one picture. The GL snaps vertices to 1/256 pixel, and blends in half floats.
    void expectSamePicture(const char* what, bool ordered, bool among_collider, double most = 0.04) {
        SCOPED_TRACE(what);
        const std::vector<float> drawn = draw(renderers_[0], ordered, among_collider);
        const std::vector<float> tiles = draw(renderers_[1], ordered, among_collider);
        const Difference difference = between(drawn, tiles, kMargin);
        EXPECT_LT(difference.mean, 0.002);
        EXPECT_LT(difference.most, most);
        EXPECT_NE(drawn, tiles) << "tiles round differently: they were not painted";
        const std::vector<ParticleLook> looks = style_.looks;
        for (ParticleLook& look : style_.looks) {
            look.opacity = {{0.0F, 0.0F}};
        }
        const float opacity = std::exchange(style_.opacity, 0.0F);
        EXPECT_GT(between(drawn, draw(renderers_[1], ordered, among_collider)).mean, 0.01)
            << "nothing is drawn";
        style_.looks = looks;
        style_.opacity = opacity;
    }

    bool srgb_ = false;
    const Collider collider_ = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 64);
    Camera camera_{.eye = {0.3F, 0.4F, 3.0F}, .near_plane = 0.5F, .far_plane = 50.0F};
    ParticleStyle style_{.diameter = 0.05F, .opacity = 0.6F, .fade_in = 0.0F, .fade_out = 0.0F};
    WorldTextures textures_ = required(WorldTextures::create(collider_));
    ColliderRenderer collider_renderer_ = required(ColliderRenderer::create(view()));
    std::vector<ParticleRenderer> renderers_;
    std::optional<ParticleSystem> particles_;
    std::optional<DepthSorter> sorter_;
    const GlTexture color_ = makeTexture2D(GL_RGBA16F, kTargetWidth, kTargetHeight, GL_RGBA, GL_HALF_FLOAT);
    const GlTexture depth_ =
        makeTexture2D(GL_DEPTH_COMPONENT32F, kTargetWidth, kTargetHeight, GL_DEPTH_COMPONENT, GL_FLOAT);
    const GlFramebuffer framebuffer_ = required(makeFramebuffer({color_.name()}, depth_.name()));
};

TEST_P(TilePainterGlTest, EveryStyleMatchesPoints) {
    spawn(1500);
    expectSamePicture("in order", true, true);
    expectSamePicture("as they come", false, false);
    style_.soft_distance = 0.3F;
    expectSamePicture("soft", true, true);
    style_.soft_distance = 0.0F;
    style_.blend = Blend::kAdditive;
    style_.opacity = 0.1F;
    expectSamePicture("added", false, true);
    style_.blend = Blend::kAlpha;
    style_.opacity = 0.6F;
    srgb_ = true;
    expectSamePicture("sRGB", true, true);
    srgb_ = false;
    for (const glm::vec3& color :
         {glm::vec3(1.0F, 0.2F, 0.1F), glm::vec3(0.1F, 0.3F, 1.0F), glm::vec3(1.0F)}) {
        ParticleLook& look = style_.looks.emplace_back();
        look.color = {{0.0F, color}};
        look.size = {{0.0F, 0.02F}, {0.5F, 0.1F}};
        look.lit = style_.looks.size() != 2;
    }
    expectSamePicture("types", true, true);
    // The order matters, so equal pictures prove that the tiles keep it.
    style_.opacity = 0.9F;
    EXPECT_GT(between(draw(renderers_[1], true, true), draw(renderers_[1], false, true)).most, 0.4);
}

// Cells rotate in the picture, and stretched sprites lie along their velocity; both have corners.
TEST_P(TilePainterGlTest, QuadsCellsAndStretchedSpritesMatch) {
    // Two cells that fade towards their edges: a smooth picture, unlike a grain.
    constexpr std::uint32_t kSide = 32;
    std::vector<std::uint8_t> rgba;
    for (std::uint32_t y = 0; y < kSide; ++y) {
        for (std::uint32_t x = 0; x < 2 * kSide; ++x) {
            const std::uint32_t in_cell = x % kSide;
            const std::uint32_t to_edge = std::min({in_cell, kSide - 1 - in_cell, y, kSide - 1 - y});
            rgba.insert(rgba.end(), {static_cast<std::uint8_t>(8 * in_cell), static_cast<std::uint8_t>(8 * y),
                                     static_cast<std::uint8_t>(x < kSide ? 255 : 0),
                                     static_cast<std::uint8_t>(15 * to_edge)});
        }
    }
    const SpriteAtlas atlas = required(SpriteAtlas::create(rgba, 2 * kSide, kSide, 2, 1));
    spawn(800);
    style_.diameter = 0.08F;
    style_.looks.resize(3);
    style_.looks[0].cell_first = 0;
    style_.looks[0].rotation_spread = 3.0F;
    style_.looks[1].cell_first = 1;
    style_.looks[1].cell_last = 1;
    style_.looks[1].rotation = {{0.0F, 0.6F}};
    constexpr double kCellSteps = 0.1;  // nearest texels are sampled
    for (const bool quads : {false, true}) {
        style_.sprite = quads ? Sprite::kQuad : Sprite::kPoint;
        style_.atlas = nullptr;
        expectSamePicture(quads ? "quads" : "points", true, true);
        style_.atlas = &atlas;
        expectSamePicture(quads ? "quads of cells" : "points of cells", true, true, kCellSteps);
    }
    style_.looks[0].stretch = 0.8F;
    style_.looks[2].stretch = 2.0F;
    expectSamePicture("stretched cells", true, true, kCellSteps);
    style_.atlas = nullptr;
    expectSamePicture("stretched", true, true);
    style_.blend = Blend::kAdditive;
    style_.opacity = 0.2F;
    expectSamePicture("stretched, added", false, false);
}

TEST_P(TilePainterGlTest, SpritesOfEverySizeMatch) {
    spawn(300);
    const auto compare = [&](float diameter, int margin) {
        style_.diameter = diameter;
        const std::vector<float> drawn = draw(renderers_[0], true, true);
        const Difference difference = between(drawn, draw(renderers_[1], true, true), margin);
        EXPECT_LT(difference.mean, 0.002) << diameter;
        EXPECT_LT(difference.most, 0.04) << diameter;
    };
    style_.opacity = 1.0F;
    compare(0.001F, kMargin);
    style_.opacity = 0.5F;
    for (const float diameter : {0.02F, 0.2F, 0.4F}) {
        compare(diameter, 25);
    }
    // Quads have no maximum size, and stay if their centre is outside the picture.
    style_.sprite = Sprite::kQuad;
    for (const float diameter : {0.4F, 5.0F, 1e4F}) {
        compare(diameter, 0);
    }
    for (const float diameter : {1e12F, 1e30F}) {  // rasterisers draw these differently
        style_.diameter = diameter;
        for (const float part : draw(renderers_[1], true, true)) {
            ASSERT_FALSE(std::isnan(part));
        }
    }
}

// Tiles have room for 2^18 entries of few sprites. Beyond that, identical points or quads are drawn.
TEST_P(TilePainterGlTest, SpritesAreDrawnIfTilesAreFull) {
    spawn(8000, 0.7F);
    style_.diameter = 2.0F;
    style_.opacity = 0.01F;
    for (const Sprite sprite : {Sprite::kQuad, Sprite::kPoint}) {
        style_.sprite = sprite;
        EXPECT_EQ(draw(renderers_[0], true, false), draw(renderers_[1], true, false));
    }
    // Afterwards tiles are painted again.
    style_.diameter = 0.05F;
    style_.opacity = 0.6F;
    expectSamePicture("after that", true, false);
}

// So far away that all particles are in a few tiles, whose work groups would process all of them: points are drawn.
TEST_P(TilePainterGlTest, ACloudFarAwayIsDrawnAsPoints) {
    spawn(90'000);
    style_.diameter = 0.2F;
    camera_.far_plane = 1000.0F;
    camera_.eye = {0.0F, 0.0F, 200.0F};
    const std::vector<float> points = draw(renderers_[0], true, false);
    EXPECT_EQ(points, draw(renderers_[1], true, false));
    camera_.eye = {0.0F, 0.0F, 3.0F};
    EXPECT_NE(points, draw(renderers_[1], true, false));
}

TEST_P(TilePainterGlTest, EmptyPicturesMatch) {
    spawn(300);
    ASSERT_EQ(sorter_->count(), 0U) << "before its first update";
    EXPECT_TRUE(renderers_[1].draw(*particles_, camera_, style_, target(), {&sorter_->order(), 0}));
    const std::vector<float> seen = draw(renderers_[1], true, false);
    camera_.target = {0.0F, 0.0F, 9.0F};  // all are behind the viewer
    EXPECT_EQ(draw(renderers_[0], true, false), draw(renderers_[1], true, false));
    EXPECT_NE(seen, draw(renderers_[1], true, false));
    camera_.target = glm::vec3(0.0F);
    particles_->step(20.0F);
    EXPECT_EQ(draw(renderers_[0], true, false), draw(renderers_[1], true, false));
}

TEST_P(TilePainterGlTest, ResizedPicturesAndTargetsWithoutDepthMatch) {
    spawn(500);
    for (const GLsizei side : {40, 17, 300}) {
        std::vector<std::vector<float>> pictures;
        for (ParticleRenderer& renderer : renderers_) {
            const GlTexture color = makeTexture2D(GL_RGBA16F, side, side, GL_RGBA, GL_HALF_FLOAT);
            const GlFramebuffer framebuffer = required(makeFramebuffer({color.name()}));
            glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
            glClear(GL_COLOR_BUFFER_BIT);
            glBindFramebuffer(GL_FRAMEBUFFER, 0);
            ASSERT_TRUE(renderer.draw(*particles_, camera_, style_, {framebuffer.name(), side, side}));
            pictures.push_back(required(readTextureFloats(color, side, side)));
        }
        const Difference difference = between(pictures[0], pictures[1], side < 100 ? 3 : 9, side, side);
        EXPECT_LT(difference.mean, 0.002) << side;
        EXPECT_LT(difference.most, 0.06) << side;
    }
}

// A depth renderbuffer cannot be read: identical points are drawn.
TEST_P(TilePainterGlTest, DepthRenderbuffersFallBackToPoints) {
    spawn(500);
    GLuint depth = 0;
    glGenRenderbuffers(1, &depth);
    glBindRenderbuffer(GL_RENDERBUFFER, depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, kTargetWidth, kTargetHeight);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    EXPECT_EQ(draw(renderers_[0], true, true), draw(renderers_[1], true, true));
    glDeleteRenderbuffers(1, &depth);
}

RELIEF_INSTANTIATE_GL_TESTS(TilePainterGlTest);

}  // namespace
}  // namespace relief
