// SPDX-License-Identifier: Apache-2.0
// Valid and invalid mesh files in several formats, all written by the tests.
#include "bake/import/mesh_import.h"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "formats/base/hash.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"

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

}  // namespace
}  // namespace relief::test
