// SPDX-License-Identifier: Apache-2.0
// Everything in a mesh file except triangles is counted, named or rejected. Nothing is skipped without a warning.
#include "bake/import/scene_polygons.h"

#include "bake/import/mesh_import.h"
#include "formats/polygons/obj_mesh.h"
#include "tests/bake/import/import_meshes.h"

namespace relief::test {
namespace {

using Lines = std::vector<std::string>;

MeshParts obj(std::string_view text) {
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
        warnOfParts(parts, warnings);
        return warnings;
    };
    EXPECT_EQ(warning({.polygons = 1, .vertices = 3}), Lines());
    EXPECT_EQ(
        warning({.polygons = 1, .lines = 1, .points = 1, .free_forms = 3}),
        Lines{"left out 1 line, 1 point and 3 free-form curves or surfaces: only polygons have a surface"});
    // A tenth of the vertices can be loose. Vertices of lines are not loose.
    EXPECT_EQ(warning({.polygons = 9, .vertices = 100, .unused = 90, .loose = 10}), Lines());
    EXPECT_EQ(warning({.polygons = 9, .vertices = 100, .unused = 11, .loose = 11}).size(), 1U);
    EXPECT_FALSE(partsRefusal({.polygons = 1, .lines = 1}));
    EXPECT_FALSE(partsRefusal({}));
    EXPECT_EQ(partsRefusal({.points = 2}), "no triangles, but 2 points; export the surface as polygons");
    EXPECT_TRUE(
        partsRefusal({.vertices = 1, .unused = 1, .loose = 1})->starts_with("1 vertex but no faces; "));
}

TEST(ImportParts, ObjStatementsAreCounted) {
    const MeshParts parts =
        obj("# v 0 0 0\nv 0 0 0\n  v 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nv 5 5 5\nv 6 6 6\nv 7 7 7 \\\n 1\n"
            "f 1/1/1 2//1 \\\n 3/1\nl 4 -1\nf -6 2 1\nf 1 2 1 3\ncurv 0 1 1 2\nsurf 0 1 0 1 1 2\nvp 0 0\nf 2 "
            "3\n");
    EXPECT_EQ(parts.vertices, 6U);
    EXPECT_EQ(parts.unused, 3U);
    EXPECT_EQ(parts.loose, 1U);  // vertex 5; the line has 4 and 6, and the faces have 1, 2 and 3
    EXPECT_EQ(parts.polygons, 3U);
    EXPECT_EQ(parts.lines, 2U) << "a face with two corners is a line";
    EXPECT_EQ(parts.free_forms, 2U);
    EXPECT_EQ(obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").unused, 0U) << "faces can precede vertices";
    EXPECT_EQ(obj("").vertices, 0U);
    EXPECT_EQ(obj("v 1 2 3\\").vertices, 1U);
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
