// Worlds of many bodies: the broad phase gives what asking every body gives, bit by bit, and what moves is found where it is.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <vector>

#include "tests/formats/random_patches.h"
#include "tests/runtime/collider/field_query.h"
#include "tests/runtime/particles/collision_test.h"

namespace relief {
namespace {

/// A reach at which every box holds every point, so that all bodies are asked.
constexpr float kEverywhere = 1e6F;

/// Colliders whose boxes are known, and one of which the first map abstains beyond its own.
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

/// Every collider at least once, so that all worlds have the same shader.
std::vector<ColliderBody> randomWorld(const Colliders& colliders, Pcg32& random) {
    const std::uint32_t count = static_cast<std::uint32_t>(Colliders::size()) + random.next() % 60;
    const float half = std::exp(random.between(-0.5F, 5.0F));
    std::vector<ColliderBody> bodies;
    for (std::uint32_t i = 0; i < count; ++i) {
        bodies.push_back({&colliders[i], randomPose(random, half), random.uniform(), random.uniform()});
    }
    return bodies;
}

class WorldGlTest : public CollisionTest {};
class WorldFieldGlTest : public GlTest {};

/// Bodies of one map of patches each, which are placed in the world.
std::vector<ColliderBody> patchWorld(const Colliders& colliders, Pcg32& random, std::uint32_t count,
                                     float half) {
    std::vector<ColliderBody> bodies;
    for (std::uint32_t i = 0; i < count; ++i) {
        bodies.push_back({&colliders[2 + i % 2], randomPose(random, half), 0.5F, 0.2F});
    }
    return bodies;
}

std::vector<Pose> posesOf(const std::vector<ColliderBody>& bodies) {
    std::vector<Pose> poses;
    for (const ColliderBody& body : bodies) {
        poses.push_back(body.pose);
    }
    return poses;
}

TEST_P(WorldFieldGlTest, FewAreAskedAndAllDecide) {
    const Colliders colliders;
    Pcg32 random(21);
    std::unique_ptr<FieldQuery> query;
    std::size_t inside = 0;
    for (int world = 0; world < 60; ++world) {
        std::vector<ColliderBody> bodies = randomWorld(colliders, random);
        auto textures = ColliderTextures::create(bodies);
        ASSERT_TRUE(textures) << textures.error().message;
        if (query) {
            query->use(*textures);
        } else {
            auto made = FieldQuery::create(*textures, "#define RELIEF_QUERY_INSIDE\n");
            ASSERT_TRUE(made) << made.error().message;
            query = std::make_unique<FieldQuery>(std::move(*made));
        }
        if (world % 3 == 1) {  // some of them move
            for (std::size_t i = 0; i < bodies.size(); i += 4) {
                bodies[i].pose.position = randomIn(random, 2.0F);
            }
            textures->setPoses(posesOf(bodies));
        }
        std::vector<glm::vec3> points;
        for (int i = 0; i < 1'000; ++i) {
            points.push_back(toWorld(bodies[random.next() % bodies.size()].pose, randomIn(random, 0.6F)));
        }
        const auto few = query->evaluate(points);
        textures->reach(kEverywhere);
        const auto all = query->evaluate(points);
        ASSERT_TRUE(few && all);
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_EQ((*few)[i].distance, (*all)[i].distance) << "world " << world;
            if ((*all)[i].distance < 0.0F) {
                ++inside;
                ASSERT_EQ((*few)[i].normal, (*all)[i].normal);
                ASSERT_EQ((*few)[i].map, (*all)[i].map);
            }
        }
    }
    EXPECT_GT(inside, 6'000U);
}

TEST_P(WorldFieldGlTest, PlacedBodiesAreThoseOfTheCpu) {
    const Colliders colliders;
    Pcg32 random(33);
    std::size_t known = 0;
    std::size_t inside = 0;
    std::size_t apart = 0;
    for (int world = 0; world < 10; ++world) {
        std::vector<ColliderBody> bodies = patchWorld(colliders, random, 30, world < 5 ? 3.0F : 20.0F);
        auto textures = ColliderTextures::create(bodies);
        ASSERT_TRUE(textures) << textures.error().message;
        EXPECT_NE(textures->defines().find("RELIEF_PLACED 1"), std::string::npos);
        for (ColliderBody& body : bodies) {
            body.pose = world % 2 == 0 ? body.pose : randomPose(random, 5.0F);
        }
        textures->setPoses(posesOf(bodies));
        std::vector<glm::vec3> points;
        for (int i = 0; i < 2'000; ++i) {
            points.push_back(toWorld(bodies[random.next() % bodies.size()].pose, randomIn(random, 4.0F)));
        }
        const std::vector<FieldSample> few = fieldOf(*textures, points);
        textures->reach(kEverywhere);
        const std::vector<FieldSample> all = fieldOf(*textures, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            float best = kFarOutside;
            for (const ColliderBody& body : bodies) {
                const FieldSample sample = evaluate(*body.collider, toObject(body.pose, points[i]));
                if (sample.map >= 0 && sample.distance < kFarOutside) {
                    best = std::min(best, body.pose.scale * sample.distance);
                }
            }
            ASSERT_EQ(few[i].distance, all[i].distance) << "world " << world;
            const bool far = best == kFarOutside;
            known += far ? 0 : 1;
            inside += best < 0.0F ? 1 : 0;
            // Distances differ if a rounding decides between two cells.
            const bool equal = far ? !(few[i].distance < kFarOutside)
                                   : std::abs(few[i].distance - best) < 1e-4F * (1.0F + std::abs(best));
            apart += equal ? 0 : 1;
        }
    }
    EXPECT_GT(inside, 2'000U);
    EXPECT_GT(known, 5'000U);
    EXPECT_LT(apart, known / 200);
}

TEST_P(WorldGlTest, ParticlesAreThoseOfEveryBody) {
    const Colliders colliders;
    for (const int kind : {0, 1, 2, 3}) {
        const bool balls = kind % 2 == 1;
        Pcg32 random(4);
        std::vector<ColliderBody> bodies;
        for (std::uint32_t i = 0; i < 60; ++i) {
            bodies.push_back({&colliders[i], randomPose(random, 3.0F), 0.5F, 0.2F});
        }
        if (kind >= 2) {
            bodies = patchWorld(colliders, random, 60, 3.0F);
        }
        std::vector<std::vector<ParticleState>> ends;
        for (const bool all : {false, true}) {
            make({.capacity = 512});
            collideWith(ColliderTextures::create(bodies));
            if (all) {
                textures_->reach(kEverywhere);
            }
            ParticleType type;
            type.radius = balls ? 0.05F : 0.0F;
            type.restitution = 0.5F;
            std::vector<ParticleType> types{type, type};
            types[1].collides = 4U | kCollidesWithGround;
            ASSERT_TRUE(particles_->setTypes(types));
            ASSERT_TRUE(particles_->setSweep(balls ? 0.0F : 0.05F));
            Pcg32 births_random(8);
            std::vector<Birth> births;
            for (std::uint32_t i = 0; i < 512; ++i) {
                const glm::vec3 place = randomIn(births_random, 4.0F);
                births.push_back({place, randomIn(births_random, 4.0F), 100.0F, i % 2});
            }
            particles_->spawn(births);
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

TEST_P(WorldFieldGlTest, AColliderOfManyBodiesIsThereOnce) {
    const Collider box = boxCollider();
    const auto one = ColliderTextures::create(std::vector<ColliderBody>(1, {&box, {}, 1.0F, 0.0F}));
    const auto many = ColliderTextures::create(std::vector<ColliderBody>(1'000, {&box, {}, 1.0F, 0.0F}));
    ASSERT_TRUE(one && many);
    EXPECT_EQ(one->mapCount(), many->mapCount());
    EXPECT_EQ(one->bytes(), many->bytes());
}

}  // namespace

RELIEF_INSTANTIATE_STEP_TESTS(WorldGlTest);
RELIEF_INSTANTIATE_GL_TESTS(WorldFieldGlTest);

}  // namespace relief
