// SPDX-License-Identifier: Apache-2.0
// Valid and invalid glTF: each file is read as specified or rejected with a one-line message.

#include <array>
#include <glm/geometric.hpp>
#include <optional>
#include <tuple>

#include "bake/import/gltf_data.h"
#include "bake/import/mesh_import.h"
#include "bake/mesh/triangle_plane.h"
#include "formats/base/file_io.h"
#include "tests/bake/import/animated_cases.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

Result<TriangleMesh> load(const std::string& text) {
    return importText("t.gltf", text);
}

Result<TriangleMesh> loadParts(const GltfParts& parts) {
    return load(tetrahedronGltf(parts));
}

TriangleMesh staticMesh(const GltfParts& parts) {
    return imported("t.gltf", tetrahedronGltf(parts));
}

void expectWrongGltf(const std::vector<Wrong>& cases) {
    expectWrong("t.gltf", cases);
}

Wrong parts(const GltfParts& parts, const std::string& words, ErrorCode code = ErrorCode::kInvalidInput) {
    return {tetrahedronGltf(parts), words, code};
}

Wrong node(const std::string& members, const std::string& words) {
    return parts({.nodes = R"({"mesh":0,)" + members + "}"}, words);
}

// --- every encoding of the tetrahedron ---

/// Packs numbers as components of a glTF type, with `gap` bytes after every `each`.
std::string componentBytes(int component, const std::vector<int>& values, std::size_t each = 1,
                           std::size_t gap = 0) {
    const std::size_t size = component <= 5121 ? 1 : component <= 5123 ? 2 : 4;
    std::string bytes;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto real = static_cast<float>(values[i]);
        const void* const value = component == 5126 ? static_cast<const void*>(&real) : &values[i];
        bytes.append(static_cast<const char*>(value), size);
        bytes.append((i + 1) % each == 0 ? gap : 0, '\x7f');
    }
    return bytes;
}

/// A file whose only primitive has these positions and, unless they are empty, indices.
GltfBuilder meshOf(std::size_t position, std::optional<std::size_t> index, GltfBuilder builder,
                   int mode = 4) {
    nlohmann::json primitive = {{"attributes", {{"POSITION", position}}}, {"mode", mode}};
    if (index) {
        primitive["indices"] = *index;
    }
    builder.json["meshes"] = {{{"primitives", nlohmann::json::array({primitive})}}};
    builder.json["nodes"] = {{{"mesh", 0}}};
    builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    return builder;
}

TriangleMesh staticMesh(const GltfBuilder& builder) {
    const TemporaryFolder folder;
    return required(importMesh(writeGltf(builder.file(), folder, "t")));
}

const std::vector<int> kPlaces = {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};
const std::vector<int> kTetrahedronFaces = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};

/// Expects the triangles of the tetrahedron, scaled, in the order of the file.
void expectTetrahedron(const TriangleMesh& mesh, float scale = 1.0F) {
    ASSERT_EQ(mesh.triangles.size(), 4U);
    for (std::uint32_t i = 0; i < 12; ++i) {
        const auto corner = static_cast<std::size_t>(3 * kTetrahedronFaces[i]);
        const glm::vec3 place(kPlaces[corner], kPlaces[corner + 1], kPlaces[corner + 2]);
        EXPECT_LT(glm::distance(cornersOf(mesh, i / 3).at(i % 3), scale * place), 1e-6F) << i;
    }
}

TEST(ImportGltf, PositionsMayHaveAnyTypeAndStride) {
    std::vector<int> apart;  // without indices
    for (const int face : kTetrahedronFaces) {
        apart.insert(apart.end(), kPlaces.begin() + 3 * face, kPlaces.begin() + 3 * face + 3);
    }
    for (const auto& [component, size, most] : {std::tuple{5120, 1U, 127.0F},
                                                {5121, 1U, 255.0F},
                                                {5122, 2U, 32767.0F},
                                                {5123, 2U, 65535.0F},
                                                {5126, 4U, 1.0F}}) {
        for (const std::size_t gap : {std::size_t{0}, std::size_t{16 - 3 * size}}) {
            for (const bool normalized : {false, component != 5126}) {
                SCOPED_TRACE(std::to_string(component) + ", " + std::to_string(gap));
                GltfBuilder builder;
                const std::size_t position = builder.accessor(
                    "VEC3", component, 36, componentBytes(component, apart, 3, gap), normalized);
                if (gap > 0) {
                    builder.json["bufferViews"][0]["byteStride"] = 16;
                }
                expectTetrahedron(staticMesh(meshOf(position, std::nullopt, builder)),
                                  normalized ? 1.0F / most : 1.0F);
            }
        }
    }
}

