#include "runtime/bench/bench_scene.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <utility>

#include "runtime/air/air.h"
#include "runtime/particles/emitter.h"

namespace relief {

namespace {

constexpr Collision kSnow{.restitution = 0.0F, .friction = 1.0F};

std::vector<Pose> posesOf(const BenchScene& scene, Solids solids) {
    if (solids == Solids::kOneBody) {
        return {Pose{}};
    }
    // Half as large, in every other corner of the box.
    std::vector<Pose> poses;
    const glm::vec3 center = scene.collider.bounds.center();
    const glm::vec3 quarter = 0.25F * scene.collider.bounds.size();
    for (const glm::vec3& corner :
         {glm::vec3(1, 1, 1), glm::vec3(1, -1, -1), glm::vec3(-1, 1, -1), glm::vec3(-1, -1, 1)}) {
        poses.push_back(Pose{0.5F * center + corner * quarter, {1.0F, 0.0F, 0.0F, 0.0F}, 0.5F});
    }
    return poses;
}

Result<ColliderTextures> makeTextures(const BenchScene& scene, Solids solids) {
    if (solids == Solids::kCollider) {
        return ColliderTextures::create(scene.collider);
    }
    std::vector<ColliderBody> bodies;
    for (const Pose& pose : posesOf(scene, solids)) {
        bodies.push_back({&scene.collider, pose, 1.0F, 0.0F});
    }
    return ColliderTextures::create(bodies);
}

ParticleType snowType() {
    ParticleType type;
    type.restitution = kSnow.restitution;
    type.friction = kSnow.friction;
    return type;
}

Result<void> setSixteenTypes(ParticleSystem& particles, const BenchScene& /*scene*/) {
    std::vector<ParticleType> types(kParticleTypesMax, snowType());
    for (std::size_t i = 0; i < types.size(); ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(types.size());
        types[i].mass = 1.0F + share;
        types[i].restitution = 0.1F * share;
    }
    return particles.setTypes(types);
}

Result<void> setRadius(ParticleSystem& particles, const BenchScene& scene) {
    ParticleType type = snowType();
    type.radius = 0.005F * scene.side;
    return particles.setTypes({&type, 1});
}

Result<void> setGround(ParticleSystem& particles, const BenchScene& scene) {
    return particles.setGround(scene.collider.bounds.min.y + 0.1F * scene.side);
}

BenchFeature sweepOf(float share) {
    return [share](ParticleSystem& particles, const BenchScene& scene) {
        return particles.setSweep(share * scene.side);
    };
}

/// A swirl on 32³ nodes.
AirSettings flowAir(const BenchScene& scene) {
    constexpr std::uint32_t kNodes = 32;
    FlowField flow;
    flow.size = {kNodes, kNodes, kNodes};
    flow.box_min = scene.collider.bounds.min;
    flow.box_max = scene.collider.bounds.max;
    for (std::uint32_t i = 0; i < kNodes * kNodes * kNodes; ++i) {
        const auto x = static_cast<float>(i % kNodes) / kNodes - 0.5F;
        const auto z = static_cast<float>(i / (kNodes * kNodes)) / kNodes - 0.5F;
        flow.nodes.push_back(0.25F * scene.side * glm::vec3(-z, 0.0F, x));
    }
    AirSettings air;
    air.wind = scene.forces.wind;
    air.flow = std::make_shared<const FlowField>(std::move(flow));
    return air;
}

AirSettings curlAir(const BenchScene& scene) {
    AirSettings air;
    air.wind = scene.forces.wind;
    air.curl_noise = CurlNoise{.amplitude = 0.25F * scene.side,
                               .scale = 0.2F * scene.side,
                               .octaves = 2,
                               .drift = 0.1F * scene.side};
    return air;
}

AirSettings attractorAir(const BenchScene& scene) {
    AirSettings air;
    air.wind = scene.forces.wind;
    for (const Pose& pose : posesOf(scene, Solids::kFourBodies)) {
        air.attractors.push_back(
            {.position = pose.position, .strength = 0.5F * scene.side, .radius = 0.1F * scene.side});
    }
    return air;
}

BenchFeature airOf(AirSettings (*make)(const BenchScene&)) {
    return
        [make](ParticleSystem& particles, const BenchScene& scene) { return particles.setAir(make(scene)); };
}

Result<void> setEvents(ParticleSystem& particles, const BenchScene& /*scene*/) {
    return particles.setEvents(EventOptions{.lasting = true, .deaths = true});
}

/// A tenth of a degree further each step, to and fro, so that every block sees the same poses, all but a degree.
std::function<void()> turning(ColliderTextures* textures, std::vector<Pose> poses) {
    return [textures, poses = std::move(poses), step = 0]() mutable {
        const float degrees = 0.1F * static_cast<float>(++step / 16 % 2 == 0 ? step % 16 : 16 - step % 16);
        for (Pose& pose : poses) {
            pose.rotation = glm::angleAxis(glm::radians(degrees), glm::vec3(0.0F, 1.0F, 0.0F));
        }
        textures->setPoses(poses);
    };
}

/// A point's place on a Morton curve through the bounds.
std::uint32_t mortonCode(const glm::vec3& p, const Bounds& bounds) {
    constexpr std::uint32_t kBits = 10;
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float share = (p[axis] - bounds.min[axis]) / bounds.longestSide();
        const auto cell = static_cast<std::uint32_t>(std::clamp(share, 0.0F, 0.9999F) * float(1U << kBits));
        for (std::uint32_t bit = 0; bit < kBits; ++bit) {
            code |= (cell >> bit & 1U) << (3 * bit + static_cast<std::uint32_t>(axis));
        }
    }
    return code;
}

}  // namespace

