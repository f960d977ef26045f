// SPDX-License-Identifier: Apache-2.0
// Baked colliders of patches beside maps and cubes: shader and CPU give the same field.
#include <random>

#include "tests/bake/meshes.h"
#include "tests/runtime/collider/field_agreement.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

class HybridGlTest : public GlTest {};

TEST_P(HybridGlTest, PatchesBesideOtherMapsMatchTheCpu) {
    const glm::dmat3 turn = test::rotation({1, 2, 3}, 40.0);
    const TriangleMesh mesh =
        test::joined({test::makeTorusMesh(1.0, 0.35, 96, 48), test::makeIcosphere({0, 0, 0.9}, 0.3, 4),
                      test::makeBoxMesh({0.1, 0.2, -0.9}, {0.9, 0.3, 0.2}, turn)});
    const std::vector<std::vector<std::string>> bakes = {
        {"patches:budget=60kB", "front-back:dir=-z,size=64"},
        {"cube:size=32", "patches:budget=200kB"},
        {"front-back:dir=-x,size=48,decode=plane", "patches:budget=100kB", "cube:size=24,decode=plane",
         "fixed8:dir=0.3/-1/0.2,size=40"},
    };
    for (const std::vector<std::string>& specs : bakes) {
        SCOPED_TRACE(specs[0]);
        const Collider collider = test::bakeSpecs(mesh, specs);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
        std::vector<glm::vec3> points(100'000);
        for (glm::vec3& p : points) {
            p = 1.1F * glm::vec3(1.4F * unit(random), 1.4F * unit(random), 1.3F * unit(random));
        }
        expectAgreement(collider, points, 1.0F / 60.0F, 5e-3);
    }
}

RELIEF_INSTANTIATE_GL_TESTS(HybridGlTest);

}  // namespace
}  // namespace relief