TEST(ImportGltf, IndicesMayHaveAnyTypeAndBeSparse) {
    for (const int component : {5121, 5123, 5125}) {
        for (const bool sparse : {false, true}) {
            SCOPED_TRACE(std::to_string(component) + (sparse ? ", sparse" : ""));
            GltfBuilder builder;
            const std::size_t position =
                builder.accessor("VEC3", 5126, 12, componentBytes(5126, kPlaces), false);
            const std::size_t index = builder.accessor("SCALAR", component, 12,
                                                       componentBytes(component, kTetrahedronFaces), false);
            if (sparse) {  // all but the first, which is at the origin
                const std::size_t where =
                    builder.accessor("SCALAR", component, 3, componentBytes(component, {1, 2, 3}), false);
                const nlohmann::json& accessors = builder.json["accessors"];
                builder.json["accessors"][position] = {
                    {"componentType", 5126},
                    {"type", "VEC3"},
                    {"count", 4},
                    {"sparse",
                     {{"count", 3},
                      {"indices",
                       {{"bufferView", accessors[where]["bufferView"]}, {"componentType", component}}},
                      {"values", {{"bufferView", accessors[position]["bufferView"]}, {"byteOffset", 12}}}}}};
            }
            expectTetrahedron(staticMesh(meshOf(position, index, builder)));
        }
    }
}

/// A ladder of squares, and a fan around the first corner. All triangles face z.
TEST(ImportGltf, StripsAndFansAreTriangles) {
    struct Case {
        int mode;
        std::vector<int> places;
        std::size_t triangles;
        double area;
    };
    for (const auto& [mode, places, triangles, area] :
         {Case{5, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0, 0, 3, 0}, 5, 2.5},
          Case{6, {0, 0, 0, 2, 0, 0, 2, 1, 0, 2, 2, 0, 0, 2, 0}, 3, 4.0}}) {
        GltfBuilder builder;
        const std::size_t position =
            builder.accessor("VEC3", 5126, places.size(), componentBytes(5126, places), false);
        const TriangleMesh mesh = staticMesh(meshOf(position, std::nullopt, builder, mode));
        ASSERT_EQ(mesh.triangles.size(), triangles);
        double sum = 0.0;
        for (std::uint32_t i = 0; i < triangles; ++i) {
            EXPECT_GT(planeOf(mesh, i).normal.z, 0.0) << mode << ", " << i;
            sum += 0.5 * planeOf(mesh, i).normal.z;
        }
        EXPECT_NEAR(sum, area, 1e-6);
    }
}

TEST(ImportGltf, NodesApplyMatricesBelowTheirParents) {
    // x' = x + y and z' = z + 5; then a scale of 2 along x, a quarter turn about z, and a translation.
    const TriangleMesh mesh = staticMesh(
        {.nodes =
             R"({"translation":[1,2,3],"rotation":[0,0,0.70710678,0.70710678],"scale":[2,1,1],"children":[1]},)"
             R"({"mesh":0,"matrix":[1,0,0,0,1,1,0,0,0,0,1,0,0,0,5,1]})"});
    const std::array<glm::vec3, 4> places = {glm::vec3(1, 2, 8), {1, 4, 8}, {-1, 6, 8}, {1, 2, 11}};
    ASSERT_EQ(mesh.triangles.size(), 4U);
    for (std::uint32_t i = 0; i < 12; ++i) {
        const glm::vec3& place = places.at(static_cast<std::size_t>(kTetrahedronFaces[i]));
        EXPECT_LT(glm::distance(cornersOf(mesh, i / 3).at(i % 3), place), 1e-5F) << i;
    }
}

// --- handwritten files ---

