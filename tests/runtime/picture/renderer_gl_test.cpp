// The pictures: what hides what, and where; and that none of Relief's passes leaves a trace in the caller's
// state or is spoilt by it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "runtime/depth_maps/depth_map_renderer.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/frame.h"
#include "runtime/picture/particle_renderer.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/depth_maps/read_texels.h"
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
    void SetUp() override {
        GlTest::SetUp();
        if (HasFatalFailure()) {
            return;
        }
        collider_ = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 128);
        auto textures = ColliderTextures::create(collider_);
        ASSERT_TRUE(textures) << textures.error().message;
        textures_.emplace(std::move(*textures));
        camera_.eye = {0.0F, 0.0F, 3.0F};
        camera_.target = {0.0F, 0.0F, 0.0F};
        camera_.fov = 30.0F;
        camera_.near_plane = 0.5F;
        camera_.far_plane = 50.0F;
        auto frame = Frame::create(kWidth, kHeight);
        ASSERT_TRUE(frame) << frame.error().message;
        frame_.emplace(std::move(*frame));
        auto renderer = ColliderRenderer::create(view());
        ASSERT_TRUE(renderer) << renderer.error().message;
        collider_renderer_.emplace(std::move(*renderer));
        auto points = ParticleRenderer::create(view());
        ASSERT_TRUE(points) << points.error().message;
        points_.emplace(std::move(*points));
        auto particles = ParticleSystem::create({.capacity = 100});
        ASSERT_TRUE(particles) << particles.error().message;
        particles_.emplace(std::move(*particles));
    }
    void TearDown() override {
        // GL objects go before their context.
        particles_.reset();
        points_.reset();
        collider_renderer_.reset();
        frame_.reset();
        textures_.reset();
        GlTest::TearDown();
    }

    [[nodiscard]] ColliderView view() const {
        return {&*textures_, collider_.bounds, finestTexel(collider_)};
    }

    void drawCollider() {
        const auto drawn = collider_renderer_->draw(camera_, style_, frame_->target());
        ASSERT_TRUE(drawn) << drawn.error().message;
    }
    Rgb pixel(const std::vector<std::uint8_t>& rgb, std::uint32_t x, std::uint32_t y) const {
        const std::size_t at = 3 * (std::size_t{kWidth} * y + x);
        return {rgb[at], rgb[at + 1], rgb[at + 2]};
    }
    /// The pixel, from the top left, where a point of object space appears.
    std::pair<std::uint32_t, std::uint32_t> project(const glm::vec3& p) const {
        const glm::vec4 clip = camera_.projection(1.5F) * camera_.view() * glm::vec4(p, 1.0F);
        return {static_cast<std::uint32_t>((0.5F + 0.5F * clip.x / clip.w) * static_cast<float>(kWidth)),
                static_cast<std::uint32_t>((0.5F - 0.5F * clip.y / clip.w) * static_cast<float>(kHeight))};
    }
    void spawnAt(const glm::vec3& p) {
        const std::array<Birth, 1> births{Birth{p, glm::vec3(0.0F), 100.0F, 0}};
        particles_->spawn(births);
        particles_->step(1.0F);
    }

    Collider collider_;
    Camera camera_;
    ColliderStyle style_;
    std::optional<ColliderTextures> textures_;
    std::optional<Frame> frame_;
    std::optional<ColliderRenderer> collider_renderer_;
    std::optional<ParticleRenderer> points_;
    std::optional<ParticleSystem> particles_;
};

