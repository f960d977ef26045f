// [[material]] of scenes, "materials" of worlds and [[spawn]] material: what is read, whom it reaches, and every mistake with its place.
#include <gtest/gtest.h>

#include "formats/container.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/scene/scene_emitter.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/scene/scene_error.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

const std::string kHead = "[[collider]]\nfile = \"box.relief\"\n";

std::filesystem::path boxIn(const test::TemporaryFolder& folder) {
    Collider box = analytic::frontBackCollider(analytic::box({-0.4, -0.2, -0.3}, {0.4, 0.2, 0.3}), 16);
    box.materials.list = {{"oak", 0.5F, 0.25F}, {"stove"}};
    box.materials.size = 1.0F;
    box.materials.origin = glm::vec3(-0.5F);
    box.materials.nodes.resize(1);
    box.materials.nodes[0].leaves = {0, 1, 0, 1, 0, 1, 0, 1};
    EXPECT_TRUE(saveCollider(folder.path() / "box.relief", box));
    return folder.path() / "box.relief";
}

TEST(SceneMaterial, ResponsesReachTheCollidersByName) {
    const test::TemporaryFolder folder;
    static_cast<void>(boxIn(folder));
    const auto loaded =
        loadAll(folder.write("scene.toml",
                             kHead + "[[material]]\nname = \"stove\"\nfriction = 0.75\nlifetime_loss = 3\n"
                                     "[[material]]\nname = \"oak\"\nrestitution = 0.125\n"
                                     "[[spawn]]\non = \"collision\"\nmaterial = \"stove\"\n"),
                {});
    ASSERT_TRUE(loaded) << loaded.error().message;
    const std::vector<Material>& list = loaded->colliders.front()->materials.list;
    EXPECT_EQ(list[0], (Material{"oak", 0.125F, 0.25F}));
    EXPECT_EQ(list[1], (Material{"stove", 1.0F, 0.75F, 3.0F}));
    // Of the names of the textures; one that is not among them is never hit.
    const std::vector<std::string> names{"oak", "stove"};
    EXPECT_EQ(makeSpawners(loaded->scene.spawns, names).front().settings().material, 1);
    EXPECT_EQ(makeSpawners(loaded->scene.spawns, std::span(names).first(1)).front().settings().material, 1);
}

TEST(SceneMaterial, MistakesHaveTheirPlace) {
    const auto expectError = [](const std::string& more, const std::string& place, const std::string& part) {
        expectSceneError(kHead + more, "dir/scene.toml:" + place + ": ", part);
    };
    expectError("[[material]]\nfriction = 1\n", "3:1", "name");
    expectError("[[material]]\nname = \"a\"\nfriction = 2\n", "5:12", "1");
    expectError("[[material]]\nname = \"a\"\nlifetime_loss = -1\n", "5:17", "0");
    expectError("[[material]]\nname = \"a\"\nfricton = 1\n", "5:1", "friction");
    expectError("[[material]]\nname = \"a\"\n[[material]]\nname = \"a\"\n", "6:8", "is taken");
    expectError("[[spawn]]\non = \"death\"\nmaterial = \"a\"\n", "5:12", "collision");

    const test::TemporaryFolder folder;
    static_cast<void>(boxIn(folder));
    for (const auto& [more, words] :
         {std::pair(
              "[[material]]\nname = \"stave\"\n",
              "scene.toml:3:1: material[0].name = 'stave' is the name of no material; did you mean 'stove'? "
              "There are 'oak', 'stove'"),
          std::pair("[[spawn]]\non = \"collision\"\nmaterial = \"ice\"\n",
                    "scene.toml:3:1: spawn[0].material = 'ice' is the name of no material; there are 'oak', "
                    "'stove'")}) {
        const auto loaded = loadAll(folder.write("scene.toml", kHead + more), {});
        ASSERT_FALSE(loaded);
        EXPECT_NE(loaded.error().message.find(words), std::string::npos) << loaded.error().message;
        // A scene that another one becomes as it plays.
        const auto plays = loadAll(folder.write("plays.toml", kHead), {});
        const auto changed = parseScene(kHead + more, "scene.toml");
        ASSERT_TRUE(plays && changed);
        EXPECT_TRUE(checkMaterials(plays->scene, *plays));
        const auto checked = checkMaterials(*changed, *plays);
        ASSERT_FALSE(checked);
        EXPECT_NE(checked.error().message.find(words), std::string::npos) << checked.error().message;
    }
}

TEST(SceneMaterial, WorldsHaveThemToo) {
    World world;
    world.materials = {{"oak", 0.5F, {}, {}}, {"ice", {}, 0.0F, 1.0F}};
    world.colliders.resize(1);
    world.colliders[0].file = "a.relief";
    world.colliders[0].hash.assign(32, '0');
    world.colliders[0].gpu_bytes = 1;
    world.bodies.resize(1);
    const auto read = parseWorld(worldText(world));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->materials, world.materials);
    world.materials[1].name = "oak";
    const auto twice = parseWorld(worldText(world));
    ASSERT_FALSE(twice);
    EXPECT_NE(twice.error().message.find("materials[1].name = 'oak' is that of another one; join them"),
              std::string::npos)
        << twice.error().message;
    world.materials.clear();
    EXPECT_EQ(worldText(world).find("materials"), std::string::npos);
}

}  // namespace
}  // namespace relief
