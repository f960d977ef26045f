// relief-bench-sort: how many passes of the depth sort the GPU of this machine makes in a millisecond. Prints
// JSON: for each number of particles the median over whole sequences, each from glFinish to glFinish.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "runtime/gl/gl_context.h"
#include "runtime/particles/emitter.h"
#include "runtime/picture/depth_sort.h"

namespace {

constexpr int kRepeatsLeast = 3;
constexpr int kRepeatsMost = 50;
constexpr double kSeconds = 1.0;  // repeats go on for so long
constexpr std::uint32_t kFrames = 30;
constexpr glm::vec3 kEye{0.5F, 0.5F, 3.0F};

double medianMilliseconds(const std::function<void()>& work) {
    using Clock = std::chrono::steady_clock;
    work();  // the driver compiles
    glFinish();
    std::vector<double> all;
    double sum = 0.0;
    while (static_cast<int>(all.size()) < kRepeatsLeast ||
           (sum < 1000.0 * kSeconds && static_cast<int>(all.size()) < kRepeatsMost)) {
        const auto start = Clock::now();
        work();
        glFinish();
        all.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
        sum += all.back();
    }
    std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
    return all[all.size() / 2];
}

relief::GlTexture randomPositions(std::uint32_t count) {
    relief::Pcg32 random(1);
    std::vector<float> texels(std::size_t{4} * count);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        texels[i] = i % 4 == 3 ? 0.0F : random.uniform();
    }
    const auto width = static_cast<GLsizei>(relief::DepthSorter::kWidth);
    return relief::makeTexture2D(GL_RGBA32F, width, static_cast<GLsizei>(count) / width, GL_RGBA, GL_FLOAT,
                                 texels.data());
}

int failure(const relief::Error& error) {
    std::fprintf(stderr, "relief-bench-sort: error: %s\n", error.message.c_str());
    return static_cast<int>(error.code);
}

}  // namespace

int main() {
    const auto context = relief::GlContext::create();
    if (!context) {
        return failure(context.error());
    }
    nlohmann::ordered_json json;
    json["device"] = (*context)->description();
    for (const std::uint32_t count : {1U << 16, 1U << 18, 1U << 20}) {
        auto sorter = relief::DepthSorter::create(count);
        if (!sorter) {
            return failure(sorter.error());
        }
        const relief::GlTexture positions = randomPositions(count);
        const auto time = [&](std::uint32_t passes) {
            return medianMilliseconds(
                [&] { sorter->update(positions, relief::DepthSorter::kWidth, count, kEye, passes); });
        };
        const std::uint32_t passes = relief::DepthSorter::sequencePasses(count);
        const double sequence_ms = time(passes);
        const double keys_ms = time(0);  // of a sorted order, which gathers positions from everywhere
        const double frame_ms = time(relief::DepthSorter::passesPerFrame(count, kFrames));
        json["sorts"].push_back({{"particles", count},
                                 {"passes", passes},
                                 {"keys_ms", keys_ms},          // the update's fixed part
                                 {"sequence_ms", sequence_ms},  // keys included
                                 {"passes_per_ms", passes / (sequence_ms - keys_ms)},
                                 {"frame_ms_over_30", frame_ms}});
    }
    std::printf("%s\n", json.dump(2).c_str());
    return 0;
}
