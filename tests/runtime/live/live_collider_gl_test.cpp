// SPDX-License-Identifier: Apache-2.0
// Deforming colliders: their maps against the CPU's field of the same texels and against closed forms, the velocity of
// surfaces that hit particles, and meshes in constant motion.
#include "runtime/bodies/world_textures.h"
#include "runtime/live/live_collider.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "runtime/gl/gl_functions.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/runtime/collider/field_query.h"
#include "tests/runtime/depth_maps/read_texels.h"
#include "tests/runtime/gl/caller_state.h"
#include "tests/runtime/particles/collision_test.h"

namespace relief {
namespace {

/// \param levels  number of times that each triangle is split into four.
AnimatedMesh box(const glm::vec3& half, int levels = 0) {
    AnimatedMesh mesh = movingBox(half);
    for (int level = 0; level < levels; ++level) {
        std::vector<glm::uvec3> parts;
        for (const glm::uvec3& t : mesh.triangles) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (int k = 0; k < 3; ++k) {
                mesh.positions.push_back(0.5F * (mesh.positions[t[k]] + mesh.positions[t[(k + 1) % 3]]));
            }
            parts.insert(parts.end(), {{t.x, first, first + 2},
                                       {first, t.y, first + 1},
                                       {first + 2, first + 1, t.z},
                                       {first, first + 1, first + 2}});
        }
        mesh.triangles = std::move(parts);
    }
    return mesh;
}

AnimatedMesh sphere(float radius) {
    AnimatedMesh mesh = box(glm::vec3(1.0F), 4);
    for (glm::vec3& p : mesh.positions) {
        p = radius * glm::normalize(p);
    }
    return mesh;
}

std::vector<glm::vec3> moved(const AnimatedMesh& mesh, const glm::vec3& by) {
    std::vector<glm::vec3> positions = mesh.positions;
    for (glm::vec3& p : positions) {
        p += by;
    }
    return positions;
}

Bounds cube(float half) {
    return {glm::vec3(-half), glm::vec3(half)};
}

class LiveColliderGlTest : public CollisionTest {
  protected:
    void makeLive(const AnimatedMesh& mesh, const Bounds& box, std::uint32_t resolution,
                  const Pose& pose = {}) {
        auto live = LiveCollider::create(mesh.positions, mesh.triangles, liveMaps(box, resolution).value());
        ASSERT_TRUE(live) << live.error().message;
        live_.emplace(std::move(*live));
        const ColliderBody body{.collider = &live_->frames(), .pose = pose, .live = true};
        textures_ = std::make_unique<WorldTextures>(WorldTextures::create({&body, 1}).value());
        update();
    }
    void update() {
        const auto done = live_->update(*textures_, 0);
        ASSERT_TRUE(done) << done.error().message;
    }
    void goTo(std::span<const glm::vec3> positions) {
        ASSERT_TRUE(live_->setPositions(positions));
        update();
    }
    void particlesOf(const ParticleSystemOptions& options, const ParticleType& type) {
        make(options);
        setType(type);
        ASSERT_TRUE(particles_->setCollider(textures_.get()));
    }
    void oneParticle(const ParticleType& type, const glm::vec3& position, const glm::vec3& velocity = {},
                     Integrator integrator = Integrator::kEuler) {
        particlesOf({.capacity = 16, .integrator = integrator}, type);
        spawnOne({position, velocity, 100.0F, 0});
    }

    const AnimatedMesh plate_ = box({0.4F, 0.05F, 0.4F});
    std::optional<LiveCollider> live_;
};
RELIEF_INSTANTIATE_STEP_TESTS(LiveColliderGlTest);

std::vector<glm::vec3> randomPoints(std::size_t count, float half) {
    Pcg32 random(5);
    std::vector<glm::vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        points.push_back(randomIn(random, half));
    }
    return points;
}

