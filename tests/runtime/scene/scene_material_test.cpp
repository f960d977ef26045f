// SPDX-License-Identifier: Apache-2.0
// [[material]] of scenes, "materials" of worlds and the material of [[spawn]]: what is read, and which colliders use
// it.
#include <gtest/gtest.h>

#include "formats/container.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/scene/scene_emitter.h"
#include "tests/results.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

const std::string kOneBox = "[[collider]]\nfile = \"box.relief\"\n";

void writeBox(const test::TemporaryFolder& folder) {
    Collider box = analytic::frontBackCollider(analytic::box({-0.4, -0.2, -0.3}, {0.4, 0.2, 0.3}), 16);
    box.materials.list = {{"oak", 0.5F, 0.25F}, {"stove"}};
    box.materials.size = 1.0F;
    box.materials.origin = glm::vec3(-0.5F);
    box.materials.nodes.resize(1);
    box.materials.nodes[0].leaves = {0, 1, 0, 1, 0, 1, 0, 1};
    EXPECT_TRUE(saveCollider(folder.path() / "box.relief", box));
}

TEST(SceneMaterial, ResponsesAreAppliedByName) {
    const test::TemporaryFolder folder;
    writeBox(folder);
    const auto loaded = required(loadAll(
        folder.write("scene.toml", kOneBox +
                                       "[[material]]\nname = \"stove\"\nfriction = 0.75\nlifetime_loss = 3\n"
                                       "[[material]]\nname = \"oak\"\nrestitution = 0.125\n"
                                       "[[spawn]]\non = \"collision\"\nmaterial = \"stove\"\n"),
        {}));
    const std::vector<Material>& list = loaded.colliders.front()->materials.list;
    EXPECT_EQ(list[0], (Material{"oak", 0.125F, 0.25F}));
    EXPECT_EQ(list[1], (Material{"stove", 1.0F, 0.75F, 3.0F}));
    // Indices into the names of the textures. A name that is missing there is never hit.
    const std::vector<std::string> names{"oak", "stove"};
    EXPECT_EQ(makeSpawners(loaded.scene.spawns, names).front().settings().material, 1);
    EXPECT_EQ(makeSpawners(loaded.scene.spawns, std::span(names).first(1)).front().settings().material, 1);
}

TEST(SceneMaterial, UnknownNamesAreErrors) {
    const test::TemporaryFolder folder;
    writeBox(folder);
    for (const auto& [more, what] :
         {std::pair("[[material]]\nname = \"stave\"\n", "material[0].name = 'stave'"),
          {"[[spawn]]\non = \"collision\"\nmaterial = \"ice\"\n", "spawn[0].material = 'ice'"}}) {
        expectErrorOf(loadAll(folder.write("scene.toml", kOneBox + more), {}), "scene.toml:3:1: ", what);
        // Another scene that replaces this one during play.
        const auto plays = loadAll(folder.write("plays.toml", kOneBox), {});
        const auto changed = parseScene(kOneBox + more, "scene.toml");
        ASSERT_TRUE(plays && changed);
        EXPECT_TRUE(checkMaterials(plays->scene, *plays));
        EXPECT_FALSE(checkMaterials(*changed, *plays));
    }
}

TEST(SceneMaterial, WorldsHaveMaterials) {
    World world;
    world.materials = {{"oak", 0.5F, {}, {}}, {"ice", {}, 0.0F, 1.0F}};
    world.colliders.resize(1);
    world.colliders[0].file = "a.relief";
    world.colliders[0].hash.assign(32, '0');
    world.colliders[0].gpu_bytes = 1;
    world.bodies.resize(1);
    const auto read = required(parseWorld(worldText(world)));
    EXPECT_EQ(read.materials, world.materials);
    world.materials[1].name = "oak";
    EXPECT_EQ(parseWorld(worldText(world)).error().code, ErrorCode::kInvalidInput);
    world.materials.clear();
    EXPECT_EQ(worldText(world).find("materials"), std::string::npos);
}

}  // namespace
}  // namespace relief
