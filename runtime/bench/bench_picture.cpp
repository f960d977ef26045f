// SPDX-License-Identifier: Apache-2.0
// Benchmark: a picture of particles in the whole box of the collider. `bare` draws points of the same size and opacity
// in one colour; the other variants add the parts of a picture one by one, then all together. A software renderer draws
// points on either path.
#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>
#include <string_view>

#include "formats/container.h"
#include "runtime/bench/bench.h"
#include "runtime/bench/bench_scene.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/collider_view.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/particle_renderer.h"

namespace relief {
namespace {

constexpr std::uint32_t kSortFrames = 30;
constexpr float kDt = 1e-5F;  // so short that particles hardly move in thousands of steps
constexpr double kWarmUpMs = 20.0;
constexpr float kPixelsMin = 1.5F;  // minimum of ParticleRenderer

/// Draws bare points.
class BarePoints {
  public:
    static Result<BarePoints> create(std::string_view defines) {
        BarePoints bare;
        bare.program_ = RELIEF_TRY(makeProgram("bench/bare_points.vert", "bench/bare_draw.frag", defines));
        bare.array_ = makeVertexArray();
        return bare;
    }
    void draw(const ParticleSystem& particles, const Camera& camera, float diameter,
              const RenderTarget& target) const {
        const PassState state;
        const glm::mat4 clip = camera.projection(target.aspect()) * camera.view();
        program_.use();
        program_.set("u_clip", clip);
        program_.set("u_pixels", diameter * 0.5F * static_cast<float>(target.height) / camera.tanHalfFov());
        program_.set("u_pixels_min", kPixelsMin);
        useTexture(0, particles.positions());
        glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
        glViewport(0, 0, target.width, target.height);
        glEnable(GL_BLEND);
        glBlendEquation(GL_FUNC_ADD);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LEQUAL);
        glDepthMask(GL_FALSE);
        glBindVertexArray(array_.name());
        glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(particles.extent()));
    }

  private:
    GlProgram program_;
    GlVertexArray array_;
};

/// \param point_pixels  diameter of the points; 0: the default of relief-sim.
Result<Json> benchSize(const Bench& bench, const BenchScene& scene, BenchSystem& system, GLsizei width,
                       GLsizei height, float point_pixels) {
    const ParticleSystem& particles = *system.particles;
    const ColliderView view{system.textures.get(), scene.collider.bounds, finestTexel(scene.collider)};
    const auto count = static_cast<std::uint32_t>(scene.births.size());
    const GlTexture color = makeTexture2D(GL_RGBA16F, width, height, GL_RGBA, GL_HALF_FLOAT);
    const std::vector<float> far(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 1.0F);
    const auto depthTexture = [&] {
        return makeTexture2D(GL_DEPTH_COMPONENT32F, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, far.data());
    };
    const GlTexture depth = depthTexture();
    const GlTexture behind = depthTexture();
    const auto framebuffer = RELIEF_TRY(makeFramebuffer({color.name()}, depth.name()));
    const RenderTarget target{framebuffer.name(), width, height};
    Camera camera;
    camera.target = view.bounds.center();
    camera.eye = defaultEye(camera.target, 0.5F * glm::length(view.bounds.size()), camera.fov);
    setClipPlanes(camera, view.bounds);
    const float unit = 0.5F * static_cast<float>(height) /
                       (camera.tanHalfFov() * glm::length(camera.eye - camera.target));  // pixels
    const float diameter = point_pixels > 0.0F ? point_pixels / unit : 0.0065F * scene.side;

    const auto bare = RELIEF_TRY(BarePoints::create("#define RELIEF_ALPHA 0.95\n"));  // as in the style
    const StepPath path = picturePath(bench.path);
    auto open = RELIEF_TRY(ParticleRenderer::create(std::nullopt, path));
    auto lit = RELIEF_TRY(ParticleRenderer::create(view, path));
    auto merge = RELIEF_TRY(DepthSorter::create(count, StepPath::kFragment));
    auto sorter = RELIEF_TRY(DepthSorter::create(count, path));
    const auto sort = [&](DepthSorter& by, std::uint32_t passes) -> Result<void> {
        by.update(particles.positions(), particles.textureWidth(), particles.extent(), camera.eye, passes);
        return {};
    };
    const std::uint32_t all = DepthSorter::sequencePasses(count);
    RELIEF_TRY(sort(sorter, all));
    const auto step = [&]() -> Result<void> {
        system.particles->step(kDt);
        return {};
    };
    const auto drawBare = [&]() -> Result<void> {
        bare.draw(particles, camera, diameter, target);
        return {};
    };
    const auto draw = [&](ParticleRenderer& renderer, bool soft, bool ordered,
                          Sprite sprite = Sprite::kPoint) {
        ParticleStyle style{.diameter = diameter, .fade_in = 0.0F, .fade_out = 0.0F};
        style.soft_distance = soft ? 0.02F * scene.side : 0.0F;
        style.sprite = sprite;
        const ParticleOrder order =
            ordered ? ParticleOrder{&sorter.order(), sorter.count()} : ParticleOrder{};
        return renderer.draw(particles, camera, style, target, order, &behind);
    };
    std::vector<Work> works{
        {"bare", drawBare},
        {"open", [&] { return draw(open, false, false); }},
        {"soft", [&] { return draw(open, true, false); }},
        {"order", [&] { return draw(open, false, true); }},
        {"light", [&] { return draw(lit, false, false); }},
        {"all", [&] { return draw(lit, true, true); }},
        {"all, quads", [&] { return draw(lit, true, true, Sprite::kQuad); }},
        {"step", step},
        {"sort", [&] { return sort(sorter, DepthSorter::passesPerFrame(count, kSortFrames)); }},
        {"sort, merge at once", [&] { return sort(merge, all); }},
        {"step and all", [&]() -> Result<void> {
             RELIEF_TRY(step());
             return draw(lit, true, true);
         }}};
    for (Work& work : works) {
        work.over = "bare";
        work.before = [&] {
            glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
            const GLfloat farthest = 1.0F;
            const std::array<GLfloat, 4> black{};
            glClearBufferfv(GL_COLOR, 0, black.data());
            glClearBufferfv(GL_DEPTH, 0, &farthest);
            glBindFramebuffer(GL_FRAMEBUFFER, 0);
            warmUp(bench, kWarmUpMs, [&] { (void)work.run(); });
        };
    }
    return Json{{"particles", count},
                {"picture", {width, height}},
                {"pixels_of_a_point", diameter * unit},
                {"rows", RELIEF_TRY(timeAlternating(bench, works, {.rounds = bench.software ? 3 : 7}))}};
}

}  // namespace

Result<Json> benchPicture(const Bench& bench) {
    const BenchScene scene =
        makeBenchScene(RELIEF_TRY(loadCollider(bench.file)), bench.particlesOr(1U << 20, 1U << 16));
    auto system = RELIEF_TRY(makeBenchSystem(scene, bench.path));
    system.begin(scene);
    Json tables = Json::array();
    for (const float point_pixels : {0.0F, 2.0F}) {
        for (const auto& [width, height] : {std::pair{1280, 720}, std::pair{1920, 1080}}) {
            tables.push_back(RELIEF_TRY(benchSize(bench, scene, system, width, height, point_pixels)));
        }
    }
    return tables;
}

}  // namespace relief
