// Where features of the step meet: sweeps with Verlet and with moving bodies, bodies that are taken away,
// births in moving air, deaths of all kinds. In OpenGL 3.3 and in OpenGL ES 3.0.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

#include "runtime/gl/gl_functions.h"
#include "runtime/particles/emitter.h"
#include "runtime/particles/particle_system.h"
#include "tests/runtime/particles/collision_test.h"

namespace relief {
namespace {

class CollisionCornersGlTest : public CollisionTest {};

// The velocity of Verlet is the way of the last step: a swept bounce must not shorten or turn it.
TEST_P(CollisionCornersGlTest, ASweptBounceKeepsTheVelocityInBothIntegrators) {
    for (const Integrator integrator : {Integrator::kEuler, Integrator::kVerlet}) {
        make({.capacity = 4, .integrator = integrator});
        EXPECT_TRUE(particles_->setGround(0.0F));
        EXPECT_TRUE(particles_->setCollision({1.0F, 0.0F, 0.0F}));
        ASSERT_TRUE(particles_->setSweep(0.005F));
        spawnOne({{0.0F, 0.43F, 0.0F}, {0.5F, -6.0F, 0.0F}, 100.0F, 0});  // 0.1 a step: 20 pieces
        for (int step = 0; step < 8; ++step) {
            particles_->step(kDt);
        }
        const ParticleState particle = state().at(0);
        EXPECT_NEAR(particle.velocity.y, 6.0F, 1e-3F) << static_cast<int>(integrator);
        EXPECT_NEAR(particle.velocity.x, 0.5F, 1e-3F) << static_cast<int>(integrator);
        EXPECT_EQ(particle.collisions, 1U) << static_cast<int>(integrator);
    }
}

// Verlet does not tunnel either.
TEST_P(CollisionCornersGlTest, SweptVerletStaysInsideAClosedBox) {
    std::vector<analytic::Shape> walls;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            analytic::Vec low(-0.5, -0.5, -0.5);
            analytic::Vec high(0.5, 0.5, 0.5);
            (side < 0.0 ? high : low)[axis] = side * 0.48;
            walls.push_back(analytic::box(low, high));
        }
    }
    const analytic::Shape shape = analytic::unite(std::move(walls));
    Collider box = analytic::frontBackCollider(shape, 96);
    box.maps.push_back(analytic::cubeMap(shape, Compare::kLess, {0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}, 128));
    make({.capacity = 2000, .integrator = Integrator::kVerlet});
    collideWith(ColliderTextures::create(box));
    EXPECT_TRUE(particles_->setCollision({1.0F, 0.0F, 0.0F}));
    ASSERT_TRUE(particles_->setSweep(0.01F));
    Pcg32 random(5);
    std::vector<Birth> births;
    for (int i = 0; i < 2000; ++i) {
        const auto in = [&](float reach) {
            const float x = random.between(-reach, reach);
            const float y = random.between(-reach, reach);
            return glm::vec3(x, y, random.between(-reach, reach));
        };
        const glm::vec3 place = in(0.45F);
        births.push_back({place, random.between(0.1F, 30.0F) * in(1.0F), 1e5F, 0});
    }
    particles_->spawn(births);
    for (int step = 0; step < 100; ++step) {
        particles_->step(kDt);
    }
    int lost = 0;
    std::uint64_t collisions = 0;
    for (const ParticleState& particle : state()) {
        const glm::vec3 p = glm::abs(particle.position);
        lost += std::max({p.x, p.y, p.z}) > 0.49F ? 1 : 0;
        collisions += particle.collisions;
    }
    EXPECT_EQ(lost, 0);
    EXPECT_GT(collisions, 2000U * 100U / 20U);
}

