// The simulation on the GPU, in OpenGL 3.3 and in OpenGL ES 3.0: against a CPU step particle by particle,
// against closed forms, and for what must hold whatever the input.
#include "runtime/particles/particle_system.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "runtime/particles/emitter.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/particles/reference_step.h"
#include "tests/runtime/particles/step_gl_test.h"

namespace relief {
namespace {

using analytic::Vec;

constexpr float kDt = 1.0F / 60.0F;

/// A particle system among a collider, ready to step.
struct World {
    Collider collider;
    std::unique_ptr<ColliderTextures> textures;
    std::unique_ptr<ParticleSystem> particles;

    void make(const ParticleSystemOptions& options) {
        auto made = ParticleSystem::create(StepGlTest::onPath(options));
        ASSERT_TRUE(made) << made.error().message;
        particles = std::make_unique<ParticleSystem>(std::move(*made));
        if (collider.maps.empty()) {
            return;
        }
        auto uploaded = ColliderTextures::create(collider);
        ASSERT_TRUE(uploaded) << uploaded.error().message;
        textures = std::make_unique<ColliderTextures>(std::move(*uploaded));
        const auto set = particles->setCollider(textures.get());
        ASSERT_TRUE(set) << set.error().message;
    }

    [[nodiscard]] std::vector<ParticleState> state() const {
        auto read = particles->readState();
        EXPECT_TRUE(read) << read.error().message;
        return read.value_or(std::vector<ParticleState>{});
    }
};

Birth birthAt(const glm::vec3& position, const glm::vec3& velocity = glm::vec3(0.0F),
              float lifetime = 1000.0F) {
    return {position, velocity, lifetime, 0};
}

glm::vec3 randomIn(Pcg32& random, const glm::vec3& low, const glm::vec3& high) {
    glm::vec3 p;
    for (int i = 0; i < 3; ++i) {
        p[i] = random.between(low[i], high[i]);
    }
    return p;
}

/// Two bodies, seen by maps of every format and compare, a cube from inside one of them and one from free
/// space.
Collider mixedCollider() {
    const analytic::Shape shape = analytic::unite(
        {analytic::sphere({0.0, 0.1, 0.0}, 0.45), analytic::box({-0.9, -0.5, -0.3}, {-0.6, 0.2, 0.35})});
    Collider collider;
    collider.bounds = shape.bounds;
    using analytic::orthographicMap;
    collider.maps.push_back(
        orthographicMap(shape, MapFormat::kFrontBackHalf, Compare::kBoth, {1, false}, 96));
    collider.maps.push_back(orthographicMap(shape, MapFormat::kFixed8, Compare::kLess, {0, true}, 128));
    collider.maps.push_back(orthographicMap(shape, MapFormat::kFixed8, Compare::kGreater, {0, true}, 64));
    collider.maps.push_back(orthographicMap(shape, MapFormat::kFloat32, Compare::kLess, {2, false}, 100));
    collider.maps.push_back(orthographicMap(shape, MapFormat::kFloat32, Compare::kGreater, {2, false}, 100));
    collider.maps.push_back(
        orthographicMap(shape, MapFormat::kFrontBackFixed, Compare::kBoth, {2, true}, 80));
    collider.maps.back().decode = Decode::kPlane;
    collider.maps.push_back(
        analytic::cubeMap(shape, Compare::kGreater, {0.0, 0.1, 0.0}, {1.3, 1.2, 1.1}, 64));
    collider.maps.push_back(
        analytic::cubeMap(shape, Compare::kLess, {-0.53, 0.45, 0.0}, {0.5, 0.4, 0.5}, 64));
    return collider;
}

class ParticleSystemGlTest : public StepGlTest {};

// Every particle of every step is compared with the CPU's step from the GPU's own previous state, and every
// index with the CPU's own bookkeeping of births and deaths.
//
// Tolerance: a GPU may fuse multiply and add, and takes 2.5 ulp for a division and 2 for 1/sqrt (Vulkan's and
// GLSL's usual bounds; OpenGL gives none). A step chains about ten such operations on numbers below 4, so 16
// ulp of 4 bound it: 16 · 2^-22 < 4e-6. Where a decision hangs by a hair (reference_step.h) the two may
// differ; those particles are counted, and may be one in a thousand at most.
TEST_P(ParticleSystemGlTest, StepEqualsTheReferenceParticleByParticle) {
    constexpr float kTolerance = 4e-6F;
    constexpr std::uint32_t kCapacity = 5000;
    World world;
    world.collider = mixedCollider();
    world.make({.capacity = kCapacity, .epoch_seconds = 2.0});
    ASSERT_FALSE(HasFatalFailure());
    ReferenceSettings settings;
    settings.collider = &world.collider;
    settings.ground = -0.4F;  // cuts through the box: in both, the deeper one decides
    settings.forces = {{0.1F, -3.0F, 0.0F}, {0.4F, 0.0F, -0.3F}, 0.5F};
    settings.type.restitution = 0.45F;
    settings.type.friction = 0.3F;
    settings.type.friction_threshold = 0.6F;
    settings.dt = kDt;
    EXPECT_TRUE(world.particles->setForces(settings.forces));
    EXPECT_TRUE(world.particles->setCollision({0.45F, 0.3F, 0.6F}));
    EXPECT_TRUE(world.particles->setGround(settings.ground));

    struct Model {
        glm::vec3 position, velocity;
        std::uint32_t id;
    };
    std::map<std::uint32_t, Model> live;  // by index
    std::set<std::uint32_t> free;
    for (std::uint32_t i = 0; i < kCapacity; ++i) {
        free.insert(i);
    }
    Pcg32 random(11);
    std::uint32_t next_id = 0;
    std::uint64_t compared = 0;
    std::uint64_t excused = 0;
    std::uint64_t identical = 0;
    std::map<Contact, std::uint64_t> contacts;
    for (int step = 0; step < 300; ++step) {
        std::vector<Birth> births;
        for (int i = 0; i < 60; ++i) {
            // Some are born inside: they are caught from the start.
            const glm::vec3 low = i % 6 == 0 ? glm::vec3(-0.9F, -0.5F, -0.3F) : glm::vec3(-1.2F, 0.6F, -0.7F);
            const glm::vec3 high = i % 6 == 0 ? glm::vec3(0.4F, 0.4F, 0.3F) : glm::vec3(0.7F, 1.0F, 0.7F);
            births.push_back(birthAt(randomIn(random, low, high),
                                     randomIn(random, glm::vec3(-1.5F), glm::vec3(1.5F)),
                                     random.between(0.3F, 2.0F)));
        }
        const std::size_t accepted = world.particles->spawn(births).value();
        for (std::size_t i = 0; i < accepted; ++i) {
            const std::uint32_t index = *free.begin();
            free.erase(free.begin());
            live[index] = {births[i].position, births[i].velocity, next_id++};
        }
        world.particles->step(kDt);

        const std::vector<ParticleState> state = world.state();
        std::map<std::uint32_t, const ParticleState*> after;
        for (const ParticleState& particle : state) {
            after[particle.index] = &particle;
        }
        for (auto it = live.begin(); it != live.end();) {
            const auto found = after.find(it->first);
            if (found == after.end()) {  // died; when it may is the business of another test
                free.insert(it->first);
                it = live.erase(it);
                continue;
            }
            const ParticleState& gpu = *found->second;
            ASSERT_EQ(gpu.id, it->second.id) << "a birth landed on another texel";
            const ReferenceState cpu = referenceStep(settings, it->second.position, it->second.velocity);
            const float off =
                std::max(glm::length(gpu.position - cpu.position), glm::length(gpu.velocity - cpu.velocity));
            ++compared;
            ++contacts[gpu.contact];
            identical += gpu.position == cpu.position && gpu.velocity == cpu.velocity ? 1 : 0;
            if (!(off <= kTolerance) || gpu.contact != cpu.contact) {
                ++excused;
                ASSERT_TRUE(cpu.ambiguous)
                    << "step " << step << " index " << gpu.index << " off by " << off << " contact "
                    << static_cast<int>(gpu.contact) << " for " << static_cast<int>(cpu.contact) << " at "
                    << gpu.position.x << " " << gpu.position.y << " " << gpu.position.z;
            }
            it->second.position = gpu.position;
            it->second.velocity = gpu.velocity;
            ++it;
        }
        ASSERT_EQ(after.size(), live.size());
        ASSERT_EQ(world.particles->counts().alive, live.size());
        ASSERT_EQ(world.particles->counts().extent, live.empty() ? 0 : live.rbegin()->first + 1);
    }
    EXPECT_GT(compared, 500'000U);
    EXPECT_GT(contacts[Contact::kCollided], 20'000U);
    EXPECT_GT(contacts[Contact::kCaught], 5'000U);
    EXPECT_LT(static_cast<double>(excused), 1e-3 * static_cast<double>(compared));
    RecordProperty("compared", std::to_string(compared));
    RecordProperty("excused", std::to_string(excused));
    RecordProperty("identical", std::to_string(identical));
}

// Closed form of semi-implicit Euler under gravity g after n steps: v = v0 + n dt g, and
// P = P0 + n dt v0 + n(n+1)/2 dt² g. A bounce in step n turns v0 + (n−1) dt g into −ε times it.
TEST_P(ParticleSystemGlTest, BouncesOnAPlaneInClosedForm) {
    for (const bool by_floor : {true, false}) {
        World world;
        if (!by_floor) {
            // A slab whose top, y = 0, one float map sees from above.
            const analytic::Shape slab = analytic::box({-2.0, -1.0, -2.0}, {2.0, 0.0, 2.0});
            world.collider.bounds = slab.bounds;
            world.collider.maps.push_back(
                analytic::orthographicMap(slab, MapFormat::kFloat32, Compare::kLess, {1, false}, 64));
            // Seen from above alone: what lies beside is empty, and above is in front.
        }
        world.make({.capacity = 8});
        ASSERT_FALSE(HasFatalFailure());
        constexpr double kRestitution = 0.7;
        constexpr double kGravity = 4.0;
        EXPECT_TRUE(world.particles->setForces({{0.0F, -static_cast<float>(kGravity), 0.0F}, {}, 0.0F}));
        EXPECT_TRUE(world.particles->setCollision({static_cast<float>(kRestitution), 0.0F, 0.0F}));
        if (by_floor) {
            EXPECT_TRUE(world.particles->setGround(0.0F));
        }
        const glm::vec3 start(0.03F, 1.0F, 0.03F);
        const glm::vec3 push(0.05F, 0.5F, -0.04F);
        const std::array<Birth, 1> births{birthAt(start, push)};
        world.particles->spawn(births);

        // Where the last flight began.
        Vec p0(start);
        Vec v0(push);
        int n = 0;
        int bounces = 0;
        double highest = 0.0;
        double last_apex = 1.0 + 0.5 * 0.5 / (2.0 * kGravity);
        for (int step = 0; step < 500; ++step) {
            world.particles->step(kDt);
            const std::vector<ParticleState> state = world.state();
            ASSERT_EQ(state.size(), 1U);
            const Vec p(state[0].position);
            const Vec v(state[0].velocity);
            ++n;
            const double dt = static_cast<double>(kDt);
            const Vec gravity(0.0, -kGravity, 0.0);
            if (state[0].contact == Contact::kNone) {
                const Vec expected = p0 + n * dt * v0 + 0.5 * n * (n + 1.0) * dt * dt * gravity;
                // Rounding of at most one ulp of 2 a step.
                ASSERT_NEAR(glm::length(p - expected), 0.0, 500 * 2.4e-7) << "step " << step;
                highest = std::max(highest, p.y);
            } else {
                const Vec arrives = v0 + (n - 1) * dt * gravity;
                ASSERT_NEAR(v.y, -kRestitution * std::min(arrives.y, 0.0), 1e-5) << "step " << step;
                ASSERT_NEAR(v.x, arrives.x, 1e-6);
                if (bounces > 0 && bounces < 4) {
                    // In the limit dt -> 0 each apex is ε² of the last; Euler is off by O(dt v) in height.
                    EXPECT_NEAR(highest / last_apex, kRestitution * kRestitution, 0.12) << bounces;
                }
                last_apex = bounces == 0 ? last_apex : highest;
                highest = 0.0;
                ++bounces;
                p0 = p;
                v0 = v;
                n = 0;
            }
            ASSERT_GT(p.y, 0.0);
        }
        EXPECT_GT(bounces, 4);
    }
}

// Wind and drag: the implicit form tends to the wind without overshooting, for any dt · drag, and the
// terminal velocity under gravity is wind + g/k exactly.
TEST_P(ParticleSystemGlTest, DragApproachesTheWindAndNeverOvershoots) {
    for (const float drag : {0.5F, 30.0F, 120.0F, 6000.0F, 1e6F}) {
        World world;
        world.make({.capacity = 1});
        ASSERT_FALSE(HasFatalFailure());
        EXPECT_TRUE(world.particles->setForces({{0.0F, -5.0F, 0.0F}, {2.0F, 0.0F, -1.0F}, drag}));
        const std::array<Birth, 1> births{birthAt(glm::vec3(0.0F), {-8.0F, 3.0F, 7.0F})};
        world.particles->spawn(births);
        glm::vec3 last(-8.0F, 3.0F, 7.0F);
        const glm::vec3 terminal(2.0F, -5.0F / drag, -1.0F);
        double factor = 1.0;
        for (int step = 0; step < 60; ++step) {
            world.particles->step(kDt);
            const glm::vec3 v = world.state().at(0).velocity;
            factor /= 1.0 + static_cast<double>(kDt) * static_cast<double>(drag);
            for (int i = 0; i < 3; ++i) {
                const double start = i == 0 ? -8.0 : (i == 1 ? 3.0 : 7.0);
                const double expected =
                    static_cast<double>(terminal[i]) + (start - static_cast<double>(terminal[i])) * factor;
                ASSERT_NEAR(static_cast<double>(v[i]), expected, 2e-5) << drag;
                ASSERT_LE(std::abs(v[i] - terminal[i]), std::abs(last[i] - terminal[i]) + 1e-6F);
            }
            last = v;
        }
    }
}

// Restitution up to 1 without forces: no contact makes a particle faster, beyond the rounding of the normal's
// length (two ulp) and of the reaction.
TEST_P(ParticleSystemGlTest, NoCollisionAddsEnergy) {
    for (const float restitution : {1.0F, 0.6F}) {
        World world;
        world.collider = mixedCollider();
        world.make({.capacity = 4000});
        ASSERT_FALSE(HasFatalFailure());
        EXPECT_TRUE(world.particles->setCollision({restitution, 0.0F, 0.0F}));
        EXPECT_TRUE(world.particles->setGround(-0.5F));
        Pcg32 random(5);
        std::vector<Birth> births;
        for (int i = 0; i < 4000; ++i) {
            const glm::vec3 p = randomIn(random, glm::vec3(-1.3F), glm::vec3(1.3F));
            births.push_back(birthAt(p, randomIn(random, glm::vec3(-1.0F), glm::vec3(1.0F)) - p));
        }
        world.particles->spawn(births);
        std::vector<float> energy;
        for (const Birth& birth : births) {
            energy.push_back(dot(birth.velocity, birth.velocity));
        }
        std::uint64_t contacts = 0;
        for (int step = 0; step < 300; ++step) {
            world.particles->step(kDt);
            for (const ParticleState& particle : world.state()) {
                const float now = dot(particle.velocity, particle.velocity);
                ASSERT_LE(now, energy[particle.index] * (1.0F + 3e-6F)) << step;
                if (particle.contact == Contact::kNone) {
                    ASSERT_EQ(now, energy[particle.index]);
                }
                contacts += particle.contact == Contact::kNone ? 0 : 1;
                energy[particle.index] = now;
            }
        }
        EXPECT_GT(contacts, 3000U);
    }
}

// Snow sticks: once at rest, no bit of any position changes in a thousand steps, on top, on slopes, in wind.
TEST_P(ParticleSystemGlTest, SnowRestsExactly) {
    World world;
    world.collider = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 128);
    world.make({.capacity = 4000});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(world.particles->setForces({{0.0F, -9.81F, 0.0F}, {0.7F, 0.0F, 0.2F}, 2.0F}));
    EXPECT_TRUE(world.particles->setCollision({0.0F, 1.0F, 0.0F}));
    EXPECT_TRUE(world.particles->setGround(-0.5F));
    Pcg32 random(3);
    std::vector<Birth> births;
    for (int i = 0; i < 4000; ++i) {
        births.push_back(birthAt(randomIn(random, {-0.8F, 0.6F, -0.6F}, {0.5F, 1.5F, 0.6F})));
    }
    world.particles->spawn(births);
    for (int step = 0; step < 400; ++step) {
        world.particles->step(kDt);
    }
    const std::vector<ParticleState> before = world.state();
    ASSERT_EQ(before.size(), 4000U);
    int on_sphere = 0;
    int on_slope = 0;
    for (const ParticleState& particle : before) {
        ASSERT_EQ(particle.velocity, glm::vec3(0.0F)) << particle.index;
        ASSERT_EQ(particle.contact, Contact::kCollided);
        const float height = glm::length(particle.position) - 0.5F;
        // It rests a last step's fall above what holds it: dt² g and the wind's share of a step.
        if (height < 0.02F && particle.position.y > -0.49F) {
            ++on_sphere;
            on_slope += particle.position.y < 0.35F ? 1 : 0;
        }
    }
    EXPECT_GT(on_sphere, 500);
    EXPECT_GT(on_slope, 100);
    for (int step = 0; step < 1000; ++step) {
        world.particles->step(kDt);
    }
    const std::vector<ParticleState> after = world.state();
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        ASSERT_EQ(std::memcmp(&after[i].position, &before[i].position, sizeof(glm::vec3)), 0) << i;
        ASSERT_EQ(after[i].collisions, before[i].collisions + 1000U);
    }
}

// Caught particles leave: born anywhere inside, with gravity pressing them in, or in free flight into the
// body.
TEST_P(ParticleSystemGlTest, CaughtParticlesLeave) {
    for (const bool gravity : {true, false}) {
        World world;
        world.collider = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 128);
        world.make({.capacity = 3000});
        ASSERT_FALSE(HasFatalFailure());
        EXPECT_TRUE(world.particles->setForces({{0.0F, gravity ? -9.81F : 0.0F, 0.0F}, {}, 0.0F}));
        EXPECT_TRUE(world.particles->setCollision({0.5F, 0.2F, 0.0F}));
        Pcg32 random(9);
        std::vector<Birth> births;
        while (births.size() < 3000) {
            const glm::vec3 p = randomIn(random, glm::vec3(-0.5F), glm::vec3(0.5F));
            if (glm::length(p) > 0.48F) {
                continue;
            }
            const glm::vec3 v =
                gravity ? glm::vec3(0.0F) : randomIn(random, glm::vec3(-1.0F), glm::vec3(1.0F));
            births.push_back(birthAt(p, v));
        }
        world.particles->spawn(births);
        for (int step = 0; step < 1500; ++step) {
            world.particles->step(kDt);
        }
        int inside = 0;
        for (const ParticleState& particle : world.state()) {
            inside += glm::length(particle.position) < 0.49F ? 1 : 0;
        }
        EXPECT_EQ(inside, 0) << (gravity ? "pressed in by gravity" : "in free flight");
    }
}

// CPU and GPU agree on every death and on its step, over irregular steps, heavy churn and an epoch that is
// set forward dozens of times; and the time of death is right against doubles.
TEST_P(ParticleSystemGlTest, DeathsOnCpuAndGpuAgree) {
    constexpr std::uint32_t kCapacity = 3000;
    World world;
    world.make({.capacity = kCapacity, .epoch_seconds = 0.75});
    ASSERT_FALSE(HasFatalFailure());
    Pcg32 random(21);
    struct Known {
        double birth, death;
    };
    std::map<std::uint32_t, Known> known;  // by id
    std::uint32_t next_id = 0;
    double time = 0.0;
    std::uint64_t refused = 0;
    for (int step = 0; step < 600; ++step) {
        std::vector<Birth> births;
        const auto count = random.next() % 90;
        for (std::uint32_t i = 0; i < count; ++i) {
            // Down to lifetimes far below a step.
            births.push_back(birthAt({1.0F, 2.0F, 3.0F}, glm::vec3(0.0F),
                                     random.between(1e-6F, 1.5F) * random.uniform() + 1e-7F));
        }
        const std::size_t accepted = world.particles->spawn(births).value();
        refused += births.size() - accepted;
        for (std::size_t i = 0; i < accepted; ++i) {
            known[next_id++] = {time, time + static_cast<double>(births[i].lifetime)};
        }
        const float dt = random.between(0.001F, 0.05F);
        world.particles->step(dt);
        time += static_cast<double>(dt);
        const auto raw = world.particles->readRaw();
        ASSERT_TRUE(raw);
        for (std::uint32_t index = 0; index < world.particles->extent(); ++index) {
            ASSERT_EQ(raw->position[4 * index + 3] >= 0.0F, world.particles->isLive(index))
                << "step " << step;
            if (!world.particles->isLive(index)) {
                ASSERT_EQ(raw->position[4 * index + 1], -1e30F) << "out of sight";
            }
        }
        std::set<std::uint32_t> alive;
        for (const ParticleState& particle : world.state()) {
            alive.insert(particle.id);
            ASSERT_NEAR(static_cast<double>(particle.age), time - known.at(particle.id).birth, 1e-5);
        }
        for (auto it = known.begin(); it != known.end();) {
            if (std::abs(it->second.death - time) > 1e-6) {
                ASSERT_EQ(alive.contains(it->first), it->second.death > time)
                    << "step " << step << " id " << it->first;
            }
            it = alive.contains(it->first) ? std::next(it) : known.erase(it);
        }
        const ParticleCounts counts = world.particles->counts();
        ASSERT_EQ(counts.alive, alive.size());
        ASSERT_EQ(counts.born, counts.alive + counts.died);
        ASSERT_EQ(counts.refused, refused);
    }
    EXPECT_NEAR(world.particles->time(), time, 1e-9);
}

// A step that ends exactly at the time of death is the last one, on both sides.
TEST_P(ParticleSystemGlTest, DeathComesWithTheStepThatReachesIt) {
    World world;
    world.make({.capacity = 4});
    ASSERT_FALSE(HasFatalFailure());
    const std::array<Birth, 3> births{birthAt(glm::vec3(1.0F), glm::vec3(0.0F), 0.25F),
                                      birthAt(glm::vec3(2.0F), glm::vec3(0.0F), 0.5F),
                                      birthAt(glm::vec3(3.0F), glm::vec3(0.0F), 0.500001F)};
    world.particles->spawn(births);
    for (const std::uint32_t alive : {2U, 1U, 0U}) {
        world.particles->step(0.25F);
        EXPECT_EQ(world.particles->counts().alive, alive);
        const auto raw = world.particles->readRaw();
        ASSERT_TRUE(raw);
        for (std::uint32_t index = 0; index < world.particles->extent(); ++index) {
            EXPECT_EQ(raw->position[4 * index + 3] >= 0.0F, index + alive >= 3U) << index;
        }
    }
}

TEST_P(ParticleSystemGlTest, BirthsFillTheFirstTexelsAndTheRestIsRefused) {
    World world;
    world.make({.capacity = 2500});  // two full rows and a part of a third
    ASSERT_FALSE(HasFatalFailure());
    std::vector<Birth> births;
    for (int i = 0; i < 2600; ++i) {
        births.push_back({glm::vec3(static_cast<float>(i), 0.5F, -1.0F),
                          glm::vec3(0.0F, static_cast<float>(i), 0.0F), 9.0F,
                          static_cast<std::uint32_t>(i % 7)});
    }
    EXPECT_EQ(world.particles->spawn(births), 2500U);
    EXPECT_EQ(world.particles->room(), 0U);
    EXPECT_TRUE(world.state().empty()) << "they are born with the next step";
    world.particles->step(0.5F);
    const std::vector<ParticleState> state = world.state();
    ASSERT_EQ(state.size(), 2500U);
    for (std::uint32_t i = 0; i < 2500; ++i) {
        ASSERT_EQ(state[i].index, i);
        ASSERT_EQ(state[i].id, i);
        ASSERT_EQ(state[i].position,
                  glm::vec3(static_cast<float>(i), 0.5F + 0.5F * static_cast<float>(i), -1.0F));
        ASSERT_EQ(state[i].type, i % 7);
        ASSERT_EQ(state[i].age, 0.5F);
        ASSERT_EQ(state[i].lifetime, 9.0F);
        ASSERT_EQ(state[i].collisions, 0U);
    }
    EXPECT_EQ(world.particles->counts().refused, 100U);
}

// Rows that fall out of use and come back must not bring back the dead.
TEST_P(ParticleSystemGlTest, RowsThatWereLeftComeBackClean) {
    World world;
    world.make({.capacity = 4096});
    ASSERT_FALSE(HasFatalFailure());
    std::vector<Birth> old_ones(1000, birthAt(glm::vec3(1.0F), glm::vec3(0.0F), 100.0F));
    old_ones.resize(3000, birthAt(glm::vec3(2.0F), glm::vec3(0.0F), 0.05F));
    world.particles->spawn(old_ones);
    for (int step = 0; step < 10; ++step) {  // an odd and an even number of steps with fewer rows
        world.particles->step(kDt);
    }
    EXPECT_EQ(world.particles->extent(), 1000U);
    for (int round = 0; round < 3; ++round) {
        const std::vector<Birth> fresh(1100, birthAt(glm::vec3(3.0F), glm::vec3(0.0F), 0.02F));
        world.particles->spawn(fresh);
        world.particles->step(0.01F);
        const auto raw = world.particles->readRaw();
        ASSERT_TRUE(raw);
        ASSERT_EQ(world.particles->extent(), 2100U);
        for (std::uint32_t i = 0; i < 2100; ++i) {
            ASSERT_EQ(raw->position[4 * i], i < 1000 ? 1.0F : 3.0F) << i;
        }
        for (int step = 0; step < 3 + round; ++step) {
            world.particles->step(0.01F);
        }
        EXPECT_EQ(world.particles->extent(), 1000U);
    }
}

// No flake ends deeper in a sphere than its maps are wrong: a point that a map sees outside lies in front of
// that map's surface point at its texel's centre, at most 0.71 texel aside, so it is at most that far from a
// point of the sphere; and a half-float depth is off by half an ulp, 2^-12 of the depth range.
TEST_P(ParticleSystemGlTest, AHundredThousandFlakesStayOutOfASphere) {
    constexpr std::uint32_t kSize = 256;
    constexpr double kRadius = 0.5;
    World world;
    world.collider = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, kRadius), kSize);
    world.make({.capacity = 100'000});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(world.particles->setForces({{0.0F, -2.0F, 0.0F}, {0.1F, 0.0F, 0.0F}, 1.0F}));
    EXPECT_TRUE(world.particles->setCollision({0.0F, 1.0F, 0.0F}));
    Pcg32 random(17);
    std::vector<Birth> births;
    for (int i = 0; i < 100'000; ++i) {
        births.push_back(birthAt(randomIn(random, {-0.55F, 0.55F, -0.5F}, {0.5F, 1.2F, 0.5F}),
                                 randomIn(random, glm::vec3(-0.3F), glm::vec3(0.3F))));
    }
    world.particles->spawn(births);
    for (int step = 0; step < 200; ++step) {
        world.particles->step(kDt);
    }
    const double texel = 2.0 * kRadius / (kSize - 2.0);
    const double quantum = 2.0 * kRadius * 1.02 / 4096.0;
    double deepest = 0.0;
    int resting = 0;
    for (const ParticleState& particle : world.state()) {
        deepest = std::max(deepest, kRadius - glm::length(Vec(particle.position)));
        resting += particle.contact == Contact::kCollided ? 1 : 0;
    }
    EXPECT_LE(deepest, 0.71 * texel + quantum);
    EXPECT_GT(resting, 30'000);
    RecordProperty("deepest_texels", std::to_string(deepest / texel));
}

TEST_P(ParticleSystemGlTest, TheSameBirthsGiveTheSameBits) {
    std::vector<RawState> runs;
    for (int run = 0; run < 2; ++run) {
        World world;
        world.collider = mixedCollider();
        world.make({.capacity = 2000});
        ASSERT_FALSE(HasFatalFailure());
        EXPECT_TRUE(world.particles->setForces({{0.0F, -3.0F, 0.0F}, {}, 0.3F}));
        EXPECT_TRUE(world.particles->setCollision({0.5F, 0.1F, 0.0F}));
        EmitterSettings settings;
        settings.box_min = {-1.0F, 0.7F, -0.5F};
        settings.box_max = {0.5F, 1.0F, 0.5F};
        settings.rate = 1500.0;
        settings.lifetime_min = 0.5F;
        settings.lifetime_max = 1.0F;
        Emitter emitter(settings, 4);
        for (int step = 0; step < 120; ++step) {
            std::vector<Birth> births;
            emitter.emit(static_cast<double>(kDt), world.particles->room(), births);
            world.particles->spawn(births);
            world.particles->step(kDt);
        }
        auto raw = world.particles->readRaw();
        ASSERT_TRUE(raw);
        runs.push_back(std::move(*raw));
    }
    ASSERT_GT(runs[0].position.size(), 1000U);
    EXPECT_EQ(runs[0].position, runs[1].position);
    EXPECT_EQ(runs[0].velocity, runs[1].velocity);
}

TEST_P(ParticleSystemGlTest, OptionsOutOfRangeAreErrors) {
    for (const ParticleSystemOptions& options :
         {ParticleSystemOptions{.capacity = 0},
          ParticleSystemOptions{.capacity = ParticleSystem::kCapacityMax + 1},
          ParticleSystemOptions{.epoch_seconds = 0.0}, ParticleSystemOptions{.epoch_seconds = std::nan("")},
          ParticleSystemOptions{.epoch_seconds = 1e9}}) {
        const auto made = ParticleSystem::create(StepGlTest::onPath(options));
        ASSERT_FALSE(made);
        EXPECT_EQ(made.error().code, ErrorCode::kUsage);
    }
    auto made = ParticleSystem::create(onPath({.capacity = 1}));
    ASSERT_TRUE(made);
    ASSERT_TRUE(made->setCollider(nullptr));
    made->step(0.1F);  // nobody there
    EXPECT_EQ(made->counts().alive, 0U);
}

}  // namespace

RELIEF_INSTANTIATE_STEP_TESTS(ParticleSystemGlTest);

}  // namespace relief
