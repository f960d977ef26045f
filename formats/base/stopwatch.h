// SPDX-License-Identifier: Apache-2.0
// Measures durations for reports. No other output may depend on time.
#pragma once

#include <chrono>

namespace relief {

/// Starts on construction.
class Stopwatch {
  public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    [[nodiscard]] double ms() const { return 1000.0 * seconds(); }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Adds its own lifetime to a total.
class TimeAdder {
  public:
    /// \param total_ms  borrowed; must outlive this object.
    explicit TimeAdder(double& total_ms) : total_ms_(total_ms) {}
    TimeAdder(const TimeAdder&) = delete;
    TimeAdder& operator=(const TimeAdder&) = delete;
    ~TimeAdder() { total_ms_ += watch_.ms(); }

  private:
    double& total_ms_;
    Stopwatch watch_;
};

}  // namespace relief
