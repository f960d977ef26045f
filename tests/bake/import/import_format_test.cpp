// SPDX-License-Identifier: Apache-2.0
// The contents of a file, not its name, determine its format. Files that are not meshes are rejected.
#include "bake/import/import_format.h"

#include "bake/import/mesh_import.h"
#include "formats/base/file_io.h"
#include "tests/bake/import/import_meshes.h"

namespace relief::test {
namespace {

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
        expectRejected(importText(name, tetrahedronObj()), "relief bake --heights", ErrorCode::kUnsupported);
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

}  // namespace
}  // namespace relief::test
