// Mesh files of several formats, right ones and wrong ones, all written here.
#include "bake/import/mesh_import.h"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "formats/base/hash.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

// A unit box from the origin, of quads.
constexpr const char* kBoxObj =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";

TEST(MeshImport, ObjOfQuads) {
    const Result<TriangleMesh> mesh = importText("box.obj", kBoxObj);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 12U);
    EXPECT_NEAR(signedVolume(*mesh), 1.0, 1e-6);
    EXPECT_EQ(mesh->bounds, (Bounds{glm::vec3(0), glm::vec3(1)}));
    EXPECT_EQ(mesh->name, "box.obj");
    EXPECT_EQ(mesh->unit, "");
    EXPECT_EQ(mesh->content_hash, xxh3_128Hex(std::as_bytes(std::span(kBoxObj, std::strlen(kBoxObj)))));
    EXPECT_TRUE(importText("BOX.OBJ", kBoxObj)) << "the extension's case";
    const Result<TriangleMesh> odd = importText("h\xc3\xa4se\xff \x1b.obj", kBoxObj);
    ASSERT_TRUE(odd) << odd.error().message;
    EXPECT_EQ(odd->name, "h\xc3\xa4se\xef\xbf\xbd \xef\xbf\xbd.obj");
}

TEST(MeshImport, MirroredNodesKeepTheirOutside) {
    const auto read = [](const std::string& nodes) {
        return importText("m.gltf", tetrahedronGltf({.nodes = nodes}));
    };
    const Result<TriangleMesh> plain = read(R"({"mesh":0})");
    const Result<TriangleMesh> mirrored = read(R"({"mesh":0,"scale":[-1,1,1]})");
    const Result<TriangleMesh> twice =
        read(R"({"children":[1],"scale":[-1,1,1]},{"mesh":0,"scale":[1,1,-1]})");
    ASSERT_TRUE(plain && mirrored && twice);
    for (const TriangleMesh* mesh : {&*plain, &*mirrored, &*twice}) {
        EXPECT_NEAR(signedVolume(*mesh), 1.0, 1e-6);
        EXPECT_TRUE(mesh->warnings.empty());
    }
    EXPECT_EQ(mirrored->bounds.min, glm::vec3(-1, 0, 0));
    EXPECT_EQ(twice->bounds.min, glm::vec3(-1, 0, -3));
    // Mirrored meshes bake to mirrored maps: the slanted face's normal points out of the solid in both.
    const glm::dvec3 normal = glm::normalize(glm::dvec3(6, 3, 2));
    for (const auto& [mesh, x] : {std::pair{&*plain, 0.2F}, std::pair{&*mirrored, -0.2F}}) {
        const std::optional<Vote> v = vote(bakeMap(*mesh, "float:dir=-z"), {x, 0.4F, 6.0F});
        ASSERT_TRUE(v);
        EXPECT_NEAR(v->normal.x, std::copysign(normal.x, x), 1e-3);
        EXPECT_NEAR(v->normal.z, normal.z, 1e-3);
    }
}

TEST(MeshImport, DeepNodesDoNotOverflowTheStack) {
    constexpr int kDepth = 20000;
    std::string nodes;
    for (int i = 0; i < kDepth; ++i) {
        nodes += R"({"children":[)" + std::to_string(i + 1) + R"(],"translation":[0.5,0,0]},)";
    }
    const Result<TriangleMesh> mesh =
        importText("deep.gltf", tetrahedronGltf({.nodes = nodes + R"({"mesh":0})"}));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->bounds.min.x, 0.5F * kDepth);
}

TEST(MeshImport, StrayVerticesFlatTrianglesPointsAndLinesAreLeftOut) {
    const Result<TriangleMesh> mesh = importText("s.obj",
                                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 100 100 100\nv 2 0 0\n"
                                                 "l 1 4\np 4\nf 1 2 3\nf 1 2 5\nf 1 1 2\nf 2 2 2\n");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 1U);
    EXPECT_GE(mesh->dropped_triangles, 1U);
    EXPECT_EQ(mesh->bounds.max, glm::vec3(1, 1, 0)) << "a vertex without a triangle is no part of the shape";
}

TEST(MeshImport, WrongFilesAreNamed) {
    const TemporaryFolder folder;
    for (const auto& import : {+[](const std::filesystem::path& path) { return importMesh(path); },
                               +[](const std::filesystem::path& path) { return importMeshInWorker(path); }}) {
        expectRefused(import(folder.path() / "missing.obj"), "missing.obj", ErrorCode::kIo);
        expectRefused(import(folder.path()), "folder", ErrorCode::kIo);
        for (const char* name : {"mesh.xyzzy", "noextension"}) {
            expectRefused(import(folder.write(name, "hello")), name, ErrorCode::kUnsupported);
        }
        expectRefused(import(folder.write("empty.obj", "")), "empty.obj");
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
        expectRefused(importText(name, noise), name);
    }
    for (const auto& [text, words] :
         {std::pair{"v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n", "w.obj"},
          std::pair{"v 0 0 0\nv 1 0 0\nl 1 2\n", "w.obj"}, std::pair{"v 0 0 0\nv 1 0 0\n", "w.obj"},
          std::pair{"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "area"},
          std::pair{"v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "w.obj"},
          std::pair{"v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "w.obj"},
          std::pair{"v 0 0 1e30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "1e15"},
          std::pair{"v 1e9 0 0\nv 1000000001 0 0\nv 1000000001 1 0\nf 1 2 3\n", "floats are 64 apart"}}) {
        SCOPED_TRACE(text);
        expectRefused(importText("w.obj", text), words);
    }
    for (const auto& [node, words] :
         {std::pair{R"({"mesh":0,"scale":[1e30,1e30,1e30]})", "1e15"},
          std::pair{R"({"mesh":0,"scale":[0,1,0]})", "area"}, std::pair{R"({})", "w.gltf"}}) {
        SCOPED_TRACE(node);
        expectRefused(importText("w.gltf", tetrahedronGltf({.nodes = node})), words);
    }
}

TEST(FinishMesh, RefusesWhatIsNoMesh) {
    TriangleMesh mesh;
    mesh.name = "raw";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 3}};
    expectRefused(finishMesh(mesh), "vertex 3");
    mesh.triangles.clear();
    expectRefused(finishMesh(mesh), "no triangle");
    mesh.triangles = {{0, 1, 2}};
    mesh.positions = {{0, 0, 0}, {1e-20F, 0, 0}, {0, 1e-20F, 0}};
    expectRefused(finishMesh(mesh), "1e-15");
}

}  // namespace
}  // namespace relief::test