// The shader's field of the live rectangles matches the CPU's field of the same maps, rendered one by one and read
// back. The shape is a sphere.
TEST_P(LiveColliderGlTest, MapsMatchAStaticRenderingOfTheMesh) {
    const AnimatedMesh mesh = sphere(0.5F);
    auto gpu_mesh = GpuMesh::create(mesh.positions, mesh.triangles);
    const auto renderer = DepthMapRenderer::create(96, 96);
    ASSERT_TRUE(gpu_mesh && renderer);
    const std::vector<glm::vec3> points = randomPoints(20'000, 0.7F);
    makeLive(mesh, cube(0.6F), 96);
    Collider baked = live_->frames();
    for (DepthMap& map : baked.maps) {
        renderer->render(*gpu_mesh, map);
        map.texels = readTexels(*renderer);
    }
    const std::vector<FieldSample> live = fieldOf(*textures_, points);
    std::size_t inside = 0;
    std::size_t other = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const FieldSample cpu = evaluate(baked, points[i]);
        const bool same =
            cpu.inside() == live[i].inside() &&
            (cpu.distance >= 1e29F || std::abs(cpu.distance - live[i].distance) < 1.2F / 65534.0F);
        other += same ? 0 : 1;
        inside += live[i].inside() ? 1 : 0;
        // To within a texel's sagitta, away from silhouettes.
        const float truth = glm::length(points[i]) - 0.5F;
        if (std::abs(truth) > 0.02F) {
            EXPECT_EQ(live[i].inside(), truth < 0.0F) << i << " " << truth;
        }
    }
    EXPECT_LE(other, 20U);  // the CPU may select the other texel at a border
    EXPECT_GT(inside, 2000U);
}

// Closed form: a plate that rises with speed w hits a particle at rest, which leaves with (1 + e) w.
TEST_P(LiveColliderGlTest, RisingPlatesThrowParticles) {
    constexpr float kSpeed = 0.6F;  // 0.01 units per step
    struct Case {
        float restitution;
        Integrator integrator;
        bool shows_motion;
    };
    for (const auto& [restitution, integrator, shows_motion] :
         {Case{0.0F, Integrator::kEuler, true}, Case{0.5F, Integrator::kEuler, true},
          Case{1.0F, Integrator::kVerlet, true}, Case{0.5F, Integrator::kEuler, false}}) {
        makeLive(plate_, cube(0.6F), 128);
        oneParticle({.restitution = restitution}, {0.1F, 0.104F, -0.07F}, {}, integrator);
        for (int step = 1; step <= 6; ++step) {
            ASSERT_TRUE(
                live_->setPositions(moved(plate_, {0.0F, kSpeed * kDt * static_cast<float>(step), 0.0F})));
            if (!shows_motion) {
                live_->settle();
            }
            update();
            particles_->step(kDt);
            EXPECT_EQ(state().at(0).collisions > 0, step == 6) << step;
        }
        // Without motion, the same plate catches the particle and does not move it.
        const ParticleState after = state().at(0);
        EXPECT_EQ(after.contact, shows_motion ? Contact::kCollided : Contact::kCaught);
        EXPECT_NEAR(after.velocity.y, shows_motion ? (1.0F + restitution) * kSpeed : 0.0F, 0.01F * kSpeed);
        EXPECT_NEAR(after.velocity.x, 0.0F, 1e-3F);
    }
}

// The same with a pose: the plate is upright, scaled by 2, and pushes along −x.
TEST_P(LiveColliderGlTest, PosesRotateTheMotion) {
    makeLive(plate_, cube(0.6F), 128,
             {{0.3F, 1.0F, 0.0F}, turn({0.0F, 0.0F, 1.0F}, glm::radians(90.0F)), 2.0F});
    // The plate's top, y = 0.05, is at x = 0.3 − 0.1 in the world.
    oneParticle({.restitution = 0.5F}, {0.185F, 1.1F, 0.2F});
    goTo(moved(plate_, {0.0F, 0.02F, 0.0F}));  // more than a texel
    particles_->step(kDt);
    const ParticleState after = state().at(0);
    EXPECT_EQ(after.contact, Contact::kCollided);
    EXPECT_NEAR(after.velocity.x, -1.5F * 0.04F / kDt, 0.02F);
    EXPECT_NEAR(after.velocity.y, 0.0F, 1e-3F);
}

TEST_P(LiveColliderGlTest, StoppedMeshesMoveNothing) {
    makeLive(plate_, cube(0.6F), 64);
    goTo(moved(plate_, {0.0F, 0.1F, 0.0F}));
    const std::uint64_t moving = textures_->revision();
    update();  // at rest now
    const std::uint64_t resting = textures_->revision();
    EXPECT_NE(resting, moving);
    update();
    EXPECT_EQ(textures_->revision(), resting) << "a resting mesh causes no update";
    oneParticle({}, {0.0F, 0.152F, 0.0F}, {0.0F, -0.3F, 0.0F});
    particles_->step(kDt);
    EXPECT_EQ(state().at(0).contact, Contact::kCollided);
    EXPECT_NEAR(state().at(0).velocity.y, 0.0F, 1e-6F);
}

