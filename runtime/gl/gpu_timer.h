// The duration of each stage: on the CPU by its clock, on the GPU by queries of elapsed time, of which a ring
// is kept so that nothing waits for a result.
#pragma once

#include <array>
#include <cstdint>

#include "formats/base/stopwatch.h"
#include "runtime/gl/gl_types.h"
#include "runtime/gl/stage_timer.h"

namespace relief {

/// Of one stage, since the beginning.
struct StageTime {
    std::uint64_t runs = 0;      ///< of the stage
    double cpu_ms = 0.0;         ///< all runs together: of the calls, not of their commands on the GPU
    std::uint64_t gpu_runs = 0;  ///< runs that the GPU has answered for so far
    double gpu_ms = 0.0;         ///< of those together
};
using StageTimes = std::array<StageTime, kStageCount>;

class GpuTimer : public StageTimer {
  public:
    /// Runs whose result may be outstanding; beyond it only the CPU's is taken.
    static constexpr int kQueries = 64;

    /// Needs a current context, as every call does. Without GL_TIME_ELAPSED (GL ES without
    /// EXT_disjoint_timer_query, or a GL whose counter has no bits) only the CPU's times are taken.
    GpuTimer();
    ~GpuTimer() override;
    GpuTimer(const GpuTimer&) = delete;
    GpuTimer& operator=(const GpuTimer&) = delete;

    /// True if the GPU's times are measured.
    [[nodiscard]] bool measuresGpu() const { return measures_gpu_; }

    /// A stage during which the caller has a query of elapsed time of its own open is timed on the CPU alone:
    /// the GL knows one at a time.
    void begin(Stage stage) override;
    void end() override;

    /// The results so far. Never waits: those of the GPU arrive some frames late.
    [[nodiscard]] const StageTimes& times();

  private:
    void collect();

    bool measures_gpu_ = false;
    bool gles_ = false;
    bool open_ = false;  // a query runs
    Stage stage_ = Stage::kBirths;
    Stopwatch stage_watch_;
    std::array<GLuint, kQueries> queries_{};
    std::array<Stage, kQueries> stages_{};
    int oldest_ = 0;
    int outstanding_ = 0;
    StageTimes times_{};
};

}  // namespace relief
