// What a mesh file holds beside triangles: counted, named or refused; never left out without a word.
#include "bake/import/import_scene.h"

#include <gtest/gtest.h>
#include <cstdio>
#include <random>

#include "bake/import/mesh_import.h"
#include "formats/polygons/obj_mesh.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"
#include "tests/bake/voxels.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

Result<TriangleMesh> load(const std::string& name, std::string_view contents) {
    const TemporaryFolder folder;
    return importMeshInWorker(folder.write(name, contents));
}

MeshParts obj(std::string_view text) {
    const Result<ObjMesh> mesh = readObj(std::as_bytes(std::span(text)));
    EXPECT_TRUE(mesh) << mesh.error().message;
    return mesh ? partsOf(mesh->polygons) : MeshParts();
}

/// The warnings, each without "NAME: ".
std::vector<std::string> warningsOf(const Result<TriangleMesh>& mesh) {
    EXPECT_TRUE(mesh) << mesh.error().message;
    std::vector<std::string> warnings;
    for (const std::string& warning : mesh ? mesh->warnings : std::vector<std::string>()) {
        warnings.push_back(warning.substr(warning.find(": ") + 2));
    }
    return warnings;
}

void expectRefused(const Result<TriangleMesh>& mesh, const std::string& says) {
    ASSERT_FALSE(mesh) << says;
    EXPECT_EQ(mesh.error().code, ErrorCode::kInvalidInput);
    EXPECT_NE(mesh.error().message.find(says), std::string::npos) << mesh.error().message;
    EXPECT_NE(mesh.error().message.find("; "), std::string::npos) << "no cure: " << mesh.error().message;
}

using Lines = std::vector<std::string>;

