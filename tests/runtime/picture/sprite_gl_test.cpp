// SPDX-License-Identifier: Apache-2.0
// Sprites in closed form: unlit sprites on a float target, so that every pixel is colour times opacity.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "runtime/gl/gl_functions.h"
#include "runtime/picture/particle_renderer.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

constexpr GLsizei kSide = 64;
// RGBA16F has a relative precision of 2^-11.
constexpr float kHalf = 1.0F / 1024.0F;

class SpriteGlTest : public GlTest {
  protected:
    /// A sprite of each type at the origin, with lifetime 8 and this age in seconds.
    void spawnTypes(const std::vector<std::uint32_t>& types, float age) {
        std::vector<Birth> births;
        for (const std::uint32_t type : types) {
            births.push_back({glm::vec3(0.0F), glm::vec3(0.0F), 8.0F, type});
        }
        spawn(births, age);
    }
    void spawn(const std::vector<Birth>& births, float dt, int steps = 1,
               Integrator integrator = Integrator::kEuler) {
        particles_.emplace(required(ParticleSystem::create({.capacity = 64, .integrator = integrator})));
        particles_->spawn(births);
        for (int i = 0; i < steps; ++i) {
            particles_->step(dt);
        }
    }
    static ParticleLook look(const glm::vec3& color, float opacity, float size) {
        ParticleLook out;
        out.color = {{0.0F, color}};
        out.opacity = {{0.0F, opacity}};
        out.size = {{0.0F, size}};
        out.lit = false;
        return out;
    }
    static ParticleLook cells(std::uint32_t first, std::uint32_t last, float size = 1.0F) {
        ParticleLook out = look(glm::vec3(1.0F), 1.0F, size);
        out.cell_first = first;
        out.cell_last = last;
        return out;
    }
    void draw(const GlTexture* order = nullptr, const GlTexture* behind = nullptr) {
        const ParticleOrder ranks{order, order_count_};
        clearPicture(framebuffer_.name(), glm::vec4(0.0F));
        const auto drawn =
            renderer_.draw(*particles_, camera_, style_, {framebuffer_.name(), kSide, kSide}, ranks, behind);
        ASSERT_TRUE(drawn) << drawn.error().message;
        pixels_ = required(readTextureFloats(color_, kSide, kSide));
    }
    /// Draws a sprite with this look at the origin, at this age of 8 seconds.
    void drawOne(const ParticleLook& look, float age = 1.0F) {
        style_.looks = {look};
        spawnTypes({0}, age);
        draw();
    }
    /// From the lower left.
    [[nodiscard]] glm::vec4 pixel(int x, int y) const {
        const std::size_t at = 4 * (static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x));
        return {pixels_[at], pixels_[at + 1], pixels_[at + 2], pixels_[at + 3]};
    }
    /// As many ranks as will be drawn; below 0: none.
    [[nodiscard]] GlTexture orderTexture(const std::vector<int>& order) {
        std::vector<std::uint32_t> texels;
        for (const int index : order) {
            texels.push_back(static_cast<std::uint32_t>(std::max(index, 0)));
            texels.push_back(index < 0 ? 0U : 7U);
        }
        order_count_ = static_cast<std::uint32_t>(order.size());
        // Two per row, to test multiple rows.
        return makeTexture2D(GL_RG32UI, 2, static_cast<GLsizei>(order.size() / 2), GL_RG_INTEGER,
                             GL_UNSIGNED_INT, texels.data());
    }
    std::uint32_t order_count_ = 0;
    /// Two cells of 2 × 2: grey, and
    ///     red  green
    ///     blue clear
    void useAtlas() {
        const std::vector<std::uint8_t> rgba{128, 128, 128, 255, 128, 128, 128, 255, 255, 0,   0,
                                             255, 0,   255, 0,   255, 128, 128, 128, 255, 128, 128,
                                             128, 255, 0,   0,   255, 255, 255, 255, 0,   0};
        atlas_.emplace(required(SpriteAtlas::create(rgba, 4, 2, 2, 1)));
        style_.atlas = &*atlas_;
    }

    const GlTexture color_ = makeTexture2D(GL_RGBA16F, kSide, kSide, GL_RGBA, GL_HALF_FLOAT);
    const GlTexture depth_ = makeTexture2D(GL_DEPTH_COMPONENT32F, kSide, kSide, GL_DEPTH_COMPONENT, GL_FLOAT);
    const GlFramebuffer framebuffer_ = required(makeFramebuffer({color_.name()}, depth_.name()));
    // At the origin, one unit is half the picture's height: 32 pixels.
    Camera camera_{.eye = {0.0F, 0.0F, 3.0F},
                   .fov = glm::degrees(2.0F * std::atan(1.0F / 3.0F)),
                   .near_plane = 0.5F,
                   .far_plane = 50.0F};
    ParticleStyle style_{.fade_in = 0.0F, .fade_out = 0.0F, .sprite = Sprite::kQuad};
    std::optional<SpriteAtlas> atlas_;
    ParticleRenderer renderer_ = required(ParticleRenderer::create(std::nullopt));
    std::optional<ParticleSystem> particles_;
    std::vector<float> pixels_;
};