// A wall overtakes what slides along it: the sweep may not keep the particle from being carried for the whole
// of the step.
TEST_P(CollisionCornersGlTest, AMovingWallPushesWhatIsSwept) {
    const Collider box = boxCollider();
    for (const Integrator integrator : {Integrator::kEuler, Integrator::kVerlet}) {
        for (const bool sweep : {false, true}) {
            make({.capacity = 4, .integrator = integrator});
            constexpr float kSpeed = 1.2F;
            const ColliderBody body{&box, {}, 1.0F, 0.0F};
            collideWith(ColliderTextures::create(std::span(&body, 1)));
            EXPECT_TRUE(particles_->setCollision({0.0F, 0.0F, 0.0F}));
            ASSERT_TRUE(particles_->setSweep(sweep ? 0.002F : 0.0F));
            spawnOne({{0.45F, -0.15F, 0.02F}, {0.0F, 0.5F, 0.0F}, 100.0F, 0});
            const int steps = 24;
            for (int step = 1; step <= steps; ++step) {
                const Pose pose{
                    {kSpeed * kDt * static_cast<float>(step), 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F, 0.0F}, 1.0F};
                textures_->setPoses(std::span(&pose, 1));
                particles_->step(kDt);
            }
            const ParticleState particle = state().at(0);
            EXPECT_GT(particle.position.x, 0.4F + kSpeed * kDt * steps - 0.01F)
                << "it stays ahead of the wall: sweep " << sweep << " integrator "
                << static_cast<int>(integrator);
            EXPECT_NEAR(particle.velocity.x, kSpeed, 2e-3F) << sweep << " " << static_cast<int>(integrator);
        }
    }
}

// What stopped on a body that is taken away stays where it is.
TEST_P(CollisionCornersGlTest, WhatStoppedOnABodyThatIsGoneStays) {
    const Collider box = boxCollider();
    make({.capacity = 4});
    std::vector<ColliderBody> bodies;
    for (int i = 0; i < 8; ++i) {
        bodies.push_back(
            {&box, {{static_cast<float>(i), 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F, 0.0F}, 1.0F}, 1.0F, 0.0F});
    }
    collideWith(ColliderTextures::create(bodies));
    ParticleType type;
    type.on_collision = OnCollision::kStop;
    setType(type);
    spawnOne({{7.1F, 0.25F, 0.0F}, {0.0F, -1.0F, 0.0F}, 100.0F, 0});
    for (int step = 0; step < 10; ++step) {
        particles_->step(kDt);
    }
    const ParticleState stopped = state().at(0);
    ASSERT_EQ(stopped.contact, Contact::kStopped);
    ASSERT_GT(stopped.position.x, 7.0F);
    const auto old = std::move(textures_);
    collideWith(ColliderTextures::create(std::span(bodies).first(2)));
    for (int step = 0; step < 10; ++step) {
        particles_->step(kDt);
    }
    EXPECT_LT(glm::length(state().at(0).position - stopped.position), 1e-5F);
    EXPECT_EQ(state().at(0).velocity, glm::vec3(0.0F));
}

// The age of a birth counts in the air that the step has, whose wind takes the place of the forces' own.
TEST_P(CollisionCornersGlTest, WhatHasAnAgeHasMovedInTheAirsWind) {
    for (const bool with_air : {false, true}) {
        make({.capacity = 4});
        EXPECT_TRUE(particles_->setForces(
            {{}, with_air ? glm::vec3(0.0F, 9.0F, 0.0F) : glm::vec3(2.0F, 0.0F, 0.0F), 3.0F}));
        if (with_air) {
            AirSettings air;
            air.wind = {2.0F, 0.0F, 0.0F};
            ASSERT_TRUE(particles_->setAir(air));
        }
        spawnOne({{}, {}, 100.0F, 0, 0.25F});
        particles_->step(0.25F);
        // v' = (v + t k w) / (1 + t k) for the age, then for the step.
        const float first = 0.25F * 3.0F * 2.0F / 1.75F;
        const ParticleState particle = state().at(0);
        EXPECT_NEAR(particle.velocity.x, (first + 1.5F) / 1.75F, 1e-5F) << with_air;
        EXPECT_NEAR(particle.velocity.y, 0.0F, 1e-6F) << with_air;
    }
}

