// SPDX-License-Identifier: Apache-2.0
// Worlds of many bodies: the broad phase is bit-identical to testing every body, and finds moving bodies where they
// are.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "runtime/bodies/world_textures.h"
#include "tests/formats/random_patches.h"
#include "tests/runtime/collider/field_query.h"
#include "tests/runtime/particles/collision_test.h"

namespace relief {
namespace {

/// A reach at which every box contains every point, so that all bodies are tested.
constexpr float kEverywhere = 1e6F;

/// Colliders with known boxes. The first map of one of them abstains outside its own box.
class Colliders {
  public:
    Colliders() {
        std::mt19937 random(9);
        colliders_[0] = boxCollider();
        colliders_[1] = analytic::frontBackCollider(analytic::sphere({0.1, 0.0, 0.0}, 0.4), 48);
        for (std::size_t i = 2; i < 4; ++i) {
            colliders_[i].maps = {test::randomPatches(random)};
        }
        colliders_[4] = colliders_[1];
        colliders_[4].maps[0].encloses = colliders_[4].maps[0].empty_is_outside = false;
    }
    [[nodiscard]] const Collider& operator[](std::size_t i) const {
        return colliders_[i % colliders_.size()];
    }
    [[nodiscard]] static std::size_t size() { return 5; }

  private:
    std::array<Collider, 5> colliders_;
};

Pose randomPose(Pcg32& random, float half) {
    const glm::vec3 axis = randomIn(random, 1.0F) + glm::vec3(0.0F, 1.1F, 0.0F);
    return {randomIn(random, half), glm::angleAxis(random.between(0.0F, 6.0F), glm::normalize(axis)),
            std::exp(random.between(-2.0F, 1.5F))};
}

/// At least one body of every collider, so that all worlds have the same shader. Or bodies of one patch map each,
/// placed in the world.
std::vector<ColliderBody> randomWorld(const Colliders& colliders, Pcg32& random, bool placed, float half) {
    const std::uint32_t count =
        placed ? 30 : static_cast<std::uint32_t>(Colliders::size()) + random.next() % 60;
    std::vector<ColliderBody> bodies;
    for (std::uint32_t i = 0; i < count; ++i) {
        bodies.push_back({&colliders[placed ? 2 + i % 2 : i], randomPose(random, half), random.uniform(),
                          random.uniform()});
    }
    return bodies;
}

class WorldGlTest : public CollisionTest {};
class WorldFieldGlTest : public GlTest {};

std::vector<Pose> posesOf(const std::vector<ColliderBody>& bodies) {
    std::vector<Pose> poses;
    for (const ColliderBody& body : bodies) {
        poses.push_back(body.pose);
    }
    return poses;
}

// Worlds of every kind of collider, and worlds of placed patch maps, whose field the CPU computes as well.
TEST_P(WorldFieldGlTest, BroadPhaseMatchesTestingEveryBody) {
    const Colliders colliders;
    Pcg32 random(21);
    std::map<std::string, FieldQuery> queries;  // by their defines
    std::size_t inside = 0;
    std::size_t known = 0;
    std::size_t apart = 0;
    for (int world = 0; world < 70; ++world) {
        const bool placed = world < 10;
        const float half = !placed ? std::exp(random.between(-0.5F, 5.0F)) : world < 5 ? 3.0F : 20.0F;
        std::vector<ColliderBody> bodies = randomWorld(colliders, random, placed, half);
        WorldTextures textures = required(WorldTextures::create(bodies));
        EXPECT_EQ(textures.defines().find("RELIEF_PLACED 1") != std::string::npos, placed);
        const std::string& defines = textures.defines();
        if (!queries.contains(defines)) {
            queries.emplace(defines, required(FieldQuery::create(
                                         textures, placed ? "" : "#define RELIEF_QUERY_INSIDE\n")));
        }
        FieldQuery& query = queries.at(defines);
        query.use(textures);
        if (world % 3 == 1) {  // some of them move
            for (std::size_t i = 0; i < bodies.size(); i += placed ? 1 : 4) {
                bodies[i].pose = randomPose(random, 2.0F);
            }
            textures.setPoses(posesOf(bodies));
        }
        std::vector<glm::vec3> points;
        for (int i = 0; i < 1'000; ++i) {
            const Pose& pose = bodies[random.next() % bodies.size()].pose;
            points.push_back(toWorld(pose, randomIn(random, placed ? 4.0F : 0.6F)));
        }
        const std::vector<FieldSample> few = required(query.evaluate(points));
        textures.reach(kEverywhere);
        const std::vector<FieldSample> all = required(query.evaluate(points));
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_EQ(few[i].distance, all[i].distance) << "world " << world;
            if (all[i].distance < 0.0F) {
                ++inside;
                ASSERT_EQ(few[i].normal, all[i].normal);
                ASSERT_EQ(few[i].map, all[i].map);
            }
            if (!placed) {
                continue;
            }
            float best = kFarOutside;
            for (const ColliderBody& body : bodies) {
                const FieldSample sample = evaluate(*body.collider, toObject(body.pose, points[i]));
                if (sample.map >= 0 && sample.distance < kFarOutside) {
                    best = std::min(best, body.pose.scale * sample.distance);
                }
            }
            const bool far = best == kFarOutside;
            known += far ? 0 : 1;
            // Distances differ if rounding selects another cell.
            const bool equal = far ? !(few[i].distance < kFarOutside)
                                   : std::abs(few[i].distance - best) < 1e-4F * (1.0F + std::abs(best));
            apart += equal ? 0 : 1;
        }
    }
    EXPECT_GT(inside, 7'000U);
    EXPECT_GT(known, 2'500U);
    EXPECT_LT(apart, known / 200);
}

// The response shows which of two coincident bodies was hit.
TEST_P(WorldGlTest, FirstOfEqualBodiesDecides) {
    const Collider box = boxCollider();
    for (const float first : {0.25F, 0.75F}) {
        const std::array<ColliderBody, 2> bodies{ColliderBody{&box, {}, first},
                                                 ColliderBody{&box, {}, 1.0F - first}};
        make({.capacity = 4});
        collideWith(WorldTextures::create(bodies));
        setType({.restitution = 1.0F});
        spawnOne({{0.0F, box.bounds.max.y + 0.005F, 0.0F}, {0.0F, -1.0F, 0.0F}, 100.0F, 0});
        step();
        EXPECT_NEAR(state().at(0).velocity.y, first, 1e-5F);
    }
}

TEST_P(WorldGlTest, ParticlesMatchThoseOfTestingEveryBody) {
    const Colliders colliders;
    for (const int kind : {0, 1, 2, 3}) {
        const bool balls = kind % 2 == 1;
        Pcg32 random(4);
        std::vector<ColliderBody> bodies;
        for (std::uint32_t i = 0; i < 60; ++i) {
            const std::uint32_t shape = kind < 2 ? i : 2 + i % 2;  // patch maps, which are placed
            bodies.push_back({&colliders[shape], randomPose(random, 3.0F), 0.5F, 0.2F});
        }
        std::vector<std::vector<ParticleState>> ends;
        for (const bool all : {false, true}) {
            make({.capacity = 512});
            collideWith(WorldTextures::create(bodies));
            if (all) {
                textures_->reach(kEverywhere);
            }
            std::vector<ParticleType> types(2, {.radius = balls ? 0.05F : 0.0F, .restitution = 0.5F});
            types[1].collides_with = 4U | kCollidesWithGround;
            ASSERT_TRUE(particles_->setTypes(types));
            ASSERT_TRUE(particles_->setSweep(balls ? 0.0F : 0.05F));
            Pcg32 births(8);
            spawnMany(512, [&](std::uint32_t i) {
                const glm::vec3 place = randomIn(births, 4.0F);
                return Birth{place, randomIn(births, 4.0F), 100.0F, i % 2};
            });
            std::vector<Pose> poses = posesOf(bodies);
            for (int i = 0; i < 8; ++i) {
                for (std::size_t k = 0; k < poses.size(); k += 5) {
                    poses[k].position += glm::vec3(0.02F, 0.01F * std::sin(static_cast<float>(i)), 0.0F);
                }
                textures_->setPoses(poses);
                step();
            }
            ends.push_back(state());
        }
        ASSERT_EQ(ends[0].size(), ends[1].size());
        std::size_t met = 0;
        for (std::size_t i = 0; i < ends[0].size(); ++i) {
            ASSERT_EQ(ends[0][i].position, ends[1][i].position);
            ASSERT_EQ(ends[0][i].velocity, ends[1][i].velocity);
            ASSERT_EQ(ends[0][i].contact, ends[1][i].contact);
            met += ends[0][i].collisions > 0 ? 1 : 0;
        }
        EXPECT_GT(met, 100U);
    }
}

TEST_P(WorldFieldGlTest, CollidersOfManyBodiesAreUploadedOnce) {
    const Collider box = boxCollider();
    const auto one = WorldTextures::create(std::vector<ColliderBody>(1, {&box, {}, 1.0F, 0.0F}));
    const auto many = WorldTextures::create(std::vector<ColliderBody>(1'000, {&box, {}, 1.0F, 0.0F}));
    ASSERT_TRUE(one && many);
    EXPECT_EQ(one->mapCount(), many->mapCount());
    EXPECT_EQ(one->bytes(), many->bytes());
}

}  // namespace

RELIEF_INSTANTIATE_STEP_TESTS(WorldGlTest);
RELIEF_INSTANTIATE_GL_TESTS(WorldFieldGlTest);

}  // namespace relief
