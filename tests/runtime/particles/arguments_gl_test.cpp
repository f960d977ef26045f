// SPDX-License-Identifier: Apache-2.0
// Rejected arguments. Only the CPU validates, so one API is enough.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "runtime/bodies/world_textures.h"
#include "runtime/events/event_recorder.h"
#include "tests/runtime/particles/collision_test.h"

namespace relief {
namespace {

constexpr float kNanFloat = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfiniteFloat = std::numeric_limits<float>::infinity();

template <class T>
bool refused(const Result<T>& result, ErrorCode code = ErrorCode::kUsage) {
    return !result && result.error().code == code && !result.error().message.empty();
}

class ArgumentsGlTest : public CollisionTest {
  protected:
    void SetUp() override {
        CollisionTest::SetUp();
        make({.capacity = 16});
    }
    bool refusedType(const std::function<void(ParticleType&)>& change) {
        ParticleType type;
        change(type);
        return refused(particles_->setTypes(std::span(&type, 1)));
    }
    bool refusedBirth(const std::function<void(Birth&)>& change) {
        std::vector<Birth> births(2);
        change(births[1]);
        const auto spawned = particles_->spawn(births);
        return refused(spawned) && spawned.error().message.find("birth 1 ") != std::string::npos;
    }
};
RELIEF_INSTANTIATE_STEP_TESTS_ONCE(ArgumentsGlTest);

TEST_P(ArgumentsGlTest, SystemsOutOfRange) {
    for (const ParticleSystemOptions& options :
         {ParticleSystemOptions{.capacity = 0},
          ParticleSystemOptions{.capacity = ParticleSystem::kCapacityMax + 1},
          ParticleSystemOptions{.epoch_seconds = 0.0}, ParticleSystemOptions{.epoch_seconds = std::nan("")},
          ParticleSystemOptions{.epoch_seconds = 1e9}, ParticleSystemOptions{.start_time = std::nan("")}}) {
        EXPECT_TRUE(refused(ParticleSystem::create(onPath(options))));
    }
    ASSERT_TRUE(particles_->setCollider(nullptr));
    ASSERT_TRUE(particles_->step(0.1F));  // no particles
    EXPECT_EQ(particles_->counts().alive, 0U);
}

TEST_P(ArgumentsGlTest, NonFiniteNumbers) {
    ASSERT_TRUE(particles_->setForces({.gravity = {0.0F, -8.0F, 0.0F}, .drag = 0.0F}));
    ASSERT_TRUE(particles_->setGround(-100.0F));
    spawnOne({{}, {}, 1000.0F, 0});
    for (const float wrong : {kNanFloat, kInfiniteFloat, -kInfiniteFloat}) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 one(0.0F);
            one[axis] = wrong;
            EXPECT_TRUE(refused(particles_->setForces({.gravity = one})));
            EXPECT_TRUE(refused(particles_->setForces({.wind = one})));
            EXPECT_TRUE(refusedBirth([&](Birth& birth) { birth.position = one; }));
            EXPECT_TRUE(refusedBirth([&](Birth& birth) { birth.velocity = one; }));
        }
        EXPECT_TRUE(refused(particles_->setForces({.drag = wrong})));
        EXPECT_TRUE(refused(particles_->setForces({.viscosity = wrong})));
        EXPECT_TRUE(refused(particles_->setGround(wrong)));
        EXPECT_TRUE(refused(particles_->setSweep(wrong)));
        EXPECT_TRUE(refused(particles_->step(wrong)));
        for (float ParticleType::*const member :
             {&ParticleType::gravity, &ParticleType::mass, &ParticleType::radius, &ParticleType::restitution,
              &ParticleType::friction, &ParticleType::friction_threshold, &ParticleType::lifetime_loss}) {
            EXPECT_TRUE(refusedType([&](ParticleType& type) { type.*member = wrong; }));
        }
        EXPECT_TRUE(refusedBirth([&](Birth& birth) { birth.lifetime = wrong; }));
        EXPECT_TRUE(refusedBirth([&](Birth& birth) { birth.age = wrong; }));
    }
    EXPECT_EQ(particles_->counts().born, 1U);
    step();
    EXPECT_NEAR(state().at(0).velocity.y, -8.0F * kDt, 1e-6F);
}

