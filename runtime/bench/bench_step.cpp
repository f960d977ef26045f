// What a step costs: relief-bench-step COLLIDER.relief [--large] [--path fragment|compute] [--particles N] [--only NAME]
// [--blocks N] [--sorted] prints JSON. --sorted: particles lie on the GPU in the order of their places, so that the lanes of a
// warp do the same; what that gains is what a warp loses by waiting for its slowest lane.
// Nothing here is a test: machines are shared and noisy.
//
// A block is some steps between two glFinish. Before each all particles are born anew, so that blocks
// are alike; births and the first step are not timed. Blocks of all variants take turns, and a ratio is the
// median of the ratios within each turn: other work on the machine meets both sides of it. With llvmpipe
// ratios are of the process's CPU time, which that other work hardly changes; else of the time by the clock
// on the wall. `call_ms` is how long the calls took of that: where it is nearly the whole, a GPU waited for
// the CPU (which llvmpipe is). Each step, and each copy, is flushed, as the end of a frame flushes a game's: else a driver
// may keep the calls of a whole block until glFinish, and the GPU would idle while they are made.
//
// `copy` is a draw, or with --path compute a dispatch, that only copies the two state textures: it reads and writes 32
// bytes a particle; a step reads the 16 of the birth texture besides.
//
// Sizes suit llvmpipe where that is the renderer, unless --large asks for a GPU's.
#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/text.h"
#include "formats/container.h"
#include "runtime/bench/bench_tool.h"
#include "runtime/bench/bench_variants.h"
#include "runtime/gl/gl_context.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/image_units.h"
#include "runtime/particles/random.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/collider_view.h"
#include "runtime/picture/particle_renderer.h"
#include "shaders/shader_constants.h"

namespace relief {
namespace {

constexpr GLsizei kPictureWidth = 1280;
constexpr GLsizei kPictureHeight = 720;
constexpr double kWarmUpMs = 100.0;

struct Sizes {
    bool software;
    std::uint32_t particles;            // of the step
    int steps;                          // of a block, kBenchStepsMost at most
    int rounds;                         // blocks of each variant
    std::vector<std::uint32_t> frames;  // particles
    int frame_steps;
    int frame_rounds;
};

Sizes sizesFor(bool software, bool large) {
    const std::vector<std::uint32_t> all{1U << 16, 1U << 18, 1U << 20, 1U << 22};
    if (software) {
        return large ? Sizes{true, 1U << 20, 4, 5, all, 1, 3}
                     : Sizes{true, 1U << 17, 4, 5, {1U << 16, 1U << 18}, 1, 3};
    }
    return {false, 1U << 20, kBenchStepsMost, 11, all, kBenchStepsMost, 7};
}

/// Milliseconds of each block, a step of it.
struct Times {
    std::vector<double> all;
    std::vector<double> calls;
    std::vector<double> cpu;  // of all threads

