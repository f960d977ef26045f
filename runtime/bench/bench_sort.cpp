// relief-bench-sort: how many passes of the depth sort the GPU of this machine makes in a millisecond. Prints
// JSON: for each number of particles the median over whole sequences, each from glFinish to glFinish.
#include <functional>
#include <vector>

#include "runtime/bench/bench_tool.h"
#include "runtime/gl/gl_context.h"
#include "runtime/particles/emitter.h"
#include "runtime/picture/depth_sort.h"

namespace relief {
namespace {

constexpr int kRepeatsLeast = 3;
constexpr int kRepeatsMost = 50;
constexpr double kSeconds = 1.0;  // repeats go on for so long
constexpr std::uint32_t kFrames = 30;
constexpr glm::vec3 kEye{0.5F, 0.5F, 3.0F};

double medianMilliseconds(const std::function<void()>& work) {
    work();  // the driver compiles
    glFinish();
    std::vector<double> all;
    double sum = 0.0;
    while (static_cast<int>(all.size()) < kRepeatsLeast ||
           (sum < 1000.0 * kSeconds && static_cast<int>(all.size()) < kRepeatsMost)) {
        const Stopwatch watch;
        work();
        glFinish();
        all.push_back(watch.ms());
        sum += all.back();
    }
    return median(all);
}

GlTexture randomPositions(std::uint32_t count) {
    Pcg32 random(1);
    std::vector<float> texels(std::size_t{4} * count);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        texels[i] = i % 4 == 3 ? 0.0F : random.uniform();
    }
    const auto width = static_cast<GLsizei>(DepthSorter::kWidth);
    return makeTexture2D(GL_RGBA32F, width, static_cast<GLsizei>(count) / width, GL_RGBA, GL_FLOAT,
                         texels.data());
}

Result<Json> bench() {
    const auto context = RELIEF_TRY(GlContext::create());
    Json json;
    json["device"] = context->description();
    for (const std::uint32_t count : {1U << 16, 1U << 18, 1U << 20}) {
        auto sorter = RELIEF_TRY(DepthSorter::create(count));
        const GlTexture positions = randomPositions(count);
        const auto time = [&](std::uint32_t passes) {
            return medianMilliseconds(
                [&] { sorter.update(positions, DepthSorter::kWidth, count, kEye, passes); });
        };
        const std::uint32_t passes = DepthSorter::sequencePasses(count);
        const double sequence_ms = time(passes);
        const double keys_ms = time(0);  // of a sorted order, which gathers positions from everywhere
        const double frame_ms = time(DepthSorter::passesPerFrame(count, kFrames));
        json["sorts"].push_back({{"particles", count},
                                 {"passes", passes},
                                 {"keys_ms", keys_ms},          // the update's fixed part
                                 {"sequence_ms", sequence_ms},  // keys included
                                 {"passes_per_ms", passes / (sequence_ms - keys_ms)},
                                 {"frame_ms_over_30", frame_ms}});
    }
    return json;
}

}  // namespace
}  // namespace relief

int main() {
    return relief::finishBench("relief-bench-sort", relief::bench());
}