TEST_P(LiveColliderGlTest, StoppedParticlesFollowTheSurface) {
    makeLive(plate_, cube(0.6F), 64);
    oneParticle({.on_collision = OnCollision::kStop}, {0.05F, 0.052F, 0.1F}, {0.0F, -0.3F, 0.0F});
    particles_->step(kDt);
    ASSERT_EQ(state().at(0).contact, Contact::kStopped);
    const glm::vec3 begin = state().at(0).position;
    glm::vec3 way(0.0F);
    for (int step = 1; step <= 20; ++step) {
        way = {0.004F * static_cast<float>(step), 0.006F * static_cast<float>(step), 0.0F};
        goTo(moved(plate_, way));
        particles_->step(kDt);
    }
    EXPECT_LE(glm::length(state().at(0).position - begin - way), 1e-4F);
}

// Drops at rest in the path of a box that is translated, scaled or rotated by its vertices. Each update draws its
// silhouette into other texels, up to half a texel off. Every drop that the box passes over by more than a texel's
// diagonal is still hit.
TEST_P(LiveColliderGlTest, PassedParticlesAreHit) {
    constexpr int kSteps = 12;
    constexpr std::uint32_t kDrops = 2048;
    const float texel = std::sqrt(2.0F) * 1.03F / 62.0F;
    const AnimatedMesh mesh = box({0.3F, 0.2F, 0.08F});
    struct Case {
        float way, angle, growth, radius;
    };
    for (const Case& c :
         {Case{0.7F, 0.0F, 0.0F, 0.0F}, Case{0.0F, 0.0F, 0.6F, 0.0F}, Case{0.0F, 1.2F, 0.0F, 0.015F}}) {
        const auto poseAt = [&](int step) {
            const float t = static_cast<float>(step) / kSteps;
            return Pose{{0.0F, 0.0F, c.way * (t - 0.5F)}, turn({0, 1, 0}, c.angle * t), 1.0F + c.growth * t};
        };
        const auto depth = [&](const glm::vec3& p, int step) {
            const glm::vec3 q = glm::vec3(0.3F, 0.2F, 0.08F) - glm::abs(toObject(poseAt(step), p));
            return poseAt(step).scale * std::min({q.x, q.y, q.z});
        };
        const auto positionsAt = [&](int step) {
            std::vector<glm::vec3> positions = mesh.positions;
            for (glm::vec3& p : positions) {
                p = toWorld(poseAt(step), p);
            }
            return positions;
        };
        AnimatedMesh first = mesh;
        first.positions = positionsAt(0);
        makeLive(first, cube(0.5F), 64);
        particlesOf({.capacity = kDrops}, {.radius = c.radius, .on_collision = OnCollision::kDie});
        Pcg32 random(11);
        std::size_t met = 0;
        spawnMany(kDrops, [&](std::uint32_t) {
            glm::vec3 p(0.0F);
            while (depth(p, 0) > -c.radius - texel) {
                p = randomIn(random, 0.45F);
            }
            float deepest = -1.0F;
            for (int step = 1; step <= kSteps; ++step) {
                deepest = std::max(deepest, depth(p, step));
            }
            met += deepest > texel ? 1 : 0;
            return Birth{p, glm::vec3(0.0F), 1000.0F, 0};
        });
        EXPECT_GT(met, 30U);
        for (int step = 1; step <= kSteps; ++step) {
            goTo(positionsAt(step));
            particles_->step(kDt);
        }
        const std::vector<ParticleState> left = state();
        EXPECT_EQ(std::count_if(left.begin(), left.end(), [](const auto& p) { return p.collisions > 0; }), 0)
            << "of " << met << " were caught";
        EXPECT_LE(left.size(), kDrops - met);
    }
}

// Positions from a span equal those from a caller's buffer with an offset, for any caller state, which is kept.
TEST_P(LiveColliderGlTest, PositionsMayComeFromACallerBuffer) {
    const AnimatedMesh mesh = sphere(0.3F);
    const std::vector<glm::vec3> points = randomPoints(5000, 0.6F);
    makeLive(mesh, cube(0.6F), 64);
    const std::vector<glm::vec3> positions = moved(mesh, {0.1F, -0.05F, 0.2F});
    goTo(positions);
    const std::vector<FieldSample> by_span = fieldOf(*textures_, points);

    const std::size_t bytes = positions.size() * sizeof(glm::vec3);
    const GlBuffer buffer = makeBuffer();
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes + 28), nullptr, GL_STATIC_DRAW);
    glBufferSubData(GL_ARRAY_BUFFER, 28, static_cast<GLsizeiptr>(bytes), positions.data());
    const CallerState caller;
    makeLive(mesh, cube(0.6F), 64);
    caller.expectKept("create");
    ASSERT_TRUE(live_->setPositions(buffer.name(), 28));
    caller.expectKept("setPositions");
    update();
    caller.expectKept("update");
    const std::vector<FieldSample> by_buffer = fieldOf(*textures_, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(by_span[i].distance, by_buffer[i].distance);
        EXPECT_EQ(by_span[i].map, by_buffer[i].map);
    }
}