    void measure(int steps, const std::function<void()>& step) {
        glFinish();
        const CpuStopwatch cpu_watch(CLOCK_PROCESS_CPUTIME_ID);
        const Stopwatch watch;
        for (int i = 0; i < steps; ++i) {
            step();
            glFlush();
        }
        calls.push_back(watch.ms() / steps);
        glFinish();
        all.push_back(watch.ms() / steps);
        cpu.push_back(cpu_watch.ms() / steps);
    }
};

Json ratio(const Times& times, const Times& base, bool software) {
    const std::vector<double>& above = software ? times.cpu : times.all;
    const std::vector<double>& below = software ? base.cpu : base.all;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < above.size(); ++i) {
        ratios.push_back(above[i] / below[i]);
    }
    return {{"median", median(ratios)},
            {"least", *std::min_element(ratios.begin(), ratios.end())},
            {"most", *std::max_element(ratios.begin(), ratios.end())}};
}

/// The bare copy of two state textures.
class Copy {
  public:
    static Result<Copy> create(std::uint32_t particles, StepPath path) {
        Copy copy;
        copy.compute_ = path == StepPath::kCompute;
        copy.rows_ = static_cast<GLsizei>(particles / ParticleSystem::kStateWidth);
        Pcg32 random(1);
        std::vector<float> texels(std::size_t{4} * particles);  // that no driver can compress
        std::generate(texels.begin(), texels.end(), [&] { return random.uniform(); });
        for (std::size_t i = 0; i < 2; ++i) {
            for (GlTexture& texture : copy.state_[i]) {
                if (!copy.compute_) {  // where there may be no immutable textures
                    texture = makeTexture2D(GL_RGBA32F, kWidth, copy.rows_, GL_RGBA, GL_FLOAT, texels.data());
                    continue;
                }
                texture = makeImageTexture2D(GL_RGBA32F, kWidth, copy.rows_);
                glBindTexture(GL_TEXTURE_2D, texture.name());
                glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kWidth, copy.rows_, GL_RGBA, GL_FLOAT, texels.data());
                glBindTexture(GL_TEXTURE_2D, 0);
            }
            copy.target_[i] = RELIEF_TRY(
                makeFramebuffer(std::array<GLuint, 2>{copy.state_[i][0].name(), copy.state_[i][1].name()}));
        }
        copy.program_ = RELIEF_TRY(copy.compute_ ? makeComputeProgram("copy_state.comp")
                                                 : makeProgram("quad.vert", "copy_state.frag"));
        copy.array_ = makeVertexArray();
        glUseProgram(copy.program_.name());
        glUniform1i(uniformLocation(copy.program_, "u_velocity"), 1);
        glUseProgram(0);
        return copy;
    }
    void step() {
        const std::size_t next = 1 - current_;
        for (std::size_t i = 0; i < 2; ++i) {
            useTexture(static_cast<int>(i), state_[current_][i]);
        }
        glUseProgram(program_.name());
        if (compute_) {
            ImageUnits::write(0, state_[next][0]);
            ImageUnits::write(1, state_[next][1]);
            // What is written beyond the last row is lost.
            glDispatchCompute(kWidth / kStepGroupWidth,
                              static_cast<GLuint>((rows_ + kStepGroupHeight - 1) / kStepGroupHeight), 1);
            ImageUnits::finish();
        } else {
            glBindFramebuffer(GL_FRAMEBUFFER, target_[next].name());
            glViewport(0, 0, kWidth, rows_);
            glBindVertexArray(array_.name());
            glDrawArrays(GL_TRIANGLES, 0, 3);
        }
        current_ = next;
    }

  private:
    static constexpr auto kWidth = static_cast<GLsizei>(ParticleSystem::kStateWidth);

    bool compute_ = false;
    GLsizei rows_ = 0;
    std::size_t current_ = 0;
    std::array<std::array<GlTexture, 2>, 2> state_;  // position and velocity
    std::array<GlFramebuffer, 2> target_;
    GlProgram program_;
    GlVertexArray array_;
};

/// Counts who touches the collider at the end of a block.
Json touching(const BenchSystem& system, int steps_taken) {
    const auto state = system.particles->readState();
    if (!state || state->empty()) {
        return nullptr;
    }
    std::uint64_t in_contact = 0;
    std::uint64_t caught = 0;
    std::uint64_t collisions = 0;
    for (const ParticleState& particle : *state) {
        in_contact += particle.contact != Contact::kNone ? 1 : 0;
        caught += particle.contact == Contact::kCaught ? 1 : 0;
        collisions += particle.collisions;
    }
    const double steps = static_cast<double>(state->size()) * steps_taken;
    return {{"alive", state->size()},
            {"in_contact", in_contact},
            {"caught", caught},
            {"contacts_a_step", static_cast<double>(collisions) / steps}};
}