TEST(ImportGltf, SkinnedMeshIgnoresItsNode) {
    const std::string nodes =
        R"({"mesh":0,"skin":0,"translation":[100,0,0],"scale":[2,2,2]},{"translation":[0,9,0]})";
    const auto skinned = [&](const std::string& skin) {
        return GltfParts{.nodes = nodes, .roots = "0,1", .more = R"("skins":[{)" + skin + "}],"};
    };
    const TriangleMesh mesh = staticMesh(skinned(R"("joints":[1])"));
    EXPECT_EQ(mesh.bounds.max, glm::vec3(1, 2, 3));
    EXPECT_TRUE(mesh.warnings.size() == 1 && warns(mesh, "it is skinned; parts without joints"));
    // A model of the glTF tutorials whose bind pose is offset by half a unit.
    const TriangleMesh model =
        required(importMesh("/usr/share/assimp/models/glTF2/simple_skin/simple_skin.gltf"));
    EXPECT_EQ(model.bounds.min, glm::vec3(-0.5F, 0, 0));
    EXPECT_TRUE(model.warnings.size() == 1 && warns(model, "in the pose of its nodes"));
    // The upper joint moves the upper ring by 2 and the middle one by half of that.
    GltfBuilder bar = bendingBar();
    bar.json["nodes"][1]["translation"] = {0, 3, 0};
    EXPECT_EQ(staticMesh(bar).bounds.max, glm::vec3(0.5F, 4.0F, 0.5F));
    // Units and axes still apply.
    const ImportOptions options = {"cm", UpAxis::kPlusZ};
    EXPECT_EQ(imported("u.gltf", tetrahedronGltf(skinned(R"("joints":[1])")), options).bounds.max,
              glm::vec3(0.01F, 0.03F, 0.0F));
    expectWrongGltf(
        {node(R"("skin":3)", "nodes[0] has skin skins[3], which does not exist"),
         parts(skinned(R"("joints":[2])"), "skins[0] has joints nodes[2], which does not exist"),
         parts(skinned(R"("joints":[])"), "skins[0] has no joints"),
         parts(skinned(R"("joints":[1],"inverseBindMatrices":0)"), "accessors[0] is not of type MAT4")});
}

TEST(ImportGltf, InvalidTransformsAreRejected) {
    const std::string zeros = R"("matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0)";
    EXPECT_TRUE(loadParts({.nodes = R"({"mesh":0,)" + zeros + ",1]}"}));
    expectWrongGltf({node(zeros + "]", "nodes[0].matrix has 15 numbers instead of 16"),
                     node(zeros + ",1,0]", "17 numbers"),
                     node(zeros + R"(,"1"])", "nodes[0].matrix[15] is not a number"),
                     node(zeros + ",2]", "last row"),
                     node(R"("matrix":[1,0,0,5,0,1,0,6,0,0,1,7,0,0,0,1])", "is it transposed?"),
                     node(R"("translation":[1,2])", "nodes[0].translation has 2 numbers instead of 3"),
                     node(R"("translation":null)", "nodes[0].translation is not an array"),
                     node(R"("translation":{})", "is not an array"),
                     node(R"("scale":[1,null,1])", "nodes[0].scale[1] is not a number"),
                     node(R"("rotation":[0,0,0,2])", "not a unit quaternion: its length is 2"),
                     node(R"("rotation":[0,0,0,0])", "not a unit quaternion"),
                     node(R"("rotation":[0,0,1])", "3 numbers instead of 4"),
                     node(zeros + R"(,1],"scale":[1,1,1])", "use one of them"),
                     node(R"("translation":[0,0,1e999])", "not valid JSON"),
                     node(R"("translation":[0,0,1e200])", "not a number or beyond 1e15")});
}

