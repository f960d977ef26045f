// SPDX-License-Identifier: Apache-2.0
// Names, materials and parts of mesh files: patterns mark the right triangles, and everything except triangles is
// counted, named or rejected.
#include "bake/import/import_scene.h"
#include "bake/import/level.h"
#include "bake/import/mesh_import.h"
#include "formats/polygons/polygon_mesh.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/temporary_folder.h"

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
                  "'glas'; did you mean 'glass'? Names: 'body', 'paint', 'glass', 'wheel', 'house'");
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
    expectUnknown("c.gltf", text, {"door"}, "Names: ");
    expectUnknown("s.stl", tetrahedronStl(), {"nothing"}, "; names: '");
    expectUnknown("p.ply", tetrahedronPly(), {"nothing"}, "the file has no names: use --as without a name");
}

TEST(ImportNames, HostileNamesAreSanitized) {
    const std::string text = gltf(R"({"name":"a\nb\u001b[31m","mesh":0},{"name":")" + std::string(5000, 'y') +
                                      R"(","mesh":0},{"name":"","mesh":0})",
                                  "0,1,2");
    const std::string clean = "a\xef\xbf\xbd" + std::string("b\xef\xbf\xbd[31m");
    expectMarks(
        "h.gltf", text,
        {{{clean}, {1, 1, 0, 0, 0, 0}}, {{std::string(kSelectedNameBytesMax, 'y')}, {0, 0, 1, 1, 0, 0}}});
    expectUnknown("h.gltf", text, {std::string(kSelectedNameBytesMax, 'z')}, "; names: '");
    std::string many;
    for (int i = 0; i < 3000; ++i) {
        many += "g group" + std::to_string(i) + std::string(100, 'n') + "\nf 1 2 3\n";
    }
    expectUnknown("m.obj", obj(many), {"x"}, " and more");
    const Names crowd(kSelectedNamesMax + 1, "paint");
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

using Lines = std::vector<std::string>;

MeshParts objParts(std::string_view text) {
    const Result<ObjMesh> mesh = readObj(std::as_bytes(std::span(text)));
    EXPECT_TRUE(mesh) << mesh.error().message;
    return mesh ? partsOf(mesh->polygons) : MeshParts();
}

/// A valid file, its warnings without "NAME: ", and other expected results.
struct Expected {
    std::string name;
    std::string text;
    Lines warnings;
    std::uint64_t unused_vertices = 0;
    std::size_t triangles = 4;
};

void expectRead(const std::vector<Expected>& cases) {
    for (const Expected& c : cases) {
        SCOPED_TRACE(c.name);
        const TriangleMesh mesh = imported(c.name, c.text);
        Lines warnings;
        for (const std::string& warning : mesh.warnings) {
            warnings.push_back(warning.substr(warning.find(": ") + 2));
        }
        EXPECT_EQ(warnings, c.warnings);
        EXPECT_EQ(mesh.unused_vertices, c.unused_vertices);
        EXPECT_EQ(mesh.triangles.size(), c.triangles);
        EXPECT_LE(mesh.bounds.max.z, 3.0F) << "unused vertices must not extend the bounds";
    }
}

TEST(ImportParts, EveryCountHasAWarning) {
    const auto warning = [](const MeshParts& parts) {
        Lines warnings;
        warnAboutParts(parts, warnings);
        return warnings;
    };
    EXPECT_EQ(warning({.polygons = 1, .vertices = 3}), Lines());
    EXPECT_EQ(
        warning({.polygons = 1, .lines = 1, .points = 1, .free_forms = 3}),
        Lines{"left out 1 line, 1 point and 3 free-form curves or surfaces: only polygons have a surface"});
    // A tenth of the vertices can be loose. Vertices of lines are not loose.
    EXPECT_EQ(warning({.polygons = 9, .vertices = 100, .unused = 90, .loose = 10}), Lines());
    EXPECT_EQ(warning({.polygons = 9, .vertices = 100, .unused = 11, .loose = 11}).size(), 1U);
    EXPECT_FALSE(partsError({.polygons = 1, .lines = 1}));
    EXPECT_FALSE(partsError({}));
    EXPECT_EQ(partsError({.points = 2}), "no triangles, but 2 points; export the surface as polygons");
    EXPECT_TRUE(partsError({.vertices = 1, .unused = 1, .loose = 1})->starts_with("1 vertex but no faces; "));
}