void expectNear(const glm::vec4& got, const glm::vec4& wanted, float tolerance, const char* what) {
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(got[i], wanted[i], tolerance) << what << " component " << i;
    }
}

const glm::vec4 kRed{1, 0, 0, 1};
const glm::vec4 kGreen{0, 1, 0, 1};
const glm::vec4 kBlue{0, 0, 1, 1};
const glm::vec4 kClear{0, 0, 0, 0};

// A quarter turn anticlockwise moves the right side to the top, and the top to the left. For quads and points: the
// centres of the four texels, and pixels beyond them, are free of filtering. The sprite's half side is 16 pixels.
TEST_P(SpriteGlTest, CellsRotateAnticlockwise) {
    useAtlas();
    const auto expectCorners = [&](const std::array<glm::vec4, 4>& wanted, const char* what) {
        expectNear(pixel(20, 43), wanted[0], kHalf, what);
        expectNear(pixel(43, 43), wanted[1], kHalf, what);
        expectNear(pixel(20, 20), wanted[2], kHalf, what);
        expectNear(pixel(43, 20), wanted[3], kHalf, what);
    };
    for (const Sprite sprite : {Sprite::kQuad, Sprite::kPoint}) {
        style_.sprite = sprite;
        ParticleLook one = cells(1, 1);
        drawOne(one);
        expectCorners({kRed, kGreen, kBlue, kClear}, "upright");
        // The square's own outline, pixel-exact.
        expectNear(pixel(16, 43), kRed, kHalf, "inside the left edge");
        expectNear(pixel(15, 43), kClear, 0.0F, "outside the left edge");
        expectNear(pixel(20, 47), kRed, kHalf, "inside the upper edge");
        expectNear(pixel(20, 48), kClear, 0.0F, "outside the upper edge");

        one.rotation = {{0.0F, 0.5F * std::numbers::pi_v<float>}};
        drawOne(one);
        expectCorners({kGreen, kClear, kRed, kBlue}, "turned");
    }
}

// Rotated by 45°, the corner of a quad of half side 16 reaches 16·√2 = 22.6 pixels; a point's corner stays in its
// square.
TEST_P(SpriteGlTest, QuadsRotateWithTheirCorners) {
    useAtlas();
    ParticleLook one = cells(0, 0);
    one.rotation = {{0.0F, 0.25F * std::numbers::pi_v<float>}};
    drawOne(one);
    EXPECT_EQ(pixel(31, 31 + 22).a, 1.0F);
    EXPECT_EQ(pixel(31, 31 + 24).a, 0.0F);
    EXPECT_EQ(pixel(31 + 14, 31 + 14).a, 0.0F);
    style_.sprite = Sprite::kPoint;
    draw();
    EXPECT_EQ(pixel(31, 31 + 15).a, 1.0F);
    EXPECT_EQ(pixel(31, 31 + 22).a, 0.0F);
}

TEST_P(SpriteGlTest, QuadsHaveTheirFullSize) {
    GLfloat sizes[2] = {};
    glGetFloatv(GL_ALIASED_POINT_SIZE_RANGE, sizes);
    useAtlas();
    ParticleLook one = cells(0, 0);
    one.size = {{0.0F, 4.0F * sizes[1] / 32.0F}};
    // Its centre lies outside the picture, where a point would be culled.
    camera_.eye.x = 1.5F;
    camera_.target.x = 1.5F;
    drawOne(one);
    EXPECT_EQ(pixel(0, 0).a, 1.0F);
    EXPECT_EQ(pixel(kSide - 1, kSide - 1).a, 1.0F);
}

