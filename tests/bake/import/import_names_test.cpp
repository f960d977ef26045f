// Which triangles have the names that somebody asks for, in files as exporters write them and as nobody should.
#include <gtest/gtest.h>

#include <filesystem>

#include "bake/import/mesh_import.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

using Marks = std::vector<std::uint8_t>;
using Names = std::vector<std::string>;

ImportOptions asking(const Names& names) {
    ImportOptions options;
    options.names = names;
    return options;
}

/// Through the worker, and in this process: the same.
Marks marksOf(const std::filesystem::path& file, const Names& names) {
    const Result<TriangleMesh> mesh = importMeshInWorker(file, asking(names));
    const Result<TriangleMesh> here = importMesh(file, asking(names));
    EXPECT_TRUE(mesh) << mesh.error().message;
    EXPECT_TRUE(here) << here.error().message;
    if (!mesh || !here) {
        return {};
    }
    EXPECT_EQ(mesh->marks, here->marks);
    EXPECT_EQ(mesh->marks.size(), names.empty() ? 0 : mesh->triangles.size());
    return mesh->marks;
}

void expectUnknown(const std::filesystem::path& file, const Names& names, const std::string& says) {
    const Result<TriangleMesh> mesh = importMeshInWorker(file, asking(names));
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, ErrorCode::kUsage) << mesh.error().message;
    EXPECT_NE(mesh.error().message.find(says), std::string::npos) << mesh.error().message;
    EXPECT_NE(mesh.error().message.find(file.filename().string()), std::string::npos);
    EXPECT_EQ(mesh.error().message.find_first_of("\n\r\x1b"), std::string::npos);
    EXPECT_LT(mesh.error().message.size(), 2500U);
}

/// Four corners; what follows them names faces.
std::string obj(const std::string& faces) {
    return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + faces;
}

TEST(ImportNames, OfObjAreGroupsObjectsAndMaterials) {
    const TemporaryFolder folder;
    const auto file = folder.write("a.obj", obj("g body\nusemtl paint\nf 1 2 3\nusemtl glass\nf 1 2 4\n"
                                                "g wheel\nf 2 3 4\no house\nusemtl paint\nf 1 3 4\n"));
    EXPECT_EQ(marksOf(file, {}), Marks());
    EXPECT_EQ(marksOf(file, {"body"}), Marks({1, 1, 0, 0}));
    EXPECT_EQ(marksOf(file, {"glass"}), Marks({0, 1, 1, 0}));
    EXPECT_EQ(marksOf(file, {"paint", "house"}), Marks({1, 0, 0, 2}));
    // Where a triangle has several of the names, the last counts.
    EXPECT_EQ(marksOf(file, {"body", "glass"}), Marks({1, 2, 2, 0}));
    EXPECT_EQ(marksOf(file, {"glass", "body"}), Marks({2, 2, 1, 0}));
    expectUnknown(file, {"body", "glas"},
                  "'glas'; did you mean 'glass'? It has 'body', 'paint', 'glass', 'wheel', 'house'");
    expectUnknown(file, {"Body"}, "'Body'; did you mean 'body'?");
}

TEST(ImportNames, AGroupMayHaveSeveralNamesAndGoOnLater) {
    const TemporaryFolder folder;
    const auto file =
        folder.write("g.obj", obj("g left door\nf 1 2 3\ng frame\nf 1 2 4\ng right door\nf 2 3 4\n"
                                  "g frame\nf 1 3 4\n"));
    EXPECT_EQ(marksOf(file, {"door", "frame"}), Marks({1, 2, 1, 2}));
    EXPECT_EQ(marksOf(file, {"left door"}), Marks({1, 0, 0, 0}));
}

TEST(ImportNames, ANameOfAGroupAndOfAMaterialIsBoth) {
    const TemporaryFolder folder;
    const auto file = folder.write(
        "b.obj",
        obj("g glass\nusemtl paint\nf 1 2 3\ng body\nusemtl glass\nf 1 2 4\nusemtl paint\nf 2 3 4\n"));
    EXPECT_EQ(marksOf(file, {"glass"}), Marks({1, 1, 0}));
}

TEST(ImportNames, TrianglesWithoutAreaTakeTheirNamesWithThem) {
    const TemporaryFolder folder;
    const auto file = folder.write("d.obj", obj("g a\nf 1 1 3\nf 1 2 3\ng b\nf 4 4 4\nf 1 2 4\n"));
    EXPECT_EQ(marksOf(file, {"a", "b"}), Marks({1, 2}));
}

/// A triangle of the tetrahedron's buffer: the first three indices.
std::string gltf(const std::string& nodes, const std::string& roots) {
    GltfParts parts;
    parts.nodes = nodes;
    parts.roots = roots;
    parts.more = R"("materials":[{"name":"paint"},{"name":"glass"}],)";
    parts.indices = R"("bufferView":1,"componentType":5123,"count":3,"type":"SCALAR")";
    parts.primitive = R"("attributes":{"POSITION":0},"indices":1,"material":0},{)"
                      R"("attributes":{"POSITION":0},"indices":1,"material":1)";
    std::string text = tetrahedronGltf(parts);
    const std::string meshes = R"("meshes":[{)";
    return text.insert(text.find(meshes) + meshes.size(), R"("name":"door-1",)");
}