// Births, deaths of all kinds and a clock that is set back, in rows that come and go: both integrators keep
// the same particles at the same places.
TEST_P(CollisionCornersGlTest, VerletKeepsTheBooksOfEuler) {
    std::array<std::vector<ParticleState>, 2> ends;
    std::array<ParticleCounts, 2> counts;
    std::vector<ParticleType> types(3);
    types[0].restitution = 0.5F;
    types[1].on_collision = OnCollision::kDie;
    types[2].restitution = 1.0F;
    types[2].lifetime_loss = 0.4F;
    for (const Integrator integrator : {Integrator::kEuler, Integrator::kVerlet}) {
        make({.capacity = 5000, .integrator = integrator, .epoch_seconds = 0.25});
        ASSERT_TRUE(particles_->setTypes(types));
        EXPECT_TRUE(particles_->setForces({{0.0F, -4.0F, 0.0F}, {}, 0.2F}));
        EXPECT_TRUE(particles_->setGround(0.0F));
        Pcg32 random(17);
        for (int step = 0; step < 300; ++step) {
            std::vector<Birth> births;
            // Crowds of a moment: the extent grows to five rows and falls to nothing.
            const int count = step % 60 == 0 ? 4500 : (step % 7 == 0 ? 30 : 0);
            for (int i = 0; i < count; ++i) {
                const float x = random.between(-1.0F, 1.0F);
                const float speed = random.between(-1.0F, 1.0F);
                const float life = random.between(0.01F, 0.5F);
                births.push_back({{x, random.between(0.02F, 0.3F), 0.0F},
                                  {0.3F, speed, 0.0F},
                                  life,
                                  static_cast<std::uint32_t>(i % 3)});
            }
            particles_->spawn(births);
            particles_->step(step % 3 == 0 ? 0.02F : 0.01F);
            if (step == 270) {
                ends[integrator == Integrator::kEuler ? 0 : 1] = state();
            }
        }
        counts[integrator == Integrator::kEuler ? 0 : 1] = particles_->counts();
    }
    EXPECT_EQ(counts[0].born, counts[1].born);
    EXPECT_EQ(counts[0].died, counts[1].died);
    EXPECT_EQ(counts[0].refused, 0U);
    // A touch that hangs by a rounding may differ; who lives is else the same.
    ASSERT_GT(ends[0].size(), 100U);
    EXPECT_NEAR(static_cast<double>(ends[0].size()), static_cast<double>(ends[1].size()), 5.0);
    std::size_t same = 0;
    std::size_t k = 0;
    for (const ParticleState& euler : ends[0]) {
        while (k < ends[1].size() && ends[1][k].index < euler.index) {
            ++k;
        }
        if (k < ends[1].size() && ends[1][k].index == euler.index) {
            EXPECT_EQ(ends[1][k].id, euler.id);
            EXPECT_EQ(ends[1][k].age, euler.age);
            same += glm::length(ends[1][k].position - euler.position) < 1e-4F &&
                            glm::length(ends[1][k].velocity - euler.velocity) < 2e-3F
                        ? 1
                        : 0;
        }
    }
    EXPECT_GT(same + 6, ends[0].size());
}

