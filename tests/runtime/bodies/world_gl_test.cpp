// SPDX-License-Identifier: Apache-2.0
// Worlds of many bodies: the broad phase is bit-identical to testing every body, and finds moving bodies where they
// are. Also contact materials: thousands of drops on a checkerboard with closed-form squares, and material numbers.
#include <gtest/gtest.h>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "runtime/bodies/world_textures.h"
#include "runtime/events/event_recorder.h"
#include "runtime/particles/random.h"
#include "tests/formats/random_patches.h"
#include "tests/runtime/collider/field_query.h"
#include "tests/runtime/particles/collision_test.h"

namespace relief::test {
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

TEST_P(WorldFieldGlTest, ExchangeNamesTheDifference) {
    const Colliders colliders;
    const std::vector<ColliderBody> bodies = {{&colliders[2], {}}};
    WorldTextures textures = required(WorldTextures::create(bodies));
    Collider other = colliders[2];
    other.maps[0].empty_is_outside = !other.maps[0].empty_is_outside;
    expectError(textures.exchange(0, other, std::nullopt), ErrorCode::kUnsupported, "empty_is_outside");
    other = colliders[2];
    other.maps.push_back(other.maps[0]);
    expectError(textures.exchange(0, other, std::nullopt), ErrorCode::kUnsupported,
                "a single map of patches");
    EXPECT_TRUE(textures.exchange(0, colliders[2], std::nullopt));
}

TEST_P(WorldFieldGlTest, CollidersOfManyBodiesAreUploadedOnce) {
    const Collider box = boxCollider();
    const auto one = WorldTextures::create(std::vector<ColliderBody>(1, {&box, {}, 1.0F, 0.0F}));
    const auto many = WorldTextures::create(std::vector<ColliderBody>(1'000, {&box, {}, 1.0F, 0.0F}));
    ASSERT_TRUE(one && many);
    EXPECT_EQ(one->mapCount(), many->mapCount());
    EXPECT_EQ(one->bytes(), many->bytes());
}

constexpr int kLevels = 4;
constexpr float kSquare = 0.05F;  ///< side of a cell of the finest level

/// A fully split tree, in which each cell has the material of its centre.
Materials materialsBy(std::vector<Material> list, const std::function<std::size_t(const glm::vec3&)>& at) {
    Materials made;
    made.list = std::move(list);
    made.size = std::ldexp(kSquare, kLevels);
    made.origin = glm::vec3(-0.4F);
    struct Cell {
        glm::vec3 corner;
        float size;
    };
    std::vector<Cell> level{{made.origin, made.size}};
    std::size_t next = 1;
    for (int depth = 1; depth <= kLevels; ++depth) {
        std::vector<Cell> below;
        for (const Cell& cell : level) {
            MaterialNode& node = made.nodes.emplace_back();
            const float half = 0.5F * cell.size;
            for (std::size_t octant = 0; octant < 8; ++octant) {
                const glm::vec3 corner =
                    cell.corner + half * glm::vec3(octant & 1U, octant >> 1U & 1U, octant >> 2U & 1U);
                below.push_back({corner, half});
                node.leaves[octant] =
                    depth < kLevels ? 0 : static_cast<std::uint8_t>(at(corner + 0.5F * half));
            }
            if (depth < kLevels) {
                node.head = static_cast<std::uint32_t>(next) << 8U | 0xFFU;
                next += 8;
            }
        }
        level = std::move(below);
    }
    EXPECT_EQ(faultOfMaterials(made), "");
    return made;
}

std::size_t squareOf(const glm::vec3& p) {
    return static_cast<std::size_t>(
        (static_cast<int>(std::floor(p.x / kSquare)) + static_cast<int>(std::floor(p.z / kSquare))) & 1);
}

float toLine(float x) {
    const float q = x / kSquare;
    return kSquare * std::abs(q - std::round(q));
}

class MaterialsGlTest : public CollisionTest {
  protected:
    Collider board_ = [] {
        Collider box = boxCollider();
        box.materials = materialsBy({{"black"}, {"white"}}, squareOf);
        return box;
    }();
};

TEST_P(MaterialsGlTest, HitsHaveTheMaterialOfTheirSquare) {
    for (const bool placed : {false, true}) {
        for (const float sweep : {0.0F, 0.05F}) {
            SCOPED_TRACE(std::string(placed ? "placed" : "in its own space") +
                         (sweep > 0.0F ? ", swept" : ""));
            const Pose pose =
                placed ? Pose{{1.0F, -2.0F, 0.5F}, turn({0.2F, 1.0F, 0.1F}, 0.7F), 2.0F} : Pose{};
            make({.capacity = 4000});
            ASSERT_TRUE(particles_->setSweep(sweep));
            const ColliderBody body{&board_, pose};
            collideWith(placed ? WorldTextures::create(std::span(&body, 1)) : WorldTextures::create(board_));
            ASSERT_EQ(textures_->materialNames().size(), 2U);
            ASSERT_TRUE(setEvents(*particles_, EventOptions{}));
            Pcg32 random(11);
            spawnMany(4000, [&](std::uint32_t) {
                const glm::vec3 from = randomIn(random, {-0.39F, 0.21F, -0.29F}, {0.39F, 0.21F, 0.29F});
                return Birth{toWorld(pose, from), pose.rotation * glm::vec3(0.0F, -3.0F, 0.0F), 100.0F};
            });
            step();
            int counted = 0;
            for (const ParticleEvent& hit : takeEvents().events) {
                const glm::vec3 object = toObject(pose, hit.position);
                // On top, away from the lines.
                if (hit.body != 0 || object.y < 0.19F || toLine(object.x) < 0.004F ||
                    toLine(object.z) < 0.004F) {
                    continue;
                }
                ++counted;
                ASSERT_GE(hit.material, 0);
                ASSERT_EQ(textures_->materialNames()[static_cast<std::size_t>(hit.material)],
                          squareOf(object) == 0 ? "black" : "white");
            }
            EXPECT_GT(counted, 2000);
        }
    }
}

TEST_P(MaterialsGlTest, HitsCanBeFilteredByMaterial) {
    make({.capacity = 4000});
    collideWith(board_);
    EXPECT_TRUE(particles_->setGround(-0.05F));
    const std::vector<EventOptions> lists{{.deaths = true},
                                          {.deaths = true, .material = -1},
                                          {.deaths = true, .material = 0},
                                          {.deaths = true, .material = 1}};
    ASSERT_TRUE(setEvents(*particles_, lists));
    Pcg32 random(12);
    spawnMany(3000, [&](std::uint32_t i) {
        // On the board, beside it on the ground, and old particles that die.
        glm::vec3 from = randomIn(random, {-0.39F, 0.21F, -0.29F}, {0.39F, 0.21F, 0.29F});
        from = i % 3 == 0 ? glm::vec3(from.x + 1.0F, -0.04F, from.z) : from;
        return Birth{from, {0.0F, -3.0F, 0.0F}, i % 7 == 0 ? 0.5F * kDt : 100.0F};
    });
    step();
    const StepEvents events = takeEvents();
    for (std::size_t list = 1; list < lists.size(); ++list) {
        const std::span<const ParticleEvent> got = events.of(list);
        std::size_t listed = 0;
        for (const ParticleEvent& event : events.of(0)) {
            if (event.death || event.material == lists[list].material) {
                ASSERT_LT(listed, got.size());
                EXPECT_EQ(got[listed++].id, event.id) << list;
            }
        }
        EXPECT_EQ(listed, got.size());
        EXPECT_GT(listed, 500U);
        EXPECT_LT(listed, events.of(0).size() - 500);
    }
}

TEST_P(MaterialsGlTest, MaterialNumbersAreSharedByColliders) {
    const Collider plain = boxCollider();
    Collider other = boxCollider();
    other.materials.list = {{"white"}};
    const std::array<ColliderBody, 4> bodies{{{&plain, {{0.0F, 0.0F, 0.0F}}},
                                              {&board_, {{10.0F, 0.0F, 0.0F}}},
                                              {&other, {{20.0F, 0.0F, 0.0F}}},
                                              {&board_, {{30.0F, 0.0F, 0.0F}}}}};
    make({.capacity = 16});
    collideWith(WorldTextures::create(bodies));
    ASSERT_EQ(textures_->materialNames().size(), 2U);
    EXPECT_EQ(textures_->materialNames()[0], "black");
    EXPECT_EQ(textures_->materialNames()[1], "white");
    ASSERT_TRUE(particles_->setGround(-5.0F));
    ASSERT_TRUE(setEvents(*particles_, EventOptions{}));
    struct Case {
        glm::vec3 from;  // beside the centre of a black square
        int body, material;
    };
    const Case cases[] = {{{0.0F, 0.0F, 0.0F}, 0, -1},
                          {{10.0F, 0.0F, 0.0F}, 1, 0},
                          {{20.0F, 0.0F, 0.0F}, 2, 1},
                          {{30.0F, 0.0F, kSquare}, 3, 1},
                          {{40.0F, -5.2F, 0.0F}, -1, -1}};
    const glm::vec3 black(0.525F * kSquare, 0.201F, 0.525F * kSquare);
    for (const Case& one : cases) {
        spawnOne({black + one.from, {0.0F, -1.0F, 0.0F}, 9.0F, 0});
    }
    step();
    const std::vector<ParticleEvent> got = takeEvents().events;
    ASSERT_EQ(got.size(), std::size(cases));
    for (std::size_t i = 0; i < got.size(); ++i) {
        EXPECT_EQ(got[i].body, cases[i].body) << i;
        EXPECT_EQ(got[i].material, cases[i].material) << i;
        EXPECT_TRUE(got[i].hit && !got[i].lasts && !got[i].death);
        EXPECT_LT(glm::length(got[i].normal - glm::vec3(0.0F, 1.0F, 0.0F)), 1e-3F);
    }
}

// The responses multiply those of the particle type and of the body.
TEST_P(MaterialsGlTest, ResponsesMultiply) {
    board_.materials.list = {{"black", 0.5F, 0.0F}, {"white", 1.0F, 0.75F}};
    make({.capacity = 4});
    collideWith(ColliderBody{&board_, {}, 0.8F, 0.0F});
    setType({.restitution = 0.5F, .friction = 0.5F});
    ASSERT_TRUE(particles_->setForces({.gravity = glm::vec3(0.0F)}));
    const glm::vec3 black(0.5F * kSquare, 0.201F, 0.5F * kSquare);
    const glm::vec3 v(0.1F, -1.0F, 0.0F);
    spawnOne({black, v, 9.0F, 0});
    spawnOne({black + glm::vec3(0.0F, 0.0F, kSquare), v, 9.0F, 0});
    step();
    const auto after = state();
    ASSERT_EQ(after.size(), 2U);
    EXPECT_NEAR(after[0].velocity.y, 0.5F * 0.8F * 0.5F, 1e-3F);
    EXPECT_NEAR(after[0].velocity.x, 0.1F * 0.5F, 1e-3F);
    EXPECT_NEAR(after[1].velocity.y, 0.5F * 0.8F, 1e-3F);
    EXPECT_NEAR(after[1].velocity.x, 0.1F * 0.5F * 0.25F, 1e-3F);
}

// A contact reduces the lifetime by the losses of the material and the type. A particle that stopped dies that much
// earlier; a sliding particle loses as much in each step.
TEST_P(MaterialsGlTest, ContactsReduceLifetime) {
    board_.materials.list = {{"black", 1.0F, 0.0F, 3.0F}, {"white", 1.0F, 0.0F, 500.0F}};
    constexpr int kLife = 600;  // steps in a lifetime of ten seconds
    const auto expectSteps = [&](OnCollision reaction, float type_loss, float square, int lived) {
        SCOPED_TRACE(lived);
        make({.capacity = 4});
        collideWith(ColliderBody{&board_, {}});
        setType({.on_collision = reaction, .lifetime_loss = type_loss});
        ASSERT_TRUE(particles_->setForces({.gravity = {0.0F, -9.81F, 0.0F}}));
        spawnOne({{0.5F * kSquare, 0.201F, (0.5F + square) * kSquare}, {0.0F, -1.0F, 0.0F}, 9.999F});
        int steps = 0;
        while (steps < kLife + 10 && (steps == 0 || !state().empty())) {
            step();
            ++steps;
        }
        EXPECT_NEAR(steps, lived, 2);
    };
    expectSteps(OnCollision::kStop, 0.0F, 0.0F, kLife - 180);
    expectSteps(OnCollision::kStop, 1.0F, 0.0F, kLife - 240);
    expectSteps(OnCollision::kStop, 0.0F, 1.0F, 2);
    expectSteps(OnCollision::kSlide, 0.0F, 0.0F, 4);
}

RELIEF_INSTANTIATE_STEP_TESTS(MaterialsGlTest);

}  // namespace

RELIEF_INSTANTIATE_STEP_TESTS(WorldGlTest);
RELIEF_INSTANTIATE_GL_TESTS(WorldFieldGlTest);

}  // namespace relief::test
