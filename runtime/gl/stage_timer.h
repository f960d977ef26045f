// The begin and end of stages of the simulation, for timers.
#pragma once

#include <array>
#include <cstddef>

namespace relief {

enum class Stage { kBirths, kStep, kSort, kDraw, kStatistics };
inline constexpr std::size_t kStageCount = 5;
/// As reports call them.
inline constexpr std::array<const char*, kStageCount> kStageNames{"births", "step", "sort", "draw",
                                                                  "statistics"};

/// Stages follow each other: none begins before the last has ended.
class StageTimer {
  public:
    virtual ~StageTimer() = default;
    virtual void begin(Stage stage) = 0;
    virtual void end() = 0;
};

/// A stage from here to the end of the block; nothing without a timer.
class StageScope {
  public:
    StageScope(StageTimer* timer, Stage stage) : timer_(timer) {
        if (timer_ != nullptr) {
            timer_->begin(stage);
        }
    }
    ~StageScope() {
        if (timer_ != nullptr) {
            timer_->end();
        }
    }
    StageScope(const StageScope&) = delete;
    StageScope& operator=(const StageScope&) = delete;

  private:
    StageTimer* timer_;
};

}  // namespace relief