// Keys at ages 0, ½ and 1 of a lifetime of 8 seconds: at 4 s the middle key itself, at 2 s and 6 s the means.
TEST_P(SpriteGlTest, KeyFramesApplyAtExactAges) {
    ParticleLook one = look(glm::vec3(1.0F), 1.0F, 1.0F);
    one.color = {{0.0F, {1.0F, 0.0F, 0.0F}}, {0.5F, {0.0F, 1.0F, 0.0F}}, {1.0F, {0.0F, 0.0F, 1.0F}}};
    one.opacity = {{0.0F, 0.0F}, {0.5F, 1.0F}, {1.0F, 0.5F}};
    one.size = {{0.25F, 0.5F}, {0.75F, 1.5F}};
    struct Case {
        float age;
        glm::vec3 color;
        float opacity;
        float size;
    };
    for (const Case& c :
         {Case{2.0F, {0.5F, 0.5F, 0.0F}, 0.5F, 0.5F}, Case{4.0F, {0.0F, 1.0F, 0.0F}, 1.0F, 1.0F},
          Case{6.0F, {0.0F, 0.5F, 0.5F}, 0.75F, 1.5F}, Case{1.0F, {0.75F, 0.25F, 0.0F}, 0.25F, 0.5F}}) {
        drawOne(one, c.age);
        expectNear(pixel(32, 32), glm::vec4(c.opacity * c.color, c.opacity), kHalf, "middle");
        // A grain is opaque up to 0.65 of its radius, and transparent from the radius on.
        const int radius = static_cast<int>(16.0F * c.size);
        EXPECT_NEAR(pixel(32 + static_cast<int>(0.6F * static_cast<float>(radius)), 32).a, c.opacity, kHalf)
            << c.age;
        EXPECT_EQ(pixel(32 + radius, 32).a, 0.0F) << c.age;
        EXPECT_GT(pixel(32 + radius - 3, 32).a, 0.0F) << c.age;
    }
}

// A curve with the maximum number of keys: a sawtooth with a tooth at each tested age.
TEST_P(SpriteGlTest, ManyKeysApplyAtExactAges) {
    style_.looks = {look(glm::vec3(1.0F), 1.0F, 1.0F)};
    AgeTrack<float>& saw = style_.looks[0].opacity;
    saw.clear();
    for (int i = 0; i < static_cast<int>(kLookKeysMax); ++i) {
        saw.push_back({static_cast<float>(i) / 255.0F, 0.125F * static_cast<float>(i % 8)});
    }
    for (const std::size_t i : {0U, 1U, 6U, 7U, 100U, 127U, 128U, 253U}) {
        spawnTypes({0}, 8.0F * (saw[i].age + 0.25F / 255.0F));
        draw();
        EXPECT_NEAR(pixel(32, 32).a, 0.75F * saw[i].value + 0.25F * saw[i + 1].value, 5.0F * kHalf)
            << "behind key " << i;
    }
}

// One unit is 32 pixels, so a sprite of ½ is 16 across. At speed 1 with 1 s of stretch, it extends 32 pixels backwards,
// in any direction: right, up, and along a diagonal of the same length. Round ends: the ellipse of the whole.
TEST_P(SpriteGlTest, StretchedSpritesExtendBackwards) {
    ParticleLook one = look(glm::vec3(1.0F), 1.0F, 0.5F);
    one.stretch = 1.0F;
    style_.looks = {one};
    constexpr float kDiagonal = 0.70710678F;
    for (const Integrator integrator : {Integrator::kEuler, Integrator::kVerlet}) {
        for (const glm::vec3 way :
             {glm::vec3(1.0F, 0.0F, 0.0F), {0.0F, 1.0F, 0.0F}, {-kDiagonal, kDiagonal, 0.0F}}) {
            spawn({{glm::vec3(0.0F), way, 8.0F, 0}}, 0.0625F, 8, integrator);
            draw();  // its head's centre is at way / 2, 16 pixels; its tail's at -16
            const auto at = [&](float along, float across) {
                const glm::vec2 p =
                    glm::vec2(32.0F) + along * glm::vec2(way) + across * glm::vec2(-way.y, way.x);
                return pixel(static_cast<int>(p.x), static_cast<int>(p.y)).a;
            };
            // A grain is opaque up to 0.65 of its radius, which is 24 along and 8 across.
            for (const glm::vec2& full : {glm::vec2(0, 0), {13, 0}, {-13, 0}, {0, 4}}) {
                EXPECT_NEAR(at(full.x, full.y), 1.0F, kHalf);
            }
            for (const glm::vec2& some : {glm::vec2(21, 0), {-21, 0}, {0, 6.5F}}) {
                EXPECT_GT(at(some.x, some.y), 0.0F);
            }
            for (const glm::vec2& none : {glm::vec2(26, 0), {-26, 0}, {0, 9.5F}, {0, -9.5F}}) {
                EXPECT_EQ(at(none.x, none.y), 0.0F);
            }
        }
    }
}

