// Contents decide what a file is: each format under every name, and what is no mesh at all.
#include "bake/import/import_format.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "bake/import/mesh_import.h"
#include "formats/base/file_io.h"
#include "tests/bake/import/gltf_cases.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

std::string contentsOf(const fs::path& path) {
    const Result<std::vector<std::byte>> bytes = readFile(path);
    EXPECT_TRUE(bytes) << path;
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
}

std::string model(const char* name) {
    return contentsOf(fs::path("/usr/share/assimp/models") / name);
}

Result<TriangleMesh> load(const std::string& name, std::string_view contents) {
    const TemporaryFolder folder;
    return importMeshInWorker(folder.write(name, contents));
}

std::string errorOf(const Result<TriangleMesh>& mesh) {
    return mesh ? "read" : mesh.error().message;
}

std::string binaryStl() {
    std::string text(80, 'x');
    const std::uint32_t count = 4;
    text.append(reinterpret_cast<const char*>(&count), 4);
    constexpr float kCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    for (const auto& face :
         {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{0, 3, 2}}) {
        text.append(12, '\0');
        for (const int corner : face) {
            text.append(reinterpret_cast<const char*>(kCorners[corner]), 12);
        }
        text.append(2, '\0');
    }
    return text;
}

TEST(ImportFormat, SignaturesCountUnderEveryName) {
    const std::vector<std::pair<std::string, std::string>> contents = {
        {"ply", tetrahedronPly()},
        {"fbx", tetrahedronFbx(1, 1, "100")},
        {"glb", model("glTF2/BoxTextured-glTF-Binary/BoxTextured.glb")},
        {"blend", model("BLEND/Suzanne_248.blend")},
        {"ms3d", model("MS3D/twospheres.ms3d")},
        {"x", model("X/test_cube_text.x")},
    };
    for (const auto& [format, bytes] : contents) {
        const Result<TriangleMesh> right = load("right." + format, bytes);
        ASSERT_TRUE(right) << format << ": " << right.error().message;
        for (const std::string name :
             {"obj", "stl", "ply", "off", "gltf", "glb", "dae", "3ds", "fbx", "smd"}) {
            SCOPED_TRACE(format + " under the name of " + name);
            const auto other = otherFormat(name, std::as_bytes(std::span(bytes)));
            EXPECT_EQ(other, name == format ? std::nullopt : std::optional(format));
        }
        const Result<TriangleMesh> wrong = load("wrong.obj", bytes);
        ASSERT_TRUE(wrong) << format << ": " << wrong.error().message;
        EXPECT_EQ(wrong->positions, right->positions);
        EXPECT_EQ(wrong->triangles, right->triangles);
        EXPECT_TRUE(std::any_of(
            wrong->warnings.begin(), wrong->warnings.end(), [&format = format](const std::string& warning) {
                return warning.find("its contents are those of a ." + format) != std::string::npos;
            }));
    }
}

TEST(ImportFormat, OthersAreReadAsTheirNameSaysOrRefused) {
    for (const std::string& text : {tetrahedronObj(), tetrahedronStl(), tetrahedronOff(), tetrahedronGltf(),
                                    tetrahedronDae(""), binaryStl(), tetrahedron3ds()}) {
        int read = 0;
        for (const char* name : {"w.obj", "w.stl", "w.ply", "w.off", "w.gltf", "w.dae", "w.3ds", "w.fbx"}) {
            read += load(name, text) ? 1 : 0;
        }
        EXPECT_EQ(read, 1) << text.substr(0, 20);
    }
    for (const char* name : {"w.amf", "w.dxf", "w.acx", "w.xyzzy"}) {
        EXPECT_NE(errorOf(load(name, tetrahedronObj())).find("convert it to glTF, OBJ or PLY"),
                  std::string::npos);
    }
    for (const char* name : {"w.png", "w.raw"}) {
        EXPECT_NE(errorOf(load(name, tetrahedronObj())).find("relief bake --heights"), std::string::npos);
    }
}

TEST(ImportFormat, AHeaderOfABinaryStlMaySayAnything) {
    for (const char* header : {"solid", "OFF", "ply\n", "glTF\x02", "BB3D", "\x1f\x8b", "\xff\xfe",
                               "{\"asset\"", "v 0 0 0\nf 1 2 3\n", "MM", "<COLLADA"}) {
        SCOPED_TRACE(header);
        std::string text = binaryStl();
        std::memcpy(text.data(), header, std::strlen(header));
        const Result<TriangleMesh> mesh = load("a.stl", text);
        ASSERT_TRUE(mesh) << mesh.error().message;
        EXPECT_EQ(mesh->triangles.size(), 4U);
        EXPECT_TRUE(mesh->warnings.empty());
    }
}

TEST(ImportFormat, WhatIsNoMeshIsRefused) {
    const std::string rest(300, '\x01');
    for (const char* begin : {"\x1f\x8b\b", "PK\x03\x04", "\xff\xfe", "\x89PNG\r\n", "\xff\xd8\xff",
                              "%PDF-1.4", "<html><body>", "version https://git-lfs.github.com/spec/v1\n"}) {
        for (const char* name : {"a.obj", "a.stl", "a.gltf", "a.dae", "a.fbx"}) {
            EXPECT_NE(errorOf(load(name, begin + rest)).find(name), std::string::npos) << begin;
        }
    }
    EXPECT_NE(errorOf(load("a.obj", "hello\n")).find("no vertices, and is probably no .obj file"),
              std::string::npos);
}

TEST(ImportFormat, BlendFilesAreOftenPacked) {
    const Result<TriangleMesh> mesh = load("a.blend", model("BLEND/BlenderDefault_250_Compressed.blend"));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 12U);
}

TEST(ImportFormat, StlInCapitals) {
    std::string text = tetrahedronStl();
    const Result<TriangleMesh> lower = load("a.stl", text);
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    const Result<TriangleMesh> upper = load("a.stl", text);
    ASSERT_TRUE(upper) << upper.error().message;
    EXPECT_EQ(upper->positions, lower->positions);
    EXPECT_TRUE(upper->warnings.empty());
    const TemporaryFolder folder;
    ImportOptions options;
    options.names = {"T"};
    const Result<TriangleMesh> named = importMesh(folder.write("n.stl", text), options);
    ASSERT_TRUE(named) << "its name keeps its capitals: " << named.error().message;
    for (const char* mixed : {"Solid T\n", "solid T\n"}) {
        std::string other = text;
        EXPECT_TRUE(load("m.stl", other.replace(0, 8, mixed)));
    }
}

TEST(ImportFormat, FarFromTheOriginFloatsAreTooCoarse) {
    const std::string error =
        errorOf(load("far.obj", "v 1e9 0 0\nv 1000000001 0 0\nv 1000000001 1 0\nf 1 2 3\n"));
    EXPECT_NE(error.find("its coordinates reach 1e+09, where floats are 64 apart: move it to the origin"),
              std::string::npos)
        << error;
}

}  // namespace
}  // namespace relief::test
