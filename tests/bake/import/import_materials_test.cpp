// Materials of mesh files: names by surface, responses of KHR_physics_rigid_bodies, and what of them makes meshes of a level differ.
#include <gtest/gtest.h>

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
    R"({"restitution":-1}]}},"extensionsRequired":["KHR_physics_rigid_bodies"],)";

TEST(ImportMaterials, PhysicsMaterialsNameSurfacesAndTheirResponses) {
    const TemporaryFolder folder;
    const auto path =
        folder.write("m.gltf", tetrahedronGltf({.nodes = node(physics("0")) + "," +
                                                         node(R"("translation":[5,0,0],)" + physics("1")) +
                                                         "," + node(R"("translation":[9,0,0])"),
                                                .roots = "0,1,2",
                                                .more = kPhysics}));
    const auto mesh = importMeshInWorker(path);
    ASSERT_TRUE(mesh) << mesh.error().message;
    ASSERT_EQ(mesh->surface_names.size(), 3U);
    EXPECT_EQ(mesh->surface_names[0], (SurfaceName{0, "", "rubber", 0.75F, 1.0F}));
    EXPECT_EQ(mesh->surface_names[1], (SurfaceName{1, "", "ice", 0.25F, 0.0F}));
    EXPECT_EQ(mesh->surface_names[2], (SurfaceName{2, "", "", 1.0F, 0.0F}));
    // Of a level the three nodes are three meshes, each of a single surface, whose name stays.
    const auto level = importLevel(path);
    ASSERT_TRUE(level) << level.error().message;
    ASSERT_EQ(level->meshes.size(), 3U);
    ASSERT_EQ(level->meshes[0].surface_names.size(), 1U);
    EXPECT_EQ(level->meshes[0].surface_names[0].material, "rubber");
    EXPECT_TRUE(level->meshes[0].labels.empty());
    EXPECT_TRUE(level->meshes[2].surface_names.empty());
    EXPECT_TRUE(hasSeveralMaterials(level->meshes));
    EXPECT_FALSE(hasSeveralMaterials(std::span(level->meshes).first(1)));
    EXPECT_FALSE(hasSeveralMaterials(std::span(level->meshes).subspan(2)));
    // Without materials they are one.
    ImportOptions without;
    without.materials = false;
    EXPECT_EQ(importLevel(path, without)->meshes.size(), 1U);
}

TEST(ImportMaterials, CombineModesWarnOnceWhereTheyWouldChangeMuch) {
    const TemporaryFolder folder;
    const auto warningsOf = [&](const std::string& first, const std::string& second) {
        const auto mesh = importMeshInWorker(folder.write(
            "m.gltf",
            tetrahedronGltf({.nodes = node(physics("0")) + "," + node(physics("1")),
                             .roots = "0,1",
                             .more = R"("extensions":{"KHR_physics_rigid_bodies":{"physicsMaterials":[{)" +
                                     first + "},{" + second + "}]}},"})));
        EXPECT_TRUE(mesh) << mesh.error().message;
        return mesh ? mesh->warnings : std::vector<std::string>();
    };
    EXPECT_EQ(warningsOf(R"("restitutionCombine":"multiply")", R"("frictionCombine":"average")").size(), 0U);
    for (const auto& [first, second] :
         {std::pair(R"("restitutionCombine":"maximum","frictionCombine":"minimum")", R"("restitution":1)"),
          std::pair(R"("frictionCombine":"maximum")", R"("restitutionCombine":"minimum")")}) {
        const std::vector<std::string> warnings = warningsOf(first, second);
        ASSERT_EQ(warnings.size(), 1U);
        EXPECT_NE(warnings[0].find("minimum or maximum, which has no effect"), std::string::npos)
            << warnings[0];
    }
    EXPECT_FALSE(importMeshInWorker(folder.write(
        "m.gltf", tetrahedronGltf({.nodes = node(physics("0")),
                                   .more = R"("extensions":{"KHR_physics_rigid_bodies":{"physicsMaterials":[)"
                                           R"({"frictionCombine":2}]}},)"}))));
}

TEST(ImportMaterials, ABrokenPhysicsMaterialHasItsPlace) {
    const TemporaryFolder folder;
    for (const auto& [material, words] :
         {std::pair("7",
                    "nodes[0].extensions.KHR_physics_rigid_bodies.collider has the physicsMaterial 7, and "
                    "there are 3"),
          std::pair("2", "physicsMaterials[2] has a restitution or a dynamicFriction below 0"),
          std::pair("\"ice\"", "physicsMaterial")}) {
        const auto mesh = importMeshInWorker(
            folder.write("m.gltf", tetrahedronGltf({.nodes = node(physics(material)), .more = kPhysics})));
        ASSERT_FALSE(mesh) << material;
        EXPECT_EQ(mesh.error().code, ErrorCode::kInvalidInput);
        EXPECT_NE(mesh.error().message.find(words), std::string::npos) << mesh.error().message;
    }
}

TEST(ImportMaterials, ObjSurfacesHaveTheirNames) {
    const TemporaryFolder folder;
    const auto mesh =
        importMeshInWorker(folder.write("m.obj",
                                        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl oak\nf 1 3 2\nf 1 2 4\n"
                                        "usemtl felt\nf 1 4 3\nusemtl oak\nf 2 3 4\n"));
    ASSERT_TRUE(mesh) << mesh.error().message;
    ASSERT_EQ(mesh->labels.size(), 4U);
    std::vector<std::string> names;
    for (const std::uint32_t label : mesh->labels) {
        names.push_back(mesh->surface_names[label].material);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"oak", "oak", "felt", "oak"}));
}

}  // namespace
}  // namespace relief::test