TEST(ImportParts, ObjStatementsAreCounted) {
    const MeshParts parts = objParts(
        "# v 0 0 0\nv 0 0 0\n  v 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nv 5 5 5\nv 6 6 6\nv 7 7 7 \\\n 1\n"
        "f 1/1/1 2//1 \\\n 3/1\nl 4 -1\nf -6 2 1\nf 1 2 1 3\ncurv 0 1 1 2\nsurf 0 1 0 1 1 2\nvp 0 0\nf 2 "
        "3\n");
    EXPECT_EQ(parts.vertices, 6U);
    EXPECT_EQ(parts.unused, 3U);
    EXPECT_EQ(parts.loose, 1U);  // vertex 5; the line has 4 and 6, and the faces have 1, 2 and 3
    EXPECT_EQ(parts.polygons, 3U);
    EXPECT_EQ(parts.lines, 2U) << "a face with two corners is a line";
    EXPECT_EQ(parts.free_forms, 2U);
    EXPECT_EQ(objParts("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").unused, 0U) << "faces can precede vertices";
    EXPECT_EQ(objParts("").vertices, 0U);
    EXPECT_EQ(objParts("v 1 2 3\\").vertices, 1U);
}

TEST(ImportParts, UnusedVerticesAreCountedInEveryFormat) {
    const std::string warning =
        "2 of its 6 vertices belong to no polygon: faces may be missing; compare its triangle count "
        "with that of the exporting program";
    std::string ply = replaced(tetrahedronPly(), "vertex 4", "vertex 6");
    ply.insert(ply.find("3 0 2 1"), "8 8 8\n9 9 9\n");
    const std::string half = R"("bufferView":1,"componentType":5123,"count":3,"type":"SCALAR")";
    expectRead(
        {{"a.obj", tetrahedronObj(), {}},
         {"b.obj", tetrahedronObj() + "v 9 9 9\nv 9 9 9\nf 1 1 2\nf 2 2 2\n", {warning}, 2},
         {"a.ply", ply, {warning}, 2},
         // Only the first three of twelve indices: one of four vertices has no triangle.
         {"a.gltf",
          tetrahedronGltf({.indices = half}),
          {replaced(warning, "2 of its 6 vertices belong", "1 of its 4 vertices belongs")},
          1,
          1},
         // Two primitives share one vertex list, as many exporters write them. Each uses its own part.
         {"shared.gltf",
          tetrahedronGltf(
              {.primitive =
                   R"("attributes":{"POSITION":0},"indices":1},{"attributes":{"POSITION":0},"indices":2)",
               .indices =
                   half +
                   R"(},{"bufferView":1,"byteOffset":6,"componentType":5123,"count":3,"type":"SCALAR")"}),
          {},
          0,
          2}});
}

TEST(ImportParts, LinesPointsAndFreeFormsAreCountedOrRejected) {
    const std::string patch = "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\nend\n";
    const std::string whole = R"("attributes":{"POSITION":0},"indices":1},{)";
    const std::string part = R"("attributes":{"POSITION":0},"mode":)";
    const auto gltf = [](const std::string& primitives) {
        return tetrahedronGltf({.primitive = primitives});
    };
    // The scene contains one of two meshes, or both.
    const std::string two =
        replaced(tetrahedronGltf(), R"(}]}],"accessors")",
                 R"(}]},{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors")");
    const std::string all =
        replaced(two, R"({"mesh":0})", R"({"children":[1]},{"mesh":1,"children":[2]},{"mesh":0})");
    expectRead({{"m.obj",
                 tetrahedronObj() + "v 5 5 5\nv 6 6 6\nl 5 6 1\np 5 6\n",
                 {"left out 2 lines and 2 points: only polygons have a surface"},
                 2},
                {"f.obj",
                 tetrahedronObj() + patch,
                 {"left out 1 free-form curve or surface: only polygons have a surface"}},
                {"p.gltf", gltf(whole + part + "0"), {"left out 4 points: only polygons have a surface"}},
                {"l.gltf",
                 gltf(whole + part + "1},{" + part + "2},{" + part + "3"),
                 {"left out 9 lines: only polygons have a surface"}},
                {"two.gltf", two, {"left out 1 of its 2 meshes: no node of its scene places them"}},
                {"all.gltf", all, {}, 0, 8}});
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    expectWrong("l.obj", {{corners + "l 1 2 3\n", "no triangles, but 2 lines"},
                          {corners + "p 1 2 3\n", "no triangles, but 3 points"},
                          {corners, "3 vertices but no faces"},
                          {corners + "v 1 1 0\n" + patch, "1 free-form curve or surface"}});
    expectWrong("l.gltf", {{gltf(part + "0"), "no triangles, but 4 points"},
                           {gltf(part + "3"), "no triangles, but 3 lines"}});
}

}  // namespace
}  // namespace relief::test
