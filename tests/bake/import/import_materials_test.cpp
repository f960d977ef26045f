// SPDX-License-Identifier: Apache-2.0
// Materials of mesh files: surface names, KHR_physics_rigid_bodies, and how they separate the meshes of a level.
#include "bake/import/level_folder.h"
#include "bake/import/mesh_import.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

std::string node(const std::string& more) {
    return R"({"mesh":0,)" + more + "}";
}

std::string physics(const std::string& material) {
    return R"("extensions":{"KHR_physics_rigid_bodies":{"collider":{"physicsMaterial":)" + material + "}}}";
}

const std::string kPhysics =
    R"("extensions":{"KHR_physics_rigid_bodies":{"physicsMaterials":[)"
    R"({"name":"rubber","restitution":0.75,"dynamicFriction":1.5,"staticFriction":9},{"name":"ice","restitution":0.25},)"
    R"({"restitution":-1},{"name":"tar","dynamicFriction":1}]}},"extensionsRequired":["KHR_physics_rigid_bodies"],)";

TEST(ImportMaterials, PhysicsMaterialsGiveNamesAndResponses) {
    const TemporaryFolder folder;
    const auto path =
        folder.write("m.gltf", tetrahedronGltf({.nodes = node(physics("0")) + "," +
                                                         node(R"("translation":[5,0,0],)" + physics("1")) +
                                                         "," + node(R"("translation":[9,0,0])"),
                                                .roots = "0,1,2",
                                                .more = kPhysics}));
    const auto mesh = required(importMesh(path));
    ASSERT_EQ(mesh.surface_names.size(), 3U);
    EXPECT_EQ(mesh.surface_names[0], (SurfaceName{0, "", "rubber", 0.75F, 1.0F}));
    EXPECT_EQ(mesh.surface_names[1], (SurfaceName{1, "", "ice", 0.25F, 0.6F}))
        << "the default friction of the schema";
    EXPECT_EQ(mesh.surface_names[2], (SurfaceName{2, "", "", 1.0F, 0.0F}));
    // In a level, the three nodes are three meshes. Each has one surface, which keeps its name.
    const auto level = required(importLevel(path));
    ASSERT_EQ(level.meshes.size(), 3U);
    ASSERT_EQ(level.meshes[0].surface_names.size(), 1U);
    EXPECT_EQ(level.meshes[0].surface_names[0].material, "rubber");
    EXPECT_TRUE(level.meshes[0].labels.empty());
    EXPECT_TRUE(level.meshes[2].surface_names.empty());
    EXPECT_TRUE(hasSeveralMaterials(level.meshes));
    EXPECT_FALSE(hasSeveralMaterials(std::span(level.meshes).first(1)));
    EXPECT_FALSE(hasSeveralMaterials(std::span(level.meshes).subspan(2)));
    // Without materials, the three meshes are one.
    ImportOptions without;
    without.materials = false;
    EXPECT_EQ(importLevel(path, without)->meshes.size(), 1U);
}

TEST(ImportMaterials, FrictionOnlyMaterialDoesNotBounce) {
    const auto mesh =
        required(importText("m.gltf", tetrahedronGltf({.nodes = node(physics("3")), .more = kPhysics})));
    EXPECT_EQ(mesh.surface_names.at(0), (SurfaceName{0, "", "tar", 0.0F, 1.0F}));
}

TEST(ImportMaterials, SignificantCombineModesWarnOnce) {
    const auto import = [](const std::string& first, const std::string& second) {
        return importText(
            "m.gltf",
            tetrahedronGltf({.nodes = node(physics("0")) + "," + node(physics("1")),
                             .roots = "0,1",
                             .more = R"("extensions":{"KHR_physics_rigid_bodies":{"physicsMaterials":[{)" +
                                     first + "},{" + second + "}]}},"}));
    };
    const auto none = import(R"("restitutionCombine":"multiply")", R"("frictionCombine":"average")");
    ASSERT_TRUE(none);
    EXPECT_TRUE(none->warnings.empty());
    for (const auto& [first, second] :
         {std::pair(R"("restitutionCombine":"maximum","frictionCombine":"minimum")", R"("restitution":1)"),
          std::pair(R"("frictionCombine":"maximum")", R"("restitutionCombine":"minimum")")}) {
        const auto mesh = import(first, second);
        ASSERT_TRUE(mesh && mesh->warnings.size() == 1U);
        EXPECT_TRUE(warns(*mesh, "minimum or maximum, which has no effect"));
    }
    EXPECT_FALSE(import(R"("frictionCombine":2)", ""));
}

TEST(ImportMaterials, InvalidPhysicsMaterialIsLocated) {
    const auto with = [](const char* material) {
        return tetrahedronGltf({.nodes = node(physics(material)), .more = kPhysics});
    };
    expectWrong(
        "m.gltf",
        {{with("7"), "nodes[0].extensions.KHR_physics_rigid_bodies.collider has the physicsMaterial 7"},
         {with("2"), "physicsMaterials[2] has a restitution or a dynamicFriction below 0"},
         {with("\"ice\""), "physicsMaterial"}});
}

}  // namespace
}  // namespace relief::test
