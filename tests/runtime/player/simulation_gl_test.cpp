// SPDX-License-Identifier: Apache-2.0
// Played scenes: drops stay outside animated and thin colliders; and births on moving and deforming surfaces.
#include <gtest/gtest.h>
#include <algorithm>
#include <glm/glm.hpp>
#include <limits>

#include "formats/container.h"
#include "runtime/events/event_recorder.h"
#include "runtime/player/simulation.h"
#include "runtime/scene/loaded_scene.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/runtime/live/animated_container.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

class SimulationGlTest : public GlTest {
  protected:
    /// A scene without forces, above a floor with the thickness 0.105.
    LoadedScene floorScene(const std::string& more) {
        const analytic::Shape floor = analytic::box({-2.0, -0.105, -2.0}, {2.0, 0.0, 2.0});
        EXPECT_TRUE(saveCollider(folder_.path() / "floor.relief", analytic::frontBackCollider(floor, 64)));
        return required(loadAll(folder_.write("scene.toml", R"(
collider = { file = "floor.relief" }
particles = { capacity = 1000 }
ground = { enabled = false }
forces = { gravity = [0, 0, 0], drag = 0 }
)" + more),
                                {}));
    }
    static std::ptrdiff_t belowFloor(const Simulation& made) {
        const std::vector<ParticleState> particles = required(made.particles().readState());
        EXPECT_EQ(particles.size(), 1000U);
        return std::ranges::count_if(particles, [](const auto& one) { return !(one.position.y > -0.105F); });
    }

    const test::TemporaryFolder folder_;
};
RELIEF_INSTANTIATE_GL_TESTS(SimulationGlTest);

TEST_P(SimulationGlTest, DropsStayOutsideAnimatedCharacters) {
    const AnimatedMesh mesh = bendingTube(24, 24);
    ASSERT_TRUE(saveCollider(folder_.path() / "tube.relief", animatedContainer(mesh)));
    const std::string scene = R"(
time = { dt = 0.0166667, steps = 90 }
particles = { capacity = 8192 }
forces = { gravity = [0, -3, 0], drag = 0 }
collision = { restitution = 0.2, sweep = 0.02 }
[[collider]]
file = "tube.relief"
play = { clip = "bend", resolution = 192 }
[[collider]]
file = "tube.relief"
position = [1.5, 0, 0]
angle = 90
play = { clip = "bend", start = 1, speed = 0.5, resolution = 192 }
[emitter]
box_min = [-1.2, 2.3, -1.2]
box_max = [2.2, 2.5, 1.2]
rate = 6000
)";
    const auto loaded = required(loadAll(folder_.write("scene.toml", scene), {}));
    auto made = required(Simulation::create(loaded));
    for (int step = 0; step < 90; ++step) {
        ASSERT_TRUE(made.step());
    }
    const auto particles = required(made.particles().readState());
    EXPECT_GT(particles.size(), 4000U);
    std::size_t hit = 0;
    std::size_t inside = 0;
    const double time = made.particles().time();
    for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<glm::vec3> positions = posed(mesh, loaded.played[i]->poseAt(time));
        for (const ParticleState& particle : particles) {
            hit += particle.collisions > 0 ? 1 : 0;
            const glm::vec3 p = toObject(poseAt(loaded.scene.colliders[i], time), particle.position);
            // Only near the tube, because solid angles are slow.
            const bool near = glm::all(glm::lessThan(glm::abs(p - glm::vec3(0, 1, 0)), glm::vec3(1.3F)));
            inside += near && windingNumber(positions, mesh.triangles, p) > 0.5 ? 1 : 0;
        }
    }
    EXPECT_GT(hit, 100U);
    EXPECT_LE(inside, 5U) << "of " << particles.size();
    ASSERT_NE(made.mesh(1), nullptr);
    EXPECT_EQ(made.mesh(1)->triangleCount(), mesh.triangles.size());
}

