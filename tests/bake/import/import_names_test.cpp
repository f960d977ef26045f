// SPDX-License-Identifier: Apache-2.0
// Name patterns mark the right triangles, in typical files of exporters and in hostile ones.

#include "bake/import/mesh_import.h"
#include "tests/bake/import/import_meshes.h"

namespace relief::test {
namespace {

using Marks = std::vector<std::uint8_t>;
using Names = std::vector<std::string>;

ImportOptions asking(const Names& names) {
    ImportOptions options;
    options.names = names;
    return options;
}

/// Imports a text through the worker and in this process, with equal results. Returns the marks of its triangles by
/// name.
void expectMarks(const std::string& name, const std::string& text,
                 const std::vector<std::pair<Names, Marks>>& cases) {
    for (const auto& [names, marks] : cases) {
        EXPECT_EQ(required(importTextInWorker(name, text, asking(names))).marks, marks);
        EXPECT_EQ(imported(name, text, asking(names)).marks, marks);
    }
}

void expectUnknown(const std::string& file, const std::string& text, const Names& names,
                   const std::string& words) {
    const Result<TriangleMesh> mesh = importText(file, text, asking(names));
    expectRejected(mesh, words, ErrorCode::kUsage);
    expectRejected(mesh, file, ErrorCode::kUsage);
    EXPECT_LT(mesh.error().message.size(), 2500U);
}

/// Four vertices; named faces follow.
std::string obj(const std::string& faces) {
    return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + faces;
}

/// glTF nodes with a mesh 'door-1' of two primitives: the tetrahedron's first triangle as paint and as glass.
std::string gltf(const std::string& nodes, const std::string& roots) {
    const std::string text =
        tetrahedronGltf({.nodes = nodes,
                         .roots = roots,
                         .primitive = R"("attributes":{"POSITION":0},"indices":1,"material":0},{)"
                                      R"("attributes":{"POSITION":0},"indices":1,"material":1)",
                         .indices = R"("bufferView":1,"componentType":5123,"count":3,"type":"SCALAR")",
                         .more = R"("materials":[{"name":"paint"},{"name":"glass"}],)"});
    return replaced(text, R"("meshes":[{)", R"("meshes":[{"name":"door-1",)");
}

TEST(ImportNames, ObjNamesAreGroupsObjectsAndMaterials) {
    const std::string text =
        obj("g body\nusemtl paint\nf 1 2 3\nusemtl glass\nf 1 2 4\n"
            "g wheel\nf 2 3 4\no house\nusemtl paint\nf 1 3 4\n");
    expectMarks("a.obj", text,
                {{{}, {}},
                 {{"body"}, {1, 1, 0, 0}},
                 {{"glass"}, {0, 1, 1, 0}},
                 {{"paint", "house"}, {1, 0, 0, 2}},
                 // If a triangle has several of the names, the last one counts.
                 {{"body", "glass"}, {1, 2, 2, 0}},
                 {{"glass", "body"}, {2, 2, 1, 0}}});
    expectUnknown("a.obj", text, {"body", "glas"},
                  "'glas'; did you mean 'glass'? Its names: 'body', 'paint', 'glass', 'wheel', 'house'");
    expectUnknown("a.obj", text, {"Body"}, "'body'");
    // A group can have several names and can be continued.
    expectMarks("g.obj",
                obj("g left door\nf 1 2 3\ng frame\nf 1 2 4\ng right door\nf 2 3 4\ng frame\nf 1 3 4\n"),
                {{{"door", "frame"}, {1, 2, 1, 2}}, {{"left door"}, {1, 0, 0, 0}}});
    // One name can belong to a group and to a material.
    expectMarks("b.obj",
                obj("g glass\nusemtl paint\nf 1 2 3\ng body\nusemtl glass\nf 1 2 4\nusemtl paint\nf 2 3 4\n"),
                {{{"glass"}, {1, 1, 0}}});
    // Triangles without area are dropped together with their names.
    expectMarks("d.obj", obj("g a\nf 1 1 3\nf 1 2 3\ng b\nf 4 4 4\nf 1 2 4\n"), {{{"a", "b"}, {1, 2}}});
}

TEST(ImportNames, GltfNamesAreNodesMeshesAndMaterials) {
    // Two cars share a mesh with two materials; the second car contains it twice. A node's name applies to all its
    // descendants.
    const std::string text =
        gltf(R"({"name":"first","mesh":0},{"name":"second","children":[2,3]},{"name":"near","mesh":0},)"
             R"({"name":"far","translation":[5,0,0],"mesh":0})",
             "0,1");
    expectMarks("c.gltf", text,
                {{{"first"}, {1, 1, 0, 0, 0, 0}},
                 {{"second"}, {0, 0, 1, 1, 1, 1}},
                 {{"second", "near"}, {0, 0, 2, 2, 1, 1}},
                 {{"near", "second"}, {0, 0, 2, 2, 2, 2}},
                 {{"second", "glass"}, {0, 2, 1, 2, 1, 2}},
                 {{"door-1"}, {1, 1, 1, 1, 1, 1}}});
    expectUnknown("c.gltf", text, {"door"}, "Its names: ");
    expectUnknown("s.stl", tetrahedronStl(), {"nothing"}, "its names: ");
    expectUnknown("p.ply", tetrahedronPly(), {"nothing"}, "the file has no names: use --as without one");
}

TEST(ImportNames, HostileNamesAreSanitized) {
    const std::string text = gltf(R"({"name":"a\nb\u001b[31m","mesh":0},{"name":")" + std::string(5000, 'y') +
                                      R"(","mesh":0},{"name":"","mesh":0})",
                                  "0,1,2");
    const std::string clean = "a\xef\xbf\xbd" + std::string("b\xef\xbf\xbd[31m");
    expectMarks(
        "h.gltf", text,
        {{{clean}, {1, 1, 0, 0, 0, 0}}, {{std::string(kAskedNameBytesMax, 'y')}, {0, 0, 1, 1, 0, 0}}});
    expectUnknown("h.gltf", text, {std::string(kAskedNameBytesMax, 'z')}, "its names: ");
    std::string many;
    for (int i = 0; i < 3000; ++i) {
        many += "g group" + std::to_string(i) + std::string(100, 'n') + "\nf 1 2 3\n";
    }
    expectUnknown("m.obj", obj(many), {"x"}, " and more");
    const Names crowd(kAskedNamesMax + 1, "paint");
    EXPECT_EQ(importTextInWorker("h.gltf", text, asking(crowd)).error().code, ErrorCode::kLimit);
}