// The buffers and textures that a caller has bound stay bound through every call.
TEST_P(CollisionCornersGlTest, BlocksAndVolumesOfTheCallerStayBound) {
    const Collider box = boxCollider();
    const GlBuffer mine = makeBuffer();
    glBindBuffer(GL_UNIFORM_BUFFER, mine.name());
    glBufferData(GL_UNIFORM_BUFFER, 4096, nullptr, GL_STATIC_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, mine.name());
    glBindBufferRange(GL_UNIFORM_BUFFER, 1, mine.name(), 1024, 512);
    GLuint volume = 0;
    glGenTextures(1, &volume);
    for (GLenum unit = 0; unit < 8; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_3D, volume);
    }
    const auto check = [&](const char* what) {
        GLint bound = 0;
        GLint64 start = -1;
        GLint64 size = -1;
        glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, 0, &bound);
        EXPECT_EQ(static_cast<GLuint>(bound), mine.name()) << what;
        glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, 1, &bound);
        glGetInteger64i_v(GL_UNIFORM_BUFFER_START, 1, &start);
        glGetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, 1, &size);
        EXPECT_EQ(static_cast<GLuint>(bound), mine.name()) << what;
        EXPECT_EQ(start, 1024) << what;
        EXPECT_EQ(size, 512) << what;
        glGetIntegerv(GL_UNIFORM_BUFFER_BINDING, &bound);
        EXPECT_EQ(static_cast<GLuint>(bound), mine.name()) << what;
        GLint active = 0;
        glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
        EXPECT_EQ(static_cast<GLenum>(active), GL_TEXTURE7) << what;
        for (GLenum unit = 0; unit < 8; ++unit) {
            glActiveTexture(GL_TEXTURE0 + unit);
            GLint texture = 0;
            glGetIntegerv(GL_TEXTURE_BINDING_3D, &texture);
            EXPECT_EQ(static_cast<GLuint>(texture), volume) << what << " unit " << unit;
        }
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << what;
    };
    make({.capacity = 16, .integrator = Integrator::kVerlet, .epoch_seconds = 0.02});
    check("create");
    const ColliderBody body{&box, {}, 1.0F, 0.0F};
    collideWith(ColliderTextures::create(std::span(&body, 1)));
    check("setCollider");
    AirSettings air;
    air.wind = {1.0F, 0.0F, 0.0F};
    auto flow = std::make_shared<FlowField>();
    flow->size = {2, 2, 2};
    flow->nodes.assign(8, glm::vec3(1.0F));
    flow->box_min = glm::vec3(-1.0F);
    flow->box_max = glm::vec3(1.0F);
    air.flow = flow;
    const auto set = particles_->setAir(air);
    ASSERT_TRUE(set) << set.error().message;
    check("setAir");
    ASSERT_TRUE(particles_->setSweep(0.1F));
    check("setSweep");
    setType({});
    check("setTypes");
    const Pose pose{{0.1F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F, 0.0F}, 1.0F};
    textures_->setPoses(std::span(&pose, 1));
    check("setPoses");
    spawnOne({{0.0F, 1.0F, 0.0F}, {}, 10.0F, 0});
    for (int i = 0; i < 4; ++i) {
        particles_->step(kDt);
        check("step");
    }
    // The system is moved: what its pass points to stays.
    particles_ = std::make_unique<ParticleSystem>(std::move(*particles_));
    particles_->step(kDt);
    check("moved");
    EXPECT_GT(state().at(0).velocity.x, -1.0F);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, 0);
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, 0);
    glDeleteTextures(1, &volume);
}

// The last of many bodies, scaled and on its way: the number of the body comes through the
// texture of either integrator, and through the statistics.
TEST_P(CollisionCornersGlTest, WhatStoppedOnTheLastBodyGoesWithIt) {
    const Collider box = boxCollider();
    for (const Integrator integrator : {Integrator::kEuler, Integrator::kVerlet}) {
        make({.capacity = 40, .integrator = integrator});
        const auto poseAt = [](float t) {
            return Pose{{20.0F + t, 0.5F * t, 0.0F},
                        glm::angleAxis(1.5F * t, glm::normalize(glm::vec3(0.3F, 1.0F, 0.2F))),
                        1.7F};
        };
        std::vector<ColliderBody> bodies(2000, ColliderBody{&box, {}, 1.0F, 0.0F});
        std::vector<Pose> poses(bodies.size());
        poses.back() = bodies.back().pose = poseAt(0.0F);
        collideWith(ColliderTextures::create(bodies));
        ParticleType type;
        type.on_collision = OnCollision::kStop;
        type.radius = 0.05F;
        setType(type);
        std::vector<Birth> births;
        for (int i = 0; i < 40; ++i) {
            births.push_back(
                {{19.6F + 0.02F * static_cast<float>(i), 0.45F, 0.1F}, {0.0F, -1.0F, 0.0F}, 100.0F, 0});
        }
        particles_->spawn(births);
        const auto stepTo = [&](float t) {
            poses.back() = poseAt(t);
            textures_->setPoses(poses);
            particles_->step(kDt);
        };
        for (int step = 0; step < 20; ++step) {
            stepTo(0.0F);
        }
        const std::vector<ParticleState> before = state();
        for (int step = 1; step <= 60; ++step) {
            stepTo(static_cast<float>(step) * kDt);
        }
        const std::vector<ParticleState> after = state();
        ASSERT_EQ(after.size(), 40U);
        for (std::size_t i = 0; i < after.size(); ++i) {
            ASSERT_EQ(after[i].contact, Contact::kStopped);
            ASSERT_EQ(after[i].collisions, 1U);
            ASSERT_LT(glm::length(toObject(poses.back(), after[i].position) -
                                  toObject(poseAt(0.0F), before[i].position)),
                      1e-4F);
        }
    }
}

