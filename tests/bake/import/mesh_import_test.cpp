// Mesh files of several formats, right ones and wrong ones, all written here.
#include "bake/import/mesh_import.h"

#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "bake/mesh/triangle_plane.h"
#include "formats/base/hash.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

double signedVolume(const TriangleMesh& mesh) {
    double volume = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const TrianglePlane plane = planeOf(mesh, i);
        volume += dot(plane.point, plane.normal) / 6.0;
    }
    return volume;
}

Result<TriangleMesh> import(const TemporaryFolder& folder, const std::string& name,
                            std::string_view contents) {
    return importMesh(folder.write(name, contents));
}

void expectError(const Result<TriangleMesh>& mesh, ErrorCode code, const std::string& says) {
    ASSERT_FALSE(mesh) << mesh->name << ": " << says;
    EXPECT_EQ(mesh.error().code, code) << mesh.error().message;
    EXPECT_NE(mesh.error().message.find(says), std::string::npos) << mesh.error().message;
    EXPECT_EQ(mesh.error().message.find('\n'), std::string::npos);
}

// A unit box from the origin, of quads.
constexpr const char* kBoxObj =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";

std::string base64(std::string_view bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
        }
    }
    return text;
}

/// A glTF file of one mesh, a tetrahedron with corners at the origin and 1 along each axis, and the given
/// nodes.
std::string gltf(const std::string& nodes, const std::string& roots, const std::string& uri = "") {
    const float positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::uint16_t indices[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    std::string buffer(sizeof(positions) + sizeof(indices), '\0');
    std::memcpy(buffer.data(), positions, sizeof(positions));
    std::memcpy(buffer.data() + sizeof(positions), indices, sizeof(indices));
    const std::string data = uri.empty() ? "data:application/octet-stream;base64," + base64(buffer) : uri;
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" +
           nodes +
           R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)"
           R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},)"
           R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],"bufferViews":[)"
           R"({"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],)"
           R"("buffers":[{"byteLength":72,"uri":")" +
           data + R"("}]})";
}

TEST(MeshImport, ObjOfQuads) {
    const TemporaryFolder folder;
    const Result<TriangleMesh> mesh = import(folder, "box.obj", kBoxObj);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 12U);
    EXPECT_NEAR(signedVolume(*mesh), 1.0, 1e-6);
    EXPECT_EQ(mesh->bounds.min, glm::vec3(0));
    EXPECT_EQ(mesh->bounds.max, glm::vec3(1));
    EXPECT_EQ(mesh->name, "box.obj");
    EXPECT_EQ(mesh->unit, "");
    EXPECT_EQ(mesh->content_hash, xxh3_128Hex(std::as_bytes(std::span(kBoxObj, std::strlen(kBoxObj)))));
    // The extension's case does not matter.
    EXPECT_TRUE(import(folder, "BOX.OBJ", kBoxObj));
}

TEST(MeshImport, StlPlyOffAgree) {
    const TemporaryFolder folder;
    const std::string stl =
        "solid t\n"
        "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
        "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
        "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
        "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\n"
        "endsolid t\n";
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    const std::string off = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    for (const auto& [name, text] :
         {std::pair{"t.stl", stl}, std::pair{"t.ply", ply}, std::pair{"t.off", off}}) {
        SCOPED_TRACE(name);
        const Result<TriangleMesh> mesh = import(folder, name, text);
        ASSERT_TRUE(mesh) << mesh.error().message;
        EXPECT_EQ(mesh->triangles.size(), 4U);
        EXPECT_NEAR(signedVolume(*mesh), 1.0 / 6.0, 1e-6);
    }
}

TEST(MeshImport, NodeTransformsAreAppliedDownTheTree) {
    const TemporaryFolder folder;
    // Scaled by 2, then moved by the parent, which is turned by 90° about z.
    const Result<TriangleMesh> mesh =
        import(folder, "t.gltf",
               gltf(R"({"children":[1],"translation":[10,0,0],"rotation":[0,0,0.70710678,0.70710678]},)"
                    R"({"mesh":0,"scale":[2,2,2],"translation":[5,0,0]})",
                    "0"));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->unit, "m");
    EXPECT_EQ(mesh->triangles.size(), 4U);
    EXPECT_NEAR(signedVolume(*mesh), 8.0 / 6.0, 1e-4);
    const glm::vec3 low(8, 5, 0);
    const glm::vec3 high(10, 7, 2);
    EXPECT_LT(glm::distance(mesh->bounds.min, low), 1e-5F);
    EXPECT_LT(glm::distance(mesh->bounds.max, high), 1e-5F);
}

