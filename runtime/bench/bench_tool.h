// What the benchmark programs share: the middle of many measurements, a clock of the CPU, and the way out.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "formats/base/result.h"
#include "formats/base/stopwatch.h"

namespace relief {

using Json = nlohmann::ordered_json;

/// 0 of no values.
inline double median(std::vector<double> values) {
    if (values.empty()) {
        return 0.0;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// As Stopwatch, but it runs only while this thread or this process computes: others on the machine do not
/// count.
class CpuStopwatch {
  public:
    /// \param clock  CLOCK_THREAD_CPUTIME_ID or CLOCK_PROCESS_CPUTIME_ID.
    explicit CpuStopwatch(clockid_t clock) : clock_(clock), start_ms_(now()) {}
    [[nodiscard]] double ms() const { return now() - start_ms_; }

  private:
    [[nodiscard]] double now() const {
        timespec t{};
        clock_gettime(clock_, &t);
        return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
    }
    clockid_t clock_;
    double start_ms_;
};

/// Prints the measurements to stdout, or the error to stderr. \return the program's exit status.
inline int finishBench(const char* program, const Result<Json>& measured) {
    if (!measured) {
        std::fprintf(stderr, "%s: error: %s\n", program, measured.error().message.c_str());
        return static_cast<int>(measured.error().code);
    }
    std::puts(measured->dump(2).c_str());
    return 0;
}

}  // namespace relief