// The outline of the sphere of radius r at distance d is a circle of angle asin(r/d); its depth at the centre
// is that of its nearest point.
TEST_P(RendererGlTest, TheColliderStandsWhereItIs) {
    drawCollider();
    const std::vector<std::uint8_t> rgb = frame_->read();
    const double edge =
        std::tan(std::asin(0.5 / 3.0)) / std::tan(15.0 * 3.14159265358979 / 180.0) * 0.5 * kHeight;
    int wrong = 0;
    for (std::uint32_t y = 0; y < kHeight; ++y) {
        for (std::uint32_t x = 0; x < kWidth; ++x) {
            const double away = std::hypot(x + 0.5 - 0.5 * kWidth, y + 0.5 - 0.5 * kHeight);
            const Rgb c = pixel(rgb, x, y);
            const bool clay = c.r > c.b;  // warm on a cool background
            wrong += std::abs(away - edge) > 1.5 && clay != (away < edge) ? 1 : 0;
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(pixel(rgb, kWidth / 2 - 5, kHeight / 2 - 5).r, 60) << "the side towards the sun is lit";

    // Depth, as the particles will be tested against.
    const RenderTarget target = frame_->target();
    GLuint depth_texture = 0;
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glGetFramebufferAttachmentParameteriv(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
                                          GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME,
                                          reinterpret_cast<GLint*>(&depth_texture));
    EXPECT_NE(depth_texture, 0U);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

TEST_P(RendererGlTest, ParticlesAreHiddenBehindAndShownInFront) {
    ParticleStyle style;
    style.diameter = 0.06F;
    style.opacity = 1.0F;
    drawCollider();
    const std::vector<std::uint8_t> bare = frame_->read();
    struct Case {
        glm::vec3 place;
        bool shown;
    };
    // In front, behind, half a diameter before and behind the surface, and beside.
    for (const Case& one : {Case{{0.0F, 0.0F, 1.0F}, true}, Case{{0.0F, 0.0F, -1.0F}, false},
                            Case{{0.1F, 0.05F, 0.51F}, true}, Case{{0.1F, 0.05F, 0.40F}, false},
                            Case{{0.7F, 0.4F, -1.0F}, true}, Case{{0.0F, 0.0F, 4.0F}, false}}) {
        auto particles = ParticleSystem::create({.capacity = 4});
        ASSERT_TRUE(particles);
        particles_ = std::move(*particles);
        spawnAt(one.place);
        drawCollider();
        points_->draw(*particles_, camera_, style, frame_->target());
        const std::vector<std::uint8_t> rgb = frame_->read();
        if (one.place.z > camera_.eye.z) {
            EXPECT_EQ(rgb, bare) << "behind the eye";
            continue;
        }
        const auto [x, y] = project(one.place);
        const Rgb c = pixel(rgb, x, y);
        if (one.shown) {
            EXPECT_GT(std::min({c.r, c.g, c.b}), 170) << one.place.z;
        } else {
            EXPECT_EQ(rgb, bare) << one.place.z;
        }
    }
}

TEST_P(RendererGlTest, TheDeadAreNotDrawn) {
    drawCollider();
    const std::vector<std::uint8_t> bare = frame_->read();
    const std::array<Birth, 2> births{Birth{{0.6F, 0.3F, 0.5F}, glm::vec3(0.0F), 0.5F, 0},
                                      Birth{{0.0F, -90.0F, 0.0F}, glm::vec3(0.0F), 100.0F, 0}};
    particles_->spawn(births);
    particles_->step(1.0F);
    ASSERT_EQ(particles_->counts().died, 1U);
    ASSERT_EQ(particles_->extent(), 2U);
    ParticleStyle style;
    style.diameter = 0.1F;
    points_->draw(*particles_, camera_, style, frame_->target());
    EXPECT_EQ(frame_->read(), bare);
}

TEST_P(RendererGlTest, OpacityFadesInAndOut) {
    ParticleStyle style;
    style.diameter = 0.2F;
    style.opacity = 1.0F;
    style.fade_in = 1.0F;
    style.fade_out = 1.0F;
    const std::array<Birth, 1> births{Birth{{0.0F, 0.0F, 1.0F}, glm::vec3(0.0F), 4.0F, 0}};
    particles_->spawn(births);
    std::vector<int> brightness;
    for (int step = 0; step < 15; ++step) {  // ages 0.25 … 3.75
        particles_->step(0.25F);
        drawCollider();
        points_->draw(*particles_, camera_, style, frame_->target());
        brightness.push_back(pixel(frame_->read(), kWidth / 2, kHeight / 2).b);
    }
    EXPECT_LT(brightness[0] + 10, brightness[1]);
    EXPECT_LT(brightness[1] + 10, brightness[3]);
    EXPECT_EQ(brightness[3], brightness[11]);
    EXPECT_GT(brightness[11], brightness[13] + 10);
    EXPECT_GT(brightness[13], brightness[14] + 10);
}

TEST_P(RendererGlTest, TheKeptPictureIsTheFreshOneAndFollowsEveryChange) {
    style_.ground = -0.5F;
    drawCollider();
    const std::vector<std::uint8_t> first = frame_->read();
    drawCollider();
    EXPECT_EQ(frame_->read(), first);
    const Camera camera = camera_;
    camera_.eye.x += 0.2F;
    drawCollider();
    EXPECT_NE(frame_->read(), first);
    camera_ = camera;
    drawCollider();
    EXPECT_EQ(frame_->read(), first);
    style_.background = {0.2F, 0.2F, 0.2F};
    drawCollider();
    EXPECT_NE(frame_->read(), first);
}

TEST_P(RendererGlTest, TheFloorIsShadedBelowTheCollider) {
    style_.ground = -0.5F;
    camera_.eye = {0.0F, 1.5F, 3.0F};
    drawCollider();
    const std::vector<std::uint8_t> rgb = frame_->read();
    const auto [x, y] = project({0.6F, -0.5F, -0.3F});     // where sunDirection() casts the sphere's shadow
    const auto [ox, oy] = project({-0.9F, -0.5F, -0.3F});  // in the open
    EXPECT_LT(pixel(rgb, x, y).b + 20, pixel(rgb, ox, oy).b);
}

TEST_P(RendererGlTest, FrameSizesAreChecked) {
    EXPECT_EQ(Frame::create(0, 5).error().code, ErrorCode::kUsage);
    EXPECT_EQ(Frame::create(5, 0).error().code, ErrorCode::kUsage);
    EXPECT_EQ(Frame::create(1000000, 5).error().code, ErrorCode::kLimit);
    EXPECT_EQ(Frame::create(0xffffffffU, 0xffffffffU).error().code, ErrorCode::kLimit);
    const auto frame = Frame::create(1, 1);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->read().size(), 3U);
}

/// Everything that a caller may have set, as numbers.
std::map<std::string, std::vector<GLint64>> glState() {
    std::map<std::string, std::vector<GLint64>> state;
    const auto integers = [&](const char* name, GLenum what, std::size_t count) {
        std::vector<GLint64> values(count);
        glGetInteger64v(what, values.data());
        state[name] = values;
    };
    const auto enabled = [&](const char* name, GLenum what) { state[name] = {glIsEnabled(what)}; };
#define INTEGERS(what, count) integers(#what, what, count)
#define ENABLED(what) enabled(#what, what)
    INTEGERS(GL_CURRENT_PROGRAM, 1);
    INTEGERS(GL_VERTEX_ARRAY_BINDING, 1);
    INTEGERS(GL_ARRAY_BUFFER_BINDING, 1);
    INTEGERS(GL_UNIFORM_BUFFER_BINDING, 1);
    INTEGERS(GL_PIXEL_PACK_BUFFER_BINDING, 1);
    INTEGERS(GL_PIXEL_UNPACK_BUFFER_BINDING, 1);
    INTEGERS(GL_DRAW_FRAMEBUFFER_BINDING, 1);
    INTEGERS(GL_READ_FRAMEBUFFER_BINDING, 1);
    INTEGERS(GL_VIEWPORT, 4);
    INTEGERS(GL_SCISSOR_BOX, 4);
    INTEGERS(GL_BLEND_SRC_RGB, 1);
    INTEGERS(GL_BLEND_DST_RGB, 1);
    INTEGERS(GL_BLEND_SRC_ALPHA, 1);
    INTEGERS(GL_BLEND_DST_ALPHA, 1);
    INTEGERS(GL_BLEND_EQUATION_RGB, 1);
    INTEGERS(GL_BLEND_EQUATION_ALPHA, 1);
    INTEGERS(GL_DEPTH_FUNC, 1);
    INTEGERS(GL_DEPTH_WRITEMASK, 1);
    INTEGERS(GL_COLOR_WRITEMASK, 4);
    INTEGERS(GL_PACK_ALIGNMENT, 1);
    INTEGERS(GL_UNPACK_ALIGNMENT, 1);
    INTEGERS(GL_PACK_ROW_LENGTH, 1);
    INTEGERS(GL_PACK_SKIP_ROWS, 1);
    INTEGERS(GL_PACK_SKIP_PIXELS, 1);
    INTEGERS(GL_UNPACK_ROW_LENGTH, 1);
    INTEGERS(GL_UNPACK_SKIP_ROWS, 1);
    INTEGERS(GL_ACTIVE_TEXTURE, 1);
    ENABLED(GL_BLEND);
    ENABLED(GL_DEPTH_TEST);
    ENABLED(GL_CULL_FACE);
    ENABLED(GL_SCISSOR_TEST);
    ENABLED(GL_STENCIL_TEST);
    ENABLED(GL_DITHER);
    ENABLED(GL_SAMPLE_ALPHA_TO_COVERAGE);
    ENABLED(GL_SAMPLE_COVERAGE);
    ENABLED(GL_RASTERIZER_DISCARD);
    ENABLED(GL_POLYGON_OFFSET_FILL);
    if (!isGles()) {
        ENABLED(GL_PRIMITIVE_RESTART);
        ENABLED(GL_COLOR_LOGIC_OP);
        ENABLED(GL_FRAMEBUFFER_SRGB);
        ENABLED(GL_PROGRAM_POINT_SIZE);
        INTEGERS(GL_POINT_SPRITE_COORD_ORIGIN, 1);
        std::array<GLint, 2> modes{};
        glGetIntegerv(GL_POLYGON_MODE, modes.data());
        state["GL_POLYGON_MODE"] = {modes[0]};
    }
#undef INTEGERS
#undef ENABLED
    GLint active = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    for (GLenum unit = 0; unit < 8; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        const std::string number = std::to_string(unit);
        integers(("2D " + number).c_str(), GL_TEXTURE_BINDING_2D, 1);
        integers(("2D array " + number).c_str(), GL_TEXTURE_BINDING_2D_ARRAY, 1);
        integers(("sampler " + number).c_str(), GL_SAMPLER_BINDING, 1);
    }
    glActiveTexture(static_cast<GLenum>(active));
    GLint buffer = 0;
    GLint64 range[2] = {};
    glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, 0, &buffer);
    glGetInteger64i_v(GL_UNIFORM_BUFFER_START, 0, &range[0]);
    glGetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, 0, &range[1]);
    state["uniform block 0"] = {buffer, range[0], range[1]};
    std::array<GLfloat, 4> clear{};
    glGetFloatv(GL_COLOR_CLEAR_VALUE, clear.data());
    for (const GLfloat value : clear) {
        state["clear color"].push_back(static_cast<GLint64>(1000.0F * value));
    }
    return state;
}

