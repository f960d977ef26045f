// The pictures: what hides what, and where; and that none of Relief's passes leaves a trace in the caller's
// state or is spoilt by it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "runtime/depth_maps/depth_map_renderer.h"
#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/depth_sort.h"
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

/// Sets everything that a pass sets, or that could spoil one, to something else: a careless pass draws nothing, or nonsense.
class CallerState {
  public:
    CallerState() {
        const std::array<GLuint, 1> colors{texture_.name()};
        framebuffer_ = makeFramebuffer(colors).value();
        program_ = makeScreenProgram("picture/resolve.frag").value();
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
        glUseProgram(program_.name());
        glBindVertexArray(array_.name());
        glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, feedback_.name());
        glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, 256, nullptr, GL_STATIC_DRAW);
        glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, feedback_.name(), 64, 128);
        glBindBuffer(GL_UNIFORM_BUFFER, buffer_.name());
        glBufferData(GL_UNIFORM_BUFFER, 4096, nullptr, GL_STATIC_DRAW);
        glBindBufferRange(GL_UNIFORM_BUFFER, 0, buffer_.name(), 0, 1024);
        glBindBufferRange(GL_UNIFORM_BUFFER, 1, buffer_.name(), 1024, 512);
        for (const GLenum target : {GL_ARRAY_BUFFER, GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER,
                                    GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER}) {
            glBindBuffer(target, buffer_.name());
        }
        if (hasCompute()) {
            image_ = makeImageTexture2D(GL_R32F, 4, 4);
            glBindImageTexture(0, image_.name(), 0, GL_FALSE, 0, GL_READ_ONLY, GL_R32F);
            glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffer_.name());
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer_.name());
            glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 2, buffer_.name(), 1024, 512);
        }
        glGenTextures(1, &volume_);
        glGenSamplers(1, &sampler_);
        for (GLenum unit = 0; unit < PassState::kUnits; ++unit) {
            glActiveTexture(GL_TEXTURE0 + unit);
            glBindTexture(GL_TEXTURE_2D, texture_.name());
            glBindTexture(GL_TEXTURE_3D, volume_);
            glBindSampler(unit, sampler_);
        }
        glActiveTexture(GL_TEXTURE5);
        for (const GLenum capability : kCapabilities) {
            glEnable(capability);
        }
        if (!isGles()) {
            for (const GLenum capability : kDesktopCapabilities) {
                glEnable(capability);
            }
            glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
            glPointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, GL_LOWER_LEFT);
            glPointSize(7.0F);
        }
        glViewport(1, 2, 3, 4);
        glScissor(5, 6, 1, 1);
        glStencilFunc(GL_NEVER, 1, 1);
        glCullFace(GL_FRONT_AND_BACK);
        glBlendFuncSeparate(GL_ZERO, GL_ZERO, GL_ONE, GL_DST_COLOR);
        glBlendEquationSeparate(GL_FUNC_SUBTRACT, GL_MAX);
        glDepthFunc(GL_NEVER);
        glDepthMask(GL_FALSE);
        glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
        glClearColor(0.25F, 0.5F, 0.75F, 1.0F);
        for (const auto& [what, value] : {std::pair<GLenum, GLint>{GL_PACK_ALIGNMENT, 8},
                                          {GL_PACK_ROW_LENGTH, 17},
                                          {GL_PACK_SKIP_ROWS, 3},
                                          {GL_PACK_SKIP_PIXELS, 5},
                                          {GL_UNPACK_ALIGNMENT, 2},
                                          {GL_UNPACK_ROW_LENGTH, 9},
                                          {GL_UNPACK_SKIP_IMAGES, 2}}) {
            glPixelStorei(what, value);
        }
        before_ = now();
    }
    ~CallerState() {
        glDeleteTextures(1, &volume_);
        glDeleteSamplers(1, &sampler_);
    }
    CallerState(const CallerState&) = delete;
    CallerState& operator=(const CallerState&) = delete;

    void expectKept(const char* after) const {
        EXPECT_EQ(now(), before_) << after;
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << after;
    }

  private:
    using Key = std::pair<GLenum, GLuint>;  // what, and of which unit or block
    static constexpr std::array<GLenum, 9> kCapabilities{
        GL_BLEND,           GL_DEPTH_TEST,         GL_CULL_FACE,
        GL_SCISSOR_TEST,    GL_STENCIL_TEST,       GL_SAMPLE_ALPHA_TO_COVERAGE,
        GL_SAMPLE_COVERAGE, GL_RASTERIZER_DISCARD, GL_POLYGON_OFFSET_FILL};
    static constexpr std::array<GLenum, 3> kDesktopCapabilities{GL_COLOR_LOGIC_OP, GL_FRAMEBUFFER_SRGB,
                                                                GL_PRIMITIVE_RESTART};

    static std::map<Key, std::vector<GLint64>> now() {
        std::map<Key, std::vector<GLint64>> state;
        const auto integers = [&](std::initializer_list<GLenum> names, GLuint unit = 0) {
            for (const GLenum what : names) {
                std::vector<GLint64>& values = state[{what, unit}];
                values.resize(4);
                glGetInteger64v(what, values.data());
            }
        };
        const auto indexed = [&](GLuint index, std::initializer_list<GLenum> names) {
            for (const GLenum what : names) {
                glGetInteger64i_v(what, index, &state[{what, index}].emplace_back());
            }
        };
        integers({GL_CURRENT_PROGRAM,
                  GL_VERTEX_ARRAY_BINDING,
                  GL_ARRAY_BUFFER_BINDING,
                  GL_UNIFORM_BUFFER_BINDING,
                  GL_TRANSFORM_FEEDBACK_BUFFER_BINDING,
                  GL_PIXEL_PACK_BUFFER_BINDING,
                  GL_PIXEL_UNPACK_BUFFER_BINDING,
                  GL_COPY_READ_BUFFER_BINDING,
                  GL_COPY_WRITE_BUFFER_BINDING,
                  GL_DRAW_FRAMEBUFFER_BINDING,
                  GL_READ_FRAMEBUFFER_BINDING,
                  GL_VIEWPORT,
                  GL_SCISSOR_BOX,
                  GL_BLEND_SRC_RGB,
                  GL_BLEND_DST_RGB,
                  GL_BLEND_SRC_ALPHA,
                  GL_BLEND_DST_ALPHA,
                  GL_BLEND_EQUATION_RGB,
                  GL_BLEND_EQUATION_ALPHA,
                  GL_DEPTH_FUNC,
                  GL_DEPTH_WRITEMASK,
                  GL_COLOR_WRITEMASK,
                  GL_COLOR_CLEAR_VALUE,
                  GL_CULL_FACE_MODE,
                  GL_PACK_ALIGNMENT,
                  GL_PACK_ROW_LENGTH,
                  GL_PACK_SKIP_ROWS,
                  GL_PACK_SKIP_PIXELS,
                  GL_UNPACK_ALIGNMENT,
                  GL_UNPACK_ROW_LENGTH,
                  GL_UNPACK_SKIP_ROWS,
                  GL_UNPACK_SKIP_IMAGES,
                  GL_ACTIVE_TEXTURE,
                  GL_DITHER});
        for (const GLenum capability : kCapabilities) {
            state[{capability, 0}] = {glIsEnabled(capability)};
        }
        if (!isGles()) {
            integers({GL_POINT_SPRITE_COORD_ORIGIN});
            std::array<GLint, 2> modes{};
            glGetIntegerv(GL_POLYGON_MODE, modes.data());
            state[{GL_POLYGON_MODE, 0}] = {modes[0]};
            for (const GLenum capability : kDesktopCapabilities) {
                state[{capability, 0}] = {glIsEnabled(capability)};
            }
            state[{GL_PROGRAM_POINT_SIZE, 0}] = {glIsEnabled(GL_PROGRAM_POINT_SIZE)};
        }
        for (const GLuint block : {0U, 1U}) {
            indexed(block, {GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE});
        }
        indexed(0, {GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, GL_TRANSFORM_FEEDBACK_BUFFER_START,
                    GL_TRANSFORM_FEEDBACK_BUFFER_SIZE});
        if (hasCompute()) {
            integers({GL_DRAW_INDIRECT_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_BINDING});
            for (GLuint unit = 0; unit < StorageUnits::kUnits; ++unit) {
                indexed(unit, {GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                               GL_SHADER_STORAGE_BUFFER_SIZE, GL_IMAGE_BINDING_NAME, GL_IMAGE_BINDING_ACCESS,
                               GL_IMAGE_BINDING_FORMAT});
            }
        }
        GLint active = 0;
        glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
        for (GLenum unit = 0; unit < PassState::kUnits; ++unit) {
            glActiveTexture(GL_TEXTURE0 + unit);
            integers({GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_2D_ARRAY, GL_TEXTURE_BINDING_3D,
                      GL_SAMPLER_BINDING},
                     unit);
        }
        glActiveTexture(static_cast<GLenum>(active));
        return state;
    }

    GlBuffer buffer_ = makeBuffer();
    GlBuffer feedback_ = makeBuffer();
    GlVertexArray array_ = makeVertexArray();
    GlTexture texture_ = makeTexture2D(GL_RGBA8, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE);
    GlTexture image_;
    GlFramebuffer framebuffer_;
    GlProgram program_;
    GLuint volume_ = 0;
    GLuint sampler_ = 0;
    std::map<Key, std::vector<GLint64>> before_;
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
        for (const StepPath path : {StepPath::kFragment, StepPath::kCompute}) {
            auto sorter = DepthSorter::create(2000, path);
            check("DepthSorter::create");
            sorter->update(particles->positions(), particles->textureWidth(), particles->extent(),
                           camera_.eye, DepthSorter::sequencePasses(2000));
            check("DepthSorter::update");
            EXPECT_TRUE(tiles->draw(*particles, camera_, ParticleStyle{.diameter = 0.1F}, frame->target(),
                                    {&sorter->order(), sorter->count()}));
            check("ParticleRenderer::draw, tiles");
        }
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
    const CallerState caller;
    const auto hostile = run([&](const char* call) { caller.expectKept(call); });
    EXPECT_EQ(hostile.first, plain.first);
    EXPECT_EQ(hostile.second, plain.second);
}

// The caller's unpack window must not cut the maps up: the collider uploaded under it draws the same picture.
TEST_P(RendererGlTest, AColliderUploadsTheSameUnderTheCallersState) {
    drawCollider();
    const std::vector<std::uint8_t> plain = frame_->read();
    const CallerState caller;
    auto textures = ColliderTextures::create(collider_);
    ASSERT_TRUE(textures) << textures.error().message;
    caller.expectKept("ColliderTextures::create");
    auto renderer = ColliderRenderer::create({&*textures, collider_.bounds, finestTexel(collider_)});
    ASSERT_TRUE(renderer) << renderer.error().message;
    ASSERT_TRUE(renderer->draw(camera_, style_, frame_->target()));
    EXPECT_EQ(frame_->read(), plain);
}

TEST_P(RendererGlTest, DepthMapsAreTheSameUnderTheCallersState) {
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
    const CallerState caller;
    glDepthRangef(0.75F, 0.25F);
    if (!isGles()) {
        glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
        glEnable(GL_DEPTH_CLAMP);
    }
    EXPECT_TRUE(run([&](const char* call) { caller.expectKept(call); }) == plain);
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