TEST(MeshImport, MirroredNodesKeepTheirOutside) {
    const TemporaryFolder folder;
    const Result<TriangleMesh> plain = import(folder, "p.gltf", gltf(R"({"mesh":0})", "0"));
    const Result<TriangleMesh> mirrored =
        import(folder, "m.gltf", gltf(R"({"mesh":0,"scale":[-1,1,1]})", "0"));
    const Result<TriangleMesh> twice = import(
        folder, "tw.gltf", gltf(R"({"children":[1],"scale":[-1,1,1]},{"mesh":0,"scale":[1,1,-1]})", "0"));
    ASSERT_TRUE(plain && mirrored && twice);
    for (const TriangleMesh* mesh : {&*plain, &*mirrored, &*twice}) {
        EXPECT_NEAR(signedVolume(*mesh), 1.0 / 6.0, 1e-6);
    }
    EXPECT_EQ(mirrored->bounds.min, glm::vec3(-1, 0, 0));
    EXPECT_EQ(twice->bounds.min, glm::vec3(-1, 0, -1));
    // Mirrored meshes bake to mirrored maps: the slanted face's normal points out of the solid in both.
    for (const auto& [mesh, x] : {std::pair{&*plain, 0.2F}, std::pair{&*mirrored, -0.2F}}) {
        const std::optional<Vote> v = vote(bakeMap(*mesh, "float:dir=-z"), {x, 0.2F, 2.0F});
        ASSERT_TRUE(v);
        EXPECT_NEAR(v->normal.x, std::copysign(std::sqrt(1.0 / 3.0), x), 1e-3);
        EXPECT_NEAR(v->normal.z, std::sqrt(1.0 / 3.0), 1e-3);
    }
}

TEST(MeshImport, InstancesAreCopies) {
    const TemporaryFolder folder;
    const Result<TriangleMesh> mesh =
        import(folder, "i.gltf", gltf(R"({"mesh":0},{"mesh":0,"translation":[3,0,0]})", "0,1"));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 8U);
    EXPECT_EQ(mesh->bounds.max, glm::vec3(4, 1, 1));
    EXPECT_NEAR(signedVolume(*mesh), 2.0 / 6.0, 1e-6);
}

TEST(MeshImport, DeepNodesDoNotOverflowTheStack) {
    const TemporaryFolder folder;
    constexpr int kDepth = 20000;
    std::string nodes;
    for (int i = 0; i < kDepth; ++i) {
        nodes += R"({"children":[)" + std::to_string(i + 1) + R"(],"translation":[0.5,0,0]},)";
    }
    const Result<TriangleMesh> mesh = import(folder, "deep.gltf", gltf(nodes + R"({"mesh":0})", "0"));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->bounds.min.x, 0.5F * kDepth);
}

TEST(MeshImport, StrayVerticesAndFlatTrianglesAreLeftOut) {
    const TemporaryFolder folder;
    const Result<TriangleMesh> mesh =
        import(folder, "s.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 100 100 100\nv 2 0 0\nf 1 2 3\nf 1 2 5\nf 1 1 2\nf 2 2 2\n");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 1U);
    EXPECT_GE(mesh->dropped_triangles, 1U);
    EXPECT_EQ(mesh->bounds.max, glm::vec3(1, 1, 0)) << "a vertex without a triangle is no part of the shape";
}

TEST(MeshImport, PointsAndLinesBesideTrianglesAreLeftOut) {
    const TemporaryFolder folder;
    const Result<TriangleMesh> mesh =
        import(folder, "mixed.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nl 1 4\np 4\nf 1 2 3\n");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 1U);
    EXPECT_EQ(mesh->bounds.max, glm::vec3(1, 1, 0));
}

TEST(MeshImport, FilesThatAreNotThereOrNoMeshes) {
    const TemporaryFolder folder;
    expectError(importMesh(folder.path() / "missing.obj"), ErrorCode::kIo, "missing.obj");
    expectError(importMesh(folder.path()), ErrorCode::kIo, "folder");
    expectError(import(folder, "mesh.xyzzy", "hello"), ErrorCode::kUnsupported,
                "convert it to glTF, OBJ or PLY");
    expectError(import(folder, "noextension", "hello"), ErrorCode::kUnsupported, "noextension");
    expectError(import(folder, "empty.obj", ""), ErrorCode::kInvalidInput, "empty.obj");
}