Result<void> benchSteps(const BenchScene& scene, const Sizes& sizes, const std::string& only, Json& json) {
    std::vector<BenchVariant> variants = benchVariants();
    if (!only.empty()) {
        const auto named = [](const BenchVariant& variant, std::string_view name) {
            return variant.name == name;
        };
        if (std::none_of(variants.begin(), variants.end(),
                         [&](const BenchVariant& variant) { return named(variant, only); })) {
            return fail(ErrorCode::kUsage, "--only " + only + ": no such variant; without it all are named");
        }
        std::erase_if(variants, [&](const BenchVariant& variant) {
            return !named(variant, only) && !named(variant, "collider") && !named(variant, "no_collider");
        });
    }
    std::vector<BenchSystem> systems;
    for (const BenchVariant& variant : variants) {
        auto made = RELIEF_TRY(variant.make(scene));
        systems.push_back(std::move(made));
    }
    auto copy = RELIEF_TRY(Copy::create(sizes.particles, scene.path));
    Times copied;
    std::vector<Times> times(variants.size());
    std::vector<Json> touch(variants.size());
    copy.step();  // the driver compiles
    // A GPU that waited for births has slowed its clock down, which no game lets it do.
    const auto warm = [&] {
        const Stopwatch watch;
        while (!sizes.software && watch.ms() < kWarmUpMs) {
            for (int i = 0; i < kBenchStepsMost; ++i) {
                copy.step();
            }
            glFinish();
        }
        glUseProgram(0);  // PassState must not save a program of the copy's
    };
    for (int round = 0; round < sizes.rounds; ++round) {
        warm();
        copied.measure(sizes.steps, [&] { copy.step(); });
        for (std::size_t i = 0; i < variants.size(); ++i) {
            systems[i].begin(scene);
            warm();
            times[i].measure(sizes.steps, [&] { systems[i].step(); });
            if (round == 0) {
                touch[i] = touching(systems[i], sizes.steps + 1);
            }
            systems[i].end();
        }
    }
    const auto timesOf = [&](std::string_view name) -> const Times& {
        const auto it = std::find_if(variants.begin(), variants.end(),
                                     [&](const BenchVariant& variant) { return variant.name == name; });
        return times[static_cast<std::size_t>(it - variants.begin())];
    };
    json["steps"] = {{"particles", sizes.particles}, {"block", sizes.steps}, {"blocks", sizes.rounds}};
    json["copy"] = {{"ms", median(copied.all)},
                    {"call_ms", median(copied.calls)},
                    {"cpu_ms", median(copied.cpu)},
                    {"step_over_copy", ratio(timesOf("no_collider"), copied, sizes.software)}};
    for (std::size_t i = 0; i < variants.size(); ++i) {
        json["variants"].push_back({{"name", variants[i].name},
                                    {"what", variants[i].what},
                                    {"ms", median(times[i].all)},
                                    {"call_ms", median(times[i].calls)},
                                    {"cpu_ms", median(times[i].cpu)},
                                    {"over_collider", ratio(times[i], timesOf("collider"), sizes.software)},
                                    {"touching", touch[i]}});
    }
    return {};
}

/// A step alone, a step and a picture of points, a step and one of quads.
Result<void> benchFrames(const Collider& collider, std::uint32_t particles, const Sizes& sizes, StepPath path,
                         Json& json) {
    BenchScene scene = makeBenchScene(collider, particles);
    scene.path = path;
    auto system = RELIEF_TRY(makeColliderSystem(scene));
    auto renderer = RELIEF_TRY(ParticleRenderer::create(
        ColliderView{system.textures.get(), collider.bounds, finestTexel(collider)}, picturePath(path)));
    const GlTexture color = makeTexture2D(GL_RGBA16F, kPictureWidth, kPictureHeight, GL_RGBA, GL_HALF_FLOAT);
    const GlTexture depth =
        makeTexture2D(GL_DEPTH_COMPONENT32F, kPictureWidth, kPictureHeight, GL_DEPTH_COMPONENT, GL_FLOAT);
    const auto framebuffer = RELIEF_TRY(makeFramebuffer(std::array<GLuint, 1>{color.name()}, depth.name()));
    const RenderTarget target{framebuffer.name(), kPictureWidth, kPictureHeight};
    Camera camera;
    camera.target = collider.bounds.center();
    camera.eye = defaultEye(camera.target, 0.5F * glm::length(collider.bounds.size()), camera.fov);
    setClipPlanes(camera, collider.bounds);
    // As relief-sim draws unless told otherwise, but nobody fades: they live too short.
    ParticleStyle style{.diameter = 0.0065F * scene.side, .fade_in = 0.0F, .fade_out = 0.0F};

    Result<void> drawn;
    const auto frame = [&](Sprite sprite) {
        system.step();
        glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        style.sprite = sprite;
        if (auto done = renderer.draw(*system.particles, camera, style, target); !done) {
            drawn = done;
        }
    };
    Times step;
    Times points;
    Times quads;
    const auto block = [&](Times& times, const std::function<void()>& work) {
        system.begin(scene);
        times.measure(sizes.frame_steps, work);
        system.end();
    };
    for (int round = -1; round < sizes.frame_rounds; ++round) {
        if (round == 0) {  // the one before was for the driver, which compiles
            step = points = quads = {};
        }
        block(step, [&] { system.step(); });
        block(points, [&] { frame(Sprite::kPoint); });
        block(quads, [&] { frame(Sprite::kQuad); });
    }
    if (!drawn) {
        return drawn;
    }
    json["frames"].push_back({{"particles", particles},
                              {"picture", {kPictureWidth, kPictureHeight}},
                              {"step_ms", median(step.all)},
                              {"points_ms", median(points.all)},  // the step included
                              {"quads_ms", median(quads.all)}});
    return {};
}