// The right side of a cell is the head.
TEST_P(SpriteGlTest, StretchedCellsHaveTheirRightSideInFront) {
    useAtlas();
    ParticleLook one = cells(1, 1, 0.5F);
    one.stretch = 1.0F;
    style_.looks = {one};
    spawn({{glm::vec3(0.0F), glm::vec3(0.0F, -1.0F, 0.0F), 8.0F, 0}}, 0.5F);
    draw();  // downwards: 48 pixels long, 16 wide; the cell is rotated by 90° clockwise
    expectNear(pixel(36, 44), kRed, kHalf, "upper left of the cell: tail, right");
    expectNear(pixel(36, 19), kGreen, kHalf, "upper right: head, right");
    expectNear(pixel(27, 44), kBlue, kHalf, "lower left: tail, left");
    expectNear(pixel(27, 19), kClear, kHalf, "lower right: head, left");
    expectNear(pixel(32, 57), kClear, 0.0F, "beyond the tail");
    expectNear(pixel(32, 6), kClear, 0.0F, "beyond the head");
}

// The tail of a particle that flies away from the viewer may lie behind the viewer: the sprite must not flip over.
TEST_P(SpriteGlTest, TailsBehindTheViewerAreClipped) {
    ParticleLook one = look(glm::vec3(1.0F), 1.0F, 0.5F);
    one.stretch = 8.0F;
    style_.looks = {one};
    spawn({{glm::vec3(0.0F), glm::vec3(0.25F, 0.0F, -1.0F), 80.0F, 0}}, 0.03125F);
    draw();  // its tail extends left and past the viewer
    EXPECT_GT(pixel(8, 32).a, 0.0F);
    EXPECT_EQ(pixel(48, 32).a, 0.0F);
}

TEST_P(SpriteGlTest, CellsAnimateOverAge) {
    useAtlas();
    drawOne(cells(0, 1), 3.9F);  // 0.49 of its lifetime
    EXPECT_NEAR(pixel(20, 43).g, 0.2158605F, kHalf) << "128 of sRGB in linear light";
    drawOne(cells(0, 1), 4.1F);
    expectNear(pixel(20, 43), kRed, kHalf, "second cell");
}

TEST_P(SpriteGlTest, EachTypeHasItsLook) {
    style_.looks = {look({1, 0, 0}, 1.0F, 1.0F), look({0, 1, 0}, 1.0F, 1.0F)};
    for (const auto& [type, wanted] : {std::pair{0U, kRed}, {1U, kGreen}, {9U, kGreen}}) {
        spawnTypes({type}, 1.0F);
        draw();
        expectNear(pixel(32, 32), wanted, kHalf, "middle");
    }
}

// Opacities of whole 64ths are exact in half floats, and so is their sum in any order.
TEST_P(SpriteGlTest, AdditiveIsIndependentOfOrder) {
    style_.blend = Blend::kAdditive;
    float sum = 0.0F;
    std::vector<std::uint32_t> types;
    std::vector<int> reversed;
    for (std::uint32_t i = 0; i < 8; ++i) {
        const float opacity = static_cast<float>(i + 1) / 64.0F;
        style_.looks.push_back(look(glm::vec3(1.0F), opacity, 0.5F + 0.1F * static_cast<float>(i)));
        types.push_back(i);
        reversed.push_back(7 - static_cast<int>(i));
        sum += opacity;
    }
    spawnTypes(types, 1.0F);
    draw();
    EXPECT_EQ(pixel(32, 32), glm::vec4(sum));
    const std::vector<float> first = pixels_;
    const GlTexture order = orderTexture(reversed);
    draw(&order);
    EXPECT_EQ(pixel(32, 32), glm::vec4(sum));
    for (std::size_t i = 0; i < first.size(); ++i) {
        ASSERT_NEAR(pixels_[i], first[i], kHalf);
    }
}

