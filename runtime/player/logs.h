// Logs of a run as lines of JSON, which grow while it goes on: statistics and hits.
#pragma once

#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>

#include "formats/base/result.h"
#include "formats/fields/field.h"
#include "runtime/gl/gpu_timer.h"
#include "runtime/particles/particle_event.h"
#include "runtime/particles/statistics.h"

namespace relief {

/// A file that grows line by line.
class LineLog {
  public:
    /// \param path    "-" for standard output
    /// \param option  that names another place, for messages
    /// Errors: kIo.
    [[nodiscard]] static Result<LineLog> create(const std::filesystem::path& path, std::string option);

    /// Errors: kIo.
    [[nodiscard]] Result<void> write(const std::string& line);
    /// Errors: kIo.
    [[nodiscard]] Result<void> flush();

  private:
    struct Close {
        void operator()(std::FILE* file) const;
    };
    [[nodiscard]] Result<void> writeError() const;

    std::filesystem::path path_;
    std::string option_;
    std::unique_ptr<std::FILE, Close> file_;
};

class EventsLog {
  public:
    /// \param path       as of LineLog
    /// \param min_speed  slower hits are left out
    /// Errors: kIo.
    [[nodiscard]] static Result<EventsLog> create(const std::filesystem::path& path, float min_speed);

    /// A line for each hit where the step before touched nothing. The tag is the number of the step.
    /// Errors: kIo.
    [[nodiscard]] Result<void> write(const StepEvents& step);
    /// Errors: kIo.
    [[nodiscard]] Result<void> finish() { return log_.flush(); }

    /// Hits beyond the capacity of a step's list.
    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

  private:
    LineLog log_;
    float min_speed_ = 0.0F;
    std::uint64_t dropped_ = 0;
};

class StatisticsLog {
  public:
    /// \param path   as of LineLog; flushed after each line, so that it can be followed
    /// \param steps  the path of the steps, which also computes the sums
    /// \param timer  of the stages; must outlive this
    /// Errors: kIo, and those of Statistics::create.
    [[nodiscard]] static Result<StatisticsLog> create(const std::filesystem::path& path,
                                                      std::uint32_t capacity, GpuTimer& timer);

    /// A line about the particles after this step, once the GPU has summed them up. Waits only where the GPU
    /// lies Statistics::kInFlightMax lines behind.
    /// \param refused  births that found no room, on top of those of the particles' own counts
    /// Errors: kIo, kFailure.
    [[nodiscard]] Result<void> request(const ParticleSystem& particles, std::uint64_t step,
                                       std::uint64_t refused);
    /// Writes what the GPU has finished. Errors: kIo.
    [[nodiscard]] Result<void> poll();
    /// Writes the rest, waiting for the GPU. Errors: kIo, kFailure.
    [[nodiscard]] Result<void> finish();

  private:
    struct Entry {  // the CPU's part of a line
        std::uint64_t step = 0;
        double time = 0.0;
        ParticleCounts counts;
        StageTimes times;
    };

    StatisticsLog(LineLog log, Statistics statistics, GpuTimer& timer)
        : log_(std::move(log)), statistics_(std::move(statistics)), timer_(&timer) {}
    [[nodiscard]] Result<void> waitForOne();
    [[nodiscard]] Result<void> write(const StatisticsSample& sample);

    LineLog log_;
    Statistics statistics_;
    GpuTimer* timer_;
    std::deque<Entry> entries_;  // the oldest first, as in statistics_
    StageTimes last_times_{};
};

// --- The lines as fields.

/// The mean run of each stage between two readings.
struct StagesReport {
    StageTimes now{};
    StageTimes before{};
};

template <class Visitor, FieldsOf<StagesReport> R>
void fields(Visitor& visit, R& report) {
    constexpr std::array<std::string_view, kStageCount> kHelp = {
        "Births", "Motion and collision", "Sorting for drawing", "Pictures", "Sums over the particles"};
    for (std::size_t i = 0; i < kStageCount; ++i) {
        const StageTime& now = report.now[i];
        const StageTime& before = report.before[i];
        const auto mean = [](double ms, std::uint64_t runs) { return ms / static_cast<double>(runs); };
        const auto stage = [&](auto& visit_stage) {
            visit_stage("cpu", mean(now.cpu_ms - before.cpu_ms, now.runs - before.runs),
                        {"Mean CPU time of a run", "ms", kFromZero});
            visit_stage("gpu",
                        onlyIf(now.gpu_runs > before.gpu_runs,
                               mean(now.gpu_ms - before.gpu_ms, now.gpu_runs - before.gpu_runs)),
                        {"Mean GPU time of a run; null until the GPU has answered", "ms", kFromZero});
        };
        visit(kStageNames[i], groupIf(now.runs > before.runs, stage), {.help = kHelp[i], .left_out = true});
    }
}

struct StatisticsLine {
    const StatisticsSample& sample = kNone<StatisticsSample>;
    double time = 0.0;
    const ParticleCounts& counts = kNone<ParticleCounts>;
    StagesReport stages = {};
};

template <class Visitor, FieldsOf<StatisticsLine> L>
void fields(Visitor& visit, L& line) {
    const auto& [sample, time, counts, stages] = line;
    visit("step", sample.tag, {"Steps done"});
    visit("time", time, {"Time of the scene", "s", kFromZero});
    visit("alive", sample.alive, {"Live particles"});
    visit("born", counts.born, {"Particles born so far"});
    visit("died", counts.died, {"Particles that died so far"});
    visit("refused", counts.refused, {"Births so far that found no room"});
    visit("in_contact", sample.in_contact, {"Particles that touched something in the last step"});
    visit("caught", sample.caught, {"Particles that the last step found inside and moved out"});
    visit("collisions", sample.collisions, {"Steps in contact of all particles so far"});
    visit("energy", sample.energy,
          {"Kinetic energy per unit of mass: half the sum of squared speeds", {}, kFromZero});
    visit("max_speed", double{sample.max_speed}, {"Largest speed", "object units per second", kFromZero});
    visit("ms", stages, {"Times since the line before"});
}

struct HitLine {
    const ParticleEvent& hit = kNone<ParticleEvent>;
    std::uint64_t step = 1;
};

template <class Visitor, FieldsOf<HitLine> L>
void fields(Visitor& visit, L& line) {
    const auto& [hit, step] = line;
    visit("step", step, {"Number of the step, from 1", {}, kFromOne});
    visit("time", hit.time, {"Time of the scene", "s", kFromZero});
    visit("id", hit.id, {"Particle, as in dumps"});
    visit("type", hit.type, {"Type of the particle, as in dumps"});
    visit("body", onlyIf(hit.body >= 0, hit.body),
          {"Collider of the scene, from 0; null: the ground", {}, kFromZero});
    visit("position", hit.position, {"Point where the particle touched the surface", "world units"});
    visit("normal", hit.normal, {"Normal of the surface, out of the body, of length 1"});
    visit("velocity", hit.velocity, {"Velocity of the particle before the hit", "world units per second"});
    visit(
        "speed", hit.speed,
        {"Speed of approach along the normal, relative to the surface", "world units per second", kFromZero});
}

}  // namespace relief