// New numbers alone need no new program, for compilers take their time.
TEST_P(CollisionCornersGlTest, NumbersDoNotCompile) {
    const auto programs = [] {
        std::vector<GLuint> names;
        for (GLuint name = 1; name < 1000; ++name) {
            if (glIsProgram(name) == GL_TRUE) {
                names.push_back(name);
            }
        }
        return names;
    };
    make({.capacity = 4});
    EXPECT_TRUE(particles_->setGround(0.0F));
    std::vector<ParticleType> types(2);
    ASSERT_TRUE(particles_->setTypes(types));
    ASSERT_TRUE(particles_->setSweep(0.1F));
    const std::vector<GLuint> before = programs();
    types[0].restitution = 1.0F;
    ASSERT_TRUE(particles_->setTypes(types));
    ASSERT_TRUE(particles_->setSweep(0.01F));
    EXPECT_EQ(programs(), before);
    ASSERT_TRUE(particles_->setSweep(0.0F));
    EXPECT_NE(programs(), before);
    // And yet they count.
    spawnOne({{0.0F, 0.01F, 0.0F}, {0.0F, -1.0F, 0.0F}, 100.0F, 0});
    particles_->step(kDt);
    EXPECT_EQ(state().at(0).velocity.y, 1.0F);
}

// A ball that flies at a box touches its faces, edges and corners with its own surface: beyond an edge of the
// maps' volumes no map sees anything, and yet the edge is there.
TEST_P(CollisionCornersGlTest, BallsTouchEdgesAndCorners) {
    constexpr float kRadius = 0.1F;
    const Collider box = boxCollider();
    make({.capacity = 4000});
    collideWith(ColliderTextures::create(box));
    ParticleType type;
    type.radius = kRadius;
    type.restitution = 1.0F;
    setType(type);
    Pcg32 random(4);
    const auto within = [&](const glm::vec3& reach) {
        const float x = random.between(-reach.x, reach.x);
        const float y = random.between(-reach.y, reach.y);
        return glm::vec3(x, y, random.between(-reach.z, reach.z));
    };
    const glm::vec3 half(0.4F, 0.2F, 0.3F);
    std::vector<Birth> births;
    for (int i = 0; i < 4000; ++i) {
        const glm::vec3 from = 0.9F * glm::normalize(within(glm::vec3(1.0F)));
        births.push_back({from, within(half) - from, 100.0F, 0});
    }
    particles_->spawn(births);
    std::vector<float> nearest(4000, 1e9F);
    for (int step = 0; step < 80; ++step) {
        particles_->step(kDt);
        for (const ParticleState& particle : state()) {
            const glm::vec3 beyond = glm::max(glm::abs(particle.position) - half, glm::vec3(0.0F));
            nearest[particle.index] = std::min(nearest[particle.index], glm::length(beyond));
        }
    }
    int met = 0;
    int sunk = 0;
    for (const float gap : nearest) {
        met += gap < 1.2F * kRadius ? 1 : 0;
        sunk += gap < 0.7F * kRadius ? 1 : 0;
    }
    EXPECT_GT(met, 3900);
    EXPECT_LE(sunk, 4) << "a texel's rim may hide one";
}

