// SPDX-License-Identifier: Apache-2.0
// GL fault injection: libepoxy's entry points are pointers, temporarily replaced with functions that fail.
#include "runtime/air/particle_air.h"
#include "runtime/bodies/world_textures.h"
#include "runtime/events/event_recorder.h"
#include "runtime/gl/gl_fault.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "formats/animation/animated_mesh.h"
#include "runtime/gl/gl_fence.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/live/live_collider.h"
#include "runtime/live/skin_pass.h"
#include "runtime/live/wobble_pass.h"
#include "runtime/picture/collider_mesh.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/frame.h"
#include "runtime/picture/mesh_renderer.h"
#include "runtime/picture/particle_renderer.h"
#include "runtime/picture/sprite_atlas.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/collider/field_query.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

/// Replaces an entry point during its lifetime; one object per entry point at a time. The GL must have been called
/// through the entry point before: libepoxy stores the driver's function in the pointer at the first call.
template <auto& kEntry>
class Replaced {
  public:
    using Function = std::remove_reference_t<decltype(kEntry)>;
    explicit Replaced(Function by) {
        EXPECT_EQ(original, nullptr);
        original = std::exchange(kEntry, by);
    }
    ~Replaced() { kEntry = std::exchange(original, nullptr); }
    Replaced(const Replaced&) = delete;
    Replaced& operator=(const Replaced&) = delete;

    static inline Function original = nullptr;
};

// State shared by the replacements, which are plain functions, and the running test.
int allocations = 0;
int failing_allocation = -1;
std::string failed_call;
GLenum pending_error = GL_NO_ERROR;
GLint texture_side = 0;

bool failsNow(const char* call, GLenum target, GLsizeiptr width, GLsizeiptr height = 1,
              GLsizeiptr depth = 1) {
    if (allocations++ != failing_allocation) {
        return false;
    }
    failed_call = call + (" of target " + std::to_string(target)) + ", " + std::to_string(width) + " x " +
                  std::to_string(height) + " x " + std::to_string(depth);
    pending_error = GL_OUT_OF_MEMORY;
    return true;
}
void image2d(GLenum target, GLint level, GLint internal, GLsizei width, GLsizei height, GLint border,
             GLenum format, GLenum type, const void* pixels) {
    if (!failsNow("glTexImage2D", target, width, height)) {
        Replaced<epoxy_glTexImage2D>::original(target, level, internal, width, height, border, format, type,
                                               pixels);
    }
}
void image3d(GLenum target, GLint level, GLint internal, GLsizei width, GLsizei height, GLsizei depth,
             GLint border, GLenum format, GLenum type, const void* pixels) {
    if (!failsNow("glTexImage3D", target, width, height, depth)) {
        Replaced<epoxy_glTexImage3D>::original(target, level, internal, width, height, depth, border, format,
                                               type, pixels);
    }
}
void storage2d(GLenum target, GLsizei levels, GLenum internal, GLsizei width, GLsizei height) {
    if (!failsNow("glTexStorage2D", target, width, height)) {
        Replaced<epoxy_glTexStorage2D>::original(target, levels, internal, width, height);
    }
}
void bufferData(GLenum target, GLsizeiptr size, const void* data, GLenum usage) {
    if (!failsNow("glBufferData", target, size)) {
        Replaced<epoxy_glBufferData>::original(target, size, data, usage);
    }
}
GLenum getError() {
    const GLenum pending = std::exchange(pending_error, GL_NO_ERROR);
    const GLenum real = Replaced<epoxy_glGetError>::original();
    return pending != GL_NO_ERROR ? pending : real;
}
void getInteger(GLenum what, GLint* value) {
    Replaced<epoxy_glGetIntegerv>::original(what, value);
    if (what == GL_MAX_TEXTURE_SIZE || what == GL_MAX_3D_TEXTURE_SIZE) {
        *value = texture_side;
    }
}
GLenum guiltyReset() {
    return GL_GUILTY_CONTEXT_RESET;
}
GLenum endlessError() {
    return GL_CONTEXT_LOST;
}
GLenum incomplete(GLenum /*target*/) {
    return GL_FRAMEBUFFER_UNSUPPORTED;
}
void programStatus(GLuint program, GLenum what, GLint* value) {
    Replaced<epoxy_glGetProgramiv>::original(program, what, value);
    if (what == GL_LINK_STATUS) {
        *value = GL_FALSE;
    }
}
GLenum waitFails(GLsync /*sync*/, GLbitfield /*flags*/, GLuint64 /*nanoseconds*/) {
    return GL_WAIT_FAILED;
}