TEST(MeshImport, WrongContentsNameTheFileAndTheCure) {
    const TemporaryFolder folder;
    std::string noise(5000, '\0');
    std::uint32_t state = 3;
    for (char& c : noise) {
        state = state * 1664525U + 1013904223U;
        c = static_cast<char>(state >> 24);
    }
    for (const std::string name :
         {"n.obj", "n.stl", "n.ply", "n.off", "n.gltf", "n.glb", "n.fbx", "n.dae", "n.3ds"}) {
        SCOPED_TRACE(name);
        expectError(import(folder, name, noise), ErrorCode::kInvalidInput, name);
    }
    expectError(import(folder, "points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n"),
                ErrorCode::kInvalidInput, "points.obj");
    expectError(import(folder, "line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), ErrorCode::kInvalidInput,
                "line.obj");
    expectError(import(folder, "vertices.obj", "v 0 0 0\nv 1 0 0\n"), ErrorCode::kInvalidInput,
                "vertices.obj");
    expectError(import(folder, "flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), ErrorCode::kInvalidInput,
                "area");
    expectError(import(folder, "nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), ErrorCode::kInvalidInput,
                "nan.obj");
    expectError(import(folder, "inf.obj", "v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), ErrorCode::kInvalidInput,
                "inf.obj");
    expectError(import(folder, "huge.obj", "v 0 0 1e30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                ErrorCode::kInvalidInput, "1e15");
    expectError(import(folder, "index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), ErrorCode::kInvalidInput,
                "index.obj");
    expectError(
        import(
            folder, "index.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"),
        ErrorCode::kInvalidInput, "index.ply");
    expectError(import(folder, "nodes.gltf", gltf(R"({"mesh":0,"scale":[1e30,1e30,1e30]})", "0")),
                ErrorCode::kInvalidInput, "1e15");
    expectError(import(folder, "singular.gltf", gltf(R"({"mesh":0,"scale":[0,1,0]})", "0")),
                ErrorCode::kInvalidInput, "area");
    expectError(import(folder, "no_nodes.gltf", gltf(R"({})", "0")), ErrorCode::kInvalidInput,
                "no_nodes.gltf");
}

TEST(MeshImport, APipeInPlaceOfABufferDoesNotHang) {
    const TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder.path() / "pipe.bin").c_str(), 0600), 0);
    expectError(import(folder, "pipe.gltf", gltf(R"({"mesh":0})", "0", "pipe.bin")), ErrorCode::kInvalidInput,
                "pipe.gltf");
    expectError(import(folder, "zero.gltf", gltf(R"({"mesh":0})", "0", "/dev/zero")),
                ErrorCode::kInvalidInput, "zero.gltf");
}

TEST(MeshImport, BuffersBesideTheFileAreRead) {
    const TemporaryFolder folder;
    const float positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::uint16_t indices[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    std::string buffer(72, '\0');
    std::memcpy(buffer.data(), positions, 48);
    std::memcpy(buffer.data() + 48, indices, 24);
    folder.write("beside.bin", buffer);
    const Result<TriangleMesh> mesh = import(folder, "beside.gltf", gltf(R"({"mesh":0})", "0", "beside.bin"));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_NEAR(signedVolume(*mesh), 1.0 / 6.0, 1e-6);
}

TEST(MeshImport, NamesOfAnyBytes) {
    const TemporaryFolder folder;
    const Result<TriangleMesh> mesh = import(folder, "h\xc3\xa4se\xff \x1b.obj", kBoxObj);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->name, "h\xc3\xa4se\xef\xbf\xbd \xef\xbf\xbd.obj");
}

TEST(FinishMesh, RefusesAnIndexOutOfRange) {
    TriangleMesh mesh;
    mesh.name = "raw";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 3}};
    expectError(finishMesh(mesh), ErrorCode::kInvalidInput, "vertex 3");
    mesh.triangles.clear();
    expectError(finishMesh(mesh), ErrorCode::kInvalidInput, "no triangle");
    mesh.triangles = {{0, 1, 2}};
    mesh.positions = {{0, 0, 0}, {1e-20F, 0, 0}, {0, 1e-20F, 0}};
    expectError(finishMesh(mesh), ErrorCode::kInvalidInput, "1e-15");
}

}  // namespace
}  // namespace relief::test
