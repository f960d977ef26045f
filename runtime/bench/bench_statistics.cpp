// relief-bench-statistics [PARTICLES…]: how long the sums over all particles take on the GPU of this machine, on each path
// that the context has. Prints JSON, ms of a sample that is asked for and waited for behind others.
#include <cstdlib>
#include <vector>

#include "runtime/bench/gpu_time.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_context.h"
#include "runtime/particles/statistics.h"

namespace relief {
namespace {

Result<ParticleSystem> flyingParticles(std::uint32_t count) {
    auto particles = RELIEF_TRY(ParticleSystem::create({.capacity = count}));
    Pcg32 random(1);
    std::vector<Birth> births(count, {glm::vec3(0.0F), glm::vec3(0.0F), 1e6F, 0});
    for (Birth& birth : births) {
        birth.velocity = {random.uniform(), random.uniform(), random.uniform()};
    }
    particles.spawn(births);
    particles.step(0.01F);
    return particles;
}

Result<double> sampleMs(const ParticleSystem& particles, StepPath path) {
    auto statistics = RELIEF_TRY(Statistics::create(particles.capacity(), path));
    bool failed = false;
    const double ms = medianGpuMs([&] {
        if (statistics.inFlight() == Statistics::kInFlightMax) {
            failed = failed || !statistics.wait();
        }
        failed = failed || !statistics.request(particles, 0);
    });
    if (failed) {
        return fail(ErrorCode::kFailure, "the GPU's statistics cannot be read");
    }
    return ms;
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
        const ParticleSystem particles = RELIEF_TRY(flyingParticles(count));
        Json one{{"particles", count}};
        one["fragment_ms"] = RELIEF_TRY(sampleMs(particles, StepPath::kFragment));
        if (hasCompute()) {
            one["compute_ms"] = RELIEF_TRY(sampleMs(particles, StepPath::kCompute));
        }
        json["statistics"].push_back(std::move(one));
    }
    return json;
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::finishBench("relief-bench-statistics", relief::bench(argc, argv));
}
