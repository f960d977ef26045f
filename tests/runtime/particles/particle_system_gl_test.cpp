// SPDX-License-Identifier: Apache-2.0
// The GPU simulation in OpenGL 3.3 and OpenGL ES 3.0: against a CPU step for each particle, against closed forms, and
// for invariants of any input.
#include "runtime/air/particle_air.h"
#include "runtime/bodies/world_textures.h"
#include "runtime/particles/particle_system.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "tests/runtime/particles/collision_test.h"
#include "tests/runtime/particles/reference_step.h"

namespace relief {
namespace {

using analytic::Vec;

Birth birthAt(const glm::vec3& position, const glm::vec3& velocity = glm::vec3(0.0F),
              float lifetime = 1000.0F) {
    return {position, velocity, lifetime, 0};
}

/// Two bodies in maps of every format and compare, including a cube map from inside one of them and one from free
/// space.
Collider mixedCollider() {
    const analytic::Shape shape = analytic::unite(
        {analytic::sphere({0.0, 0.1, 0.0}, 0.45), analytic::box({-0.9, -0.5, -0.3}, {-0.6, 0.2, 0.35})});
    using analytic::orthographicMap;
    Collider collider;
    collider.bounds = shape.bounds;
    collider.maps = {orthographicMap(shape, MapFormat::kFrontBackHalf, Compare::kBoth, {1, false}, 96),
                     orthographicMap(shape, MapFormat::kFixed8, Compare::kLess, {0, true}, 128),
                     orthographicMap(shape, MapFormat::kFixed8, Compare::kGreater, {0, true}, 64),
                     orthographicMap(shape, MapFormat::kFloat32, Compare::kLess, {2, false}, 100),
                     orthographicMap(shape, MapFormat::kFloat32, Compare::kGreater, {2, false}, 100),
                     orthographicMap(shape, MapFormat::kFrontBackFixed, Compare::kBoth, {2, true}, 80),
                     analytic::cubeMap(shape, Compare::kGreater, {0.0, 0.1, 0.0}, {1.3, 1.2, 1.1}, 64),
                     analytic::cubeMap(shape, Compare::kLess, {-0.53, 0.45, 0.0}, {0.5, 0.4, 0.5}, 64)};
    collider.maps[5].decode = Decode::kPlane;
    return collider;
}

/// Three moving bodies at time t.
std::array<Pose, 3> posesAt(float t) {
    return {Pose{{0.4F * std::sin(t), 0.0F, 0.0F}, turn({1.0F, 2.0F, 0.5F}, 0.8F * t), 1.0F},
            Pose{{-0.8F, 0.3F * t, 0.2F}, turn({0.0F, 0.0F, 1.0F}, 2.0F * t), 0.7F},
            Pose{{0.7F, -0.5F, -0.2F}, turn({0.0F, 1.0F, 0.0F}, 0.3F), 1.6F}};
}

class ParticleSystemGlTest : public CollisionTest {
  protected:
    void spawn(const std::vector<Birth>& births) { ASSERT_EQ(particles_->spawn(births), births.size()); }
};
RELIEF_INSTANTIATE_STEP_TESTS(ParticleSystemGlTest);

// Compares every particle of every step with the CPU's step from the GPU's previous state, and every index with the
// CPU's own record of births and deaths.
// Tolerance: a GPU may fuse multiply-adds, and its error is 2.5 ulp for a division and 2 ulp for 1/sqrt (the usual
// bounds of Vulkan and GLSL; OpenGL specifies none). A step chains about ten such operations on numbers below 4, so 16
// ulp of 4 bound it: 16 · 2^-22 < 4e-6. Poses add a dozen operations each way: 48 · 2^-22. Velocities of a moving
// surface divide such an error by dt. Near a decision (reference_step.h) the two may differ. Such particles are
// counted: at most one in a thousand, or three if bodies move.
TEST_P(ParticleSystemGlTest, StepEqualsTheReferenceParticleByParticle) {
    constexpr std::uint32_t kCapacity = 5000;
    const Collider mixed = mixedCollider();
    const Collider ball = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 128);
    const Collider box = boxCollider();
    const std::array<Pose, 3> start = posesAt(0.0F);
    ReferenceSettings still;
    still.bodies = {{&mixed, {}, {}}};
    still.ground = -0.4F;  // intersects the box: the deeper one decides
    still.forces = {{0.1F, -3.0F, 0.0F}, {0.4F, 0.0F, -0.3F}, 0.5F};
    still.type.restitution = 0.45F;
    still.type.friction = 0.3F;
    still.type.friction_threshold = 0.6F;
    still.dt = kDt;
    ReferenceSettings moving = still;
    moving.bodies = {{&ball, start[0], start[0], 0.9F, 0.1F},
                     {&box, start[1], start[1], 1.0F, 0.0F},
                     {&box, start[2], start[2], 0.3F, 0.5F}};
    moving.ground = -0.9F;
    moving.type.mass = 1.5F;
    moving.type.gravity = 0.75F;
    struct Case {
        const char* name;
        ReferenceSettings settings;
        Integrator integrator;
        float position, velocity, excused;
    };
    constexpr float kPosed = 1.2e-5F;
    for (auto& [name, settings, integrator, position, velocity, excused_max] :
         {Case{"one collider", still, Integrator::kEuler, 4e-6F, 4e-6F, 1e-3F},
          Case{"moving bodies", moving, Integrator::kEuler, kPosed, 2.0F * kPosed / kDt, 3e-3F},
          Case{"moving bodies, Verlet", moving, Integrator::kVerlet, kPosed, 2.0F * kPosed / kDt, 3e-3F}}) {
        SCOPED_TRACE(name);
        ReferenceSettings reference = settings;
        make({.capacity = kCapacity, .integrator = integrator, .epoch_seconds = 0.5});
        std::vector<ColliderBody> bodies;
        for (const ReferenceBody& body : reference.bodies) {
            bodies.push_back({body.collider, body.now, body.restitution, body.friction});
        }
        const bool moves = bodies.size() > 1;
        collideWith(moves ? WorldTextures::create(bodies) : WorldTextures::create(mixed));
        setType(reference.type);
        EXPECT_TRUE(particles_->setForces(reference.forces));
        EXPECT_TRUE(particles_->setGround(reference.ground));
        std::map<std::uint32_t, ParticleState> live;  // by index
        std::set<std::uint32_t> free;
        for (std::uint32_t i = 0; i < kCapacity; ++i) {
            free.insert(i);
        }
        Pcg32 random(11);
        std::uint32_t next_id = 0;
        std::uint64_t compared = 0;
        std::uint64_t excused = 0;
        std::map<Contact, std::uint64_t> contacts;
        for (int i = 0; i < 100; ++i) {
            std::vector<Birth> births;
            for (int k = 0; k < 60; ++k) {
                // Some are born inside, and are caught from the start.
                const glm::vec3 place = k % 6 == 0
                                            ? randomIn(random, {-0.9F, -0.5F, -0.3F}, {0.4F, 0.4F, 0.3F})
                                            : randomIn(random, {-1.2F, 0.6F, -0.7F}, {0.7F, 1.0F, 0.7F});
                const glm::vec3 speed = randomIn(random, 1.5F);
                births.push_back(birthAt(place, speed, random.between(0.3F, 2.0F)));
            }
            spawn(births);
            for (const Birth& birth : births) {
                const std::uint32_t index = *free.begin();
                free.erase(free.begin());
                live[index] = {.id = next_id++, .position = birth.position, .velocity = birth.velocity};
            }
            const std::array<Pose, 3> poses = posesAt(static_cast<float>(i + 1) * kDt);
            for (std::size_t k = 0; moves && k < poses.size(); ++k) {
                reference.bodies[k].before = std::exchange(reference.bodies[k].now, poses[k]);
            }
            if (moves) {
                textures_->setPoses(poses);
            }
            step();
            std::map<std::uint32_t, ParticleState> after;
            for (const ParticleState& particle : state()) {
                after[particle.index] = particle;
            }
            for (const auto& [index, before] : live) {
                const auto found = after.find(index);
                if (found == after.end()) {  // died; another test checks the time of death
                    free.insert(index);
                    continue;
                }
                const ParticleState& gpu = found->second;
                ASSERT_EQ(gpu.id, before.id) << "a birth was written to the wrong texel";
                const ReferenceState cpu = referenceStep(reference, before.position, before.velocity);
                const float way = glm::length(gpu.position - cpu.position);
                const float speed = glm::length(gpu.velocity - cpu.velocity);
                ++compared;
                ++contacts[gpu.contact];
                if (!(way <= position) || !(speed <= velocity) || gpu.contact != cpu.contact) {
                    ++excused;
                    ASSERT_TRUE(cpu.ambiguous)
                        << "step " << i << " index " << index << " error " << way << ", velocity " << speed
                        << ", contact " << static_cast<int>(gpu.contact) << " for "
                        << static_cast<int>(cpu.contact);
                }
            }
            std::erase_if(live, [&](const auto& one) { return !after.contains(one.first); });
            ASSERT_EQ(after.size(), live.size());
            ASSERT_EQ(particles_->counts().alive, live.size());
            ASSERT_EQ(particles_->counts().extent, live.empty() ? 0 : live.rbegin()->first + 1);
            live = std::move(after);
        }
        EXPECT_GT(compared, 100'000U);
        EXPECT_GT(contacts[Contact::kCollided], 2'000U);
        EXPECT_GT(contacts[Contact::kCaught], 1'000U);
        EXPECT_LT(static_cast<double>(excused),
                  static_cast<double>(excused_max) * static_cast<double>(compared));
    }
}

// Wind and drag: v' = (v + dt (g + k w)) / (1 + dt k) approaches the terminal velocity w + g/k without overshoot, for
// any dt · k. k is drag / mass, or 6π η r / m by Stokes' law.
TEST_P(ParticleSystemGlTest, DragMatchesTheClosedForm) {
    struct Case {
        Forces forces;
        ParticleType type;
        double k;
    };
    const double pi = std::numbers::pi;
    for (const auto& [forces, type, k] :
         {Case{{.drag = 0.5F}, {}, 0.5}, Case{{.drag = 30.0F}, {}, 30.0}, Case{{.drag = 1e6F}, {}, 1e6},
          Case{{.drag = 2.0F}, {.mass = 4.0F}, 0.5},
          Case{{.viscosity = 0.5F}, {.radius = 0.1F}, 6.0 * pi * 0.5 * 0.1},
          Case{{.drag = 7.0F, .viscosity = 0.5F},
               {.mass = 8.0F, .radius = 0.2F},
               6.0 * pi * 0.5 * 0.2 / 8.0}}) {
        SCOPED_TRACE(k);
        make({.capacity = 1});
        setType(type);
        Forces all = forces;
        all.gravity = {0.0F, -5.0F, 0.0F};
        all.wind = {2.0F, 0.0F, -1.0F};
        EXPECT_TRUE(particles_->setForces(all));
        const Vec start(-8.0, 3.0, 7.0);
        const Vec terminal = Vec(2.0, -5.0 / k, -1.0);
        spawn({birthAt(glm::vec3(0.0F), glm::vec3(start))});
        for (int n = 1; n <= 60; ++n) {
            step();
            const double left = std::pow(1.0 + static_cast<double>(kDt) * k, -n);
            const Vec v(state().at(0).velocity);
            ASSERT_NEAR(glm::length(v - (terminal + left * (start - terminal))), 0.0, 4e-5) << n;
        }
    }
}

// Snow sticks: once at rest, no bit of any position changes, on top, on slopes, in wind. And no flake sinks deeper into
// a sphere than the error of its maps. A point with an outside vote lies in front of that map's surface point at the
// texel's centre, at most 0.71 texel aside. So it is at most that far from a point of the sphere. A half-float depth is
// off by half an ulp, 2^-12 of the depth range.
TEST_P(ParticleSystemGlTest, SnowRestsExactlyOnASphere) {
    constexpr std::uint32_t kSize = 256;
    constexpr double kRadius = 0.5;
    constexpr std::uint32_t kFlakes = 10'000;
    make({.capacity = kFlakes});
    collideWith(analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, kRadius), kSize));
    EXPECT_TRUE(particles_->setForces({{0.0F, -9.81F, 0.0F}, {0.7F, 0.0F, 0.2F}, 2.0F}));
    EXPECT_TRUE(particles_->setType({.friction = 1.0F}));
    EXPECT_TRUE(particles_->setGround(-0.5F));
    Pcg32 random(3);
    spawnMany(kFlakes, [&](std::uint32_t) {
        return birthAt(randomIn(random, {-0.8F, 0.6F, -0.6F}, {0.5F, 1.5F, 0.6F}));
    });
    step(400);
    const std::vector<ParticleState> before = state();
    std::uint32_t on_sphere = 0;
    std::uint32_t on_slope = 0;
    double deepest = 0.0;
    for (const ParticleState& particle : before) {
        ASSERT_EQ(particle.velocity, glm::vec3(0.0F)) << particle.index;
        ASSERT_EQ(particle.contact, Contact::kCollided);
        const double height = glm::length(Vec(particle.position)) - kRadius;
        deepest = std::max(deepest, -height);
        // It rests at most the last step's fall above the surface: dt² g plus the wind's contribution.
        if (height < 0.02 && particle.position.y > -0.49F) {
            ++on_sphere;
            on_slope += particle.position.y < 0.35F ? 1 : 0;
        }
    }
    EXPECT_LE(deepest, 0.71 * 2.0 * kRadius / (kSize - 2.0) + 2.0 * kRadius * 1.02 / 4096.0);
    EXPECT_GT(on_sphere, kFlakes / 8);
    EXPECT_GT(on_slope, kFlakes / 40);
    step(500);
    const std::vector<ParticleState> after = state();
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        ASSERT_EQ(std::memcmp(&after[i].position, &before[i].position, sizeof(glm::vec3)), 0) << i;
        ASSERT_EQ(after[i].collisions, before[i].collisions + 500U);
    }
}

TEST_P(ParticleSystemGlTest, CaughtParticlesLeave) {
    const Collider ball = analytic::frontBackCollider(analytic::sphere({0.0, 0.0, 0.0}, 0.5), 128);
    for (const bool gravity : {true, false}) {
        make({.capacity = 3000});
        collideWith(ball);
        EXPECT_TRUE(particles_->setForces({{0.0F, gravity ? -9.81F : 0.0F, 0.0F}, {}, 0.0F}));
        EXPECT_TRUE(particles_->setType({.restitution = 0.5F, .friction = 0.2F}));
        Pcg32 random(9);
        std::vector<Birth> births;
        while (births.size() < 3000) {
            const glm::vec3 p = randomIn(random, 0.5F);
            if (glm::length(p) < 0.48F) {
                births.push_back(birthAt(p, gravity ? glm::vec3(0.0F) : randomIn(random, 1.0F)));
            }
        }
        spawn(births);
        step(1500);
        int inside = 0;
        for (const ParticleState& particle : state()) {
            inside += glm::length(particle.position) < 0.49F ? 1 : 0;
            if (!gravity) {
                ASSERT_LE(glm::length(particle.velocity),
                          glm::length(births[particle.index].velocity) * (1.0F + 3e-6F));
            }
        }
        EXPECT_EQ(inside, 0) << (gravity ? "pulled in by gravity" : "in free flight");
    }
}

// CPU and GPU agree on every death and its step, with irregular steps, high churn and an epoch that advances dozens of
// times. The time of death is correct compared with doubles.
TEST_P(ParticleSystemGlTest, DeathsOnCpuAndGpuAgree) {
    for (const Integrator integrator : {Integrator::kEuler, Integrator::kVerlet}) {
        constexpr std::uint32_t kCapacity = 3000;
        make({.capacity = kCapacity, .integrator = integrator, .epoch_seconds = 0.75});
        Pcg32 random(21);
        struct Known {
            double birth, death;
        };
        std::map<std::uint32_t, Known> known;  // by id
        std::uint32_t next_id = 0;
        double time = 0.0;
        std::uint64_t rejected = 0;
        std::uint32_t least = kCapacity;  // minimum and maximum extent in the second half
        std::uint32_t most = 0;
        for (int step = 0; step < 400; ++step) {
            // In waves, so that rows become unused and are reused, which must not revive dead particles.
            std::vector<Birth> births(random.next() % (step / 80 % 2 == 0 ? 400 : 9),
                                      birthAt({1.0F, 2.0F, 3.0F}));
            for (Birth& birth : births) {  // includes lifetimes far shorter than a step
                birth.lifetime = random.between(1e-6F, 1.5F) * random.uniform() + 1e-7F;
            }
            const std::size_t accepted = particles_->spawn(births).value();
            rejected += births.size() - accepted;
            for (std::size_t i = 0; i < accepted; ++i) {
                known[next_id++] = {time, time + static_cast<double>(births[i].lifetime)};
            }
            const float dt = random.between(0.001F, 0.05F);
            particles_->step(dt);
            time += static_cast<double>(dt);
            const auto raw = particles_->readRaw();
            ASSERT_TRUE(raw);
            for (std::uint32_t index = 0; index < particles_->extent(); ++index) {
                ASSERT_EQ(raw->position[4 * index + 3] >= 0.0F, particles_->isLive(index)) << "step " << step;
                if (!particles_->isLive(index)) {
                    ASSERT_EQ(raw->position[4 * index + 1], -1e30F) << "moved out of sight";
                }
            }
            std::set<std::uint32_t> alive;
            for (const ParticleState& particle : state()) {
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
            const ParticleCounts counts = particles_->counts();
            ASSERT_EQ(counts.alive, alive.size());
            ASSERT_EQ(counts.born, counts.alive + counts.died);
            ASSERT_EQ(counts.rejected, rejected);
            least = step < 200 ? least : std::min(least, counts.extent);
            most = step < 200 ? most : std::max(most, counts.extent);
        }
        EXPECT_LT(least, 1024U) << "shrinks to one row";
        EXPECT_GT(most, 2048U) << "grows to three rows";
        EXPECT_NEAR(particles_->time(), time, 1e-9);
    }
}

// The age of a birth is an extra step before the first one, v' = (v + t (g + k w)) / (1 + t k), in the step's air,
// whose wind replaces that of the forces. The age also counts towards death.
TEST_P(ParticleSystemGlTest, BirthAgeIsAnExtraStep) {
    constexpr float kTime = 0.25F;
    constexpr float kDrag = 3.0F;
    const glm::vec3 wind(2.0F, 0.0F, -1.0F);
    for (const bool with_air : {false, true}) {
        make({.capacity = 4});
        setType({.gravity = -2.0F});
        const glm::vec3 gravity(0.0F, -9.0F, 0.0F);  // gravity of the type
        EXPECT_TRUE(
            particles_->setForces({-0.5F * gravity, with_air ? glm::vec3(0.0F, 9.0F, 0.0F) : wind, kDrag}));
        if (with_air) {
            AirSettings air;
            air.wind = wind;
            ASSERT_TRUE(setAir(*particles_, air));
        }
        const glm::vec3 start(4.0F, 5.0F, 6.0F);
        spawnOne({{1.0F, 2.0F, 3.0F}, start, 3.0F * kTime, 0, kTime});
        particles_->step(kTime);
        const auto after = [&](const glm::vec3& v) {
            return (v + kTime * (gravity + kDrag * wind)) / (1.0F + kTime * kDrag);
        };
        const glm::vec3 second = after(after(start));
        const ParticleState particle = state().at(0);
        EXPECT_LT(glm::length(particle.velocity - second), 1e-5F) << with_air;
        EXPECT_LT(
            glm::length(particle.position - glm::vec3(1.0F, 2.0F, 3.0F) - kTime * (after(start) + second)),
            1e-5F);
        EXPECT_EQ(particle.age, 2.0F * kTime);
        EXPECT_EQ(particle.lifetime, 3.0F * kTime);
        particles_->step(kTime);  // ends exactly at the time of death: the last step
        EXPECT_EQ(particles_->counts().died, 1U);
    }
}

}  // namespace
}  // namespace relief