/// Counts allocations during its lifetime. The one numbered failing_allocation fails.
class CountedAllocations {
  public:
    CountedAllocations() { start(-1); }
    ~CountedAllocations() { start(-1); }
    CountedAllocations(const CountedAllocations&) = delete;
    CountedAllocations& operator=(const CountedAllocations&) = delete;
    static void start(int failing) {
        failing_allocation = failing;
        allocations = 0;
        pending_error = GL_NO_ERROR;
        failed_call.clear();
    }

  private:
    Replaced<epoxy_glTexImage2D> two_{&image2d};
    Replaced<epoxy_glTexImage3D> three_{&image3d};
    Replaced<epoxy_glTexStorage2D> storage_{&storage2d};
    Replaced<epoxy_glBufferData> buffers_{&bufferData};
    Replaced<epoxy_glGetError> errors_{&getError};
};

PictureMesh tetrahedron() {
    PictureMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    return mesh;
}

/// One triangle with a joint and a morph target.
AnimatedMesh animatedTriangle() {
    AnimatedMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.influence_begin = {0, 1, 2, 3};
    mesh.influences.resize(3);
    mesh.delta_begin = {0, 1, 1, 1};
    mesh.deltas.resize(1);
    mesh.joints.resize(1);
    mesh.weights.resize(1);
    return mesh;
}

template <class T>
Result<void> outcome(const Result<T>& result) {
    return result ? Result<void>{} : Result<void>(forward(result));
}

/// An operation that allocates GPU memory. Its prerequisites are created before `work` is called.
struct Work {
    template <class Make>
    Work(std::string its_name, Make make)
        : name(std::move(its_name)), work([make]() -> Result<void> { return outcome(make()); }) {}
    std::string name;
    std::function<Result<void>()> work;
};

class GlFaultTest : public GlTest {
  protected:
    GlFaultTest() {
        particles_.spawn(std::vector<Birth>{{{0.0F, 2.0F, 0.0F}, glm::vec3(0.0F), 100.0F, 0}});
        particles_.step(0.01F);
        // Calls every entry point that is replaced below once, so that libepoxy resolves it.
        auto one = required(ParticleSystem::create({.capacity = 1}));
        EXPECT_TRUE(setAir(one, air()));
        EXPECT_TRUE(ParticleSystem::create({.capacity = 1, .path = StepPath::kCompute}));
        EXPECT_TRUE(waitForGpu("nothing"));
        EXPECT_TRUE(FieldQuery::create(collider_));
    }

