// Scenes with animated colliders, played: what rains on them stays outside.
#include "runtime/player/simulation.h"

#include <gtest/gtest.h>

#include <glm/glm.hpp>

#include "formats/container.h"
#include "runtime/scene/loaded_scene.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/runtime/collider/animated_container.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

class SimulationGlTest : public GlTest {};
RELIEF_INSTANTIATE_GL_TESTS(SimulationGlTest);

TEST_P(SimulationGlTest, DropsStayOutOfCharactersThatMove) {
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
axis = [0, 1, 0]
angle = 90
play = { clip = "bend", start = 1, speed = 0.5, resolution = 192 }
[[emitter]]
box_min = [-1.2, 2.3, -1.2]
box_max = [2.2, 2.5, 1.2]
rate = 6000
velocity = [0, -1, 0]
lifetime = [9, 9]
)";
    const auto loaded = loadAll(folder.write("scene.toml", scene), {});
    ASSERT_TRUE(loaded) << loaded.error().message;
    auto made = Simulation::create(*loaded);
    ASSERT_TRUE(made) << made.error().message;
    for (int step = 0; step < 90; ++step) {
        ASSERT_TRUE(made->step());
    }
    const auto particles = made->particles().readState();
    ASSERT_TRUE(particles);
    EXPECT_GT(particles->size(), 4000U);
    std::size_t hit = 0;
    std::size_t inside = 0;
    const double time = made->particles().time();
    for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<glm::vec3> positions = posed(mesh, loaded->played[i]->poseAt(time));
        for (const ParticleState& particle : *particles) {
            hit += particle.collisions > 0 ? 1 : 0;
            const glm::vec3 p = toObject(poseAt(loaded->scene.colliders[i], time), particle.position);
            // Only near it: solid angles are slow.
            const bool near = glm::all(glm::lessThan(glm::abs(p - glm::vec3(0, 1, 0)), glm::vec3(1.3F)));
            inside += near && windingNumber(positions, mesh.triangles, p) > 0.5 ? 1 : 0;
        }
    }
    EXPECT_GT(hit, 100U);
    EXPECT_LE(inside, 5U) << "of " << particles->size();
    ASSERT_NE(made->mesh(1), nullptr);
    EXPECT_EQ(made->mesh(1)->triangleCount(), mesh.triangles.size());
}

}  // namespace
}  // namespace relief
