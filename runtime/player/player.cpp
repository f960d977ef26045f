// SPDX-License-Identifier: Apache-2.0
#include "runtime/player/player.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "formats/base/stopwatch.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/player/outputs.h"
#include "runtime/player/simulation.h"
#include "runtime/player/watchdog.h"

namespace relief {
namespace {

// Steps between two calls of PlayerOptions::progress and between two waits for the GPU. Without waits, the driver would
// queue the whole run.
constexpr std::uint32_t kStepsAtOnce = 16;
// Longer stretches are halved, so that progress is updated and the watchdog does not expire.
constexpr double kStretchMsMax = 4000.0;

/// Returns the lower median; 0 if there are no values.
double median(std::vector<double> values) {
    if (values.empty()) {
        return 0.0;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Runs stretches of steps, with frames between them.
class Run {
  public:
    Run(const PlayerOptions& options, Simulation& simulation, Outputs& outputs, PlayerReport& report)
        : options_(options),
          scene_(report.scene),
          simulation_(simulation),
          outputs_(outputs),
          report_(report) {}

    Result<void> play() {
        if (outputs_.hasFrames() && frameDue(scene_, 0)) {
            RELIEF_TRY(afterStretch());
        }
        while (step_ < scene_.time.steps) {
            RELIEF_TRY(playStretch(stretchEnd()));
            RELIEF_TRY(afterStretch());
        }
        if (step_ > 0) {
            report_.ms_per_step = spent_ms_ / step_;
        }
        report_.ms_per_step_median = median(std::move(stretches_));
        report_.counts = simulation_.particles().counts();
        report_.counts.rejected += simulation_.rejected();
        if (outputs_.events() != nullptr) {
            RELIEF_TRY(watched(options_.watchdog, "the events", [&] { return simulation_.finishEvents(); }));
            report_.events_dropped = outputs_.events()->dropped();
            return outputs_.events()->finish();
        }
        return {};
    }

  private:
    /// Returns the last step of the next stretch, which does not pass the next frame.
    [[nodiscard]] std::uint32_t stretchEnd() const {
        std::uint32_t end = step_ + 1;
        const std::uint32_t last = std::min(scene_.time.steps, step_ + at_once_);
        while (end < last && !(outputs_.hasFrames() && frameDue(scene_, end))) {
            ++end;
        }
        return end;
    }

    /// Runs steps up to `end`, waits for the GPU, and measures the time.
    Result<void> playStretch(std::uint32_t end) {
        const std::uint32_t first = step_;
        const std::string steps = "steps " + std::to_string(first + 1) + " to " + std::to_string(end);
        const Stopwatch watch;
        RELIEF_TRY(watched(options_.watchdog, steps, [&] { return playSteps(end, steps); }));
        const double ms = watch.ms();
        if (ms > kStretchMsMax) {
            at_once_ = std::max(at_once_ / 2, 1U);
        }
        spent_ms_ += ms;
        stretches_.push_back(ms / (step_ - first));
        return {};
    }

    Result<void> playSteps(std::uint32_t end, const std::string& steps) {
        while (step_ < end) {
            RELIEF_TRY(simulation_.step());
            ++step_;
        }
        RELIEF_TRY(waitForGpu(steps));
        // A step returns no error if the GPU is out of memory, so check here.
        return checkAllocated(steps, "choose a smaller capacity");
    }

    /// Reports progress, and writes a frame if one is due.
    Result<void> afterStretch() {
        if (options_.progress) {
            options_.progress(step_, scene_.time.steps);
        }
        return frameDue(scene_, step_) && outputs_.hasFrames()
                   ? outputs_.writeFrame(simulation_.particles(), report_)
                   : Result<void>{};
    }

    const PlayerOptions& options_;
    const Scene& scene_;
    Simulation& simulation_;
    Outputs& outputs_;
    PlayerReport& report_;
    std::uint32_t step_ = 0;  // steps taken
    std::uint32_t at_once_ = kStepsAtOnce;
    double spent_ms_ = 0.0;
    std::vector<double> stretches_;  // ms per step
};

}  // namespace

Result<PlayerReport> play(const PlayerOptions& options) {
    FileGuard guard = options.guard;
    RELIEF_TRY(checkOutputs(options, guard));
    auto loaded = RELIEF_TRY(loadAll(options.input, options.overrides));
    RELIEF_TRY(checkFrames(options, loaded, guard));
    const auto context = RELIEF_TRY(watched(options.watchdog, "creating the GL context", [&] {
        return GlContext::create({options.gpu.api, options.gpu.device});
    }));
    if (options.watchdog != nullptr) {
        options.watchdog->setLimit(options.gpu.limit(context->software()));
    }
    auto simulation =
        RELIEF_TRY(Simulation::create(loaded, {.path = options.path, .watchdog = options.watchdog}));
    if (options.events.empty() && loaded.scene.time.steps > 0) {  // the list of hits changes the program
        RELIEF_TRY(
            watched(options.watchdog, "the shaders of particles", [&] { return simulation.startStep(); }));
    }
    Outputs outputs(options, loaded, simulation.textures());
    RELIEF_TRY(outputs.open(guard));
    if (EventsLog* events = outputs.events(); events != nullptr) {
        const std::span<const std::string> materials = simulation.textures().materialNames();
        RELIEF_TRY(simulation.listHits(
            options.events_min_speed.value_or(0.0F),
            [events, materials](const StepEvents& step) { return events->write(step, materials); }));
    }

    PlayerReport report;
    report.scene = loaded.scene;
    report.device = context->description();
    report.path = simulation.particles().path();
    report.collider_maps = static_cast<std::size_t>(simulation.textures().mapCount());
    report.collider_bytes = simulation.textures().bytes();
    RELIEF_TRY(Run(options, simulation, outputs, report).play());
    RELIEF_TRY(outputs.writeEnd(simulation.particles(), report));
    report.warnings = simulation.takeWarnings();
    const ParticleCounts& counts = report.counts;
    if (counts.rejected > counts.born) {
        report.warnings.push_back(
            std::to_string(counts.rejected) + " of " + std::to_string(counts.born + counts.rejected) +
            " births were rejected because the system was full; raise particles.capacity (now " +
            std::to_string(report.scene.particles.capacity) +
            "), or lower emitter.rate, emitter.burst or emitter.lifetime");
    }
    guard.keepFolders();
    return report;
}

void fields(FieldVisitor& visit, GpuOptions& options) {
    visit("device", options.device,
          {.help = "Index of the EGL device to use",
           .range = {0.0, 4294967295.0},
           .fallback = "EGL's choice",
           .value = "N",
           .must = "the index of a device; 'eglinfo -B' lists them"});
    visit("gpu_timeout", options.timeout,
          {.help = "Exit with code 4 if the GPU does not respond for this long; 0: never",
           .unit = "s",
           .range = {0.0, 1e6},
           .fallback = "60; 600 on a software renderer",
           .value = "SECONDS",
           .must = "a number of seconds from 0 (never) to 1000000"});
}

}  // namespace relief