struct Options {
    std::string collider;
    bool large = false;
    StepPath path = StepPath::kFragment;
    std::uint32_t particles = 0;  ///< of the step, and no frames; 0: as sizesFor() has it
    int blocks = 0;               ///< of each variant; 0: as sizesFor() has it
    bool sorted = false;          ///< particles by their places
    std::string only;             ///< the variant to compare with the collider and with none; empty: all
};

Result<Options> parse(int argc, char** argv) {
    Options options;
    bool known = argc >= 2;
    for (int i = 1; i < argc && known; ++i) {
        const std::string_view word = argv[i];
        const std::string_view value = i + 1 < argc ? argv[i + 1] : "";
        if (word == "--large") {
            options.large = true;
        } else if (word == "--sorted") {
            options.sorted = true;
        } else if (word == "--path" && (value == "fragment" || value == "compute")) {
            options.path = value == "compute" ? StepPath::kCompute : StepPath::kFragment;
            ++i;
        } else if (const auto count = parseUnsigned(value); word == "--particles" && count &&
                                                            *count % 1024 == 0 && *count > 0 &&
                                                            *count <= ParticleSystem::kCapacityMax) {
            options.particles = static_cast<std::uint32_t>(*count);
            ++i;
        } else if (const auto blocks = parseUnsigned(value);
                   word == "--blocks" && blocks && *blocks > 0 && *blocks <= 1000) {
            options.blocks = static_cast<int>(*blocks);
            ++i;
        } else if (word == "--only" && !value.empty()) {
            options.only = value;
            ++i;
        } else {
            known = options.collider.empty() && !word.starts_with("--");
            options.collider = word;
        }
    }
    if (!known || options.collider.empty()) {
        return fail(ErrorCode::kUsage,
                    "usage: relief-bench-step COLLIDER.relief [--large] [--path fragment|compute] "
                    "[--particles N, of 1024] [--only NAME] [--blocks N] [--sorted]");
    }
    return options;
}

Result<Json> bench(int argc, char** argv) {
    const Options options = RELIEF_TRY(parse(argc, argv));
    const auto collider = RELIEF_TRY(loadCollider(options.collider));
    const auto context = RELIEF_TRY(GlContext::create(GlApi::kGl33Core));
    Sizes sizes = sizesFor(context->software(), options.large);
    if (options.particles != 0) {
        sizes.particles = options.particles;
        sizes.rounds = options.particles > (1U << 20) ? 3 : sizes.rounds;  // births take the processor long
        sizes.frames.clear();
    }
    sizes.rounds = options.blocks != 0 ? options.blocks : sizes.rounds;
    Json json;
    json["device"] = context->description();
    json["renderer"] = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    json["software"] = sizes.software;
    json["ratios_of"] = sizes.software ? "CPU time" : "wall clock";
    json["path"] = options.path == StepPath::kCompute ? "compute" : "fragment";
    json["collider"] = {{"maps", collider.maps.size()}};
    json["sorted"] = options.sorted;
    BenchScene scene = makeBenchScene(collider, sizes.particles, options.sorted);
    scene.path = options.path;
    RELIEF_TRY(benchSteps(scene, sizes, options.only, json));
    for (const std::uint32_t particles : sizes.frames) {
        RELIEF_TRY(benchFrames(collider, particles, sizes, options.path, json));
    }
    if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
        return fail(ErrorCode::kFailure, "the GL reports error " + std::to_string(error));
    }
    return json;
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::finishBench("relief-bench-step", relief::bench(argc, argv));
}