// Event lists are as short as spawns can use, or long for a log: the particles are the same.
TEST_P(SimulationGlTest, HitLogsDoNotChangeBirths) {
    ASSERT_TRUE(saveCollider(folder_.path() / "tube.relief", animatedContainer(bendingTube(12, 8))));
    const std::string scene = R"(
time = { dt = 0.02, steps = 60, prewarm = 0.5 }
particles = { capacity = 20000 }
collider = { file = "tube.relief", play = { clip = "bend", resolution = 64 } }
emitter = { box_min = [-1.2, 2.3, -1.2], box_max = [1.2, 2.5, 1.2], rate = 4000, lifetime = 2, type = "drop" }
[[type]]
name = "drop"
on_collision = "die"
[[type]]
name = "splash"
collides_with = ["ground"]
[[spawn]]
on = "collision"
parent = "drop"
type = "splash"
count = [1, 3]
max_per_step = 60
lifetime = [0.2, 0.4]
[[spawn]]
on = "death"
parent = "drop"
type = "splash"
max_per_step = 30
)";
    const auto loaded = required(loadAll(folder_.write("scene.toml", scene), {}));
    const auto run = [&](bool log, std::size_t& longest) {
        auto made = required(Simulation::create(loaded));
        std::uint64_t next = 1;
        if (log) {
            EXPECT_TRUE(made.listHits(0.0F, [&](const StepEvents& events) -> Result<void> {
                EXPECT_EQ(events.tag, next++);
                longest = std::max(longest, events.events.size());
                return {};
            }));
        }
        for (int step = 0; step < 60; ++step) {
            EXPECT_TRUE(made.step());
        }
        EXPECT_TRUE(made.finishEvents());
        EXPECT_EQ(next, log ? 61U : 1U);
        EXPECT_GT(made.rejected(), 100U);
        return std::pair(made.rejected(), required(made.particles().readState()));
    };
    std::size_t longest = 0;
    const auto [rejected, plain] = run(false, longest);
    const auto [rejected_logged, logged] = run(true, longest);
    EXPECT_GT(longest, 60U) << "more events than spawns can use";
    EXPECT_EQ(rejected_logged, rejected);
    ASSERT_EQ(logged.size(), plain.size());
    std::size_t splashes = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        ASSERT_EQ(logged[i].id, plain[i].id);
        ASSERT_EQ(logged[i].position, plain[i].position);
        ASSERT_EQ(logged[i].velocity, plain[i].velocity);
        splashes += plain[i].type == 1 ? 1 : 0;
    }
    EXPECT_GT(splashes, 200U);
}

// Every host creates its simulation this way: relief-sim, the page's player and Python. A host may step by more than
// the scene's dt, and spawn its own particles.
TEST_P(SimulationGlTest, SweepsIfAStepExceedsTheColliderThickness) {
    std::vector<Birth> births;
    for (int i = 0; i < 1000; ++i) {
        births.push_back({{0.0F, 1.0F + 0.001F * static_cast<float>(i), 0.0F}, {0.0F, -20.0F, 0.0F}, 9.0F});
    }
    const auto below = [&](const std::string& more, float dt, std::size_t warnings = 0) {
        const bool own = more.find("emitter") == std::string::npos;
        const LoadedScene loaded = floorScene(more);
        auto made = required(Simulation::create(loaded));
        EXPECT_TRUE(!own || made.spawn(births));
        for (float time = 0.0F; time < 2.0F; time += dt) {
            EXPECT_TRUE(made.step(dt));
        }
        EXPECT_EQ(made.takeWarnings().size(), warnings);
        return belowFloor(made);
    };
    const auto emitter = [](float speed) {
        return "emitter = { box_min = [-1, 1, -1], box_max = [1, 2, 1], velocity = [0, -" +
               std::to_string(speed) + ", 0], rate = 0, burst = 1000, lifetime = 9 }\n";
    };
    EXPECT_GT(below("time = { dt = 0.02 }\ncollision = { sweep = 0 }\n" + emitter(20.0F), 0.02F, 1), 500);
    EXPECT_EQ(below("time = { dt = 0.02 }\n" + emitter(20.0F), 0.02F), 0);
    EXPECT_EQ(below("time = { dt = 0.005 }\n" + emitter(20.0F), 0.03F), 0) << "a longer step";
    EXPECT_EQ(below("time = { dt = 0.02 }\n", 0.02F), 0) << "births of the host";
    EXPECT_EQ(below("time = { dt = 0.02 }\n" + emitter(5.51F), 0.02F), 0)
        << "a step of 1.05 times the thickness";
    births[0] = {{0.0F, 3.0F, 0.0F}, {0.0F, -50.0F, 0.0F}, 9.0F, 1};
    EXPECT_EQ(below("time = { dt = 0.02 }\ntype = [{}, { radius = 0.4 }]\n", 0.02F), 0)
        << "with a larger, faster emitter";
}