TEST(ImportGltf, VersionsAndExtensions) {
    const auto asset = [](const std::string& members) {
        return replaced(tetrahedronGltf(), R"("version":"2.0")", members);
    };
    const auto extension = [](const char* list, const std::string& name) {
        return GltfParts{.more = '"' + std::string(list) + R"(":[")" + name + "\"],"};
    };
    EXPECT_TRUE(load(asset(R"("version":"2.1","minVersion":"2.0")")));
    // Extensions that are used but not required do not stop the import.
    EXPECT_TRUE(staticMesh(extension("extensionsUsed", "VENDOR_unheard_of")).warnings.empty());
    EXPECT_TRUE(loadParts(extension("extensionsUsed", "KHR_mesh_quantization")));
    EXPECT_TRUE(loadParts(extension("extensionsRequired", "KHR_materials_unlit")));
    EXPECT_TRUE(loadParts(extension("extensionsRequired", "KHR_node_visibility")));
    for (const char* name : {"KHR_meshopt_compression", "KHR_draco_mesh_compression", "VENDOR_unheard_of"}) {
        expectWrongGltf({parts(extension("extensionsRequired", name), name, ErrorCode::kUnsupported)});
    }
    const std::string view = R"({"buffer":0,"byteOffset":0,"byteLength":48)";
    expectWrongGltf(
        {{asset(R"("version":"2.1","minVersion":"2.1")"), "version '2.1'", ErrorCode::kUnsupported},
         {asset(R"("version":"3.0")"), "version '3.0'", ErrorCode::kUnsupported},
         {replaced(tetrahedronGltf(), view, view + R"(,"extensions":{"KHR_meshopt_compression":{}})"),
          "bufferViews[0] uses KHR_meshopt_compression", ErrorCode::kUnsupported},
         {asset(R"("version":2.0)"), "asset.version is not a string"},
         {asset(R"("version":"two")"), "asset has the invalid version 'two'"},
         {asset(R"("version":"2.0","minVersion":[])"), "asset.minVersion"},
         {asset(R"("generator":"x")"), "no glTF version"},
         {replaced(tetrahedronGltf(), R"("asset")", R"("assets")"), "no glTF version"},
         {replaced(tetrahedronGltf(), R"({"asset")", R"({"extensionsRequired":{},"asset")"),
          "extensionsRequired is not an array"}});
    // If the extension is optional, its accessors also contain the uncompressed mesh.
    EXPECT_TRUE(loadParts(
        {.primitive = R"("attributes":{"POSITION":0},"indices":1,"extensions":{)"
                      R"("KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})"}));
}

TEST(ImportGltf, InstancesAreRepeated) {
    // Instances at the corners of the tetrahedron, below a node with a scale of 2.
    const auto instances = [](const std::string& attributes) {
        return GltfParts{.nodes = R"({"mesh":0,"scale":[2,2,2],"extensions":{"EXT_mesh_gpu_instancing":{)" +
                                  attributes + "}}}",
                         // The same floats as three VEC4; none is a rotation.
                         .indices = GltfParts().indices +
                                    R"(},{"bufferView":0,"componentType":5126,"count":3,"type":"VEC4")",
                         .more = R"("extensionsRequired":["EXT_mesh_gpu_instancing"],)"};
    };
    const TriangleMesh mesh = staticMesh(instances(R"("attributes":{"TRANSLATION":0})"));
    EXPECT_EQ(mesh.triangles.size(), 16U);
    EXPECT_EQ(mesh.bounds.max, glm::vec3(4.0F, 8.0F, 12.0F));
    EXPECT_TRUE(mesh.warnings.empty());
    expectWrongGltf(
        {parts(instances(R"("attributes":{})"), "attributes have none of TRANSLATION"),
         parts(instances(R"("attributes":{"TRANSLATION":1})"), "accessors[1] is not of type VEC3"),
         parts(instances(R"("attributes":{"TRANSLATION":7})"), "accessors[7], which does not exist"),
         parts(instances(""), "has no attributes"),
         parts(instances(R"("attributes":{"ROTATION":2})"), "not a unit quaternion"),
         parts(instances(R"("attributes":{"TRANSLATION":0,"ROTATION":2})"),
               "different counts of TRANSLATION, ROTATION and SCALE")});
}

TEST(ImportGltf, DuplicateKeysAndInvalidJson) {
    EXPECT_TRUE(loadParts({.more = R"("extras":{"a":[{"b":1},{"b":1}]},)"}));
    EXPECT_TRUE(load(tetrahedronGltf() + std::string("\n\0\0", 3))) << "padded";
    expectWrongGltf({node(R"("scale":[1,1,1],"scale":[2,2,2])", "the key 'scale' twice"),
                     node(R"("me\u0073h":0)", "the key 'mesh' twice"),
                     parts({.more = R"("extras":{"a":[{"b":1},{"b":1,"b":1}]},)"}, "the key 'b' twice"),
                     {tetrahedronGltf() + "x", "not valid JSON: parse error at line 1, column "},
                     {"{\n \"asset\": ,}", "not valid JSON: parse error at line 2, column 11"},
                     {tetrahedronGltf() + std::string("\0{}", 3), "a zero byte"},
                     {"[]", "not an object"},
                     {"{", "not valid JSON"}});
}

TEST(ImportGltf, InvalidAccessorsAndIndices) {
    const auto positions = [](const std::string& members, const std::string& words,
                              ErrorCode code = ErrorCode::kInvalidInput) {
        return parts({.position = members + R"(,"componentType":5126,"type":"VEC3")"}, words, code);
    };
    const auto indices = [](const std::string& members, const std::string& words) {
        return parts({.indices = R"("bufferView":1,"type":"SCALAR",)" + members}, words);
    };
    const auto primitive = [](const std::string& members, const std::string& words) {
        return parts({.primitive = members}, words);
    };
    expectWrongGltf(
        {positions(R"("bufferView":0,"count":4,"sparse":{"count":1})", "accessors[0].sparse"),
         positions(R"("count":4)", "no data", ErrorCode::kUnsupported),
         positions(R"("bufferView":0,"count":5)", "extends beyond"),
         positions(R"("bufferView":0,"count":9007199254740991)", "extends beyond"),
         positions(R"("bufferView":0,"count":-4)", "count"),
         positions(R"("bufferView":9,"count":4)", "bufferViews[9]"),
         parts({.position = R"("bufferView":0,"componentType":5125,"count":4,"type":"VEC3")"}, "5125",
               ErrorCode::kUnsupported),
         parts({.position = R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC2")"}, "VEC3"),
         positions(R"("bufferView":0,"count":4,"normalized":true)", "is normalized, but only integer"),
         {replaced(tetrahedronGltf(), R"("byteLength":48)", R"("byteLength":48,"byteStride":0)"),
          "has a byteStride of 0"},
         {replaced(tetrahedronGltf(), R"("byteLength":48)", R"("byteLength":480)"), "beyond its buffer"},
         indices(R"("componentType":5125,"count":12)", "extends beyond"),
         indices(R"("componentType":5123,"count":11)",
                 "meshes[0].primitives[0] has 11 corners, which is not a multiple of 3"),
         primitive(R"("attributes":{"POSITION":0},"indices":1,"mode":7)", "mode"),
         primitive(R"("attributes":{"POSITION":0},"indices":null)",
                   "meshes[0].primitives[0].indices is not a whole number"),
         primitive(R"("attributes":{"POSITION":-1})", "attributes.POSITION is not a whole number"),
         primitive(R"("attributes":{"POSITION":7})", "accessors[7]")});
    for (const auto& [kind, at, value, words] :
         {std::tuple{"5123", 0, std::string("\x04\0", 2), "4, which is not below the number of vertices, 4"},
          std::tuple{"5123", 4, std::string("\xff\xff"), "65535, which is reserved"},
          std::tuple{"5121", 5, std::string("\xff"), "255, which is reserved"},
          std::tuple{"5125", 0, std::string("\xff\xff\xff\xff"), "4294967295, which is reserved"}}) {
        std::string buffer = tetrahedronBuffer();
        buffer.replace(static_cast<std::size_t>(48 + at), value.size(), value);
        expectWrongGltf({parts({.indices = R"("bufferView":1,"componentType":)" + std::string(kind) +
                                           R"(,"count":6,"type":"SCALAR")",
                                .uri = "data:;base64," + base64(buffer)},
                               "accessors[1] has the index " + std::string(words))});
    }
}

TEST(ImportGltf, BuffersByUri) {
    const auto beside = [](const std::string& file, const std::string& uri, std::size_t size = 72) {
        const TemporaryFolder folder;
        folder.write(file, tetrahedronBuffer().substr(0, size));
        return importMesh(folder.write("t.gltf", tetrahedronGltf({.uri = uri})));
    };
    for (const auto& [file, uri] :
         {std::pair{"a b.bin", "a%20b.bin"}, std::pair{"a b.bin", "a b.bin"},
          std::pair{"\xc3\xa4.bin", "%C3%a4.bin"}, std::pair{"50%.bin", "50%25.bin"},
          std::pair{"a#1.bin", "a%231.bin"}, std::pair{"a:b.bin", "a%3Ab.bin"}}) {
        EXPECT_EQ(fs::path(required(beside(file, uri)).dependencies.back()).filename(), file);
    }
    for (const auto& [uri, words] :
         {std::pair{"50%.bin", "buffers[0] has a % without two hexadecimal digits"},
          std::pair{"%2e%2e/b.bin", "not below the mesh's folder"},
          std::pair{"%2Fetc%2Fpasswd", "not below the mesh's folder"},
          std::pair{"b.bin%00", "not below the mesh's folder"},
          std::pair{"c.bin", "buffers[0] refers to 'c.bin' (No such file"}}) {
        expectRejected(beside("b.bin", uri), words);
    }
    expectRejected(beside("b.bin", "b.bin", 71), "buffers[0] has 71 of the 72 bytes that it declares");
    const std::string data = "data:application/octet-stream;base64,";
    expectWrongGltf({{replaced(tetrahedronGltf(), R"("uri")", R"("url")"), "buffers[0] has no uri"},
                     parts({.uri = data + "AAA*"}, "buffers[0] is not valid base64"),
                     parts({.uri = data + "AAAA"}, "buffers[0] has 3 of the 72 bytes")});
}

TEST(ImportGltf, DataUris) {
    const auto decoded = [](const std::string& uri) {
        const Result<std::vector<std::byte>> bytes = dataUriBytes(uri);
        return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size())
                     : "error: " + bytes.error().message;
    };
    EXPECT_EQ(decoded("data:application/octet-stream;base64,aGVsbG8="), "hello");
    EXPECT_EQ(decoded("data:;base64,aGVsbG8"), "hello") << "padding is optional, as in browsers";
    EXPECT_EQ(decoded("DATA:application/gltf-buffer;BASE64,aGVsbG8%3D"), "hello");
    EXPECT_EQ(decoded("data:;base64,"), "");
    for (const char* wrong :
         {"a", "aGVsbG8=a", "a=Vs", "aGVs bG8=", "aGVs\nbG8=", "aG-_", "====", "aGVsbG8%", "a==="}) {
        EXPECT_EQ(decoded(std::string("data:;base64,") + wrong).substr(0, 6), "error:") << wrong;
    }
    EXPECT_EQ(decoded("data:application/octet-stream,hello").substr(0, 6), "error:");
    EXPECT_EQ(decoded("data:base64").substr(0, 6), "error:");
}

TEST(ImportGltf, BinaryChunks) {
    const TemporaryFolder folder;
    const fs::path path = writeGltf(bendingBar().file(), folder, "m");
    ASSERT_TRUE(importMesh(path));
    const Result<std::vector<std::byte>> bytes = readFile(path);
    const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    for (std::size_t size = 5; size < text.size(); size += size < 40 ? 1 : 97) {
        EXPECT_FALSE(importText("c.glb", text.substr(0, size))) << size;
    }
    EXPECT_TRUE(warns(imported("m.glb", text + "more"), "4 bytes after the end"));
    const auto with = [&](std::size_t at, const std::string& by) {
        return std::string(text).replace(at, by.size(), by);
    };
    test::expectWrong("w.glb", {{with(4, "\x01"), "version 1", ErrorCode::kUnsupported},
                                {with(16, "BIN"), "first chunk is not JSON"},
                                {with(12, "\xf1\xff\xff\x7f"), "extends beyond the end of the file"}});
}

TEST(ImportGltf, SparseAndQuantizedAccessors) {
    // Bytes of ±127 are ±1, offset by a sparse accessor.
    const std::string text =
        R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_mesh_quantization"],"scenes":[{"nodes":[0]}],)"
        R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[)"
        R"({"bufferView":0,"componentType":5120,"normalized":true,"count":3,"type":"VEC3","sparse":{"count":1,)"
        R"("indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":2}}}],"bufferViews":[)"
        R"({"buffer":0,"byteLength":12,"byteStride":4},{"buffer":0,"byteOffset":12,"byteLength":1},)"
        R"({"buffer":0,"byteOffset":13,"byteLength":3}],"buffers":[{"byteLength":16,"uri":"b.bin"}]})";
    const std::string bytes(
        "\0\0\0\0"
        "\x7f\0\0\0"
        "\0\x81\0\0"
        "\2"
        "\0\x7f\x80",
        16);
    const auto with = [&](const std::string& data) {
        return replaced(text, "b.bin", "data:;base64," + base64(data));
    };
    const std::string whole = with(bytes);
    const TriangleMesh mesh = imported("q.gltf", whole);
    EXPECT_EQ(mesh.bounds.min, glm::vec3(0, 0, -1));
    EXPECT_EQ(mesh.bounds.max, glm::vec3(1, 1, 0));
    expectWrongGltf(
        {{replaced(whole, R"("count":1)", R"("count":4)"), "accessors[0].sparse"},
         {replaced(whole, R"("byteLength":1})", R"("byteLength":0})"), "sparse.indices extends beyond"},
         {replaced(whole, R"("componentType":5121})", R"("componentType":5120})"), "not valid for indices"},
         {replaced(whole, R"("values":{"bufferView":2})", R"("values":{"bufferView":1})"),
          "accessors[0].sparse.values extends beyond"},
         {replaced(whole, R"("byteStride":4)", R"("byteStride":2)"),
          "a buffer view with a stride of 2 bytes"},
         {replaced(whole, R"("normalized":true)", R"("normalized":1)"), "accessors[0].normalized"},
         {with(std::string(bytes).replace(12, 1, "\3")), "sparse.indices are not in ascending order"},
         // The next byte, 0, is the second index.
         {replaced(replaced(replaced(whole, R"("count":1)", R"("count":2)"), R"("byteLength":1})",
                            R"("byteLength":2})"),
                   R"("byteOffset":13,"byteLength":3})", R"("byteOffset":0,"byteLength":6})"),
          "sparse.indices are not in ascending order"}});
}

TEST(ImportGltf, FlatAndMorphedPartsWarn) {
    const TriangleMesh flat = staticMesh(
        {.nodes = R"({"mesh":0},{"mesh":0,"scale":[1,0,1]},{"mesh":0,"scale":[0,0,0]})", .roots = "0,1,2"});
    EXPECT_TRUE(warns(flat, "2 of its parts are scaled to 0"));
    const TriangleMesh morphed =
        staticMesh({.primitive = R"("attributes":{"POSITION":0},"indices":1,"targets":[{"POSITION":0}])"});
    EXPECT_TRUE(warns(morphed, "morph targets"));
    EXPECT_EQ(morphed.bounds.max, glm::vec3(1, 2, 3));
}

TEST(ImportGltf, ScenesMustBeNonemptyTrees) {
    std::string unfolding;
    for (int i = 0; i < 40; ++i) {  // a kilobyte that expands to 2⁴⁰ instances
        const std::string next = std::to_string(i + 1);
        unfolding += R"({"children":[)" + next + "," + next + "]},";
    }
    EXPECT_TRUE(load(replaced(tetrahedronGltf(), R"("scene":0,)", "")));
    EXPECT_TRUE(load(replaced(tetrahedronGltf(), R"("scene":0,"scenes":[)", R"("scene":1,"scenes":[{},)")));
    expectWrongGltf(
        {{replaced(tetrahedronGltf(), R"("scene":0)", R"("scene":1)"), "scenes[1], which does not exist"},
         {replaced(replaced(tetrahedronGltf(), R"("scene":0,)", ""), R"("scenes")", R"("scene_")"),
          "it has no scene"},
         parts({.roots = ""}, "no triangles"),
         parts({.roots = "7"}, "scenes[0] references nodes[7]"),
         parts({.nodes = R"({"mesh":1})"}, "nodes[0] has mesh meshes[1], which does not exist"),
         parts({.nodes = R"({"mesh":0},7)"}, "nodes[1] is not an object"),
         node(R"("scale":[0,0,0])", ""),
         node(R"("children":[0])", ""),
         node(R"("children":[5])", "child"),
         parts({.nodes = R"({"children":[1]},{"children":[2]},{"children":[1],"mesh":0})"}, "two parents"),
         parts({.nodes = R"({"mesh":0},{"children":[2]},{"children":[1]})"}, "contain a cycle"),
         parts({.roots = "0,0"}, "twice"),
         parts({.nodes = R"({"children":[1]},{"mesh":0})", .roots = "0,1"}, "parent"),
         parts({.nodes = unfolding + R"({"mesh":0})"}, "two parents")});
}

}  // namespace
}  // namespace relief::test