    static AirSettings air() {
        AirSettings settings;
        auto flow = std::make_shared<FlowField>();
        flow->size = {100, 1, 1};
        flow->nodes.assign(100, glm::vec3(1.0F));
        settings.flow = flow;
        return settings;
    }
    static Result<ParticleSystem> particles(Integrator integrator, StepPath path) {
        return ParticleSystem::create({.capacity = 200'000, .integrator = integrator, .path = path});
    }
    [[nodiscard]] ColliderView view() const { return {&textures_, collider_.bounds, finestTexel(collider_)}; }

    std::vector<Work> allWork() {
        const auto drawCollider = [this](const ColliderMesh* mesh) -> Result<void> {
            auto renderer = RELIEF_TRY(ColliderRenderer::create(view(), mesh));
            return renderer.draw({}, {}, frame_.target());
        };
        const auto evaluate = [this]() -> Result<std::vector<FieldSample>> {
            const auto query = RELIEF_TRY(FieldQuery::create(collider_));
            return query.evaluate(std::vector<glm::vec3>(200'000));  // more rows than the limit below
        };
        const auto events = [this] {
            EXPECT_TRUE(setEvents(particles_, std::nullopt));
            return setEvents(particles_, EventOptions{});
        };
        const std::vector<std::uint8_t> atlas(4 * 128 * 128);
        return {
            {"maps", [this] { return WorldTextures::create(collider_); }},
            {"query", evaluate},
            {"euler", [] { return particles(Integrator::kEuler, StepPath::kFragment); }},
            {"verlet", [] { return particles(Integrator::kVerlet, StepPath::kFragment); }},
            {"euler, compute", [] { return particles(Integrator::kEuler, StepPath::kCompute); }},
            {"verlet, compute", [] { return particles(Integrator::kVerlet, StepPath::kCompute); }},
            {"events", events},
            {"flow", [this] { return setAir(particles_, air()); }},
            {"sort", [] { return DepthSorter::create(200'000, StepPath::kFragment); }},
            {"sort, compute", [] { return DepthSorter::create(200'000, StepPath::kCompute); }},
            {"frame", [] { return Frame::create(100, 100); }},
            {"collider from maps", [=] { return drawCollider(nullptr); }},
            {"collider from mesh", [=, this] { return drawCollider(&mesh_); }},
            {"atlas", [=] { return SpriteAtlas::create(atlas, 128, 128, 2, 2); }},
        };
    }
    /// Operations that are small on every GL and stay within all limits.
    std::vector<Work> smallWork() {
        const PictureMesh mesh = tetrahedron();
        const auto live = [=]() -> Result<LiveCollider> {
            Collider frames = RELIEF_TRY(liveMaps({glm::vec3(0.0F), glm::vec3(1.0F)}, 32));
            return LiveCollider::create(mesh.positions, trianglesOf(mesh), std::move(frames));
        };
        const auto wobble = [=] {
            return WobblePass::create({}, mesh.positions, std::vector<glm::vec3>(mesh.positions.size()));
        };
        const auto picture = [=]() -> Result<void> {
            PictureMesh colored = mesh;
            colored.colors.resize(mesh.positions.size());
            auto renderer = RELIEF_TRY(MeshRenderer::create({&colored, 1}));
            return renderer.setPositions(0, mesh.positions);
        };
        const std::vector<ColliderBody> bodies(2, {&collider_, {}});
        return {{"mesh", [=] { return ColliderMesh::create(mesh); }},
                {"particles, lit", [this] { return drawParticles(view(), StepPath::kFragment); }},
                {"bodies", [=] { return WorldTextures::create(bodies); }},
                {"live mesh", live},
                {"wobbling mesh", wobble},
                {"animated mesh", [] { return SkinPass::create(animatedTriangle()); }},
                {"picture of meshes", picture}};
    }
    /// The particle fills the centre of the picture.
    Result<void> drawParticles(const std::optional<ColliderView>& collider, StepPath path) {
        clearPicture(frame_.target().framebuffer, {0.0F, 0.0F, 0.0F, 1.0F});
        auto renderer = RELIEF_TRY(ParticleRenderer::create(collider, path));
        const Camera camera{.eye = {0.0F, 2.0F, 4.0F}, .target = {0.0F, 2.0F, 0.0F}};
        const ParticleStyle style{.diameter = 1.0F, .fade_in = 0.0F, .sprite = Sprite::kQuad};
        return renderer.draw(particles_, camera, style, frame_.target());
    }

    const Collider collider_ = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 32);
    WorldTextures textures_ = required(WorldTextures::create(collider_));
    Frame frame_ = required(Frame::create(32, 32));
    ColliderMesh mesh_ = required(ColliderMesh::create(tetrahedron()));
    ParticleSystem particles_ = required(ParticleSystem::create({.capacity = 100}));
};

// Only the first allocation fails, then only the second, and so on. Each returns an error, until all succeed.
TEST_P(GlFaultTest, EveryFailedAllocationIsAnError) {
    std::vector<Work> all = allWork();
    for (Work& small : smallWork()) {
        all.push_back(std::move(small));
    }
    const CountedAllocations counted;
    for (const Work& one : all) {
        SCOPED_TRACE(one.name);
        for (int failing = 0;; ++failing) {
            ASSERT_LT(failing, 100);
            CountedAllocations::start(failing);
            const Result<void> done = one.work();
            if (allocations <= failing) {
                EXPECT_TRUE(done) << done.error().message;
                EXPECT_GT(failing, 0) << "nothing is allocated: the test proves nothing";
                break;
            }
            ASSERT_FALSE(done) << "allocation " << failing << " failed in silence: " << failed_call;
            expectError(done, ErrorCode::kLimit, "out of GPU memory");
        }
    }
}

// Tile memory is the only allocation that may fail without an error: the GL then draws the particles.
TEST_P(GlFaultTest, ParticlesAreDrawnWithoutTileMemory) {
    ASSERT_TRUE(drawParticles(std::nullopt, StepPath::kFragment));
    const std::vector<std::uint8_t> drawn = frame_.read();
    EXPECT_GT(*std::max_element(drawn.begin(), drawn.end()), 100)
        << "nothing is drawn: the test proves nothing";
    const CountedAllocations counted;
    ASSERT_TRUE(drawParticles(std::nullopt, StepPath::kFragment));
    const int first = std::exchange(allocations, 0);
    ASSERT_TRUE(drawParticles(std::nullopt, StepPath::kCompute));
    const int end = allocations;
    EXPECT_EQ(end - first, 8) << "seven buffers and the layer";
    for (int failing = 0; failing < end; ++failing) {
        CountedAllocations::start(failing);
        const Result<void> done = drawParticles(std::nullopt, StepPath::kCompute);
        SCOPED_TRACE("allocation " + std::to_string(failing) + ": " + failed_call);
        ASSERT_FALSE(failed_call.empty());
        ASSERT_EQ(done.has_value(), failing >= first);
        if (done) {
            const std::vector<std::uint8_t> picture = frame_.read();
            for (std::size_t i = 0; i < drawn.size(); ++i) {
                ASSERT_LE(std::abs(picture[i] - drawn[i]), 1) << "byte " << i;
            }
        }
    }
}

TEST_P(GlFaultTest, TextureLimitErrorsNameSizeAndLimit) {
    const Replaced<epoxy_glGetIntegerv> integers(&getInteger);
    texture_side = 31;  // below the smallest texture, 32x32 pixels, and all others
    for (const Work& one : allWork()) {
        SCOPED_TRACE(one.name);
        expectError(one.work(), ErrorCode::kLimit, "31");
    }
}

TEST_P(GlFaultTest, ReadBacksReportAReset) {
    const auto query = required(FieldQuery::create(collider_));
    const std::array<glm::vec3, 1> points{glm::vec3(0.0F)};
    ASSERT_TRUE(query.evaluate(points));
    ASSERT_TRUE(checkGpu("testing")) << "without a reset there is no error";
    ASSERT_TRUE(setEvents(particles_, EventOptions{}));
    particles_.step(0.01F);
    ASSERT_TRUE(requestEvents(particles_, 1));
    {
        const Replaced<epoxy_glGetGraphicsResetStatus> status(&guiltyReset);
        for (const Result<void>& done :
             {checkGpu("testing"), waitForGpu("steps 1 to 2"), outcome(query.evaluate(points)),
              outcome(particles_.readState()), outcome(waitEvents(particles_))}) {
            expectError(done, ErrorCode::kFailure, "the GPU was reset");
        }
    }
    EXPECT_TRUE(query.evaluate(points));
}

// A lost context may return errors forever.
TEST_P(GlFaultTest, EndlessErrorsTerminate) {
    const Replaced<epoxy_glGetError> errors(&endlessError);
    clearGlErrors();
    expectError(WorldTextures::create(collider_), ErrorCode::kFailure, "0x0507");
}

TEST_P(GlFaultTest, FailedWaitsAreErrors) {
    const Replaced<epoxy_glClientWaitSync> wait(&waitFails);
    expectError(waitForGpu("steps 3 to 4"), ErrorCode::kFailure, "steps 3 to 4");
    GlFence fence;
    EXPECT_TRUE(fence.failed()) << "never inserted";
    fence.insert();
    EXPECT_FALSE(fence.failed());
    EXPECT_FALSE(fence.passed());
    EXPECT_TRUE(fence.failed());
}

TEST_P(GlFaultTest, RejectedFramebuffersAndShadersAreErrors) {
    {
        const Replaced<epoxy_glCheckFramebufferStatus> status(&incomplete);
        expectError(ParticleSystem::create({.capacity = 10}), ErrorCode::kUnsupported, "0x8cdd");
        expectError(particles_.readState(), ErrorCode::kUnsupported);
    }
    {
        const Replaced<epoxy_glGetProgramiv> status(&programStatus);
        expectError(Frame::create(8, 8), ErrorCode::kFailure, "base/quad.vert");
    }
    // The driver's message is included.
    const auto program = makeProgram("base/quad.vert", "bench/copy_state.frag", "no GLSL at all\n");
    expectError(program, ErrorCode::kFailure, "quad.vert does not compile: ");
    expectError(program, ErrorCode::kFailure, "syntax error");
}

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(GlFaultTest);

}  // namespace relief
