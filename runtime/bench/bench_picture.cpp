// What a picture of particles costs: relief-bench-picture COLLIDER.relief [--particles N] [--path fragment|compute]
// prints JSON. Nothing here is a test: machines are shared and noisy. A software renderer draws points on either path.
//
// The particles are those of relief-bench-step, born all through the collider's box. `bare` draws the same points, as
// large and opaque as they are, in one colour (a GPU need not read what a wholly opaque one covers); then the parts of a picture one by one, and all of them. A block is
// some draws between two glFinish; blocks take turns, and a ratio is the median of the ratios within each turn.
#include <algorithm>
#include <array>
#include <functional>
#include <glm/gtc/type_ptr.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/text.h"
#include "formats/container.h"
#include "runtime/bench/bench_tool.h"
#include "runtime/bench/bench_variants.h"
#include "runtime/gl/gl_context.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/collider_light.h"
#include "runtime/picture/collider_view.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/particle_renderer.h"

namespace relief {
namespace {

constexpr std::uint32_t kSortFrames = 30;
constexpr double kWarmUpMs = 20.0;
constexpr float kDt = 1e-5F;          // of a step: thousands of them leave the particles where they are
constexpr float kPointPixels = 2.0F;  // a side of the small points
constexpr float kLeastPixels = 1.5F;  // ParticleRenderer draws none smaller

struct Options {
    std::string collider;
    std::uint32_t particles = 1U << 20;
    StepPath path = StepPath::kFragment;
};

struct Work {
    std::string name;
    std::function<void()> run;
    std::vector<double> ms;
};

/// The bare draw.
class BarePoints {
  public:
    static Result<BarePoints> create(std::string_view defines) {
        BarePoints bare;
        bare.program_ = RELIEF_TRY(makeProgram("bare_points.vert", "bare_draw.frag", defines));
        bare.array_ = makeVertexArray();
        return bare;
    }
    void draw(const ParticleSystem& particles, const Camera& camera, float diameter,
              const RenderTarget& target) const {
        const PassState state;
        const glm::mat4 clip = camera.projection(target.aspect()) * camera.view();
        glUseProgram(program_.name());
        glUniformMatrix4fv(uniformLocation(program_, "u_clip"), 1, GL_FALSE, glm::value_ptr(clip));
        glUniform1f(uniformLocation(program_, "u_pixels"),
                    diameter * 0.5F * static_cast<float>(target.height) / camera.tanHalfFov());
        glUniform1f(uniformLocation(program_, "u_pixels_min"), kLeastPixels);
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

void measure(std::vector<Work>& works, bool software, const std::function<void()>& clear) {
    const int rounds = software ? 3 : 7;
    const int draws = software ? 1 : 16;
    for (int round = -1; round < rounds; ++round) {  // the first for the driver, which compiles
        for (Work& work : works) {
            clear();
            const Stopwatch warm_up;
            do {
                work.run();
                glFinish();
            } while (!software && warm_up.ms() < kWarmUpMs);
            const Stopwatch watch;
            for (int i = 0; i < draws; ++i) {
                work.run();
            }
            glFinish();
            if (round >= 0) {
                work.ms.push_back(watch.ms() / draws);
            }
        }
    }
}

Json reportOf(const std::vector<Work>& works) {
    Json json;
    for (const Work& work : works) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < work.ms.size(); ++i) {
            ratios.push_back(work.ms[i] / works.front().ms[i]);
        }
        json[work.name] = {{"ms", median(work.ms)}, {"over_bare", median(ratios)}};
    }
    return json;
}

/// What a picture is drawn to, and of what.
struct Stage {
    const Options& options;
    const BenchScene& scene;
    BenchSystem& system;
    ColliderView view;
    bool software;
};

Result<Json> benchSize(const Stage& stage, GLsizei width, GLsizei height, bool small) {
    const ParticleSystem& particles = *stage.system.particles;
    const GlTexture color = makeTexture2D(GL_RGBA16F, width, height, GL_RGBA, GL_HALF_FLOAT);
    const GlTexture depth = makeTexture2D(GL_DEPTH_COMPONENT32F, width, height, GL_DEPTH_COMPONENT, GL_FLOAT);
    const std::vector<float> far(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 1.0F);
    const GlTexture behind =
        makeTexture2D(GL_DEPTH_COMPONENT32F, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, far.data());
    const auto framebuffer = RELIEF_TRY(makeFramebuffer(std::array<GLuint, 1>{color.name()}, depth.name()));
    const RenderTarget target{framebuffer.name(), width, height};
    Camera camera;
    camera.target = stage.view.bounds.center();
    camera.eye = defaultEye(camera.target, 0.5F * glm::length(stage.view.bounds.size()), camera.fov);
    setClipPlanes(camera, stage.view.bounds);
    // As relief-sim draws unless told otherwise, but nobody fades: they live too short.
    const float unit = 0.5F * static_cast<float>(height) /
                       (camera.tanHalfFov() * glm::length(camera.eye - camera.target));  // pixels
    const float diameter = small ? kPointPixels / unit : 0.0065F * stage.scene.side;
    const ParticleStyle plain{.diameter = diameter, .fade_in = 0.0F, .fade_out = 0.0F};

    auto bare = RELIEF_TRY(BarePoints::create("#define RELIEF_ALPHA 0.95\n"));  // as the style's
    auto opaque = RELIEF_TRY(BarePoints::create(""));
    const StepPath path = picturePath(stage.options.path);
    auto open = RELIEF_TRY(ParticleRenderer::create(std::nullopt, path));
    auto lit = RELIEF_TRY(ParticleRenderer::create(stage.view, path));
    auto sorter = RELIEF_TRY(DepthSorter::create(stage.options.particles));
    const auto sort = [&](std::uint32_t passes) {
        sorter.update(particles.positions(), particles.textureWidth(), particles.extent(), camera.eye,
                      passes);
    };
    sort(DepthSorter::sequencePasses(stage.options.particles));
    const auto step = [&] { stage.system.particles->step(kDt); };
    Result<void> drawn;
    const auto draw = [&](ParticleRenderer& renderer, bool soft, bool ordered,
                          Sprite sprite = Sprite::kPoint) {
        ParticleStyle style = plain;
        style.soft = soft ? 0.02F * stage.scene.side : 0.0F;
        style.sprite = sprite;
        const ParticleOrder order =
            ordered ? ParticleOrder{&sorter.order(), sorter.count()} : ParticleOrder{};
        if (auto done = renderer.draw(particles, camera, style, target, order, &behind); !done) {
            drawn = done;
        }
    };
    std::vector<Work> works{
        {"bare", [&] { bare.draw(particles, camera, diameter, target); }, {}},
        {"bare, opaque", [&] { opaque.draw(particles, camera, diameter, target); }, {}},
        {"open", [&] { draw(open, false, false); }, {}},
        {"soft", [&] { draw(open, true, false); }, {}},
        {"order", [&] { draw(open, false, true); }, {}},
        {"light", [&] { draw(lit, false, false); }, {}},
        {"all", [&] { draw(lit, true, true); }, {}},
        {"all, quads", [&] { draw(lit, true, true, Sprite::kQuad); }, {}},
        {"step", step, {}},
        {"sort", [&] { sort(DepthSorter::passesPerFrame(stage.options.particles, kSortFrames)); }, {}},
        {"step and all",
         [&] {
             step();
             draw(lit, true, true);
         },
         {}},
    };
    const auto clear = [&] {
        glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
        const GLfloat nearest_is_one = 1.0F;
        const std::array<GLfloat, 4> black{};
        glClearBufferfv(GL_COLOR, 0, black.data());
        glClearBufferfv(GL_DEPTH, 0, &nearest_is_one);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
    };
    measure(works, stage.software, clear);
    RELIEF_TRY(Result<void>(drawn));
    return Json{
        {"picture", {width, height}}, {"pixels_of_a_point", diameter * unit}, {"parts", reportOf(works)}};
}

/// The light among the collider, made anew.
Result<double> benchLight(const Stage& stage) {
    std::vector<double> ms;
    for (int i = 0; i < 5; ++i) {
        const PassState state;
        auto light = RELIEF_TRY(ColliderLight::create(stage.view));
        RELIEF_TRY(light.update());  // the driver allocates
        stage.system.textures->noteLiveUpdate();
        glFinish();
        const Stopwatch watch;
        RELIEF_TRY(light.update());
        glFinish();
        ms.push_back(watch.ms());
    }
    return median(ms);
}

Result<Options> parse(int argc, char** argv) {
    Options options;
    bool known = argc >= 2;
    for (int i = 1; i < argc && known; ++i) {
        const std::string_view word = argv[i];
        const std::string_view value = i + 1 < argc ? argv[i + 1] : "";
        const auto count = parseUnsigned(value);
        if (word == "--path" && (value == "fragment" || value == "compute")) {
            options.path = value == "compute" ? StepPath::kCompute : StepPath::kFragment;
            ++i;
        } else if (word == "--particles" && count && *count > 0 && *count <= DepthSorter::kCapacityMax) {
            options.particles = static_cast<std::uint32_t>(*count);
            ++i;
        } else {
            known = options.collider.empty() && !word.starts_with("--");
            options.collider = word;
        }
    }
    if (!known || options.collider.empty()) {
        return fail(ErrorCode::kUsage,
                    "usage: relief-bench-picture COLLIDER.relief [--particles N] [--path fragment|compute]");
    }
    return options;
}

Result<Json> bench(int argc, char** argv) {
    const Options options = RELIEF_TRY(parse(argc, argv));
    const auto collider = RELIEF_TRY(loadCollider(options.collider));
    const auto context = RELIEF_TRY(GlContext::create(GlApi::kGl33Core));
    BenchScene scene = makeBenchScene(collider, options.particles);
    scene.path = options.path;
    for (Birth& birth : scene.births) {
        birth.lifetime = 1e6F;
    }
    auto system = RELIEF_TRY(makeColliderSystem(scene));
    system.begin(scene);
    const Stage stage{options,
                      scene,
                      system,
                      {system.textures.get(), collider.bounds, finestTexel(collider)},
                      context->software()};
    Json json;
    json["device"] = context->description();
    json["software"] = stage.software;
    json["particles"] = options.particles;
    json["path"] = options.path == StepPath::kCompute ? "compute" : "fragment";
    const double light = RELIEF_TRY(benchLight(stage));
    json["light_anew_ms"] = light;
    for (const bool small : {false, true}) {
        for (const auto& [width, height] : {std::pair{1280, 720}, std::pair{1920, 1080}}) {
            Json size = RELIEF_TRY(benchSize(stage, width, height, small));
            json["pictures"].push_back(std::move(size));
        }
    }
    if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
        return fail(ErrorCode::kFailure, "the GL reports error " + std::to_string(error));
    }
    return json;
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::finishBench("relief-bench-picture", relief::bench(argc, argv));
}
