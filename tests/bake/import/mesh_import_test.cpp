// SPDX-License-Identifier: Apache-2.0
// Small files in several formats: what determines the format, AC3D as TORCS and other programs write it, and polygons,
// which are triangulated without gaps and overlaps, also far from the origin.
#include <gtest/gtest.h>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <random>

#include "bake/import/import_format.h"
#include "bake/import/level.h"
#include "bake/import/mesh_import.h"
#include "bake/import/polygon_cutter.h"
#include "bake/mesh/triangle_plane.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"
#include "tests/seeds.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

// A unit box with a corner at the origin, made of quads.
constexpr const char* kBoxObj =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";

TEST(MeshImport, ObjWithQuads) {
    const TriangleMesh mesh = imported("box.obj", kBoxObj);
    EXPECT_EQ(mesh.triangles.size(), 12U);
    EXPECT_NEAR(signedVolume(mesh), 1.0, 1e-6);
    EXPECT_EQ(mesh.bounds, (Bounds{glm::vec3(0), glm::vec3(1)}));
    EXPECT_EQ(mesh.name, "box.obj");
    EXPECT_EQ(mesh.unit, "");
    EXPECT_EQ(mesh.content_hash, xxh3_128Hex(std::as_bytes(std::span(kBoxObj, std::strlen(kBoxObj)))));
    EXPECT_TRUE(importText("BOX.OBJ", kBoxObj)) << "extensions are not case-sensitive";
    EXPECT_EQ(imported("h\xc3\xa4se\xff \x1b.obj", kBoxObj).name, "h\xc3\xa4se\xef\xbf\xbd \xef\xbf\xbd.obj");
}

TEST(MeshImport, MirroredNodesKeepOutwardWinding) {
    const auto read = [](const std::string& nodes) {
        return imported("m.gltf", tetrahedronGltf({.nodes = nodes}));
    };
    const TriangleMesh plain = read(R"({"mesh":0})");
    const TriangleMesh mirrored = read(R"({"mesh":0,"scale":[-1,1,1]})");
    const TriangleMesh twice = read(R"({"children":[1],"scale":[-1,1,1]},{"mesh":0,"scale":[1,1,-1]})");
    for (const TriangleMesh* mesh : {&plain, &mirrored, &twice}) {
        EXPECT_NEAR(signedVolume(*mesh), 1.0, 1e-6);
        EXPECT_TRUE(mesh->warnings.empty());
    }
    EXPECT_EQ(mirrored.bounds.min, glm::vec3(-1, 0, 0));
    EXPECT_EQ(twice.bounds.min, glm::vec3(-1, 0, -3));
    // Mirrored meshes give mirrored maps. The normal of the slanted face points outward in both.
    const glm::dvec3 normal = glm::normalize(glm::dvec3(6, 3, 2));
    for (const auto& [mesh, x] : {std::pair{&plain, 0.2F}, std::pair{&mirrored, -0.2F}}) {
        const Vote v = vote(bakeMap(*mesh, "float:dir=-z"), {x, 0.4F, 6.0F}).value();
        EXPECT_NEAR(v.normal.x, std::copysign(normal.x, x), 1e-3);
        EXPECT_NEAR(v.normal.z, normal.z, 1e-3);
    }
}

