// SPDX-License-Identifier: Apache-2.0
// Surface emitters: their area, and invalid surfaces.
#include "runtime/scene/scene_births.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "formats/container.h"
#include "runtime/scene/loaded_scene.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/results.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/live/animated_container.h"
#include "tests/runtime/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

const std::string kCollider = "[[collider]]\nfile = \"tube.relief\"\n";
const std::string kPlayed = kCollider + "play = { clip = \"bend\", start = 0.5 }\n";
const std::string kSurface = "[[emitter]]\nshape = \"surface\"\n";

double areaOf(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles) {
    double area = 0.0;
    for (const glm::uvec3& t : triangles) {
        const glm::dvec3 p(positions[t.x]);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(positions[t.y]) - p, glm::dvec3(positions[t.z]) - p));
    }
    return area;
}

class SceneSurface : public testing::Test {
  protected:
    SceneSurface() {
        EXPECT_TRUE(saveCollider(folder_.path() / "tube.relief", animatedContainer(mesh_)));
        folder_.write(
            "cube.obj",
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
            "f 4 3 2 1\no shell\nusemtl wood\nf 5 6 7 8\ng lid top\nusemtl iron\nf 4 8 7 3\nf 1 2 6 5\n");
    }
    Result<LoadedScene> load(const std::string& text) {
        return loadAll(folder_.write("scene.toml", text), {});
    }
    double area(const std::string& text) {
        const auto loaded = load(text);
        EXPECT_TRUE(loaded) << loaded.error().message;
        return loaded ? loaded->emitters.at(0).settings().surface->area() : 0.0;
    }
    void expectRefused(const std::string& text, const std::string& place, const std::string& words) {
        expectErrorOf(load(text), "scene.toml:" + place + ": ", words);
    }

    const AnimatedMesh mesh_ = tubeWithMaterials("cloth", "skin");
    const test::TemporaryFolder folder_;
};

TEST_F(SceneSurface, SelectsGroupsAndMaterials) {
    const std::vector<glm::vec3> bent = posed(mesh_, poseAt(mesh_, mesh_.clips[0], 0.5));
    EXPECT_NEAR(area(kPlayed + kSurface + "attach = 0\n"), areaOf(bent, mesh_.triangles), 1e-6);
    EXPECT_NEAR(area(kCollider + kSurface + "attach = 0\n"), areaOf(mesh_.positions, mesh_.triangles), 1e-6)
        << "at rest";
    EXPECT_GT(std::abs(areaOf(bent, mesh_.triangles) - areaOf(mesh_.positions, mesh_.triangles)), 1e-3);
    double skin = 0.0;
    double upper = 0.0;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
        const glm::uvec3& t = mesh_.triangles[i];
        const double own = areaOf(mesh_.positions, {t});
        skin += mesh_.triangle_materials[i] == 1 ? own : 0.0;
        for (int corner = 0; corner < 3; ++corner) {
            // The joint weight that the tube is made with.
            const float y = mesh_.positions[t[corner]].y;
            upper += own / 3.0 * double{std::clamp((y / 2.0F - 0.5F) * 3.0F + 0.5F, 0.0F, 1.0F)};
        }
    }
    const std::string head = kCollider + kSurface + "attach = 0\n";
    EXPECT_NEAR(area(head + "material = \"skin\"\n"), skin, 1e-6);
    EXPECT_NEAR(area(head + "group = \"middle\"\n"), upper, 1e-6);
    const double both = area(head + "group = \"middle\"\nmaterial = \"skin\"\n");
    EXPECT_LT(both, std::min(skin, upper));
    EXPECT_GT(both, 0.5 * skin);
}

TEST_F(SceneSurface, MayBeAMeshFile) {
    const std::string head = kCollider + kSurface + "mesh = \"cube.obj\"\n";
    EXPECT_NEAR(area(head), 4.0, 1e-6);
    EXPECT_NEAR(area(head + "group = \"lid top\"\n"), 2.0, 1e-6);
    EXPECT_NEAR(area(head + "group = \"shell\"\n"), 1.0, 1e-6);
    EXPECT_NEAR(area(head + "material = \"iron\"\n"), 2.0, 1e-6);
    EXPECT_NEAR(area(head + "material = \"wood\"\ngroup = \"shell\"\n"), 1.0, 1e-6);
    EXPECT_NEAR(area(head + "attach = 0\n"), 4.0, 1e-6) << "in the collider's space";
    expectRefused(head + "group = \"floor\"\n", "3:1", "'shell', 'lid top'");
    expectRefused(head + "material = \"glass\"\n", "3:1", "'wood', 'iron'");
    expectRefused(head + "material = \"wood\"\ngroup = \"lid top\"\n", "3:1", "no area");
    const auto loaded = load(head);
    ASSERT_TRUE(loaded);
    const auto files = filesOf(loaded->scene);
    EXPECT_NE(std::find(files.begin(), files.end(), folder_.path() / "cube.obj"), files.end());
}

TEST_F(SceneSurface, CollidersWithoutAMeshGiveASurface) {
    const glm::dvec3 half(0.5, 0.3, 0.2);
    ASSERT_TRUE(saveCollider(folder_.path() / "box.relief",
                             analytic::frontBackCollider(analytic::box(-half, half), 128)));
    const std::string box = "[[collider]]\nfile = \"box.relief\"\n";
    EXPECT_NEAR(area(box + kSurface + "attach = 0\n"), 2.48, 0.03);
    const auto two = required(
        load(box + box + "position = [3, 0, 0]\n" + kSurface + "attach = 0\n" + kSurface + "attach = 1\n"));
    EXPECT_EQ(two.emitters[0].settings().surface->area(), two.emitters[1].settings().surface->area());
    folder_.write("ball.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const std::string wobbles =
        "[[collider]]\nmesh = \"ball.obj\"\ndeform = { amplitude = 0.1, frequency = 1 }\n";
    EXPECT_NEAR(area(wobbles + kSurface + "attach = 0\n"), 1.5 + 0.5 * std::sqrt(3.0), 1e-6);
    expectRefused(wobbles + kSurface + "attach = 0\ngroup = \"a\"\n", "4:1", "emitter.group");
}

TEST_F(SceneSurface, MissingPartsAreErrors) {
    const std::string head = kPlayed + kSurface + "attach = 0\n";
    expectRefused(head + "group = \"Head\"\n", "4:1", "emitter.group");
    expectRefused(head + "material = \"hair\"\n", "4:1", "emitter.material");
    Collider bare = animatedContainer(mesh_);
    bare.animation.clear();
    ASSERT_TRUE(saveCollider(folder_.path() / "tube.relief", bare));
    expectRefused(kCollider + kSurface + "attach = 0\ngroup = \"Head\"\n", "3:1", "emitter.group");
    expectRefused(kCollider + kSurface + "attach = 0\n", "3:1", (folder_.path() / "tube.relief").string());
    folder_.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    expectRefused(kCollider + kSurface + "mesh = \"flat.obj\"\n", "3:1", "no area");
}

}  // namespace
}  // namespace relief