constexpr double kDt = 1.0 / 50;

class SurfaceBirthsGlTest : public GlTest {
  protected:
    SurfaceBirthsGlTest() {
        EXPECT_TRUE(saveCollider(folder_.path() / "tube.relief", animatedContainer(mesh_)));
    }

    /// The particles after some steps of a scene in which a bending tube emits sparks.
    /// \param own  poses set by the program, equal to the clip's.
    std::vector<ParticleState> played(
        const std::string& emitter, int steps, bool collides = false, bool own = false,
        const std::string& collider =
            "play = { clip = \"bend\", start = 0.3, resolution = 192 }\nscale = 2\n"
            "key = [{ time = 0 }, { time = 2, position = [1, 0, 3], angle = 120 }]\n") {
        const std::string scene =
            "time = { dt = 0.02, steps = 60 }\nparticles = { capacity = 20000 }\n"
            "forces = { gravity = [0, 0, 0], drag = 0 }\nground = { enabled = false }\n[[type]]\n" +
            std::string(collides ? "" : "collides_with = []\n") + "[[collider]]\nfile = \"tube.relief\"\n" +
            collider + "[[emitter]]\nshape = \"surface\"\nattach = 0\nlifetime = 9\n" + emitter;
        loaded_ = std::make_unique<LoadedScene>(required(loadAll(folder_.write("scene.toml", scene), {})));
        auto made = required(Simulation::create(*loaded_));
        for (int step = 0; step < steps; ++step) {
            if (own) {
                const double end = made.particles().time() + double{loaded_->scene.time.dt};
                EXPECT_TRUE(made.setPose(0, loaded_->played[0]->poseAt(end)));
            }
            EXPECT_TRUE(made.step());
        }
        time_ = made.particles().time();
        return required(made.particles().readState());
    }

    /// The positions of the tube's vertices in the world.
    std::vector<glm::dvec3> tubeAt(double time) const {
        const Pose pose = poseAt(loaded_->scene.colliders[0], time);
        std::vector<glm::dvec3> out;
        for (const glm::vec3& p : posed(mesh_, loaded_->played[0]->poseAt(time))) {
            out.emplace_back(toWorld(pose, p));
        }
        return out;
    }
    /// The birth position. Without forces a spark flies straight, so it was born at its position minus age times
    /// velocity.
    static glm::dvec3 birthplace(const ParticleState& spark) {
        return glm::dvec3(spark.position) - double{spark.age} * glm::dvec3(spark.velocity);
    }
    const AnimatedMesh mesh_ = bendingTube(16, 20);
    const test::TemporaryFolder folder_;
    std::unique_ptr<LoadedScene> loaded_;
    double time_ = 0.0;
};
// The CPU computes births, so one API is enough; SimulationGlTest runs in both.
INSTANTIATE_TEST_SUITE_P(Api, SurfaceBirthsGlTest, testing::Values(GlApi::kGl33Core), glApiTestName);

double distanceTo(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) {
    const auto toSide = [&](const glm::dvec3& u, const glm::dvec3& v) {
        const double t = std::clamp(glm::dot(p - u, v - u) / glm::dot(v - u, v - u), 0.0, 1.0);
        return glm::length(u + t * (v - u) - p);
    };
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const bool over = glm::dot(glm::cross(b - a, p - a), n) >= 0 &&
                      glm::dot(glm::cross(c - b, p - b), n) >= 0 &&
                      glm::dot(glm::cross(a - c, p - c), n) >= 0;
    return over ? std::abs(glm::dot(p - a, n)) / glm::length(n)
                : std::min({toSide(a, b), toSide(b, c), toSide(c, a)});
}

double distanceTo(const std::vector<glm::dvec3>& at, const std::vector<glm::uvec3>& triangles,
                  const glm::dvec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const glm::uvec3& t : triangles) {
        least = std::min(least, distanceTo(at[t.x], at[t.y], at[t.z], p));
    }
    return least;
}