/// A caller's state in which a careless pass would draw nothing, or nonsense.
class OddState {
  public:
    OddState()
        : texture_(makeTexture2D(GL_RGBA8, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE)),
          buffer_(makeBuffer()),
          array_(makeVertexArray()) {
        const std::array<GLuint, 1> colors{texture_.name()};
        framebuffer_ = std::move(*makeFramebuffer(colors));
        program_ = std::move(*makeScreenProgram("picture/resolve.frag"));
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
        glUseProgram(program_.name());
        glBindVertexArray(array_.name());
        glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
        glBindBuffer(GL_UNIFORM_BUFFER, buffer_.name());
        glBufferData(GL_UNIFORM_BUFFER, 4096, nullptr, GL_STATIC_DRAW);
        glBindBufferRange(GL_UNIFORM_BUFFER, 0, buffer_.name(), 0, 1024);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.name());
        glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer_.name());
        glViewport(1, 2, 3, 4);
        glScissor(5, 6, 1, 1);
        for (const GLenum what : {GL_BLEND, GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST,
                                  GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE, GL_RASTERIZER_DISCARD,
                                  GL_POLYGON_OFFSET_FILL}) {
            glEnable(what);
        }
        if (!isGles()) {
            glEnable(GL_COLOR_LOGIC_OP);
            glEnable(GL_FRAMEBUFFER_SRGB);
            glEnable(GL_PRIMITIVE_RESTART);
            glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
            glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, GL_LOWER_LEFT);
            glPointSize(7.0F);
        }
        glStencilFunc(GL_NEVER, 1, 1);
        glCullFace(GL_FRONT_AND_BACK);
        glBlendFuncSeparate(GL_ZERO, GL_ZERO, GL_ONE, GL_DST_COLOR);
        glBlendEquationSeparate(GL_FUNC_SUBTRACT, GL_MAX);
        glDepthFunc(GL_NEVER);
        glDepthMask(GL_FALSE);
        glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
        glClearColor(0.25F, 0.5F, 0.75F, 1.0F);
        glPixelStorei(GL_PACK_ALIGNMENT, 8);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
        glPixelStorei(GL_PACK_ROW_LENGTH, 17);
        glPixelStorei(GL_PACK_SKIP_ROWS, 3);
        glPixelStorei(GL_PACK_SKIP_PIXELS, 5);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 9);
        GLuint sampler = 0;
        glGenSamplers(1, &sampler);
        for (GLenum unit = 0; unit < 8; ++unit) {
            glActiveTexture(GL_TEXTURE0 + unit);
            glBindTexture(GL_TEXTURE_2D, texture_.name());
            glBindSampler(unit, sampler);
        }
        glActiveTexture(GL_TEXTURE5);
    }

  private:
    GlTexture texture_;
    GlBuffer buffer_;
    GlVertexArray array_;
    GlFramebuffer framebuffer_;
    GlProgram program_;
};

