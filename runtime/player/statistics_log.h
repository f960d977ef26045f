// Statistics of a run as lines of JSON, written while it goes on.
#pragma once

#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>

#include "formats/base/result.h"
#include "runtime/gl/gpu_timer.h"
#include "runtime/particles/statistics.h"

namespace relief {

class StatisticsLog {
  public:
    /// \param path   "-" for standard output. Unlike other outputs it grows line by line, to be followed.
    /// \param steps  how the sums are made: the path of the steps.
    /// \param timer  of the stages; must outlive this.
    /// Errors: kIo, and those of Statistics::create.
    [[nodiscard]] static Result<StatisticsLog> create(const std::filesystem::path& path,
                                                      std::uint32_t capacity, StepPath steps,
                                                      GpuTimer& timer);

    /// A line about the particles after this step, once the GPU has summed them up. Waits only where the GPU
    /// lies Statistics::kInFlightMax lines behind.
    /// \param refused  births that found no room, on top of those of the particles' own counts.
    /// Errors: kIo, kFailure.
    [[nodiscard]] Result<void> request(const ParticleSystem& particles, std::uint64_t step,
                                       std::uint64_t refused);
    /// Writes what the GPU has finished. Errors: kIo.
    [[nodiscard]] Result<void> poll();
    /// Writes the rest, waiting for the GPU. Errors: kIo, kFailure.
    [[nodiscard]] Result<void> finish();

  private:
    struct Close {
        void operator()(std::FILE* file) const;
    };
    struct Entry {  // what the CPU knew when the sample was asked for
        std::uint64_t step = 0;
        double time = 0.0;
        ParticleCounts counts;
        StageTimes times;
    };

    StatisticsLog(Statistics statistics, GpuTimer& timer)
        : statistics_(std::move(statistics)), timer_(&timer) {}
    [[nodiscard]] Result<void> waitForOne();
    [[nodiscard]] Result<void> write(const StatisticsSample& sample);

    Statistics statistics_;
    GpuTimer* timer_;
    std::filesystem::path path_;
    std::unique_ptr<std::FILE, Close> file_;
    std::deque<Entry> entries_;  // the oldest first, as in statistics_
    StageTimes last_times_{};
};

}  // namespace relief