TEST(ImportNames, OfGltfAreNodesMeshesAndMaterials) {
    const TemporaryFolder folder;
    // Two cars share a mesh of two materials; the second has two of it.
    const auto file = folder.write(
        "c.gltf",
        gltf(R"({"name":"first","mesh":0},{"name":"second","children":[2,3]},{"name":"near","mesh":0},)"
             R"({"name":"far","translation":[5,0,0],"mesh":0})",
             "0,1"));
    EXPECT_EQ(marksOf(file, {"first"}), Marks({1, 1, 0, 0, 0, 0}));
    EXPECT_EQ(marksOf(file, {"second"}), Marks({0, 0, 1, 1, 1, 1})) << "a node is all below it";
    EXPECT_EQ(marksOf(file, {"second", "near"}), Marks({0, 0, 2, 2, 1, 1}));
    EXPECT_EQ(marksOf(file, {"near", "second"}), Marks({0, 0, 2, 2, 2, 2}));
    EXPECT_EQ(marksOf(file, {"second", "glass"}), Marks({0, 2, 1, 2, 1, 2}));
    EXPECT_EQ(marksOf(file, {"door-1"}), Marks({1, 1, 1, 1, 1, 1})) << "as the file writes it";
    expectUnknown(file, {"door"}, "It has");
}

TEST(ImportNames, OfOtherFormats) {
    const TemporaryFolder folder;
    const auto stl = folder.write("s.stl", tetrahedronStl());
    expectUnknown(stl, {"nothing"}, "it has");
    // Nothing in a PLY file has a name.
    expectUnknown(folder.write("p.ply", tetrahedronPly()), {"nothing"},
                  "nor anything else; leave the name out");
}

TEST(ImportNames, HostileOnesAreMadeClean) {
    const TemporaryFolder folder;
    const std::string endless(5000, 'y');
    const auto file = folder.write("h.gltf", gltf(R"({"name":"a\nb\u001b[31m","mesh":0},{"name":")" +
                                                      endless + R"(","mesh":0},{"name":"","mesh":0})",
                                                  "0,1,2"));
    EXPECT_EQ(marksOf(file, {"a\xef\xbf\xbd"
                             "b\xef\xbf\xbd[31m"}),
              Marks({1, 1, 0, 0, 0, 0}));
    EXPECT_EQ(marksOf(file, {std::string(kAskedNameBytesMax, 'y')}), Marks({0, 0, 1, 1, 0, 0}));
    expectUnknown(file, {std::string(kAskedNameBytesMax, 'z')}, "it has");
    std::string many;
    for (int i = 0; i < 3000; ++i) {
        many += "g group" + std::to_string(i) + std::string(100, 'n') + "\nf 1 2 3\n";
    }
    expectUnknown(folder.write("m.obj", obj(many)), {"x"}, " and more");
    const Names crowd(kAskedNamesMax + 1, "paint");
    EXPECT_EQ(importMeshInWorker(file, asking(crowd)).error().code, ErrorCode::kLimit);
}

TEST(ImportNames, AChainOfNodesIsWalkedOnce) {
    // Each of 20,000 nodes has the next below it, and a mesh.
    const TemporaryFolder folder;
    constexpr int kNodes = 20'000;
    std::string nodes;
    for (int i = 0; i < kNodes; ++i) {
        nodes += (i == 0 ? "{" : ",{") + std::string(R"("name":"n)") + std::to_string(i) + R"(","mesh":0)" +
                 (i + 1 < kNodes ? R"(,"children":[)" + std::to_string(i + 1) + "]}" : "}");
    }
    const Marks marks = marksOf(folder.write("deep.gltf", gltf(nodes, "0")), {"n0", "n19999"});
    ASSERT_EQ(marks.size(), 2U * kNodes);
    EXPECT_EQ(std::count(marks.begin(), marks.end(), 1), 2 * kNodes - 2);
    EXPECT_EQ(std::count(marks.begin(), marks.end(), 2), 2);
}

/// "node/material" of each triangle, through the worker and in this process: the same.
std::vector<std::string> surfacesOf(const std::filesystem::path& file) {
    const Result<TriangleMesh> mesh = importMeshInWorker(file);
    const Result<TriangleMesh> here = importMesh(file);
    EXPECT_TRUE(mesh && here);
    if (!mesh || !here) {
        return {};
    }
    EXPECT_EQ(mesh->labels, here->labels);
    EXPECT_EQ(mesh->surface_names, here->surface_names);
    std::vector<std::string> names;
    for (const std::uint32_t label : mesh->labels) {
        const SurfaceName& name = mesh->surface_names[label];
        names.push_back(name.node + "/" + name.material);
    }
    return names;
}

TEST(ImportNames, EveryTriangleKnowsItsNodeAndItsMaterial) {
    using Surfaces = std::vector<std::string>;
    const TemporaryFolder folder;
    EXPECT_EQ(
        surfacesOf(folder.write("a.obj", obj("g body\nusemtl paint\nf 1 2 3\nusemtl glass\nf 1 1 4\nf 1 2 4\n"
                                             "g wheel\nf 2 3 4\n"))),
        Surfaces({"body/paint", "body/glass", "wheel/glass"}));
    // One surface needs no names.
    EXPECT_EQ(surfacesOf(folder.write("one.obj", obj("g body\nf 1 2 3\nf 1 2 4\n"))), Surfaces());
}

TEST(ImportNames, TwoNodesOfOneNameAreTwo) {
    const TemporaryFolder folder;
    const auto file = folder.write(
        "n.gltf",
        gltf(R"({"name":"chair","mesh":0},{"name":"chair","translation":[5,0,0],"mesh":0})", "0,1"));
    EXPECT_EQ(surfacesOf(file),
              std::vector<std::string>({"chair/paint", "chair/glass", "chair/paint", "chair/glass"}));
    const Result<TriangleMesh> mesh = importMeshInWorker(file);
    ASSERT_TRUE(mesh && mesh->surface_names.size() == 4U);
    EXPECT_EQ(mesh->surface_names[0].node_index, mesh->surface_names[1].node_index);
    EXPECT_NE(mesh->surface_names[1].node_index, mesh->surface_names[2].node_index);
}

}  // namespace
}  // namespace relief::test
