// How long calls keep the GPU busy, by the clock.
#pragma once

#include <functional>
#include <vector>

#include "runtime/bench/bench_tool.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"

namespace relief {

/// Milliseconds of a call: the median over blocks of calls of at least 10 ms, each from glFinish to glFinish, so that
/// neither waiting for the GPU nor waking it tells. Goes on for a second, but for at least 3 blocks.
inline double medianGpuMs(const std::function<void()>& work) {
    constexpr double kBlockMs = 10.0;
    constexpr std::size_t kRepeatsLeast = 3;
    constexpr std::size_t kRepeatsMost = 50;
    constexpr double kWholeMs = 1000.0;
    const auto block = [&](int calls) {
        const Stopwatch watch;
        for (int i = 0; i < calls; ++i) {
            work();
        }
        glFinish();
        return watch.ms();
    };
    block(1);  // the driver compiles
    int calls = 1;
    while (block(calls) < kBlockMs) {
        calls *= 2;
    }
    std::vector<double> all;
    double sum = 0.0;
    while (all.size() < kRepeatsLeast || (sum < kWholeMs && all.size() < kRepeatsMost)) {
        const double ms = block(calls);
        all.push_back(ms / calls);
        sum += ms;
    }
    return median(all);
}

}  // namespace relief
