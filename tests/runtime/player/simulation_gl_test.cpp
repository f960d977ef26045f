// SPDX-License-Identifier: Apache-2.0
// Played scenes: drops stay outside animated and thin colliders.
#include "runtime/events/event_recorder.h"
#include "runtime/player/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/glm.hpp>

#include "formats/container.h"
#include "runtime/scene/loaded_scene.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/runtime/live/animated_container.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

class SimulationGlTest : public GlTest {};
RELIEF_INSTANTIATE_GL_TESTS(SimulationGlTest);

TEST_P(SimulationGlTest, DropsStayOutsideAnimatedCharacters) {
    const test::TemporaryFolder folder;
    const AnimatedMesh mesh = bendingTube(24, 24);
    ASSERT_TRUE(saveCollider(folder.path() / "tube.relief", animatedContainer(mesh)));
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
    const auto loaded = required(loadAll(folder.write("scene.toml", scene), {}));
    auto made = required(Simulation::create(loaded));
    for (int step = 0; step < 90; ++step) {
        ASSERT_TRUE(made.step());
    }
    const auto particles = made.particles().readState();
    ASSERT_TRUE(particles);
    EXPECT_GT(particles->size(), 4000U);
    std::size_t hit = 0;
    std::size_t inside = 0;
    const double time = made.particles().time();
    for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<glm::vec3> positions = posed(mesh, loaded.played[i]->poseAt(time));
        for (const ParticleState& particle : *particles) {
            hit += particle.collisions > 0 ? 1 : 0;
            const glm::vec3 p = toObject(poseAt(loaded.scene.colliders[i], time), particle.position);
            // Only near the tube, because solid angles are slow.
            const bool near = glm::all(glm::lessThan(glm::abs(p - glm::vec3(0, 1, 0)), glm::vec3(1.3F)));
            inside += near && windingNumber(positions, mesh.triangles, p) > 0.5 ? 1 : 0;
        }
    }
    EXPECT_GT(hit, 100U);
    EXPECT_LE(inside, 5U) << "of " << particles->size();
    ASSERT_NE(made.mesh(1), nullptr);
    EXPECT_EQ(made.mesh(1)->triangleCount(), mesh.triangles.size());
}

// Event lists are as short as spawns can use, or long for a log: the particles are the same.
TEST_P(SimulationGlTest, HitLogsDoNotChangeBirths) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(saveCollider(folder.path() / "tube.relief", animatedContainer(bendingTube(12, 8))));
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
most = 60
lifetime = [0.2, 0.4]
[[spawn]]
on = "death"
parent = "drop"
type = "splash"
most = 30
)";
    const auto loaded = required(loadAll(folder.write("scene.toml", scene), {}));
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
        return std::pair(made.rejected(), made.particles().readState().value());
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
    const test::TemporaryFolder folder;
    const analytic::Shape floor = analytic::box({-2.0, -0.105, -2.0}, {2.0, 0.0, 2.0});
    ASSERT_TRUE(saveCollider(folder.path() / "floor.relief", analytic::frontBackCollider(floor, 64)));
    std::vector<Birth> births;
    for (int i = 0; i < 1000; ++i) {
        births.push_back({{0.0F, 1.0F + 0.001F * static_cast<float>(i), 0.0F}, {0.0F, -20.0F, 0.0F}, 9.0F});
    }
    const auto below = [&](const std::string& more, float dt, std::size_t warnings = 0) {
        const bool own = more.find("emitter") == std::string::npos;
        const auto loaded = loadAll(folder.write("scene.toml", R"(
collider = { file = "floor.relief" }
particles = { capacity = 1000 }
ground = { enabled = false }
forces = { gravity = [0, 0, 0], drag = 0 }
)" + more),
                                    {});
        EXPECT_TRUE(loaded) << loaded.error().message;
        auto made = Simulation::create(*loaded);
        EXPECT_TRUE(made) << made.error().message;
        EXPECT_TRUE(!own || made->spawn(births));
        for (float time = 0.0F; time < 2.0F; time += dt) {
            EXPECT_TRUE(made->step(dt));
        }
        EXPECT_EQ(made->takeWarnings().size(), warnings);
        const std::vector<ParticleState> particles = made->particles().readState().value();
        EXPECT_EQ(particles.size(), 1000U);
        return std::count_if(particles.begin(), particles.end(),
                             [](const ParticleState& one) { return one.position.y < -0.105F; });
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

// A former fault: a change of forces or types without new emitters left the sweep as it was.
TEST_P(SimulationGlTest, ChangedForcesAndTypesSetTheSweep) {
    const test::TemporaryFolder folder;
    const analytic::Shape floor = analytic::box({-2.0, -0.105, -2.0}, {2.0, 0.0, 2.0});
    ASSERT_TRUE(saveCollider(folder.path() / "floor.relief", analytic::frontBackCollider(floor, 64)));
    auto loaded = required(loadAll(folder.write("scene.toml", R"(
collider = { file = "floor.relief" }
particles = { capacity = 1000 }
ground = { enabled = false }
time = { dt = 0.02 }
forces = { gravity = [0, 0, 0], drag = 0 }
emitter = { box_min = [-1, 1, -1], box_max = [1, 2, 1], rate = 0, burst = 1000, lifetime = 9 }
)"),
                                   {}));
    auto made = required(Simulation::create(loaded));
    ASSERT_TRUE(made.step());
    loaded.scene.forces.gravity = glm::vec3(0.0F, -200.0F, 0.0F);
    ASSERT_TRUE(made.change(std::nullopt));
    for (int step = 0; step < 20; ++step) {
        ASSERT_TRUE(made.step());
    }
    for (const ParticleState& one : required(made.particles().readState())) {
        ASSERT_GT(one.position.y, -0.105F);
    }
}

}  // namespace
}  // namespace relief
