// SPDX-License-Identifier: Apache-2.0
// All step paths give the same particles and events.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "runtime/air/particle_air.h"
#include "runtime/bodies/world_textures.h"
#include "runtime/events/event_recorder.h"
#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/particle_system.h"
#include "runtime/particles/random.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/particles/collision_test.h"

namespace relief {
namespace {

constexpr std::uint32_t kParticles = 3000;

/// The features that a step is compiled for.
struct Features {
    const char* name;
    Integrator integrator = Integrator::kEuler;
    bool collider = true;
    float radius = 0.0F;
    float sweep = 0.0F;
    bool air = false;
    int bodies = 0;      ///< number of moving bodies
    bool masks = false;  ///< every other particle collides only with body 1 and the floor
    int repeats = 0;     ///< of six maps, each of which sees only one side of the box
};

/// Bodies whose first maps allow different conclusions about points that they do not cover.
class Bodies {
  public:
    [[nodiscard]] std::vector<ColliderBody> first(int count) const {
        std::vector<ColliderBody> bodies;
        for (int i = 0; i < count; ++i) {
            bodies.push_back({&colliders_[static_cast<std::size_t>(i) % colliders_.size()], pose(i, 0),
                              i % 2 == 0 ? 1.0F : 0.5F, 0.1F});
        }
        return bodies;
    }
    /// Close together, so that some overlap.
    static Pose pose(int body, int step) {
        const auto i = static_cast<float>(body);
        const auto angle = 0.02F * static_cast<float>(step) + i;
        return {{0.35F * std::cos(2.0F * i), 0.12F * i - 0.1F, 0.35F * std::sin(2.0F * i)},
                glm::angleAxis(angle, glm::normalize(glm::vec3(1.0F, i, 0.5F))),
                0.6F + 0.15F * i};
    }

  private:
    std::array<Collider, 5> colliders_{boxCollider(), half(), layer(), Collider{}, cube()};