// Blending "over": the later of two half-transparent sprites covers half of the earlier.
TEST_P(SpriteGlTest, AlphaFollowsTheOrder) {
    style_.looks = {look({1, 0, 0}, 0.5F, 1.0F), look({0, 1, 0}, 0.5F, 1.0F)};
    spawnTypes({0, 1}, 1.0F);
    struct Case {
        std::vector<int> order;
        glm::vec4 wanted;
    };
    const glm::vec4 green_last{0.25F, 0.5F, 0.0F, 0.75F};
    const Case cases[] = {{{}, green_last},
                          {{0, 1}, green_last},
                          {{1, 0}, {0.5F, 0.25F, 0.0F, 0.75F}},
                          {{1, -1}, {0.0F, 0.5F, 0.0F, 0.5F}},  // one omitted
                          {{2, 0}, {0.5F, 0.0F, 0.0F, 0.5F}}};  // one beyond the extent
    for (const Sprite sprite : {Sprite::kQuad, Sprite::kPoint}) {
        style_.sprite = sprite;
        for (const auto& [order, wanted] : cases) {
            const GlTexture texture = order.empty() ? GlTexture() : orderTexture(order);
            draw(order.empty() ? nullptr : &texture);
            expectNear(pixel(32, 32), wanted, kHalf, "middle");
        }
    }
}

// The front of a sprite of diameter ½ at distance 3 is at 2.75. A surface h behind the front leaves h / soft of the
// opacity.
TEST_P(SpriteGlTest, SoftEdgesFadeByDistance) {
    style_.looks = {look(glm::vec3(1.0F), 1.0F, 0.5F)};
    style_.soft_distance = 0.4F;
    spawnTypes({0}, 1.0F);
    for (const auto& [behind, wanted] :
         {std::pair{0.0F, 0.0F}, {0.1F, 0.25F}, {0.2F, 0.5F}, {0.3F, 0.75F}, {0.4F, 1.0F}, {9.0F, 1.0F}}) {
        const glm::vec2 depth = camera_.depthOfDistance();
        const std::vector<float> depths(kSide * kSide, depth.x + depth.y / (2.75F + behind));
        const GlTexture texture =
            makeTexture2D(GL_DEPTH_COMPONENT32F, kSide, kSide, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
        for (const Sprite sprite : {Sprite::kQuad, Sprite::kPoint}) {
            style_.sprite = sprite;
            draw(nullptr, &texture);
            EXPECT_NEAR(pixel(32, 32).a, wanted, 2e-3F) << behind;
            EXPECT_NEAR(pixel(32, 32).r, wanted, 2e-3F) << behind;
        }
    }
    draw();
    EXPECT_EQ(pixel(32, 32).a, 1.0F) << "nothing to compare with";
}

TEST_P(SpriteGlTest, RandomRotationsArePerParticle) {
    useAtlas();
    ParticleLook one = cells(1, 1);
    one.rotation_spread = std::numbers::pi_v<float>;
    drawOne(one);
    const std::vector<float> first = pixels_;
    drawOne(one, 2.0F);
    EXPECT_EQ(pixels_, first) << "the initial angle is constant";
    style_.looks[0].spin_spread = 1.0F;
    draw();
    EXPECT_NE(pixels_, first) << "the angular speed rotates it";
}

TEST_P(SpriteGlTest, InvalidStylesAreRejected) {
    spawnTypes({0}, 1.0F);
    const auto refused = [&] {
        const auto drawn = renderer_.draw(*particles_, camera_, style_, {framebuffer_.name(), kSide, kSide});
        return !drawn && drawn.error().code == ErrorCode::kUsage;
    };
    style_.looks.resize(kLooksMax + 1);
    EXPECT_TRUE(refused());
    style_.looks = {look(glm::vec3(1.0F), 1.0F, 1.0F)};
    style_.looks[0].stretch = 1.0F;
    style_.sprite = Sprite::kPoint;
    EXPECT_TRUE(refused());
    style_.sprite = Sprite::kQuad;
    EXPECT_FALSE(refused());
    for (const float soft :
         {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        style_.soft_distance = soft;
        EXPECT_TRUE(refused());
    }
    const std::vector<std::uint8_t> rgba(4 * 6 * 4);
    EXPECT_TRUE(SpriteAtlas::create(rgba, 6, 4, 3, 2));
    EXPECT_EQ(SpriteAtlas::create(rgba, 6, 4, 4, 2).error().code, ErrorCode::kUsage);
    EXPECT_EQ(SpriteAtlas::create(rgba, 6, 4, 0, 1).error().code, ErrorCode::kUsage);
    EXPECT_EQ(SpriteAtlas::create(rgba, 6, 5, 1, 1).error().code, ErrorCode::kUsage);
    EXPECT_EQ(SpriteAtlas::create(rgba, 0, 0, 1, 1).error().code, ErrorCode::kUsage);
    EXPECT_EQ(SpriteAtlas::create(rgba, 9000, 1, 1, 1).error().code, ErrorCode::kLimit);
}

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(SpriteGlTest);

}  // namespace relief
