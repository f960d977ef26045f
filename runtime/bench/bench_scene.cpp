// SPDX-License-Identifier: Apache-2.0
#include "runtime/bench/bench_scene.h"
#include "runtime/air/particle_air.h"
#include "runtime/events/event_recorder.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <utility>

#include "runtime/air/air.h"
#include "runtime/particles/emitter.h"
#include "runtime/particles/random.h"

namespace relief {

namespace {

/// Returns four poses of half size in alternate corners of the box.
std::vector<Pose> fourPoses(const BenchScene& scene) {
    std::vector<Pose> poses;
    const glm::vec3 center = scene.collider.bounds.center();
    const glm::vec3 quarter = 0.25F * scene.collider.bounds.size();
    for (const glm::vec3& corner :
         {glm::vec3(1, 1, 1), glm::vec3(1, -1, -1), glm::vec3(-1, 1, -1), glm::vec3(-1, -1, 1)}) {
        poses.push_back(Pose{0.5F * center + corner * quarter, {1.0F, 0.0F, 0.0F, 0.0F}, 0.5F});
    }
    return poses;
}

std::vector<Pose> crowdPoses(const BenchScene& scene, const BenchVariant& variant) {
    const std::uint32_t bodies = variant.bodies;
    std::uint32_t across = 1;
    while (across * across * across < bodies) {
        ++across;
    }
    Pcg32 random(17);
    std::vector<Pose> poses;
    const Bounds& bounds = scene.collider.bounds;
    const glm::vec3 cell = bounds.size() / static_cast<float>(across);
    for (std::uint32_t i = 0; i < bodies; ++i) {
        const glm::uvec3 at(i % across, i / across % across, i / across / across);
        const glm::quat turn = glm::normalize(
            glm::quat(1.0F, random.signedUniform(), random.signedUniform(), random.signedUniform()));
        const float scale = variant.share / static_cast<float>(across);
        const glm::vec3 middle = bounds.min + cell * (glm::vec3(at) + 0.5F);
        poses.push_back({middle - scale * (turn * bounds.center()), turn, scale});
    }
    return poses;
}

Result<WorldTextures> makeTextures(const BenchScene& scene, const BenchVariant& variant) {
    if (variant.solids == Solids::kCollider) {
        return WorldTextures::create(scene.collider);
    }
    const bool crowd = variant.solids == Solids::kCrowd;
    const std::vector<Pose> poses = crowd ? crowdPoses(scene, variant) : fourPoses(scene);
    const std::vector<Collider> copies(crowd ? std::min(poses.size(), kCrowdColliders) : 1, scene.collider);
    std::vector<ColliderBody> bodies;
    for (const Pose& pose : poses) {
        bodies.push_back({&copies[bodies.size() % copies.size()], pose, 1.0F, 0.0F});
    }
    return WorldTextures::create(bodies);
}

Result<void> setSixteenTypes(ParticleSystem& particles, const BenchScene& /*scene*/) {
    std::vector<ParticleType> types(kParticleTypesMax, kBenchSnow);
    for (std::size_t i = 0; i < types.size(); ++i) {
        const float fraction = static_cast<float>(i) / static_cast<float>(types.size());
        types[i].mass = 1.0F + fraction;
        types[i].restitution = 0.1F * fraction;
    }
    return particles.setTypes(types);
}

Result<void> setRadius(ParticleSystem& particles, const BenchScene& scene) {
    ParticleType type = kBenchSnow;
    type.radius = 0.005F * scene.side;
    return particles.setType(type);
}

/// Adds a vortex flow on 32³ nodes.
void addFlow(AirSettings& air, const BenchScene& scene) {
    constexpr std::uint32_t kNodes = 32;
    FlowField flow;
    flow.size = {kNodes, kNodes, kNodes};
    flow.box_min = scene.collider.bounds.min;
    flow.box_max = scene.collider.bounds.max;
    for (std::uint32_t i = 0; i < kNodes * kNodes * kNodes; ++i) {
        const auto x = static_cast<float>(i % kNodes) / kNodes - 0.5F;
        const std::uint32_t layer = i / (kNodes * kNodes);
        const auto z = static_cast<float>(layer) / kNodes - 0.5F;
        flow.nodes.push_back(0.25F * scene.side * glm::vec3(-z, 0.0F, x));
    }
    air.flow = std::make_shared<const FlowField>(std::move(flow));
}

void addCurlNoise(AirSettings& air, const BenchScene& scene) {
    air.curl_noise = CurlNoise{.amplitude = 0.25F * scene.side,
                               .scale = 0.2F * scene.side,
                               .octaves = 2,
                               .drift = 0.1F * scene.side};
}

void addAttractors(AirSettings& air, const BenchScene& scene) {
    for (const Pose& pose : fourPoses(scene)) {
        air.attractors.push_back(
            {.position = pose.position, .strength = 0.5F * scene.side, .radius = 0.1F * scene.side});
    }
}

auto airWith(void (*add)(AirSettings&, const BenchScene&)) {
    return [add](ParticleSystem& particles, const BenchScene& scene) {
        AirSettings air;
        air.wind = scene.forces.wind;
        add(air, scene);
        return setAir(particles, air);
    };
}

Result<void> recordEvents(ParticleSystem& particles, const BenchScene& /*scene*/) {
    return setEvents(particles, EventOptions{.lasting = true, .deaths = true});
}

/// Turns bodies back and forth by 0.1° per step, so that the poses of all blocks differ by at most 1.6°.
std::function<void()> turning(WorldTextures* textures, std::vector<Pose> poses) {
    return [textures, poses = std::move(poses), step = 0]() mutable {
        const float degrees = 0.1F * static_cast<float>(++step / 16 % 2 == 0 ? step % 16 : 16 - step % 16);
        for (Pose& pose : poses) {
            pose.rotation = glm::angleAxis(glm::radians(degrees), glm::vec3(0.0F, 1.0F, 0.0F));
        }
        textures->setPoses(poses);
    };
}

}  // namespace

BenchScene makeBenchScene(Collider collider, std::uint32_t particles, float lifetime) {
    BenchScene scene;
    scene.collider = std::move(collider);
    const Bounds& bounds = scene.collider.bounds;
    const float side = scene.side = bounds.longestSide();
    scene.forces = {
        .gravity = {0.0F, -3.0F * side, 0.0F}, .wind = {0.125F * side, 0.0F, 0.05F * side}, .drag = 2.5F};
    EmitterSettings settings;
    settings.box_min = bounds.min;
    settings.box_max = bounds.max;
    settings.burst = particles;
    settings.velocity = {0.0F, -0.8F * side, 0.0F};
    settings.velocity_spread = glm::vec3(0.12F, 0.1F, 0.12F) * side;
    settings.lifetime_min = settings.lifetime_max = lifetime;
    Emitter emitter(settings, 1);
    emitter.emit(1.0, particles, scene.births);
    for (std::size_t i = 0; i < scene.births.size(); ++i) {
        scene.births[i].type = static_cast<std::uint32_t>(i % kParticleTypesMax);
    }
    return scene;
}

void BenchSystem::step() {
    if (before_step) {
        before_step();
    }
    particles->step(kBenchDt);
}

void BenchSystem::begin(const BenchScene& scene) {
    particles->spawn(scene.births);
    step();
}

Result<BenchSystem> makeBenchSystem(const BenchScene& scene, StepPath path, const BenchVariant& variant) {
    auto particles =
        RELIEF_TRY(ParticleSystem::create({.capacity = static_cast<std::uint32_t>(scene.births.size()),
                                           .integrator = variant.integrator,
                                           .path = path}));
    BenchSystem system;
    system.particles = std::make_unique<ParticleSystem>(std::move(particles));
    RELIEF_TRY(system.particles->setForces(scene.forces));
    RELIEF_TRY(system.particles->setType(kBenchSnow));
    if (variant.solids != Solids::kNone) {
        system.textures = std::make_unique<WorldTextures>(RELIEF_TRY(makeTextures(scene, variant)));
        RELIEF_TRY(system.particles->setCollider(system.textures.get()));
    }
    if (variant.set) {
        RELIEF_TRY(variant.set(*system.particles, scene));
    }
    if (variant.each_step == EachStep::kPoses) {
        std::vector<Pose> poses =
            variant.solids == Solids::kCrowd ? crowdPoses(scene, variant) : fourPoses(scene);
        poses.resize(std::min(poses.size(), kCrowdMoves));
        system.before_step = turning(system.textures.get(), std::move(poses));
    } else if (variant.each_step == EachStep::kEvents) {
        system.before_step = [particles = system.particles.get()] {
            requestEvents(*particles, 0);
            while (pollEvents(*particles)) {
            }
        };
    }
    return system;
}

std::vector<BenchVariant> benchVariants() {
    const auto sweep = [](ParticleSystem& particles, const BenchScene& scene) {
        return particles.setSweep(0.01F * scene.side);
    };
    const auto ground = [](ParticleSystem& particles, const BenchScene& scene) {
        return particles.setGround(scene.collider.bounds.min.y + 0.1F * scene.side);
    };
    std::vector<BenchVariant> variants = {
        {.name = "no_collider", .solids = Solids::kNone},
        {.name = "collider"},
        {.name = "types_16", .set = setSixteenTypes},
        {.name = "radius", .set = setRadius},
        {.name = "sweep", .set = sweep},
        {.name = "verlet", .integrator = Integrator::kVerlet},
        {.name = "four_bodies", .solids = Solids::kFourBodies},
        {.name = "four_bodies_turning", .solids = Solids::kFourBodies, .each_step = EachStep::kPoses},
        {.name = "ground", .set = ground},
        {.name = "flow", .set = airWith(addFlow)},
        {.name = "curl_noise", .set = airWith(addCurlNoise)},
        {.name = "attractors", .set = airWith(addAttractors)},
        {.name = "events", .set = recordEvents},
        {.name = "events_listed", .set = recordEvents, .each_step = EachStep::kEvents},
        {.name = "bodies_1000_moving",
         .solids = Solids::kCrowd,
         .each_step = EachStep::kPoses,
         .bodies = 1'000},
    };
    for (const std::uint32_t bodies : {1U, 10U, 100U, 1'000U, 10'000U, 65'536U}) {
        variants.push_back(
            {.name = "bodies_" + std::to_string(bodies), .solids = Solids::kCrowd, .bodies = bodies});
    }
    for (const std::uint32_t bodies : {1'000U, 10'000U}) {
        variants.push_back({.name = "village_" + std::to_string(bodies),
                            .solids = Solids::kCrowd,
                            .bodies = bodies,
                            .share = kVillageFill});
    }
    return variants;
}

}  // namespace relief