// A ball that lies a little in a floor and rolls into a wall bounces off the wall as its type says: what it touches
// elsewhere does not make it one that the wall has caught, which would come back as fast as it came.
TEST_P(CollisionCornersGlTest, ABallOnAFloorBouncesOffAWall) {
    constexpr float kRadius = 0.1F;
    const analytic::Shape shape = analytic::unite({analytic::box({-1.0, -0.2, -0.5}, {1.0, 0.0, 0.5}),
                                                   analytic::box({0.5, -0.2, -0.5}, {1.0, 0.6, 0.5})});
    const Collider corner = analytic::frontBackCollider(shape, 128);
    for (const bool posed : {false, true}) {
        const Pose pose =
            posed ? Pose{{3.0F, 0.0F, 0.0F}, glm::angleAxis(0.7F, glm::vec3(0.0F, 1.0F, 0.0F)), 2.0F}
                  : Pose{};
        const auto turned = [&](const glm::vec3& v) { return pose.scale * (pose.rotation * v); };
        make({.capacity = 1});
        if (posed) {
            const ColliderBody body{&corner, pose, 1.0F, 0.0F};
            collideWith(ColliderTextures::create(std::span(&body, 1)));
        } else {
            collideWith(ColliderTextures::create(corner));
        }
        ParticleType type;
        type.radius = pose.scale * kRadius;
        type.restitution = 0.5F;
        setType(type);
        EXPECT_TRUE(particles_->setForces({}));
        // 0.01 in the floor, and at the wall after a step and a half.
        const glm::vec3 at(0.5F - kRadius - 1.5F * 0.03F, kRadius - 0.01F, 0.05F);
        spawnOne({pose.position + turned(at), turned({0.03F / kDt, 0.0F, 0.0F}), 100.0F, 0});
        for (int step = 0; step < 2; ++step) {
            particles_->step(kDt);
        }
        const ParticleState ball = state().at(0);
        const glm::vec3 expected = turned({-0.5F * 0.03F / kDt, 0.0F, 0.0F});
        EXPECT_EQ(ball.contact, Contact::kCollided) << posed;
        EXPECT_LT(glm::length(ball.velocity - expected), 0.02F * glm::length(expected)) << posed;
    }
}

// Verlet's bounces end, too.
TEST_P(CollisionCornersGlTest, VerletComesToRest) {
    const Collider box = analytic::frontBackCollider(analytic::box({-2.0, -0.5, -2.0}, {2.0, 0.0, 2.0}), 64);
    for (const float sweep : {0.0F, 0.02F}) {
        make({.capacity = 200, .integrator = Integrator::kVerlet});
        collideWith(ColliderTextures::create(box));
        ParticleType type;
        type.restitution = 0.6F;
        type.friction = 0.3F;
        setType(type);
        ASSERT_TRUE(particles_->setSweep(sweep));
        EXPECT_TRUE(particles_->setForces({{0.0F, -9.81F, 0.0F}, {}, 0.0F}));
        Pcg32 random(8);
        std::vector<Birth> births;
        for (int i = 0; i < 200; ++i) {
            const float x = random.between(-0.8F, 0.8F);
            const float y = random.between(0.1F, 1.0F);
            births.push_back({{x, y, random.between(-0.8F, 0.8F)}, {0.2F, 0.0F, -0.1F}, 1e5F, 0});
        }
        particles_->spawn(births);
        for (int step = 0; step < 1000; ++step) {
            particles_->step(kDt);
        }
        const std::vector<ParticleState> before = state();
        for (int step = 0; step < 1000; ++step) {
            particles_->step(kDt);
        }
        const std::vector<ParticleState> after = state();
        ASSERT_EQ(after.size(), 200U);
        for (std::size_t i = 0; i < after.size(); ++i) {
            ASSERT_EQ(after[i].position, before[i].position)
                << sweep << " " << i << " v " << after[i].velocity.y;
            ASSERT_GT(after[i].position.y, -0.002F);
            ASSERT_LT(after[i].position.y, 0.01F);
        }
    }
}

}  // namespace

RELIEF_INSTANTIATE_STEP_TESTS(CollisionCornersGlTest);

}  // namespace relief
