// SPDX-License-Identifier: Apache-2.0
#include "runtime/bench/bench.h"

#include <time.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "formats/base/stopwatch.h"
#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

constexpr double kBlockMs = 10.0;

/// Returns the CPU time of all threads in milliseconds.
double cpuMs() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// Milliseconds per call; one value per block.
struct Times {
    std::vector<double> wall;
    std::vector<double> cpu;
    std::vector<double> gpu;
};

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Result<double> timeBlock(const Work& work, int calls, Times& times) {
    GLuint query = 0;
    glGenQueries(1, &query);
    glFinish();
    const double cpu_before = cpuMs();
    const Stopwatch watch;
    glBeginQuery(GL_TIME_ELAPSED, query);
    for (int i = 0; i < calls; ++i) {
        RELIEF_TRY(work.run());
        glFlush();
    }
    glEndQuery(GL_TIME_ELAPSED);
    glFinish();
    const double all = watch.ms();
    times.wall.push_back(all / calls);
    times.cpu.push_back((cpuMs() - cpu_before) / calls);
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
    glDeleteQueries(1, &query);
    times.gpu.push_back(1e-6 * static_cast<double>(nanoseconds) / calls);
    return all;
}

Result<int> callsPerBlock(const Work& work) {
    Times ignored;
    int calls = 1;
    while (RELIEF_TRY(timeBlock(work, calls, ignored)) < kBlockMs) {
        calls *= 2;
    }
    return calls;
}

Json ratioOf(const std::string& of, const std::vector<double>& above, const std::vector<double>& below) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(above.size(), below.size()); ++i) {
        ratios.push_back(above[i] / below[i]);
    }
    if (ratios.empty()) {
        return nullptr;
    }
    const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
    return {{"median", median(ratios)}, {"least", *least}, {"most", *most}, {"of", of}};
}

}  // namespace

void warmUp(const Bench& bench, double ms, const std::function<void()>& run) {
    const Stopwatch watch;
    while (!bench.software && watch.ms() < ms) {
        run();
        glFinish();
    }
}

Result<Json> timeAlternating(const Bench& bench, const std::vector<Work>& works, const Blocks& blocks) {
    std::vector<Times> times(works.size());
    std::vector<int> calls;
    for (const Work& work : works) {
        RELIEF_TRY(work.run());
        glFinish();
        calls.push_back(blocks.calls != 0 ? blocks.calls : RELIEF_TRY(callsPerBlock(work)));
    }
    for (int round = 0; round < (bench.rounds != 0 ? bench.rounds : blocks.rounds); ++round) {
        for (std::size_t i = 0; i < works.size(); ++i) {
            if (works[i].before) {
                works[i].before();
            }
            RELIEF_TRY(timeBlock(works[i], calls[i], times[i]));
            if (works[i].after) {
                works[i].after();
            }
        }
    }
    const auto compared = [&](const Times& of) -> const std::vector<double>& {
        return bench.software ? of.cpu : of.wall;
    };
    Json rows = Json::array();
    for (std::size_t i = 0; i < works.size(); ++i) {
        rows.push_back({{"name", works[i].name},
                        {"ms", median(times[i].wall)},
                        {"cpu_ms", median(times[i].cpu)},
                        {"gpu_ms", bench.software ? Json() : Json(median(times[i].gpu))}});
        for (std::size_t k = 0; k < works.size(); ++k) {
            if (works[k].name == works[i].over) {
                rows.back()["over"] = ratioOf(works[k].name, compared(times[i]), compared(times[k]));
            }
        }
    }
    if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
        return fail(ErrorCode::kFailure, "OpenGL reports error " + std::to_string(error));
    }
    return rows;
}

}  // namespace relief