TEST(MeshImport, ErrorsNameTheFile) {
    const TemporaryFolder folder;
    for (const auto& import : {+[](const std::filesystem::path& path) { return importMesh(path); },
                               +[](const std::filesystem::path& path) { return importMeshInWorker(path); }}) {
        expectRejected(import(folder.path() / "missing.obj"), "missing.obj", ErrorCode::kIo);
        expectRejected(import(folder.path()), "folder", ErrorCode::kIo);
        for (const char* name : {"mesh.xyzzy", "noextension"}) {
            expectRejected(import(folder.write(name, "hello")), name, ErrorCode::kUnsupported);
        }
        expectRejected(import(folder.write("empty.obj", "")), "empty.obj");
    }
    std::string noise(5000, '\0');
    std::uint32_t state = 3;
    for (char& c : noise) {
        state = state * 1664525U + 1013904223U;
        c = static_cast<char>(state >> 24);
    }
    for (const std::string name :
         {"n.obj", "n.stl", "n.ply", "n.off", "n.gltf", "n.glb", "n.fbx", "n.dae", "n.3ds"}) {
        SCOPED_TRACE(name);
        expectRejected(importText(name, noise), name);
    }
    expectWrong("w.obj",
                {{"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "area"},
                 {"v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ""},
                 {"v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ""},
                 {"v 0 0 1e30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "1e15"},
                 {"v 1e9 0 0\nv 1000000001 0 0\nv 1000000001 1 0\nf 1 2 3\n", "floats are 64 apart"}});
    expectWrong("w.gltf", {{tetrahedronGltf({.nodes = R"({"mesh":0,"scale":[1e30,1e30,1e30]})"}), "1e15"},
                           {tetrahedronGltf({.nodes = R"({"mesh":0,"scale":[0,1,0]})"}), "area"}});
}

TEST(FinishMesh, RejectsInvalidMeshes) {
    TriangleMesh mesh;
    mesh.name = "raw";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 3}};
    expectRejected(finishMesh(mesh), "vertex 3");
    mesh.triangles.clear();
    expectRejected(finishMesh(mesh), "no triangle");
    mesh.triangles = {{0, 1, 2}};
    mesh.positions = {{0, 0, 0}, {1e-20F, 0, 0}, {0, 1e-20F, 0}};
    expectRejected(finishMesh(mesh), "1e-15");
}

namespace fs = std::filesystem;

std::string model(const char* name) {
    const std::vector<std::byte> bytes = required(readFile(fs::path("/usr/share/assimp/models") / name));
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(ImportFormat, SignaturesOverrideNames) {
    const std::vector<std::pair<std::string, std::string>> contents = {
        {"ply", tetrahedronPly()},
        {"fbx", tetrahedronFbx(1, 1, "100")},
        {"glb", model("glTF2/BoxTextured-glTF-Binary/BoxTextured.glb")},
        {"blend", model("BLEND/Suzanne_248.blend")},
        {"ms3d", model("MS3D/twospheres.ms3d")},
        {"x", model("X/test_cube_text.x")},
    };
    for (const auto& [format, bytes] : contents) {
        for (const std::string name :
             {"obj", "stl", "ply", "off", "gltf", "glb", "dae", "3ds", "fbx", "smd"}) {
            SCOPED_TRACE(format + " under the name of " + name);
            const auto other = otherFormat(name, std::as_bytes(std::span(bytes)));
            EXPECT_EQ(other, name == format ? std::nullopt : std::optional(format));
        }
        const TriangleMesh right = required(importTextInWorker("right." + format, bytes));
        const TriangleMesh wrong = required(importTextInWorker("wrong.obj", bytes));
        EXPECT_EQ(wrong.name, "wrong.obj");
        EXPECT_EQ(wrong.positions, right.positions);
        EXPECT_EQ(wrong.triangles, right.triangles);
        EXPECT_TRUE(warns(wrong, "its contents are those of a ." + format));
        EXPECT_FALSE(warns(right, "its contents"));
    }
    EXPECT_TRUE(importTextInWorker("json.glb", tetrahedronGltf()));
    // Files without an unambiguous signature are read by their name.
    expectRejected(importTextInWorker("b.obj", "glTF and other words\n"), "b.obj");
}

TEST(ImportFormat, FilesWithoutSignatureAreReadByName) {
    for (const std::string& text : {tetrahedronObj(), tetrahedronStl(), tetrahedronOff(), tetrahedronGltf(),
                                    tetrahedronDae(""), tetrahedronBinaryStl(""), tetrahedron3ds()}) {
        int read = 0;
        for (const char* name : {"w.obj", "w.stl", "w.ply", "w.off", "w.gltf", "w.dae", "w.3ds", "w.fbx"}) {
            read += importTextInWorker(name, text) ? 1 : 0;
        }
        EXPECT_EQ(read, 1) << text.substr(0, 20);
    }
    for (const char* name : {"w.amf", "w.dxf", "w.acx", "w.xyzzy"}) {
        expectRejected(importText(name, tetrahedronObj()), "convert it to glTF, OBJ or PLY",
                       ErrorCode::kUnsupported);
    }
    for (const char* name : {"w.png", "w.raw"}) {
        expectRejected(importText(name, tetrahedronObj()), "bake it with --heights", ErrorCode::kUnsupported);
    }
}

TEST(ImportFormat, NonMeshesAreRejected) {
    const std::string rest(300, '\x01');
    for (const char* begin : {"\x1f\x8b\b", "PK\x03\x04", "\xff\xfe", "\x89PNG\r\n", "\xff\xd8\xff",
                              "%PDF-1.4", "<html><body>", "version https://git-lfs.github.com/spec/v1\n"}) {
        for (const char* name : {"a.obj", "a.stl", "a.gltf", "a.dae", "a.fbx"}) {
            const Result<TriangleMesh> mesh = importTextInWorker(name, begin + rest);
            EXPECT_TRUE(!mesh && mesh.error().message.find(name) != std::string::npos) << begin;
        }
    }
    expectRejected(importText("a.obj", "hello\n"), "no vertices, and is probably not an .obj file");
    for (const auto& [name, text] : {std::pair<const char*, std::string>{"a.stl", std::string(84, '\0')},
                                     {"b.stl", "solid none\nendsolid none\n"},
                                     {"a.off", "OFF\n0 0 0\n"}}) {
        expectRejected(importText(name, text), "it has no triangles; export");
    }
}

TEST(ImportFormat, CompressedBlendFilesAreDetected) {
    EXPECT_EQ(imported("a.blend", model("BLEND/BlenderDefault_250_Compressed.blend")).triangles.size(), 12U);
}

TEST(ImportFormat, TextCanStartWithAByteOrderMark) {
    const std::string mark = "\xef\xbb\xbf";
    const TriangleMesh plain = imported("a.obj", tetrahedronObj());
    const TriangleMesh marked = imported("a.obj", mark + tetrahedronObj());
    EXPECT_EQ(marked.positions, plain.positions);
    EXPECT_NE(marked.content_hash, plain.content_hash) << "the hash covers all bytes of the file";
    EXPECT_TRUE(importText("a.gltf", mark + tetrahedronGltf()));
}

const std::string kAc3dHead =
    "AC3Db\n"
    "MATERIAL \"red paint\" rgb 1 0 0  amb 1 1 1  emis 0 0 0  spec 0 0 0  shi 10  trans 0\n"
    "MATERIAL \"\" rgb 1 1 1  amb 1 1 1  emis 0 0 0  spec 0 0 0  shi 10  trans 0\n";

/// A tetrahedron with two materials. \param keys  lines before its vertices. \param after  text after 'kids'
std::string tetrahedron(const std::string& name, const std::string& keys = "",
                        const std::string& kids = "0") {
    return "OBJECT poly\nname \"" + name + "\"\n" + keys +
           "numvert 4\n0 0 0\n1 0 0\n0 2 0\n0 0 3\nnumsurf 4\n"
           "SURF 0x0\nmat 0\nrefs 3\n0 0 0\n2 0 1\n1 1 0\nSURF 0X30\nmat 1\nrefs 3\n0 0 0\n1 0 1\n3 1 0\n"
           "SURF 0x20\nmat 0\nrefs 3\n1 0 0\n2 0 1\n3 1 0\nSURF 0x10\nrefs 3\n0 0 0\n3 0 1\n2 1 0\nkids " +
           kids + "\n";
}

TEST(Ac3d, ObjectsInheritTransforms) {
    // Children inherit the parent's offset. 'rot' maps x to y: its triples are the images of the axes.
    const TemporaryFolder folder;
    const Level read = required(importLevel(folder.write(
        "l.acc", kAc3dHead + "OBJECT world\nkids 2\nOBJECT group\nname \"yard\"\nloc 10 0 0\nkids 1\n" +
                     tetrahedron("tower", "loc 0 1 0\nrot 0 1 0 -1 0 0 0 0 1\n", "1") +
                     tetrahedron("flag", "loc 5 0 0\n") + tetrahedron("tree"))));
    ASSERT_EQ(read.bodies.size(), 3U);
    ASSERT_EQ(read.meshes.size(), 1U);
    EXPECT_EQ(read.meshes[0].triangles.size(), 4U);
    EXPECT_EQ(read.unit, "");
    EXPECT_TRUE(read.warnings.empty());
    const std::array<std::string, 3> nodes = {"tower", "flag", "tree"};
    const std::array<std::array<double, 3>, 3> places = {{{10, 1, 0}, {10, 6, 0}, {0, 0, 0}}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(read.bodies[i].node, nodes[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(read.bodies[i].position[k], places[i][k], 1e-6) << nodes[i];
        }
        EXPECT_NEAR(read.bodies[i].rotation[2], i < 2 ? std::sqrt(0.5) : 0.0, 1e-6);
    }
}

TEST(Ac3d, SurfacesOfEveryKind) {
    // A quad as a strip with normals and two textures, joined to another quad by duplicate vertices, and two lines.
    const std::string strip =
        "OBJECT poly\nname plain\ntexture \"a b.rgb\" base\ntexture empty_texture_no_mapping skids\ndata "
        "13\nOBJECT\nkids 9\n"
        "crease 45\nnumvert 6\n0 0 0 0 1 0\n0 0 1 0 1 0\n1 0 0 0 1 0\n1 0 1 0 1 0\n3 0 0 0 1 0\n3 0 1 0 1 "
        "0\nnumsurf 3\n"
        "SURF 0x14\nmat 0\nrefs 10\n0 0 0 0 0\n1 0 1 0 1\n2 1 0 1 0\n3 1 1 1 1\n3 1 1\n2 1 0\n2 1 0\n3 1 "
        "1\n4 1 0\n5 1 1\n"
        "SURF 0x1\nmat 0\nrefs 3\n0 0 0\n1 0 0\n2 0 0\nSURF 0x2\nmat 0\nrefs 2\n0 0 0\n1 0 0\nkids 0\n";
    const TriangleMesh mesh = imported("a.ac", kAc3dHead + "OBJECT world\r\nkids 1\r\n" + strip);
    ASSERT_EQ(mesh.triangles.size(), 4U);
    double area = 0.0;
    for (std::uint32_t t = 0; t < 4; ++t) {
        const auto [a, b, c] = cornersOf(mesh, t);
        const glm::dvec3 normal = glm::cross(glm::dvec3(b - a), glm::dvec3(c - a));
        EXPECT_GT(normal.y, 0.5) << "triangle " << t;
        area += 0.5 * normal.y;
    }
    EXPECT_NEAR(area, 3.0, 1e-6);
    EXPECT_TRUE(mesh.warnings.size() == 1 && warns(mesh, "left out 2 lines"));
}

TEST(Ac3d, NamesAndMaterialsAreSelectable) {
    ImportOptions options;
    options.names = {"red paint", "big tower"};
    const std::string one = kAc3dHead + "OBJECT world\nkids 1\n" + tetrahedron("big tower");
    EXPECT_EQ(imported("n.ac", one, options).marks, std::vector<std::uint8_t>(4, 2));
}

TEST(Ac3d, OddFilesWarnOrFailWithTheLine) {
    const std::string one = kAc3dHead + "OBJECT world\nkids 1\n" + tetrahedron("t");
    const TriangleMesh fewer =
        imported("a.ac", kAc3dHead + "OBJECT world\nkids 3\n" + tetrahedron("t", "subdiv 2\n"));
    EXPECT_EQ(fewer.warnings.size(), 2U);
    EXPECT_TRUE(warns(fewer, "it has 2 fewer objects than its 'kids' declare"));
    EXPECT_TRUE(warns(fewer, "1 of its objects use subdivision"));
    for (std::size_t length = kAc3dHead.size(); length + 8 < one.size(); length += 7) {
        ASSERT_FALSE(importText("a.ac", one.substr(0, length))) << "truncated to " << length << " bytes";
    }
    std::string deep = kAc3dHead;
    for (int i = 0; i < 1100; ++i) {
        deep += "OBJECT group\nkids 1\n";
    }
    const auto with = [&](const std::string& from, const std::string& to) {
        return std::string(one).replace(one.find(from), from.size(), to);
    };
    expectWrong("a.ac", {{with("1 0 0\n", "1 zero 0\n"), "line 10: 'zero'"},
                         {with("2 0 1\n", "4 0 1\n"),
                          "the vertex '4', but its object has 4 vertices, numbered from 0"},
                         {with("SURF 0x0", "SURF green"), "'green' is not a number such as 0x20"},
                         {with("numvert 4", "numvert 5"), "not a number"},
                         {with("numvert 4", "numvert 99999999999"), "", ErrorCode::kLimit},
                         {with("kids 1", "kids many"), "'many' is not a number of kids"},
                         {with("refs 3", "refs 4000000000"), "line "},
                         {with("\nkids 0", "\n"), "no 'kids'"},
                         {kAc3dHead, "no triangles"},
                         {"AC4D\n", "does not begin with AC3D"},
                         {deep + tetrahedron("t"), "", ErrorCode::kLimit}});
}

/// Twice the area vector of a polygon.
double areaOf(const std::vector<glm::vec3>& corners) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum += planeOf(corners[0], corners[i], corners[i + 1]).normal;
    }
    return length(sum);
}

/// Expects triangles with positive areas and the polygon's winding, whose areas sum to that of the polygon.
void expectWhole(const std::vector<glm::vec3>& corners, const std::string& what, double tolerance = 1e-3) {
    PolygonCutter cutter;
    const auto triangles = cutter.cut(corners);
    ASSERT_EQ(triangles.size(), corners.size() - 2) << what;
    glm::dvec3 sum(0.0);
    double areas = 0.0;
    for (const glm::uvec3& t : triangles) {
        const TrianglePlane plane = planeOf(corners, t);
        EXPECT_TRUE(hasArea(plane)) << what;
        areas += length(plane.normal);
        sum += plane.normal;
    }
    EXPECT_NEAR(areas, length(sum), tolerance * areas) << what << ": some triangles are reversed";
    EXPECT_NEAR(areas, areaOf(corners), tolerance * areas) << what;
}

/// A rectangle with `more` extra vertices on its edges.
std::vector<glm::vec3> rectangle(int more, const glm::dvec3& origin, const glm::dvec3& u,
                                 const glm::dvec3& v) {
    std::vector<glm::vec3> corners;
    const glm::dvec3 ends[4] = {origin, origin + u, origin + u + v, origin + v};
    for (int side = 0; side < 4; ++side) {
        const glm::dvec3 step = (ends[(side + 1) % 4] - ends[side]) / (more + 1.0);
        for (int i = 0; i <= more; ++i) {
            corners.emplace_back(ends[side] + static_cast<double>(i) * step);
        }
    }
    return corners;
}

TEST(PolygonCutter, CornersOnStraightEdges) {
    for (const double far : {0.0, 1.4e5, -1.4e5, 1e7}) {
        for (const int more : {1, 2, 7}) {
            const double size = std::max(1.0, std::abs(far) * 1e-5) * (more + 1);
            const glm::dvec3 origin(far, 0.3 * far, -far);
            const std::string what = std::to_string(far) + ", " + std::to_string(more);
            expectWhole(rectangle(more, origin, {size, 0, 0}, {0, size, 0}), what);
            expectWhole(rectangle(more, origin, {0, 0, size}, {size, 0, 0}), what);
        }
    }
    // A triangle with an extra vertex on any edge.
    for (int i = 0; i < 3; ++i) {
        std::vector<glm::vec3> corners{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
        corners.insert(corners.begin() + i + 1, 0.5F * (corners[i] + corners[(i + 1) % 3]));
        for (int turn = 0; turn < 4; ++turn) {
            std::rotate(corners.begin(), corners.begin() + 1, corners.end());
            expectWhole(corners, std::to_string(i) + ", " + std::to_string(turn));
        }
    }
}

TEST(PolygonCutter, ConcavePolygonsFarFromTheOrigin) {
    for (std::uint32_t seed = seedFrom(31), end = seed + 200; seed < end; ++seed) {
        // A star with random radii, which does not intersect itself.
        std::mt19937 random(seed);
        const int count = 5 + static_cast<int>(random() % 40);
        const double far = (seed % 4) * 1.4e5;
        std::vector<glm::vec3> corners;
        for (int i = 0; i < count; ++i) {
            const double angle = 6.283185307179586 * i / count;
            const double radius = 200.0 + static_cast<double>(random() % 1000);
            const glm::dvec3 p(radius * std::cos(angle), radius * std::sin(angle), 0.0);
            corners.emplace_back(p.x + far, p.z - far, p.y + 2.0 * far);
        }
        expectWhole(corners, "seed " + std::to_string(seed));
    }
}

TEST(PolygonCutter, DegeneratePolygonsAreTriangulated) {
    PolygonCutter cutter;
    const std::vector<glm::vec3> knot{{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}, {2, 9, 0}};
    const std::vector<glm::vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}};
    const std::vector<glm::vec3> nowhere(7, glm::vec3(NAN));
    for (const auto& corners : {knot, line, nowhere, std::vector<glm::vec3>(4, glm::vec3(1))}) {
        const auto triangles = cutter.cut(corners);
        ASSERT_EQ(triangles.size(), corners.size() - 2);
        for (const glm::uvec3& t : triangles) {
            EXPECT_LT(std::max({t.x, t.y, t.z}), corners.size());
        }
    }
}

TEST(PolygonCutter, CombWithThousandsOfTeethIsTriangulated) {
    // A quadratic search for ears among 8,000 vertices took most of a minute.
    constexpr int kTeeth = 2000;
    std::vector<glm::vec3> corners;
    for (int i = 0; i < kTeeth; ++i) {
        const auto x = static_cast<float>(2 * i);
        corners.emplace_back(x, 5.0F, 0.0F);
        corners.emplace_back(x + 1.0F, 0.0F, 0.0F);
    }
    corners.emplace_back(2.0F * kTeeth, 5.0F, 0.0F);
    corners.emplace_back(2.0F * kTeeth, -1.0F, 0.0F);
    corners.emplace_back(0.0F, -1.0F, 0.0F);
    expectWhole(corners, "comb", 1e-6);
}

TEST(PolygonCutter, SelfIntersectingPolygonLosesNoTriangles) {
    // An incomplete first attempt must not be preferred to a complete one.
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    PolygonCutter cutter;
    for (int round = 0; round < 3000; ++round) {
        std::vector<glm::vec3> corners(static_cast<std::size_t>(5 + round % 12));
        for (glm::vec3& corner : corners) {
            corner = {unit(random), unit(random), 0.0F};
        }
        EXPECT_EQ(cutter.cut(corners).size(), corners.size() - 2) << "round " << round;
    }
}

}  // namespace
}  // namespace relief::test