// A deep hierarchy must not overflow the stack either.
TEST(ImportNames, NodeChainIsWalkedOnce) {
    // Each of 20,000 nodes has a mesh and the next node as child.
    constexpr int kNodes = 20'000;
    std::string nodes;
    for (int i = 0; i < kNodes; ++i) {
        nodes += (i == 0 ? "{" : ",{") + std::string(R"("name":"n)") + std::to_string(i) + R"(","mesh":0)" +
                 (i + 1 < kNodes ? R"(,"children":[)" + std::to_string(i + 1) + "]}" : "}");
    }
    Marks marks(2U * kNodes, 1);
    std::fill(marks.end() - 2, marks.end(), std::uint8_t{2});
    EXPECT_EQ(imported("deep.gltf", gltf(nodes, "0"), asking({"n0", "n19999"})).marks, marks);
}

TEST(ImportNames, EveryTriangleHasItsNodeAndItsMaterial) {
    // Two nodes with equal names are distinct.
    const std::string chairs =
        gltf(R"({"name":"chair","mesh":0},{"name":"chair","translation":[5,0,0],"mesh":0})", "0,1");
    const std::vector<std::tuple<std::string, std::string, Names>> cases = {
        {"a.obj",
         obj("g body\nusemtl paint\nf 1 2 3\nusemtl glass\nf 1 1 4\nf 1 2 4\ng wheel\nf 2 3 4\n"),
         {"body/paint", "body/glass", "wheel/glass"}},
        {"m.obj",
         obj("usemtl oak\nf 1 3 2\nusemtl felt\nf 1 4 3\nusemtl oak\nf 2 3 4\n"),
         {"/oak", "/felt", "/oak"}},
        {"one.obj", obj("g body\nf 1 2 3\nf 1 2 4\n"), {}},  // one surface needs no names
        {"n.gltf", chairs, {"chair/paint", "chair/glass", "chair/paint", "chair/glass"}}};
    for (const auto& [name, text, surfaces] : cases) {
        SCOPED_TRACE(name);
        const TriangleMesh here = imported(name, text);
        const TriangleMesh there = required(importTextInWorker(name, text));
        EXPECT_TRUE(there.labels == here.labels && there.surface_names == here.surface_names);
        Names names;
        for (const std::uint32_t label : here.labels) {
            names.push_back(here.surface_names[label].node + "/" + here.surface_names[label].material);
        }
        EXPECT_EQ(names, surfaces);
    }
    const std::vector<SurfaceName> names = imported("n.gltf", chairs).surface_names;
    ASSERT_EQ(names.size(), 4U);
    EXPECT_EQ(names[0].node_index, names[1].node_index);
    EXPECT_NE(names[1].node_index, names[2].node_index);
}

}  // namespace
}  // namespace relief::test
