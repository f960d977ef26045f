// SPDX-License-Identifier: Apache-2.0
// Benchmark: frame times of a flight over a streamed world, to find slow frames.
#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "formats/base/stopwatch.h"
#include "runtime/bench/bench.h"
#include "runtime/bench/bench_scene.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/particles/random.h"
#include "runtime/stream/world_stream.h"

namespace relief {
namespace {

constexpr std::chrono::microseconds kPace(16'667);
/// Radius of full detail around the camera, as a fraction of the world's longest side.
constexpr float kRadius = 0.05F;
constexpr int kWarmFrames = 60;

/// Times of the frames of a flight, milliseconds.
struct Frames {
    std::vector<double> frame;   // wall clock, with a glFinish at the end
    std::vector<double> gpu;     // GPU time
    std::vector<double> update;  // wall clock of update()
};

Json summaryOf(std::vector<double> ms) {
    std::sort(ms.begin(), ms.end());
    const auto percentile = [&](std::size_t p) { return ms[(ms.size() - 1) * p / 100]; };
    const double median = percentile(50);
    return {{"median", median},
            {"p99", percentile(99)},
            {"worst", ms.back()},
            {"worst_over_median", ms.back() / median}};
}

Result<void> fly(WorldStream& world, ParticleSystem& particles, const Bounds& box, int frames, bool moves,
                 Frames& times) {
    GLuint query = 0;
    glGenQueries(1, &query);
    auto next = std::chrono::steady_clock::now();
    for (int i = -kWarmFrames; i < frames; ++i) {
        std::this_thread::sleep_until(next += kPace);
        const float way = moves ? static_cast<float>(std::max(i, 0)) / static_cast<float>(frames) : 0.5F;
        const glm::vec3 at = box.min + glm::vec3(0.05F + 0.9F * way, 1.0F, 0.1F + 0.8F * way) * box.size();
        const PointOfInterest point{at, kRadius * box.longestSide()};
        const Stopwatch frame;
        glBeginQuery(GL_TIME_ELAPSED, query);
        RELIEF_TRY(world.update({&point, 1}));
        const double update = frame.ms();
        RELIEF_TRY(particles.step(kBenchDt));
        glEndQuery(GL_TIME_ELAPSED);
        glFinish();
        if (i >= 0) {
            times.frame.push_back(frame.ms());
            times.update.push_back(update);
            GLuint64 nanoseconds = 0;
            glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
            times.gpu.push_back(1e-6 * static_cast<double>(nanoseconds));
        }
    }
    glDeleteQueries(1, &query);
    return {};
}

/// Returns births distributed over the world, with unlimited lifetime.
std::vector<Birth> rainOn(const Bounds& box, std::uint32_t count) {
    Pcg32 random(1);
    std::vector<Birth> births;
    births.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const float x = random.between(box.min.x, box.max.x);
        const float z = random.between(box.min.z, box.max.z);
        births.push_back(
            {{x, random.between(0.5F * (box.min.y + box.max.y), box.max.y), z}, {}, kBenchForever});
    }
    return births;
}

}  // namespace

Result<Json> benchStream(const Bench& bench) {
    const World named = RELIEF_TRY(loadWorldFile(bench.file));
    const Bounds box = worldBounds(named);
    const std::uint32_t count = bench.particlesOr(1U << 20, 1U << 14);
    const int frames = bench.software ? 120 : 2000;
    Json rows = Json::array();
    for (int round = 0; round < (bench.rounds != 0 ? bench.rounds : 1); ++round) {
        for (const bool moves : {false, true}) {
            auto world = RELIEF_TRY(WorldStream::open(bench.file, {.gpu_bytes = bench.stream_bytes}));
            auto particles = RELIEF_TRY(ParticleSystem::create({.capacity = count, .path = bench.path}));
            RELIEF_TRY(particles.setCollider(&world->textures()));
            RELIEF_TRY(particles.setForces({.gravity = {0.0F, -9.81F, 0.0F}, .drag = 0.5F}));
            particles.spawn(rainOn(box, count));
            Frames times;
            RELIEF_TRY(fly(*world, particles, box, frames, moves, times));
            const StreamCounts counts = world->counts();
            rows.push_back({{"name", moves ? "flight" : "hover"},
                            {"frames", frames},
                            {"uploaded_bytes", counts.uploaded},
                            {"gpu_bytes", counts.gpu_bytes},
                            {"missing_at_the_end", counts.wanted - counts.present},
                            {"warnings", world->takeWarnings()},
                            {"frame_ms", summaryOf(times.frame)},
                            {"gpu_ms", bench.software ? Json() : summaryOf(times.gpu)},
                            {"update_ms", summaryOf(times.update)}});
        }
    }
    return Json{{{"particles", count}, {"colliders", named.colliders.size()}, {"rows", std::move(rows)}}};
}

}  // namespace relief