TEST_P(RendererGlTest, TheCallersStateIsKeptAndDoesNoHarm) {
    // What a plain state gives …
    style_.ground = -0.5F;
    const std::array<Birth, 2> births{Birth{{0.0F, 0.8F, 0.9F}, {0.3F, 0.0F, 0.0F}, 100.0F, 0},
                                      Birth{{0.0F, 0.7F, 0.0F}, {0.0F, -1.0F, 0.0F}, 100.0F, 0}};
    const auto run = [&](const std::function<void(const char*)>& check) {
        auto particles = ParticleSystem::create({.capacity = 2000, .epoch_seconds = 0.5});
        check("ParticleSystem::create");
        EXPECT_TRUE(particles->setCollider(&*textures_));
        check("setCollider");
        EXPECT_TRUE(particles->setEvents(EventOptions{.lasting = true}));
        check("setEvents");
        EXPECT_TRUE(particles->setForces({{0.0F, -1.0F, 0.0F}, {}, 0.0F}));
        particles->spawn(births);
        std::vector<float> hits;
        for (int step = 0; step < 40; ++step) {  // sets the clock back on its way
            particles->step(1.0F / 60.0F);
            check("step");
            EXPECT_TRUE(particles->requestEvents(0));
            check("requestEvents");
            const auto events = particles->waitEvents();
            check("waitEvents");
            for (const ParticleEvent& hit : (*events)->events) {
                hits.insert(hits.end(), {hit.position.x, hit.position.y, hit.position.z, hit.speed});
            }
        }
        EXPECT_FALSE(hits.empty());
        auto raw = particles->readRaw();
        check("readRaw");
        raw->position.insert(raw->position.end(), hits.begin(), hits.end());
        auto frame = Frame::create(kWidth, kHeight);
        check("Frame::create");
        auto renderer = ColliderRenderer::create(view());
        check("ColliderRenderer::create");
        auto points = ParticleRenderer::create(view());
        check("ParticleRenderer::create");
        EXPECT_TRUE(renderer->draw(camera_, style_, frame->target()));
        check("ColliderRenderer::draw");
        points->draw(*particles, camera_, ParticleStyle{.diameter = 0.1F}, frame->target());
        check("ParticleRenderer::draw");
        auto tiles = ParticleRenderer::create(view(), StepPath::kCompute);
        check("ParticleRenderer::create, tiles");
        EXPECT_TRUE(tiles->draw(*particles, camera_, ParticleStyle{.diameter = 0.1F}, frame->target()));
        check("ParticleRenderer::draw, tiles");
        const std::vector<std::uint8_t> rgba(16, 200);
        const auto atlas = SpriteAtlas::create(rgba, 2, 2, 2, 1);
        check("SpriteAtlas::create");
        ParticleStyle quads;
        quads.diameter = 0.3F;
        quads.sprite = Sprite::kQuad;
        quads.blend = Blend::kAdditive;
        quads.soft = 0.1F;
        quads.atlas = &*atlas;
        quads.looks.resize(1);
        quads.looks[0].cell_first = 0;
        EXPECT_TRUE(points->draw(*particles, camera_, quads, frame->target(), {}, &renderer->depth()));
        check("ParticleRenderer::draw, quads");
        const auto mesh = ColliderMesh::create(
            {{{-0.5F, 0.5F, 0.5F}, {-0.2F, 0.5F, 0.5F}, {-0.3F, 0.9F, 0.5F}}, {}, {0, 1, 2}});
        check("ColliderMesh::create");
        camera_.eye.x += 1.0F;
        auto with_mesh = ColliderRenderer::create(view(), &*mesh);
        check("ColliderRenderer::create, mesh");
        auto other = Frame::create(kWidth, kHeight);
        EXPECT_TRUE(with_mesh->draw(camera_, style_, other->target()));
        camera_.eye.x -= 1.0F;
        check("ColliderRenderer::draw, mesh");
        const std::vector<std::uint8_t> rgb = frame->read();
        check("Frame::read");
        std::vector<std::uint8_t> both = rgb;
        const std::vector<std::uint8_t> mesh_rgb = other->read();
        both.insert(both.end(), mesh_rgb.begin(), mesh_rgb.end());
        return std::pair(raw->position, both);
    };
    const auto plain = run([](const char*) {});
    // … a hostile one gives as well, and keeps.
    const OddState odd;
    const auto before = glState();
    const auto hostile = run([&](const char* call) { EXPECT_EQ(glState(), before) << "after " << call; });
    EXPECT_EQ(hostile.first, plain.first);
    EXPECT_EQ(hostile.second, plain.second);
}