BenchScene makeBenchScene(Collider collider, std::uint32_t particles, bool sorted) {
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
    settings.lifetime_min = settings.lifetime_max = kBenchLifetime;
    Emitter emitter(settings, 1);
    emitter.emit(1.0, particles, scene.births);
    if (sorted) {
        std::ranges::stable_sort(scene.births, {},
                                 [&](const Birth& birth) { return mortonCode(birth.position, bounds); });
    }
    for (std::size_t i = 0; i < scene.births.size(); ++i) {
        scene.births[i].type = static_cast<std::uint32_t>(i % kParticleTypesMax);
    }
    return scene;
}

void BenchScene::liveForever() {
    for (Birth& birth : births) {
        birth.lifetime = 1e6F;
    }
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

Result<BenchSystem> makeBenchSystem(const BenchScene& scene, const BenchVariant& variant) {
    auto particles =
        RELIEF_TRY(ParticleSystem::create({.capacity = static_cast<std::uint32_t>(scene.births.size()),
                                           .integrator = variant.integrator,
                                           .path = scene.path}));
    BenchSystem system;
    system.particles = std::make_unique<ParticleSystem>(std::move(particles));
    RELIEF_TRY(system.particles->setForces(scene.forces));
    RELIEF_TRY(system.particles->setCollision(kSnow));
    if (variant.solids != Solids::kNone) {
        system.textures = std::make_unique<ColliderTextures>(RELIEF_TRY(makeTextures(scene, variant.solids)));
        RELIEF_TRY(system.particles->setCollider(system.textures.get()));
    }
    if (variant.set) {
        RELIEF_TRY(variant.set(*system.particles, scene));
    }
    if (variant.each_step == EachStep::kPoses) {
        system.before_step = turning(system.textures.get(), posesOf(scene, variant.solids));
    } else if (variant.each_step == EachStep::kEvents) {
        system.before_step = [particles = system.particles.get()] {
            particles->requestEvents(0);
            while (particles->pollEvents()) {
            }
        };
    }
    return system;
}

std::vector<BenchVariant> benchVariants() {
    return {
        {.name = "no_collider", .what = "nothing solid at all", .solids = Solids::kNone},
        {.name = "collider", .what = "one type, no radius, no ground, Euler"},
        {.name = "types_16", .what = "16 types in turn", .set = setSixteenTypes},
        {.name = "radius", .what = "of half a percent of the longest side", .set = setRadius},
        {.name = "sweep", .what = "in pieces of 1 % of the longest side", .set = sweepOf(0.01F)},
        {.name = "sweep_fine", .what = "in pieces of 0.25 % of the longest side", .set = sweepOf(0.0025F)},
        {.name = "verlet", .what = "Verlet instead of Euler", .integrator = Integrator::kVerlet},
        {.name = "one_body", .what = "the collider as a body with a pose", .solids = Solids::kOneBody},
        {.name = "one_body_turning",
         .what = "the same with a new pose each step",
         .solids = Solids::kOneBody,
         .each_step = EachStep::kPoses},
        {.name = "four_bodies", .what = "four of half the size", .solids = Solids::kFourBodies},
        {.name = "four_bodies_turning",
         .what = "the same with new poses each step",
         .solids = Solids::kFourBodies,
         .each_step = EachStep::kPoses},
        {.name = "ground", .what = "a floor a tenth of the longest side up", .set = setGround},
        {.name = "flow", .what = "a flow field of 32 x 32 x 32 nodes", .set = airOf(flowAir)},
        {.name = "curl_noise", .what = "two octaves of curl noise", .set = airOf(curlAir)},
        {.name = "attractors", .what = "four attractors", .set = airOf(attractorAir)},
        {.name = "events", .what = "writing what happened to each particle", .set = setEvents},
        {.name = "events_listed",
         .what = "and lists of up to 65,536 events, which come to the CPU",
         .set = setEvents,
         .each_step = EachStep::kEvents},
    };
}

}  // namespace relief
