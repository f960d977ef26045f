// relief-bench-sort [PARTICLES…]: how long the depth sort takes on the GPU of this machine, on each path that the context
// has. Prints JSON: for each number of particles the median over blocks of calls, each from glFinish to glFinish.
#include <cstdlib>
#include <functional>
#include <memory>
#include <vector>

#include "runtime/bench/gpu_time.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_context.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/particles/emitter.h"
#include "runtime/picture/depth_sort.h"

namespace relief {
namespace {

constexpr std::uint32_t kFrames = 30;
constexpr glm::vec3 kEye{0.5F, 0.5F, 3.0F};

GlTexture randomPositions(std::uint32_t count) {
    Pcg32 random(1);
    const std::uint32_t rows = (count + DepthSorter::kWidth - 1) / DepthSorter::kWidth;
    std::vector<float> texels(std::size_t{4} * DepthSorter::kWidth * rows);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        texels[i] = i % 4 == 3 ? 0.0F : random.uniform();
    }
    return makeTexture2D(GL_RGBA32F, static_cast<GLsizei>(DepthSorter::kWidth), static_cast<GLsizei>(rows),
                         GL_RGBA, GL_FLOAT, texels.data());
}

/// \return ms of an update with so many passes.
Result<std::function<double(std::uint32_t)>> timer(std::uint32_t count, StepPath path,
                                                   const GlTexture& positions) {
    auto sorter = std::make_shared<DepthSorter>(RELIEF_TRY(DepthSorter::create(count, path)));
    return [sorter, count, &positions](std::uint32_t passes) {
        return medianGpuMs([&] { sorter->update(positions, DepthSorter::kWidth, count, kEye, passes); });
    };
}

Result<Json> benchCount(std::uint32_t count) {
    const GlTexture positions = randomPositions(count);
    const auto merge = RELIEF_TRY(timer(count, StepPath::kFragment, positions));
    const std::uint32_t passes = DepthSorter::sequencePasses(count);
    const double sequence_ms = merge(passes);
    const double keys_ms = merge(0);  // of a sorted order, which gathers positions from everywhere
    Json json{{"particles", count},
              {"passes", passes},
              {"keys_ms", keys_ms},          // the update's fixed part
              {"sequence_ms", sequence_ms},  // keys included
              {"passes_per_ms", passes / (sequence_ms - keys_ms)},
              {"frame_ms_over_30", merge(DepthSorter::passesPerFrame(count, kFrames))}};
    if (hasCompute()) {
        const auto radix = RELIEF_TRY(timer(count, StepPath::kCompute, positions));
        json["compute_ms"] = radix(1);  // whole, each time
    }
    return json;
}

Result<Json> bench(int argc, char** argv) {
    std::vector<std::uint32_t> counts;
    for (int i = 1; i < argc; ++i) {
        counts.push_back(static_cast<std::uint32_t>(std::strtoul(argv[i], nullptr, 10)));
    }
    if (counts.empty()) {
        counts = {1U << 16, 1U << 18, 1U << 20};
    }
    const auto context = RELIEF_TRY(GlContext::create());
    Json json;
    json["device"] = context->description();
    for (const std::uint32_t count : counts) {
        json["sorts"].push_back(RELIEF_TRY(benchCount(count)));
    }
    return json;
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::finishBench("relief-bench-sort", relief::bench(argc, argv));
}