    /// A ball whose first map covers one side and abstains beyond it.
    static Collider half() {
        const analytic::Shape ball = analytic::sphere(analytic::Vec(0.0), 0.3);
        const analytic::Shape side = analytic::box({-0.3, -0.3, -0.3}, {0.0, 0.3, 0.3});
        Collider collider;
        collider.bounds = ball.bounds;
        collider.maps = {
            analytic::orthographicMap(side, MapFormat::kFrontBackHalf, Compare::kBoth, {1, true}, 48),
            analytic::cubeMap(ball, Compare::kGreater, analytic::Vec(0.0), analytic::Vec(0.35), 32)};
        collider.maps[0].encloses = collider.maps[0].empty_is_outside = false;
        return collider;
    }
    static Collider cube() {
        Collider ball = half();
        ball.maps.erase(ball.maps.begin());
        return ball;
    }
    /// A box whose first map covers a layer, with texels that abstain at any depth.
    static Collider layer() {
        const analytic::Shape thin = analytic::box({-0.4, -0.2, -0.05}, {0.4, 0.2, 0.05});
        DepthMap first =
            analytic::orthographicMap(thin, MapFormat::kFrontBackHalf, Compare::kBoth, {2, true}, 48);
        first.empty_is_outside = false;
        for (std::uint32_t y = 0; y < first.height; ++y) {
            for (std::uint32_t x = 0; x < first.width / 2; ++x) {
                encodeTexel(first.format, Texel{}, first.texelAt(0, x, y));
            }
        }
        Collider box = boxCollider();
        box.maps.insert(box.maps.begin(), first);
        return box;
    }
};

/// No map can be omitted: each is the only one that sees its side as free.
Collider sidesOf(int repeats) {
    analytic::Shape box = analytic::box({-0.4, -0.2, -0.3}, {0.4, 0.2, 0.3});
    box.bounds.add(glm::vec3(-0.7F));
    box.bounds.add(glm::vec3(0.7F));
    Collider collider;
    collider.bounds = box.bounds;
    for (int i = 0; i < 6 * repeats; ++i) {
        collider.maps.push_back(
            analytic::orthographicMap(box, MapFormat::kFixed8, Compare::kLess, {i % 3, i % 6 < 3}, 48));
        collider.maps.back().empty_is_outside = false;
    }
    return collider;
}

struct PathRun {
    std::vector<ParticleState> state;
    std::vector<ParticleEvent> events;
};

class StepPathGlTest : public GlTest {
  protected:
    /// Particles that are spawned in two batches, collide and die.
    static PathRun played(const Features& features, StepPath path, int steps) {
        static const Collider kBox = boxCollider();
        static const Bodies kBodies;
        const Collider box = features.repeats > 0 ? sidesOf(features.repeats) : kBox;
        WorldTextures textures =
            required(features.bodies > 0 ? WorldTextures::create(kBodies.first(features.bodies))
                                         : WorldTextures::create(box));
        ParticleSystem particles = required(ParticleSystem::create({.capacity = kParticles + 100,
                                                                    .integrator = features.integrator,
                                                                    .epoch_seconds = 0.3,
                                                                    .path = path}));
        EXPECT_EQ(particles.path(), path);
        EXPECT_TRUE(particles.setForces({{0.1F, -3.0F, 0.0F}, {0.4F, 0.0F, -0.3F}, 0.5F}));
        EXPECT_TRUE(particles.setGround(-0.19F));  // above some, which touch it in the first step
        const ParticleType type{.radius = features.radius, .restitution = 0.5F, .friction = 0.2F};
        std::vector<ParticleType> types{type};
        if (features.masks) {
            types.push_back(type);
            types[1].collides_with = 2U | kCollidesWithGround;
        }
        EXPECT_TRUE(particles.setTypes(types));
        EXPECT_TRUE(particles.startStep());  // of settings that change before the first step
        EXPECT_TRUE(particles.setSweep(features.sweep));
        if (features.air) {
            AirSettings air;
            air.curl_noise = CurlNoise{.amplitude = 0.5F, .scale = 0.4F, .octaves = 2, .drift = 0.1F};
            EXPECT_TRUE(setAir(particles, air));
        }
        if (features.collider) {
            EXPECT_TRUE(particles.setCollider(&textures));
        }
        EXPECT_TRUE(setEvents(particles, EventOptions{.lasting = true, .deaths = true}));
        PathRun run;
        Pcg32 random(5);
        std::vector<Birth> births;
        for (std::uint32_t i = 0; i < kParticles; ++i) {
            births.push_back(
                {{random.between(-0.8F, 0.8F), random.between(-0.2F, 0.8F), random.between(-0.8F, 0.8F)},
                 {random.between(-1.0F, 1.0F), random.between(-3.0F, 0.0F), random.between(-1.0F, 1.0F)},
                 random.between(0.2F, 2.0F),
                 i % static_cast<std::uint32_t>(types.size())});
        }
        const auto half = static_cast<std::ptrdiff_t>(kParticles / 2);
        particles.spawn({births.begin(), births.begin() + half});
        EXPECT_TRUE(particles.startStep());
        for (int i = 0; i < steps; ++i) {
            if (i == steps / 2) {
                particles.spawn({births.begin() + half, births.end()});
            }
            std::vector<Pose> poses(static_cast<std::size_t>(features.bodies));
            for (int body = 0; body < features.bodies; ++body) {
                poses[static_cast<std::size_t>(body)] = Bodies::pose(body, i);
            }
            textures.setPoses(poses);
            particles.step(kDt);
            EXPECT_TRUE(requestEvents(particles, 0));
            const StepEvents step = required(waitEvents(particles)).value();
            run.events.insert(run.events.end(), step.events.begin(), step.events.end());
        }
        run.state = required(particles.readState());
        return run;
    }
};

constexpr Features kAll[] = {
    {"nothing solid", Integrator::kEuler, false},
    {"a collider"},
    {"Verlet", Integrator::kVerlet},
    {"a radius", Integrator::kEuler, true, 0.03F},
    {"swept", Integrator::kEuler, true, 0.0F, 0.02F},
    {.name = "swept, maps of one side", .sweep = 0.02F, .repeats = 1},
    {"swept Verlet with a radius, in moving air", Integrator::kVerlet, true, 0.02F, 0.05F, true},
    {.name = "swept, with masks", .sweep = 0.02F, .masks = true},
    {.name = "swept, more maps than a group copies", .sweep = 0.02F, .repeats = 11},
    {.name = "a body", .bodies = 1},
    {.name = "bodies, one without maps", .bodies = 5},
    {.name = "bodies, swept", .sweep = 0.02F, .bodies = 3},
    {"bodies, swept Verlet with masks", Integrator::kVerlet, true, 0.0F, 0.02F, false, 3, true},
    {.name = "bodies and balls, swept", .radius = 0.02F, .sweep = 0.03F, .bodies = 2},
};

// A software renderer runs both paths on one processor with the same arithmetic, so they are bit-identical. A GPU may
// fuse operations differently in a compute shader. A step from the same births is then within the CPU reference's
// tolerance (particle_system_gl_test.cpp), except for one in a thousand near a decision.
TEST_P(StepPathGlTest, BothPathsGiveTheSameParticles) {
    const bool bits = context_->software();
    const int steps = bits ? 24 : 2;
    for (const Features& features : kAll) {
        SCOPED_TRACE(features.name);
        const auto [fragment, listed] = played(features, StepPath::kFragment, steps);
        const auto [compute, other] = played(features, StepPath::kCompute, steps);
        ASSERT_EQ(fragment.size(), compute.size());
        ASSERT_GT(fragment.size(), kParticles / 4);
        std::size_t others = 0;
        std::size_t touched = 0;
        for (std::size_t i = 0; i < fragment.size(); ++i) {
            const ParticleState& a = fragment[i];
            const ParticleState& b = compute[i];
            ASSERT_EQ(a.id, b.id);
            touched += a.collisions > 0 ? 1 : 0;
            const float far =
                std::max(glm::length(a.position - b.position), glm::length(a.velocity - b.velocity));
            const bool same = bits ? far == 0.0F && a.collisions == b.collisions && a.contact == b.contact &&
                                         a.age == b.age && a.lifetime == b.lifetime
                                   : far < 4e-6F;
            others += same ? 0 : 1;
        }
        EXPECT_LE(others, bits ? 0 : fragment.size() / 1000);
        EXPECT_GT(listed.size(), 100U);
        EXPECT_NEAR(static_cast<double>(listed.size()), static_cast<double>(other.size()),
                    bits ? 0.0 : 0.01 * static_cast<double>(listed.size()));
        for (std::size_t i = 0; bits && i < listed.size(); ++i) {
            const ParticleEvent& a = listed[i];
            const ParticleEvent& b = other.at(i);
            ASSERT_TRUE(a.id == b.id && a.index == b.index && a.type == b.type && a.time == b.time &&
                        a.position == b.position && a.velocity == b.velocity && a.normal == b.normal &&
                        a.speed == b.speed && a.body == b.body && a.hit == b.hit && a.lasts == b.lasts &&
                        a.death == b.death);
        }
        EXPECT_GT(touched, 0U);
        if (features.collider) {  // not only the floor
            Features floor = features;
            floor.collider = false;
            const std::vector<ParticleState> free = played(floor, StepPath::kFragment, steps).state;
            ASSERT_EQ(free.size(), fragment.size());
            std::size_t met = 0;
            for (std::size_t i = 0; i < free.size(); ++i) {
                met += free[i].velocity != fragment[i].velocity ? 1 : 0;
            }
            EXPECT_GT(met, 20U);
        }
    }
}

// Checks that tours are used; otherwise the test above proves nothing about them.
TEST_P(StepPathGlTest, ToursAreUsedForSweepsOfASingleCollider) {
    const auto tours = [](const Result<WorldTextures>& textures, StepVariant variant) {
        variant.collider = &*textures;
        StepPass pass = required(StepPass::start(variant));
        EXPECT_TRUE(pass.finish());
        return pass.usesStorage();
    };
    const auto many = [](std::size_t maps) {
        Collider box = boxCollider();
        box.maps.resize(maps, box.maps.front());
        return WorldTextures::create(box);
    };
    const auto box = WorldTextures::create(boxCollider());
    EXPECT_TRUE(tours(box, {.sweep = true, .compute = true}));
    EXPECT_TRUE(tours(many(64), {.sweep = true, .compute = true}));
    EXPECT_FALSE(tours(many(65), {.sweep = true, .compute = true}));
    EXPECT_FALSE(tours(WorldTextures::create(Bodies().first(1)), {.sweep = true, .compute = true}));
    EXPECT_FALSE(tours(box, {.compute = true}));
    EXPECT_FALSE(tours(box, {.sweep = true, .radius = true, .compute = true}));
    EXPECT_FALSE(tours(box, {.sweep = true}));
}

TEST_P(StepPathGlTest, AutomaticPathFollowsTheDevice) {
    const auto particles = ParticleSystem::create({.capacity = 10});
    ASSERT_TRUE(particles);
    EXPECT_EQ(particles->path(), context_->software() ? StepPath::kFragment : StepPath::kCompute);
}

// More births than one dispatch handles, on texels in random order, because the short lives of the first batch have
// ended.
TEST_P(StepPathGlTest, ManyBirthsAtOnceAreIdentical) {
    constexpr std::uint32_t kMany = 300'000;
    std::vector<std::vector<ParticleState>> states;
    for (const StepPath path : {StepPath::kFragment, StepPath::kCompute}) {
        ParticleSystem particles = required(ParticleSystem::create({.capacity = kMany, .path = path}));
        Pcg32 random(7);
        for (const bool lasting : {false, true}) {
            std::vector<Birth> births(kMany);
            for (Birth& birth : births) {
                birth.position = {random.uniform(), random.uniform(), random.uniform()};
                birth.velocity = {random.uniform(), 0.0F, random.uniform()};
                birth.lifetime = lasting || random.next() % 2 == 0 ? 10.0F : kDt;
                birth.type = random.next() % 3;
            }
            EXPECT_EQ(particles.spawn(births) == kMany, !lasting);
            particles.step(2.0F * kDt);
        }
        states.push_back(required(particles.readState()));
    }
    ASSERT_EQ(states[0].size(), kMany);
    ASSERT_EQ(states[1].size(), kMany);
    for (std::uint32_t i = 0; i < kMany; ++i) {
        const ParticleState& a = states[0][i];
        const ParticleState& b = states[1][i];
        ASSERT_TRUE(a.id == b.id && a.type == b.type && a.age == b.age && a.lifetime == b.lifetime) << i;
        ASSERT_LT(glm::length(a.position - b.position), context_->software() ? 1e-30F : 1e-6F);
        ASSERT_LT(glm::length(a.velocity - b.velocity), context_->software() ? 1e-30F : 1e-6F);
    }
}

RELIEF_INSTANTIATE_GL_TESTS(StepPathGlTest);

}  // namespace
}  // namespace relief
