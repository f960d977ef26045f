// Births, the depth sort, and the sums over all particles.
#include <memory>

#include "runtime/bench/bench.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/particles/emitter.h"
#include "runtime/particles/statistics.h"
#include "runtime/picture/depth_sort.h"

namespace relief {
namespace {

constexpr float kDt = 1.0F / 60.0F;
constexpr std::uint32_t kSortFrames = 30;
constexpr glm::vec3 kEye{0.5F, 0.5F, 3.0F};

std::vector<StepPath> paths() {
    return hasCompute() ? std::vector{StepPath::kFragment, StepPath::kCompute}
                        : std::vector{StepPath::kFragment};
}

std::string named(const char* work, StepPath path) {
    return std::string(work) + (path == StepPath::kCompute ? ", compute" : ", fragment");
}

/// A system and its emitter in their steady state: each step as many die as are born.
struct Fountain {
    ParticleSystem particles;
    Emitter emitter;
    std::vector<Birth> births = {};

    void emit(double dt) {
        births.clear();
        emitter.emit(dt, particles.room(), births);
    }
    Result<void> step(float dt) {
        particles.step(dt);
        return {};
    }
};

/// The most expensive shape and law of speed.
EmitterSettings fountainSettings(std::uint32_t births_per_step, float life) {
    EmitterSettings settings;
    settings.shape = EmitterShape::kSphere;
    settings.radius = 1.0F;
    settings.rate = 60.0 * births_per_step;
    settings.aim = EmitterAim{glm::vec3(0.0F, 1.0F, 0.0F), 20.0F, 3.0F, 3.0F, 0.5F};
    // Spread so that indices come back in disorder.
    settings.lifetime_min = 0.5F * life;
    settings.lifetime_max = 1.5F * life;
    return settings;
}

Result<std::shared_ptr<Fountain>> fountain(std::uint32_t capacity, std::uint32_t births_per_step,
                                           StepPath path) {
    // Nine of ten places are taken.
    const float life = 0.9F * static_cast<float>(capacity) / (60.0F * static_cast<float>(births_per_step));
    auto particles = RELIEF_TRY(ParticleSystem::create({.capacity = capacity, .path = path}));
    auto made = std::make_shared<Fountain>(
        Fountain{std::move(particles), Emitter(fountainSettings(births_per_step, life), 1)});
    // 32 steps that together last 1.5 lives.
    const float skip = 1.5F * life / 32.0F;
    for (int i = 0; i < 32; ++i) {
        made->emit(static_cast<double>(skip));
        made->particles.spawn(made->births);
        made->particles.step(skip);
    }
    return made;
}

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

}  // namespace

/// `emit` samples; `spawn` takes indices and files the deaths; `step` gives indices back, hands the births to the driver
/// and draws them, which `idle step` need not.
Result<Json> benchBirths(const Bench& bench) {
    Json tables = Json::array();
    for (const std::uint32_t capacity :
         bench.particlesOr(bench.large() ? std::vector{1U << 16, 1U << 18, 1U << 20, 1U << 22}
                                         : std::vector{1U << 16, 1U << 18})) {
        const std::uint32_t births = std::min(bench.options.births, capacity / 4);
        std::vector<Work> works;
        for (const StepPath path : paths()) {
            const auto made = RELIEF_TRY(fountain(capacity, births, path));
            works.push_back({named("emit", path), [made]() -> Result<void> {
                                 made->emit(static_cast<double>(kDt));
                                 return {};
                             }});
            works.push_back({named("spawn", path), [made]() -> Result<void> {
                                 made->particles.spawn(made->births);
                                 return {};
                             }});
            works.push_back(
                {named("step", path), [made] { return made->step(kDt); }, named("idle step", path)});
            works.push_back({named("idle step", path), [made] { return made->step(1e-6F); }});
        }
        // A call a block, for they are a sequence.
        tables.push_back({{"capacity", capacity},
                          {"births", births},
                          {"rows", RELIEF_TRY(timeInTurns(bench, works, {.rounds = 24, .calls = 1}))}});
    }
    return tables;
}

Result<Json> benchSort(const Bench& bench) {
    Json tables = Json::array();
    for (const std::uint32_t count : bench.particlesOr({1U << 16, 1U << 18, 1U << 20})) {
        const GlTexture positions = randomPositions(count);
        auto merge = RELIEF_TRY(DepthSorter::create(count, StepPath::kFragment));
        const auto update = [&](DepthSorter& sorter, std::uint32_t passes) -> Result<void> {
            sorter.update(positions, DepthSorter::kWidth, count, kEye, passes);
            return {};
        };
        const std::uint32_t passes = DepthSorter::sequencePasses(count);
        std::vector<Work> works{
            {"sequence", [&] { return update(merge, passes); }},
            // The update's fixed part, of a sorted order, which gathers positions from everywhere.
            {"keys", [&] { return update(merge, 0); }},
            {"frame of 30", [&] { return update(merge, DepthSorter::passesPerFrame(count, kSortFrames)); }}};
        std::optional<DepthSorter> radix;
        if (hasCompute()) {
            radix.emplace(RELIEF_TRY(DepthSorter::create(count, StepPath::kCompute)));
            works.push_back({"compute, whole", [&] { return update(*radix, 1); }});
        }
        tables.push_back(
            {{"particles", count}, {"passes", passes}, {"rows", RELIEF_TRY(timeInTurns(bench, works, {}))}});
    }
    return tables;
}

/// A sample that is requested and waited for behind others.
Result<Json> benchStatistics(const Bench& bench) {
    Json tables = Json::array();
    for (const std::uint32_t count : bench.particlesOr({1U << 16, 1U << 18, 1U << 20})) {
        const ParticleSystem particles = RELIEF_TRY(flyingParticles(count));
        const auto sums = std::make_shared<Statistics>(RELIEF_TRY(Statistics::create(count)));
        const std::vector<Work> works{{"sample", [sums, &particles]() -> Result<void> {
                                           const bool full = sums->inFlight() == Statistics::kInFlightMax;
                                           if ((full && !sums->wait()) || !sums->request(particles, 0)) {
                                               return fail(ErrorCode::kFailure,
                                                           "the GPU's statistics cannot be read");
                                           }
                                           return {};
                                       }}};
        tables.push_back({{"particles", count}, {"rows", RELIEF_TRY(timeInTurns(bench, works, {}))}});
    }
    return tables;
}

}  // namespace relief
