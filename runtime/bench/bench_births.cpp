// What a birth costs: relief-bench-births [BIRTHS_PER_STEP [CAPACITY…]] prints JSON. Nothing here is a test:
// machines are shared and noisy.
//
// Each capacity is run on each path that the context has, in its steady state: each step as many die as are born (at
// most a quarter of the capacity), which is what a long run pays, not what an empty system pays. `emit` samples;
// `spawn` takes indices and files the deaths; `free_and_upload` is what births and deaths add to the call of a step:
// indices given back, and the births handed to the driver; `draw` is what they add to a step until it is finished:
// the GPU's work, and the CPU's where that plays the GPU. All but `draw` is CPU time of the one thread. `bookkeeping`
// is indices and deaths alone, without GL.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "runtime/bench/bench_tool.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_context.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/particles/death_queue.h"
#include "runtime/particles/particle_system.h"

namespace relief {
namespace {

constexpr float kDt = 1.0F / 60.0F;

/// Times what this thread computes.
CpuStopwatch threadStopwatch() {
    return CpuStopwatch(CLOCK_THREAD_CPUTIME_ID);
}

/// A fountain has the most expensive shape and law of speed.
EmitterSettings fountain(double rate) {
    EmitterSettings settings;
    settings.shape = EmitterShape::kSphere;
    settings.radius = 1.0F;
    settings.rate = rate;
    settings.aim = EmitterAim{glm::vec3(0.0F, 1.0F, 0.0F), 20.0F, 3.0F, 3.0F, 0.5F};
    return settings;
}

/// Births per ms of sampling alone.
double emitRate(const EmitterSettings& settings, std::size_t births_per_step) {
    Emitter emitter(settings, 1);
    std::vector<Birth> births;
    std::vector<double> times;
    for (int step = 0; step < 60; ++step) {
        births.clear();
        const CpuStopwatch watch = threadStopwatch();
        emitter.emit(1.0 / 60.0, births_per_step, births);
        times.push_back(watch.ms());
    }
    return static_cast<double>(births_per_step) / median(times);
}

struct Cost {
    std::vector<double> emit, spawn, step, drawn;
};

/// Births per step that a capacity can sustain.
std::uint32_t steadyBirths(std::uint32_t capacity, std::uint32_t per_step) {
    return std::min(per_step, capacity / 4);
}

/// The mean life that keeps nine of ten places taken, seconds.
float steadyLife(std::uint32_t capacity, std::uint32_t per_step) {
    return 0.9F * static_cast<float>(capacity) / (60.0F * static_cast<float>(per_step));
}

/// Goes to the steady state: 32 steps that together last 1.5 lives.
void fill(ParticleSystem& particles, Emitter& emitter, float life) {
    std::vector<Birth> births;
    const double skip = 1.5 * static_cast<double>(life) / 32.0;
    for (int i = 0; i < 32; ++i) {
        births.clear();
        emitter.emit(skip, particles.room(), births);
        particles.spawn(births);
        particles.step(static_cast<float>(skip));
    }
    glFinish();
}

/// Times the call of a step, and the step until it is finished.
void timeStep(ParticleSystem& particles, float dt, Cost& cost) {
    const Stopwatch whole;
    const CpuStopwatch watch = threadStopwatch();
    particles.step(dt);
    cost.step.push_back(watch.ms());
    glFinish();
    cost.drawn.push_back(whole.ms());
}

Cost costWithBirths(ParticleSystem& particles, Emitter& emitter) {
    Cost cost;
    std::vector<Birth> births;
    for (int i = 0; i < 24; ++i) {
        births.clear();
        CpuStopwatch watch = threadStopwatch();
        emitter.emit(static_cast<double>(kDt), particles.room(), births);
        cost.emit.push_back(watch.ms());
        watch = threadStopwatch();
        particles.spawn(births);
        cost.spawn.push_back(watch.ms());
        timeStep(particles, kDt, cost);
    }
    return cost;
}

/// The same steps without births: the difference is the births' own.
Cost costWithout(ParticleSystem& particles) {
    Cost cost;
    for (int i = 0; i < 12; ++i) {
        timeStep(particles, 1e-6F, cost);
    }
    return cost;
}

Json benchCapacity(std::uint32_t capacity, std::uint32_t per_step, StepPath path) {
    per_step = steadyBirths(capacity, per_step);
    EmitterSettings settings = fountain(60.0 * per_step);
    // Spread so that indices come back in disorder.
    const float life = steadyLife(capacity, per_step);
    settings.lifetime_min = 0.5F * life;
    settings.lifetime_max = 1.5F * life;
    auto particles = ParticleSystem::create({.capacity = capacity, .path = path});
    if (!particles) {
        return {{"capacity", capacity}, {"error", particles.error().message}};
    }
    Emitter emitter(settings, 1);
    fill(*particles, emitter, life);
    const Cost cost = costWithBirths(*particles, emitter);
    const Cost without = costWithout(*particles);
    const double draw = median(cost.drawn) - median(without.drawn);
    Json json;
    json["capacity"] = capacity;
    json["path"] = path == StepPath::kCompute ? "compute" : "fragment";
    json["births_per_step"] = per_step;
    json["alive"] = particles->counts().alive;
    json["ms_per_step"] = {{"emit", median(cost.emit)},
                           {"spawn", median(cost.spawn)},
                           {"free_and_upload", median(cost.step) - median(without.step)},
                           {"draw", draw}};
    json["births_per_ms"] = {{"emit", per_step / median(cost.emit)},
                             {"spawn", per_step / median(cost.spawn)},
                             {"draw", per_step / std::max(draw, 1e-6)}};
    json["worst_ms"] = {{"emit", *std::max_element(cost.emit.begin(), cost.emit.end())},
                        {"spawn", *std::max_element(cost.spawn.begin(), cost.spawn.end())}};
    return json;
}

/// The bookkeeping of deaths alone, in its steady state: ns for a death pushed and popped.
Json benchDeaths(std::uint32_t capacity, std::uint32_t per_step) {
    per_step = steadyBirths(capacity, per_step);
    const float life = steadyLife(capacity, per_step);
    IndexAllocator allocator(capacity);
    DeathQueue queue(capacity);
    Pcg32 random(1);
    std::vector<std::uint32_t> dead;
    std::vector<double> push;
    std::vector<double> pop;
    const int warm_up = static_cast<int>(90.0F * life) + 1;
    for (int step = 0; step < warm_up + 60; ++step) {
        const float now = static_cast<float>(step) * kDt;
        CpuStopwatch watch = threadStopwatch();
        for (std::uint32_t i = 0; i < per_step; ++i) {
            if (const auto index = allocator.acquire(); index) {
                queue.push(now + random.between(0.5F * life, 1.5F * life), *index);
            }
        }
        const double pushed = watch.ms();
        watch = threadStopwatch();
        dead.clear();
        queue.popUntil(now + kDt, dead);
        for (const std::uint32_t index : dead) {
            allocator.release(index);
        }
        if (step >= warm_up) {
            push.push_back(pushed);
            pop.push_back(watch.ms());
        }
    }
    const double all = 1e6 / per_step;
    return {{"ns_per_birth", all * median(push)},
            {"ns_per_death", all * median(pop)},
            {"worst_ms_per_step", *std::max_element(pop.begin(), pop.end())}};
}

Result<Json> bench(int argc, char** argv) {
    const auto number = [&](int i) { return static_cast<std::uint32_t>(std::strtoul(argv[i], nullptr, 10)); };
    const std::uint32_t per_step = std::max(argc > 1 ? number(1) : 16667U, 1U);
    std::vector<std::uint32_t> capacities;
    for (int i = 2; i < argc; ++i) {
        capacities.push_back(std::max(number(i), 4U));
    }
    if (capacities.empty()) {
        capacities = {1U << 16, 1U << 18, 1U << 20, 1U << 22};
    }
    const auto context = RELIEF_TRY(GlContext::create(GlApi::kGl33Core));
    Json json;
    json["device"] = context->description();
    EmitterSettings box = fountain(60.0 * per_step);
    box.shape = EmitterShape::kBox;
    box.aim.reset();
    json["emit_births_per_ms"] = {{"box", emitRate(box, per_step)},
                                  {"fountain", emitRate(fountain(60.0 * per_step), per_step)}};
    for (const std::uint32_t capacity : capacities) {
        const Json bookkeeping = benchDeaths(capacity, per_step);
        for (const StepPath path : {StepPath::kFragment, StepPath::kCompute}) {
            if (path == StepPath::kCompute && !hasCompute()) {
                continue;
            }
            Json one = benchCapacity(capacity, per_step, path);
            one["bookkeeping"] = bookkeeping;
            json["capacities"].push_back(std::move(one));
        }
    }
    return json;
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::finishBench("relief-bench-births", relief::bench(argc, argv));
}