// Births by rate have their own times, between two poses.
TEST_P(SurfaceBirthsGlTest, LieOnTheSurfaceAtTheirOwnTime) {
    const std::vector<ParticleState> sparks = played("rate = 2000\nspeed = 0.5\n", 12);
    ASSERT_NEAR(static_cast<double>(sparks.size()), 480.0, 1.0);
    double worst = 0.0;
    double still = 0.0;
    for (const ParticleState& spark : sparks) {
        const double born = time_ - double{spark.age};
        const glm::dvec3 place = birthplace(spark);
        worst = std::max(worst, distanceTo(tubeAt(born), mesh_.triangles, place));
        still = std::max(still, distanceTo(tubeAt(born + 0.5 * kDt), mesh_.triangles, place));
    }
    // r (ω dt)² / 8 for the clip's 90° per second at an arm of 2.2.
    constexpr double kTurn = 1.5708;
    EXPECT_LT(worst, 2.2 * kTurn * kTurn * kDt * kDt / 8 + 2e-5);
    EXPECT_GT(still, 10 * worst) << "half a step later the surface has moved on";
}

// Poses of the program are a jump at first. After that they move like the same clip.
TEST_P(SurfaceBirthsGlTest, FollowPosesSetByTheProgram) {
    const std::string keys = "rate = 1000\nspeed = 0\ninherit = 1\nstart = 0.1\n";
    const std::vector<ParticleState> by_clip = played(keys, 12);
    const std::vector<ParticleState> by_program = played(keys, 12, false, true);
    ASSERT_GT(by_clip.size(), 100U);
    ASSERT_EQ(by_program.size(), by_clip.size());
    for (std::size_t i = 0; i < by_clip.size(); ++i) {
        ASSERT_EQ(by_program[i].position, by_clip[i].position) << i;
        ASSERT_EQ(by_program[i].velocity, by_clip[i].velocity) << i;
    }
}

// A clip whose end differs from its start jumps when it repeats: no spark is born on the way.
TEST_P(SurfaceBirthsGlTest, JumpsThrowNothing) {
    const std::vector<ParticleState> sparks =
        played("rate = 5000\nspeed = 0\ninherit = 1\n", 50, false, false,
               "play = { clip = \"grow\", start = 0.5, resolution = 64 }\n");
    ASSERT_GT(sparks.size(), 4900U);
    std::size_t still = 0;
    for (const ParticleState& spark : sparks) {
        // It grows by 0.1 in 1 s, so sparks move outwards at that speed, or slower on the lids.
        const glm::vec2 away(spark.position.x, spark.position.z);
        const glm::vec2 velocity(spark.velocity.x, spark.velocity.z);
        ASSERT_LE(glm::length(velocity), 0.1001F);
        ASSERT_GE(glm::dot(away, velocity), 0.0F);
        still += velocity == glm::vec2(0.0F) ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(still), 100.0, 2.0) << "births in the step of the jump";
}

TEST_P(SurfaceBirthsGlTest, StayOutsideTheirSurface) {
    const std::vector<ParticleState> sparks =
        played("rate = 5000\nspeed = 1\ninherit = 1\ncone = 30\n", 50, true);
    ASSERT_GT(sparks.size(), 4900U);
    std::vector<glm::vec3> positions;
    for (const glm::dvec3& p : tubeAt(time_)) {
        positions.emplace_back(p);
    }
    std::size_t inside = 0;
    for (const ParticleState& spark : sparks) {
        inside += windingNumber(positions, mesh_.triangles, glm::dvec3(spark.position)) > 0.5 ? 1 : 0;
    }
    EXPECT_LE(inside, sparks.size() / 1000) << "of " << sparks.size();
}

// A former fault: a change of forces or types without new emitters left the sweep as it was.
TEST_P(SimulationGlTest, ChangedForcesAndTypesSetTheSweep) {
    LoadedScene loaded = floorScene(R"(
time = { dt = 0.02 }
emitter = { box_min = [-1, 1, -1], box_max = [1, 2, 1], rate = 0, burst = 1000, lifetime = 9 }
)");
    auto made = required(Simulation::create(loaded));
    ASSERT_TRUE(made.step());
    loaded.scene.forces.gravity = glm::vec3(0.0F, -200.0F, 0.0F);
    ASSERT_TRUE(made.change(std::nullopt));
    for (int step = 0; step < 20; ++step) {
        ASSERT_TRUE(made.step());
    }
    EXPECT_EQ(belowFloor(made), 0);
}

}  // namespace
}  // namespace relief::test