TEST_P(ArgumentsGlTest, NumbersOutOfRange) {
    EXPECT_TRUE(refused(particles_->setForces({.drag = -1.0F})));
    EXPECT_TRUE(refused(particles_->setSweep(-1.0F)));
    EXPECT_TRUE(refused(particles_->step(0.0F)));
    EXPECT_TRUE(refusedBirth([](Birth& birth) { birth.lifetime = 0.0F; }));
    EXPECT_TRUE(refusedBirth([](Birth& birth) { birth.type = 1U << 24; }));
    EXPECT_TRUE(refusedBirth([](Birth& birth) { birth.age = -1.0F; }));
    EXPECT_TRUE(refused(particles_->setTypes({})));
    EXPECT_TRUE(refused(particles_->setTypes(std::vector<ParticleType>(kParticleTypesMax + 1))));
    EXPECT_TRUE(refusedType([](ParticleType& type) { type.mass = 0.0F; }));
    EXPECT_TRUE(refusedType([](ParticleType& type) { type.collides_with = kCollidesWithAll + 1; }));
    for (float ParticleType::*const member :
         {&ParticleType::radius, &ParticleType::restitution, &ParticleType::friction,
          &ParticleType::friction_threshold, &ParticleType::lifetime_loss}) {
        EXPECT_TRUE(refusedType([&](ParticleType& type) { type.*member = -0.5F; }));
    }
    EXPECT_TRUE(particles_->setTypes(std::vector<ParticleType>(kParticleTypesMax)));
}

TEST_P(ArgumentsGlTest, Bodies) {
    const Collider box = boxCollider();
    const std::vector<ColliderBody> many(WorldTextures::kBodiesMax + 1, ColliderBody{&box, {}});
    EXPECT_TRUE(refused(WorldTextures::create(many), ErrorCode::kLimit));
    ColliderBody body{&box, {}};
    body.pose.scale = 0.0F;
    EXPECT_TRUE(refused(WorldTextures::create(std::span(&body, 1))));
    body.pose.scale = 1.0F;
    body.group = WorldTextures::kGroups;
    EXPECT_TRUE(refused(WorldTextures::create(std::span(&body, 1))));
}

TEST_P(ArgumentsGlTest, Events) {
    for (const EventOptions& wrong :
         {EventOptions{.max_per_step = 0}, EventOptions{.max_per_step = (1U << 24) + 1},
          EventOptions{.min_speed = -1.0F}, EventOptions{.min_speed = kNanFloat}}) {
        EXPECT_TRUE(refused(setEvents(*particles_, wrong)));
    }
    EXPECT_TRUE(refused(setEvents(*particles_, std::vector<EventOptions>(kEventLists + 1))));
    ASSERT_TRUE(setEvents(*particles_, EventOptions{}));
    EXPECT_TRUE(takeEvents().events.empty()) << "there are no particles";
    for (int i = 0; i < EventList::kInFlightMax; ++i) {
        EXPECT_TRUE(requestEvents(*particles_, 0));
    }
    EXPECT_FALSE(requestEvents(*particles_, 0)) << "too many lists";
}

// Events can distinguish 254 material names.
TEST_P(ArgumentsGlTest, TooManyMaterialsForEvents) {
    std::vector<Collider> colliders(2, boxCollider());
    std::vector<ColliderBody> bodies;
    for (int i = 0; i < 255; ++i) {
        colliders[0].materials.list.push_back({"a" + std::to_string(i)});
        colliders[1].materials.list.push_back({"b" + std::to_string(i)});
    }
    for (std::size_t i = 0; i < 700; ++i) {
        bodies.push_back({&colliders[i % 2], {{static_cast<float>(i), 0.0F, 0.0F}}});
    }
    collideWith(WorldTextures::create(bodies));
    EXPECT_TRUE(refused(setEvents(*particles_, EventOptions{}), ErrorCode::kLimit));
    EXPECT_TRUE(particles_->step(kDt));  // unchanged and usable
    EXPECT_FALSE(requestEvents(*particles_, 1));
}

}  // namespace
}  // namespace relief