// A live body beside a static one, with another layout and with the same: each has the field that it has on its own.
TEST_P(LiveColliderGlTest, WorksBesideStaticBodies) {
    const AnimatedMesh mesh = sphere(0.3F);
    auto live = LiveCollider::create(mesh.positions, mesh.triangles, liveMaps(cube(0.5F), 64).value());
    ASSERT_TRUE(live) << live.error().message;
    const Collider half = analytic::frontBackCollider(analytic::sphere({0, 0, 0}, 0.25), 48);
    Collider single;
    single.bounds = half.bounds;
    single.maps.push_back(analytic::orthographicMap(analytic::box({-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}),
                                                    MapFormat::kFloat32, Compare::kLess, {1, false}, 40));
    const std::array<ColliderBody, 3> bodies{ColliderBody{.collider = &half, .pose = {{-1.0F, 0.0F, 0.0F}}},
                                             ColliderBody{.collider = &live->frames(), .live = true},
                                             ColliderBody{.collider = &single, .pose = {{1.0F, 0.0F, 0.0F}}}};
    auto textures = required(WorldTextures::create(bodies));
    EXPECT_FALSE(live->update(textures, 0));
    EXPECT_FALSE(live->update(textures, 3));
    ASSERT_TRUE(live->update(textures, 1));
    const std::vector<glm::vec3> points = randomPoints(20'000, 1.4F);
    const std::vector<FieldSample> samples = fieldOf(textures, points);
    std::array<std::size_t, 3> inside{};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::vec3 p = points[i];
        const glm::vec3 q = glm::abs(p - glm::vec3(1, 0, 0));
        const std::array<float, 3> truths{glm::length(p + glm::vec3(1, 0, 0)) - 0.25F, glm::length(p) - 0.3F,
                                          std::max({q.x, q.y, q.z}) - 0.2F};
        const float truth = *std::ranges::min_element(truths);
        if (std::abs(truth) > 0.03F) {
            EXPECT_EQ(samples[i].inside(), truth < 0.0F) << p.x << " " << p.y << " " << p.z;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            inside[k] += truths[k] < 0.0F ? 1 : 0;
        }
    }
    EXPECT_GT(*std::ranges::min_element(inside), 30U);
}

using LiveArgumentsGlTest = LiveColliderGlTest;
RELIEF_INSTANTIATE_STEP_TESTS_ONCE(LiveArgumentsGlTest);

TEST_P(LiveArgumentsGlTest, MisuseIsRejected) {
    const AnimatedMesh& plate = plate_;
    makeLive(plate, cube(0.5F), 32);
    EXPECT_EQ(live_->setPositions(moved(plate, {0.0F, 0.6F, 0.0F})).error().code, ErrorCode::kUsage)
        << "outside the box";
    ASSERT_TRUE(live_->setPositions(moved(plate, {0.0F, 0.1F, 0.0F})));
    EXPECT_EQ(live_->setPositions(plate.positions).error().code, ErrorCode::kUsage) << "twice";
    update();
    EXPECT_FALSE(live_->setPositions(std::span(plate.positions).first(3)));
    EXPECT_FALSE(live_->setPositions(GLuint{0}));
    EXPECT_FALSE(LiveCollider::create(plate.positions, plate.triangles, {}));
    Collider other = *liveMaps(cube(0.5F), 32);
    other.maps[1].format = MapFormat::kFrontBackHalf;
    EXPECT_FALSE(LiveCollider::create(plate.positions, plate.triangles, other));
    EXPECT_FALSE(liveMaps(cube(0.5F), 2));
    EXPECT_FALSE(liveMaps({}, 64));
    EXPECT_FALSE(liveMaps({glm::vec3(1.0F), glm::vec3(1.0F)}, 64));
}

}  // namespace
}  // namespace relief