TEST(ImportParts, WordsForEachCount) {
    const auto warning = [](const MeshParts& parts) {
        Lines warnings;
        warnOfParts(parts, warnings);
        return warnings;
    };
    EXPECT_EQ(warning({.polygons = 1, .vertices = 3}), Lines());
    EXPECT_EQ(warning({.polygons = 1, .lines = 1}), Lines{"left out 1 line: only polygons have a surface"});
    EXPECT_EQ(
        warning({.polygons = 1, .lines = 2, .points = 1, .free_forms = 3}),
        Lines{"left out 2 lines, 1 point and 3 free-form curves or surfaces: only polygons have a surface"});
    EXPECT_EQ(warning({.polygons = 1, .meshes = 3, .unplaced = 2}),
              Lines{"left out 2 of its 3 meshes: no node of its scene places them"});
    // A tenth of the vertices may lie loose; those of lines are none of them.
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
    EXPECT_EQ(parts.loose, 1U);  // 5: neither the line's 4 and 6 nor the faces' 1, 2 and 3
    EXPECT_EQ(parts.polygons, 3U);
    EXPECT_EQ(parts.lines, 2U) << "a face of two corners is one";
    EXPECT_EQ(parts.free_forms, 2U);
    EXPECT_EQ(obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").unused, 0U) << "faces may come first";
    EXPECT_EQ(obj("").vertices, 0U);
    EXPECT_EQ(obj("v 1 2 3\\").vertices, 1U);
}

std::string asciiStl() {
    std::string text = "solid t\n";
    for (const char* corners :
         {"0 0 0 0 1 0 1 0 0", "0 0 0 1 0 0 0 0 1", "1 0 0 0 1 0 0 0 1", "0 0 0 0 0 1 0 1 0"}) {
        float c[9];
        std::sscanf(corners, "%f%f%f%f%f%f%f%f%f", c, c + 1, c + 2, c + 3, c + 4, c + 5, c + 6, c + 7, c + 8);
        text += "facet normal 0 0 0\nouter loop\n";
        for (int i = 0; i < 9; i += 3) {
            text += "vertex " + std::to_string(c[i]) + " " + std::to_string(c[i + 1]) + " " +
                    std::to_string(c[i + 2]) + "\n";
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid t\n";
}

TEST(ImportParts, AFileThatWasCutOffIsRefused) {
    const std::string whole = asciiStl();
    const Result<TriangleMesh> sound = load("a.stl", whole);
    ASSERT_TRUE(sound) << sound.error().message;
    EXPECT_EQ(sound->triangles.size(), 4U);
    for (const char* end : {"", "\r\n", "\n\n "}) {
        EXPECT_TRUE(load("b.stl", whole.substr(0, whole.size() - 1) + end)) << end;
    }
    EXPECT_TRUE(load("c.stl", whole + std::string(40, '\0'))) << "filled up with zeros";
    // After any of its lines but the last.
    for (std::size_t at = whole.find('\n'); at + 1 < whole.size(); at = whole.find('\n', at + 1)) {
        const Result<TriangleMesh> cut = load("d.stl", whole.substr(0, at + 1));
        ASSERT_FALSE(cut) << whole.substr(0, at);
        EXPECT_NE(cut.error().message.find("cut off"), std::string::npos) << cut.error().message;
    }
    const std::string off = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    EXPECT_TRUE(load("a.off", off));
    for (const auto& [line, says] : {std::pair{"3 0 3 2\n", "line 10: it ends in face 3"},
                                     std::pair{"3 0 1 3\n", "line 10: it ends after face 3 of 4"}}) {
        std::string less = off;
        const std::size_t end = less.find(line) + std::string_view(line).size();
        expectRefused(load("c.off", less.erase(end - 3, 2)), says);
    }
    EXPECT_TRUE(load("d.off", std::string(off).replace(off.find("1 3\n"), 4, "1 3 # 9\n")));
    for (const std::size_t lines : {1, 2, 3}) {
        const Result<TriangleMesh> cut = load("b.off", off.substr(0, off.size() - 8 * lines));
        ASSERT_FALSE(cut) << lines;
        EXPECT_NE(cut.error().message.find("cut off"), std::string::npos) << cut.error().message;
    }
}

std::string numbers(const glm::vec3& p) {
    return std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
}

/// A mesh as ASCII STL, OFF and PLY, by the ends of their names.
std::vector<std::pair<std::string, std::string>> textsOf(const TriangleMesh& mesh) {
    std::string stl = "solid s\n";
    std::string faces;
    for (const glm::uvec3& t : mesh.triangles) {
        stl += "facet normal 0 0 0\nouter loop\n";
        for (int k = 0; k < 3; ++k) {
            stl += "vertex " + numbers(mesh.positions[t[k]]);
        }
        stl += "endloop\nendfacet\n";
        faces += "3 " + std::to_string(t.x) + " " + std::to_string(t.y) + " " + std::to_string(t.z) + "\n";
    }
    std::string vertices;
    for (const glm::vec3& p : mesh.positions) {
        vertices += numbers(p);
    }
    const std::string n = std::to_string(mesh.positions.size());
    const std::string m = std::to_string(mesh.triangles.size());
    return {{"stl", stl + "endsolid\n"},
            {"off", "OFF\n" + n + " " + m + " 0\n" + vertices + faces},
            {"ply", "ply\nformat ascii 1.0\nelement vertex " + n +
                        "\nproperty float x\nproperty float y\nproperty float z\nelement face " + m +
                        "\nproperty list uchar int vertex_indices\nend_header\n" + vertices + faces}};
}

TEST(ImportParts, TextThatWasCutOffBetweenAnyTwoWordsIsRefused) {
    for (std::uint32_t seed = seedFrom(401), end = seed + 12; seed < end; ++seed) {
        const TriangleMesh mesh = VoxelGrid::random(seed).mesh();
        std::mt19937 random(seed);
        for (const auto& [kind, text] : textsOf(mesh)) {
            const Result<TriangleMesh> whole = load("whole." + kind, text);
            ASSERT_TRUE(whole) << whole.error().message;
            EXPECT_EQ(whole->triangles.size(), mesh.triangles.size());
            for (int i = 0; i < 5; ++i) {
                // Behind any word but the last; half of them near the end, where little is missing.
                const std::size_t last = text.find_last_of(" \n", text.size() - 2);
                const std::size_t from = random() % (i % 2 == 0 ? last : std::min<std::size_t>(last, 60));
                const std::size_t at = text.find_last_of(" \n", last - from);
                const Result<TriangleMesh> cut = load("cut." + kind, text.substr(0, at));
                ASSERT_FALSE(cut) << kind << " of seed " << seed << ", " << at << " of " << text.size();
                EXPECT_EQ(cut.error().message.find("crashed"), std::string::npos) << cut.error().message;
            }
        }
    }
}

TEST(ImportParts, WhatReadersOfTextMisread) {
    const std::string mark = "\xef\xbb\xbf";
    const Result<TriangleMesh> plain = load("a.obj", tetrahedronObj());
    const Result<TriangleMesh> marked = load("a.obj", mark + tetrahedronObj());
    ASSERT_TRUE(marked) << marked.error().message;
    EXPECT_EQ(marked->positions, plain->positions);
    EXPECT_NE(marked->content_hash, plain->content_hash) << "of the file's bytes";
    const Result<TriangleMesh> gltf = load("a.gltf", mark + tetrahedronGltf({}));
    EXPECT_TRUE(gltf) << gltf.error().message;

    const Result<TriangleMesh> hexadecimal = load("b.obj", "v 0 0 0\nv 0x1p0 0 0\nv 0 1 0\nf 1 2 3\n");
    ASSERT_FALSE(hexadecimal);
    EXPECT_NE(hexadecimal.error().message.find("line 2: '0x1p0' is hexadecimal"), std::string::npos)
        << hexadecimal.error().message;
}

TEST(ImportParts, ContentsDecideWhereTheNameIsWrong) {
    const Result<TriangleMesh> ply = load("a.obj", tetrahedronPly());
    ASSERT_TRUE(ply) << ply.error().message;
    EXPECT_EQ(ply->triangles.size(), 4U);
    EXPECT_EQ(ply->name, "a.obj");
    EXPECT_EQ(warningsOf(ply),
              Lines{"its contents are those of a .ply, not of a .obj, and are read so; rename it"});
    const Result<TriangleMesh> json = load("a.glb", tetrahedronGltf({}));
    ASSERT_TRUE(json) << json.error().message;
    EXPECT_TRUE(warningsOf(load("a.ply", tetrahedronPly())).empty());
    // What names nothing beyond doubt is read as its name says.
    EXPECT_FALSE(load("b.obj", "glTF and other words\n"));
}

TEST(ImportParts, UnusedVerticesOfEachFormat) {
    const std::string more = "v 9 9 9\n";
    EXPECT_EQ(load("a.obj", tetrahedronObj())->unused_vertices, 0U);
    const Result<TriangleMesh> loose = load("b.obj", tetrahedronObj() + more + more);
    EXPECT_EQ(
        warningsOf(loose),
        Lines{
            "2 of its 6 vertices belong to no polygon: faces may be missing; compare the count of triangles "
            "with that of the program that wrote it"});
    EXPECT_EQ(loose->unused_vertices, 2U);
    EXPECT_EQ(loose->bounds.max, glm::vec3(1, 2, 3)) << "an unused vertex widens the box";

    std::string ply = tetrahedronPly();
    ply.replace(ply.find("vertex 4"), 8, "vertex 6");
    ply.replace(ply.find("3 0 2 1"), 0, "8 8 8\n9 9 9\n");
    const Result<TriangleMesh> of_ply = load("a.ply", ply);
    EXPECT_EQ(warningsOf(of_ply).size(), 1U);
    EXPECT_EQ(of_ply->unused_vertices, 2U);
    EXPECT_EQ(of_ply->positions.size(), 4U);
    EXPECT_EQ(of_ply->bounds.max, glm::vec3(1, 2, 3));

    // The first three of the twelve indices: one corner of four has no triangle.
    const Result<TriangleMesh> of_gltf = load(
        "a.gltf",
        tetrahedronGltf({.indices = R"("bufferView":1,"componentType":5123,"count":3,"type":"SCALAR")"}));
    EXPECT_EQ(warningsOf(of_gltf).size(), 1U);
    EXPECT_EQ(of_gltf->unused_vertices, 1U);
}

TEST(ImportParts, VerticesThatPrimitivesShareAreUsedByAny) {
    // Two primitives with one list of vertices, as many exporters write them: each leaves the other's alone.
    const std::string half = R"("bufferView":1,"componentType":5123,"count":3,"type":"SCALAR")";
    const Result<TriangleMesh> mesh =
        load("shared.gltf",
             tetrahedronGltf(
                 {.primitive =
                      R"("attributes":{"POSITION":0},"indices":1},{"attributes":{"POSITION":0},"indices":2)",
                  .indices =
                      half +
                      R"(},{"bufferView":1,"byteOffset":6,"componentType":5123,"count":3,"type":"SCALAR")"}));
    EXPECT_EQ(warningsOf(mesh), Lines());
    EXPECT_EQ(mesh->triangles.size(), 2U);
    EXPECT_EQ(mesh->unused_vertices, 0U);
}

TEST(ImportParts, LinesAndPointsAreCountedOrRefused) {
    const Result<TriangleMesh> mixed = load("m.obj", tetrahedronObj() + "v 5 5 5\nv 6 6 6\nl 5 6 1\np 5 6\n");
    EXPECT_EQ(warningsOf(mixed), Lines{"left out 2 lines and 2 points: only polygons have a surface"});
    EXPECT_EQ(mixed->triangles.size(), 4U);
    EXPECT_EQ(mixed->unused_vertices, 2U);
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    expectRefused(load("l.obj", corners + "l 1 2 3\n"), "no triangles, but 2 lines");
    expectRefused(load("p.obj", corners + "p 1 2 3\n"), "no triangles, but 3 points");
    expectRefused(load("v.obj", corners), "3 vertices but no faces");

    const auto gltf = [](const std::string& primitives) {
        return load("p.gltf", tetrahedronGltf({.primitive = primitives}));
    };
    const std::string whole = R"("attributes":{"POSITION":0},"indices":1)";
    const std::string part = R"("attributes":{"POSITION":0},"mode":)";
    EXPECT_EQ(warningsOf(gltf(whole + "},{" + part + "0")),
              Lines{"left out 4 points: only polygons have a surface"});
    EXPECT_EQ(warningsOf(gltf(whole + "},{" + part + "1},{" + part + "2},{" + part + "3")),
              Lines{"left out 9 lines: only polygons have a surface"});
    expectRefused(gltf(part + "0"), "no triangles, but 4 points");
    expectRefused(gltf(part + "3"), "no triangles, but 3 lines");
}

TEST(ImportParts, FreeFormSurfacesAreNamed) {
    const std::string patch = "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\nend\n";
    EXPECT_EQ(warningsOf(load("f.obj", tetrahedronObj() + patch)),
              Lines{"left out 1 free-form curve or surface: only polygons have a surface"});
    expectRefused(load("s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n" + patch),
                  "1 free-form curve or surface");
}

TEST(ImportParts, MeshesThatNoNodePlaces) {
    // glTF shows what its scene names; the rest is told.
    const std::string second =
        R"(}]},{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors")";
    std::string gltf = tetrahedronGltf();
    gltf.replace(gltf.find(R"(}]}],"accessors")"), 16, second);
    EXPECT_EQ(warningsOf(load("two.gltf", gltf)),
              Lines{"left out 1 of its 2 meshes: no node of its scene places them"});
    EXPECT_EQ(warningsOf(
                  load("all.gltf", gltf.replace(gltf.find(R"({"mesh":0})"), 10,
                                                R"({"children":[1]},{"mesh":1,"children":[2]},{"mesh":0})"))),
              Lines());
}

TEST(ImportParts, LargePolygonsOfOff) {
    // assimp read polygons of up to 9 corners, and the file without the others.
    const auto disc = [](int corners) {
        std::string text = "OFF\n" + std::to_string(corners + 1) + " 2 0\n0 0 1\n";
        std::string face = std::to_string(corners);
        for (int i = 0; i < corners; ++i) {
            text += std::to_string(i) + " " + std::to_string(i * i) + " 0\n";  // on a parabola: convex
            face += " " + std::to_string(i + 1);
        }
        return text + "3 0 1 2\n" + face + "\n";
    };
    for (const int corners : {9, 10, 100}) {
        const Result<TriangleMesh> mesh = load("large.off", disc(corners));
        EXPECT_EQ(warningsOf(mesh), Lines());
        EXPECT_EQ(mesh->triangles.size(), static_cast<std::size_t>(corners) - 1);
    }
}

TEST(ImportParts, IndicesOutOfRangeAreRefusedInGltfToo) {
    // assimp drops such faces, and says so in a warning.
    std::string buffer = tetrahedronBuffer();
    buffer[48] = 9;
    const TemporaryFolder folder;
    folder.write("b.bin", buffer);
    expectRefused(importMeshInWorker(folder.write("i.gltf", tetrahedronGltf({.uri = "b.bin"}))),
                  "a vertex that does not exist");
}

}  // namespace
}  // namespace relief::test