// The caller's unpack window must not cut the maps up: the collider uploaded under it draws the same picture.
TEST_P(RendererGlTest, AColliderUploadsTheSameUnderOddState) {
    drawCollider();
    const std::vector<std::uint8_t> plain = frame_->read();
    const OddState odd;
    const auto before = glState();
    auto textures = ColliderTextures::create(collider_);
    ASSERT_TRUE(textures) << textures.error().message;
    EXPECT_EQ(glState(), before);
    auto renderer = ColliderRenderer::create({&*textures, collider_.bounds, finestTexel(collider_)});
    ASSERT_TRUE(renderer) << renderer.error().message;
    ASSERT_TRUE(renderer->draw(camera_, style_, frame_->target()));
    EXPECT_EQ(frame_->read(), plain);
}

TEST_P(RendererGlTest, DepthMapsAreTheSameUnderOddState) {
    const std::array<glm::vec3, 4> corners{
        {{0.1F, 0.1F, 0.2F}, {0.9F, 0.1F, 0.4F}, {0.1F, 0.9F, 0.6F}, {0.8F, 0.8F, 0.1F}}};
    const std::array<glm::uvec3, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
    const auto run = [&](const std::function<void(const char*)>& check) {
        auto mesh = GpuMesh::create(corners, triangles);
        check("GpuMesh::create");
        EXPECT_TRUE(mesh->setPositions(corners));
        check("GpuMesh::setPositions");
        const auto renderer = DepthMapRenderer::create(16, 16);
        check("DepthMapRenderer::create");
        DepthMap map;
        map.format = MapFormat::kFrontBackFixed;
        map.compare = Compare::kBoth;
        map.decode = Decode::kPlane;
        map.width = map.height = 16;
        for (int k = 0; k < 3; ++k) {
            map.object_to_map.row[k] = glm::vec4(0.0F);
            map.object_to_map.row[k][k] = 1.0F;
        }
        renderer->render(*mesh, map);
        check("DepthMapRenderer::render");
        const std::vector<std::byte> texels = readTexels(*renderer);
        return texels;
    };
    const std::vector<std::byte> plain = run([](const char*) {});
    EXPECT_NE(plain, std::vector<std::byte>(plain.size())) << "nothing was drawn";
    const OddState odd;
    glDepthRangef(0.75F, 0.25F);
    if (!isGles()) {
        glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
        glEnable(GL_DEPTH_CLAMP);
    }
    const auto before = glState();
    EXPECT_TRUE(run([&](const char* call) { EXPECT_EQ(glState(), before) << "after " << call; }) == plain);
    std::array<GLfloat, 2> range{};
    glGetFloatv(GL_DEPTH_RANGE, range.data());
    EXPECT_EQ(range, (std::array<GLfloat, 2>{0.75F, 0.25F}));
    if (!isGles()) {
        GLint provoking = 0;
        glGetIntegerv(GL_PROVOKING_VERTEX, &provoking);
        EXPECT_EQ(provoking, static_cast<GLint>(GL_FIRST_VERTEX_CONVENTION));
        EXPECT_EQ(glIsEnabled(GL_DEPTH_CLAMP), GL_TRUE);
    }
}

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(RendererGlTest);

}  // namespace relief
