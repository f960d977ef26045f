// glTF, right and wrong: each file is read as the specification says, or refused in one line.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <optional>

#include "bake/import/gltf_data.h"
#include "bake/import/mesh_import.h"
#include "formats/base/file_io.h"
#include "tests/bake/import/gltf_cases.h"
#include "tests/bake/import/gltf_oracle.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

Result<TriangleMesh> load(const std::string& text, const std::string& name = "t.gltf") {
    const TemporaryFolder folder;
    return importMeshInWorker(folder.write(name, text));
}

Result<TriangleMesh> loadParts(const GltfParts& parts) {
    return load(tetrahedronGltf(parts));
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    EXPECT_NE(text.find(what), std::string::npos) << what;
    return text.replace(text.find(what), what.size(), by);
}

void expectError(const Result<TriangleMesh>& mesh, ErrorCode code, const std::string& says) {
    ASSERT_FALSE(mesh) << says;
    const std::string& text = mesh.error().message;
    EXPECT_EQ(mesh.error().code, code) << text;
    EXPECT_NE(text.find(says), std::string::npos) << text;
    EXPECT_NE(text.find(".gl") == std::string::npos ? text.find(".dae") : 0, std::string::npos)
        << "no file: " << text;
    EXPECT_NE(text.find("; "), std::string::npos) << "no cure: " << text;
    EXPECT_EQ(text.find_first_of("\n\r\x1b"), std::string::npos) << text;
}

void expectWrong(const std::string& text, const std::string& says) {
    SCOPED_TRACE(says);
    expectError(load(text), ErrorCode::kInvalidInput, says);
}

void expectPartsWrong(const GltfParts& parts, const std::string& says) {
    expectWrong(tetrahedronGltf(parts), says);
}

void expectNode(const std::string& members, const std::string& says) {
    expectPartsWrong({.nodes = R"({"mesh":0,)" + members + "}"}, says);
}

// --- against the book ---

/// Whether it may be that a triangle has no area: Relief drops those.
bool isThin(const Corners& t) {
    const glm::dvec3 a = t[1] - t[0];
    const glm::dvec3 b = t[2] - t[0];
    const double longest = std::max({glm::length(a), glm::length(b), glm::length(a - b), 1e-9});
    const double size = std::max({glm::length(t[0]), glm::length(t[1]), glm::length(t[2]), longest});
    return glm::length(glm::cross(a, b)) <= 1e-4 * longest * size;
}

std::vector<Corners> trianglesOf(const TriangleMesh& mesh) {
    std::vector<Corners> triangles;
    for (const glm::uvec3& t : mesh.triangles) {
        triangles.push_back({glm::dvec3(mesh.positions[t.x]), glm::dvec3(mesh.positions[t.y]),
                             glm::dvec3(mesh.positions[t.z])});
    }
    return triangles;
}

/// The same corners, whichever comes first.
bool same(const Corners& a, const Corners& b) {
    for (std::size_t turn = 0; turn < 3; ++turn) {
        bool all = true;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3& other = b.at((i + turn) % 3);
            all = all && glm::distance(a.at(i), other) <= 1e-5 * (1.0 + glm::length(other));
        }
        if (all) {
            return true;
        }
    }
    return false;
}

/// The book does not know what is outwards: a transform that mirrors turns Relief's triangles over.
bool sameSurface(const Corners& a, const Corners& b) {
    return same(a, b) || same(a, {b[0], b[2], b[1]});
}

struct Verdicts {
    int read = 0;
    int refused = 0;
    int stricter = 0;  // refused, though the book reads it
};

/// What Relief reads of a file must be what the book reads. \param right  whether it must be read at all.
void compare(const fs::path& file, bool right, Verdicts& verdicts) {
    std::optional<std::vector<Corners>> book;
    std::string why;
    try {
        book = readGltfByTheBook(file);
    } catch (const std::exception& error) {
        why = error.what();
    }
    const Result<TriangleMesh> mesh = importMesh(file);
    if (!mesh) {
        ++verdicts.refused;
        const bool visible = book && !std::all_of(book->begin(), book->end(), isThin);
        verdicts.stricter += visible ? 1 : 0;
        EXPECT_FALSE(right && visible) << mesh.error().message;
        EXPECT_NE(mesh.error().message.find(file.filename().string()), std::string::npos);
        EXPECT_NE(mesh.error().message.find("; "), std::string::npos) << "no cure: " << mesh.error().message;
        return;
    }
    ++verdicts.read;
    ASSERT_TRUE(book) << "read, but the book says: " << why;
    const std::vector<Corners> triangles = trianglesOf(*mesh);
    std::size_t at = 0;
    for (const Corners& t : *book) {
        if (at < triangles.size() && sameSurface(triangles[at], t)) {
            ++at;
        } else {
            ASSERT_TRUE(isThin(t)) << "another triangle than number " << at;
        }
    }
    ASSERT_EQ(at, triangles.size()) << "triangles that are not in the file";
}

TEST(ImportGltf, WhatTheSpecificationAllowsIsRead) {
    const TemporaryFolder folder;
    Verdicts verdicts;
    for (std::uint64_t seed = seedFrom(0), end = seed + 300; seed < end; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Dice dice(seed);
        compare(writeGltf(makeGltf(dice), folder, "m"), true, verdicts);
        ASSERT_FALSE(HasFatalFailure());
    }
    EXPECT_GT(verdicts.read, 270) << "some are thin all over";
}

TEST(ImportGltf, MutantsAreReadRightOrRefused) {
    const TemporaryFolder folder;
    Verdicts verdicts;
    for (std::uint64_t seed = seedFrom(1000), end = seed + 700; seed < end; ++seed) {
        Dice dice(seed);
        GltfCase gltf = makeGltf(dice);
        const std::string what = mutateGltf(gltf.document, dice);
        SCOPED_TRACE("seed " + std::to_string(seed) + ": " + what);
        compare(writeGltf(gltf, folder, "m"), false, verdicts);
        ASSERT_FALSE(HasFatalFailure());
    }
    EXPECT_GT(verdicts.read, 140);
    EXPECT_GT(verdicts.refused, 250);
    EXPECT_LT(verdicts.stricter, 100) << "names that are none, say";
}

TEST(ImportGltf, BytesOfBuffersAreIndicesThatExistOrNot) {
    const TemporaryFolder folder;
    Verdicts verdicts;
    for (std::uint64_t seed = seedFrom(5000), end = seed + 300; seed < end; ++seed) {
        Dice dice(seed);
        GltfCase gltf = makeGltf(dice);
        SCOPED_TRACE("seed " + std::to_string(seed));
        for (int i = 0; i < 3; ++i) {
            gltf.buffer[dice.roll(gltf.buffer.size())] = static_cast<char>(dice.roll(256));
        }
        compare(writeGltf(gltf, folder, "m"), false, verdicts);
        ASSERT_FALSE(HasFatalFailure());
    }
    EXPECT_GT(verdicts.read, 50);
    EXPECT_GT(verdicts.refused, 20);
}

// --- by hand ---

TEST(ImportGltf, TheNodeOfASkinnedMeshDoesNotMoveIt) {
    const std::string nodes =
        R"({"mesh":0,"skin":0,"translation":[100,0,0],"scale":[2,2,2]},{"translation":[0,9,0]})";
    const std::string skins = R"("skins":[{"joints":[1]}],)";
    const Result<TriangleMesh> mesh = loadParts({.nodes = nodes, .roots = "0,1", .more = skins});
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->bounds.max, glm::vec3(1, 2, 3));
    ASSERT_EQ(mesh->warnings.size(), 1U);
    EXPECT_NE(mesh->warnings[0].find("it is skinned; parts without joints"), std::string::npos);
    // Units and axes still do.
    const TemporaryFolder folder;
    const Result<TriangleMesh> turned =
        importMesh(folder.write("u.gltf", tetrahedronGltf({.nodes = nodes, .roots = "0,1", .more = skins})),
                   {"cm", UpAxis::kPlusZ});
    ASSERT_TRUE(turned) << turned.error().message;
    EXPECT_EQ(turned->bounds.max, glm::vec3(0.01F, 0.03F, 0.0F));
    expectNode(R"("skin":3)", "nodes[0] names by skin skins[3], which does not exist");
    expectPartsWrong({.nodes = nodes, .roots = "0,1", .more = R"("skins":[{"joints":[2]}],)"},
                     "skins[0] names by joints nodes[2], which does not exist");
    expectPartsWrong({.nodes = nodes, .roots = "0,1", .more = R"("skins":[{"joints":[]}],)"},
                     "skins[0] has no joints");
    expectPartsWrong(
        {.nodes = nodes, .roots = "0,1", .more = R"("skins":[{"joints":[1],"inverseBindMatrices":0}],)"},
        "accessors[0] is not of type MAT4");
}

TEST(ImportGltf, JointsMoveVertices) {
    // A triangle, whose last corner a second joint moves: by 1 along x as it is bound, by 10 along y as it stands.
    const std::string text =
        R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"skin":0,"scale":[9,9,9]},)"
        R"({"children":[2]},{"translation":[0,10,0]}],"skins":[{"joints":[1,2],"inverseBindMatrices":3}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}]}],"accessors":[)"
        R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
        R"({"bufferView":0,"byteOffset":36,"componentType":5121,"count":3,"type":"VEC4"},)"
        R"({"bufferView":0,"byteOffset":48,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"},)"
        R"({"bufferView":0,"byteOffset":60,"componentType":5126,"count":2,"type":"MAT4"}],)"
        R"("bufferViews":[{"buffer":0,"byteLength":188}],"buffers":[{"byteLength":188,"uri":"b.bin"}]})";
    const std::array<float, 9> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::array<float, 32> bound = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                         1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1};
    std::string bytes(reinterpret_cast<const char*>(corners.data()), sizeof(corners));
    bytes += std::string("\0\0\0\0\0\0\0\0\1\0\0\0", 12);
    bytes += std::string("\xff\0\0\0\xff\0\0\0\xff\0\0\0", 12);
    bytes += std::string(reinterpret_cast<const char*>(bound.data()), sizeof(bound));
    const TemporaryFolder folder;
    folder.write("b.bin", bytes);
    const Result<TriangleMesh> mesh = importMesh(folder.write("t.gltf", text));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->positions, std::vector<glm::vec3>({{0, 0, 0}, {1, 0, 0}, {1, 11, 0}}));
    ASSERT_EQ(mesh->warnings.size(), 1U);
    EXPECT_NE(mesh->warnings[0].find("in the pose that its nodes have"), std::string::npos);
    // A model of the glTF tutorials, which is bound half a unit beside.
    const Result<TriangleMesh> model =
        importMeshInWorker("/usr/share/assimp/models/glTF2/simple_skin/simple_skin.gltf");
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_EQ(model->bounds.min, glm::vec3(-0.5F, 0, 0));
    const auto wrong = [&](std::size_t at, char byte, const std::string& says) {
        folder.write("b.bin", std::string(bytes).replace(at, 1, 1, byte));
        expectError(importMesh(folder.write("w.gltf", text)), ErrorCode::kInvalidInput, says);
    };
    wrong(36, 2, "meshes[0] has vertices that are moved by a joint which its skin, skins[0], does not have");
    wrong(48, 0, "attributes have weights that are less than 0, no numbers, or 0 for all joints of a vertex");
    wrong(60 + 15, 0x40, "skins[0] has inverseBindMatrices whose last row is not 0 0 0 1");
    folder.write("b.bin", bytes);
    for (const auto& [what, by, says] :
         {std::tuple{R"("WEIGHTS_0":2)", R"("WEIGHTS_1":2)", "have only one of JOINTS_0 and WEIGHTS_0"},
          std::tuple{R"("joints":[1,2])", R"("joints":[1,2,1])", "fewer inverseBindMatrices than joints"},
          std::tuple{R"("normalized":true,)", "", "is not normalized"}}) {
        expectError(importMesh(folder.write("w.gltf", replaced(text, what, by))), ErrorCode::kInvalidInput,
                    says);
    }
}

TEST(ImportGltf, TransformsThatAreNone) {
    const std::string zeros = "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0";
    EXPECT_TRUE(loadParts({.nodes = R"({"mesh":0,"matrix":[)" + zeros + ",1]}"}));
    expectNode(R"("matrix":[)" + zeros + "]", "nodes[0].matrix has 15 numbers instead of 16");
    expectNode(R"("matrix":[)" + zeros + ",1,0]", "17 numbers");
    expectNode(R"("matrix":[)" + zeros + R"(,"1"])", "nodes[0].matrix[15] is no number");
    expectNode(R"("matrix":[)" + zeros + ",2]", "last row");
    expectNode(R"("matrix":[1,0,0,5,0,1,0,6,0,0,1,7,0,0,0,1])", "is it transposed?");
    expectNode(R"("translation":[1,2])", "nodes[0].translation has 2 numbers instead of 3");
    expectNode(R"("translation":null)", "nodes[0].translation is not an array");
    expectNode(R"("translation":{})", "is not an array");
    expectNode(R"("scale":[1,null,1])", "nodes[0].scale[1] is no number");
    expectNode(R"("rotation":[0,0,0,2])", "no unit quaternion: its length is 2");
    expectNode(R"("rotation":[0,0,0,0])", "no unit quaternion");
    expectNode(R"("rotation":[0,0,1])", "3 numbers instead of 4");
    expectNode(R"("matrix":[)" + zeros + R"(,1],"scale":[1,1,1])", "only one may be");
    expectNode(R"("translation":[0,0,1e999])", "no valid JSON");
    expectNode(R"("translation":[0,0,1e200])", "not a number or beyond 1e15");
}

TEST(ImportGltf, VersionsAndExtensions) {
    const auto asset = [](const std::string& members) {
        return replaced(tetrahedronGltf(), R"("version":"2.0")", members);
    };
    EXPECT_TRUE(load(asset(R"("version":"2.1","minVersion":"2.0")")));
    expectError(load(asset(R"("version":"2.1","minVersion":"2.1")")), ErrorCode::kUnsupported,
                "version '2.1'");
    expectError(load(asset(R"("version":"3.0")")), ErrorCode::kUnsupported, "version '3.0'");
    for (const std::string name : {"KHR_node_visibility"}) {
        const Result<TriangleMesh> mesh = loadParts({.more = R"("extensionsUsed":[")" + name + "\"],"});
        ASSERT_TRUE(mesh) << mesh.error().message;
        ASSERT_EQ(mesh->warnings.size(), 1U);
        EXPECT_NE(mesh->warnings[0].find(name), std::string::npos);
        expectError(loadParts({.more = R"("extensionsRequired":[")" + name + "\"],"}),
                    ErrorCode::kUnsupported, name);
    }
    expectWrong(asset(R"("version":2.0)"), "asset.version is no string");
    expectWrong(asset(R"("version":"two")"), "asset has 'two' where a version belongs");
    expectWrong(asset(R"("version":"2.0","minVersion":[])"), "asset.minVersion");
    expectWrong(asset(R"("generator":"x")"), "no glTF version");
    expectWrong(replaced(tetrahedronGltf(), R"("asset")", R"("assets")"), "no glTF version");
    expectWrong(replaced(tetrahedronGltf(), R"({"asset")", R"({"extensionsRequired":{},"asset")"),
                "extensionsRequired is not an array");
}

TEST(ImportGltf, InstancesAreRepeated) {
    // At the corners of the tetrahedron, (0, 0, 0), (1, 0, 0), (0, 2, 0) and (0, 0, 3), within a node that is twice as large.
    const auto node = [](const std::string& attributes, const std::string& more = "") {
        return R"({"mesh":0,"scale":[2,2,2],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{)" +
               attributes + "}}}" + more + "}";
    };
    GltfParts parts{.nodes = node(R"("TRANSLATION":0)"),
                    .more = R"("extensionsRequired":["EXT_mesh_gpu_instancing"],)"};
    const Result<TriangleMesh> mesh = loadParts(parts);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 16U);
    EXPECT_EQ(mesh->bounds.max, glm::vec3(4.0F, 8.0F, 12.0F));
    EXPECT_TRUE(mesh->warnings.empty());

    parts.nodes = node("");
    expectPartsWrong(parts, "attributes have none of TRANSLATION");
    parts.nodes = node(R"("TRANSLATION":1)");
    expectPartsWrong(parts, "accessors[1] is not of type VEC3");
    parts.nodes = node(R"("TRANSLATION":7)");
    expectPartsWrong(parts, "accessors[7], which does not exist");
    parts.nodes = R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{}}})";
    expectPartsWrong(parts, "has no attributes");
    // The same floats as three vectors of four numbers, none of which is a rotation.
    parts.indices += R"(},{"bufferView":0,"componentType":5126,"count":3,"type":"VEC4")";
    parts.nodes = node(R"("ROTATION":2)");
    expectPartsWrong(parts, "no unit quaternion");
    parts.nodes = node(R"("TRANSLATION":0,"ROTATION":2)");
    expectPartsWrong(parts, "other counts of TRANSLATION, ROTATION and SCALE");
}

TEST(ImportGltf, EqualKeysAndJsonThatIsNone) {
    expectPartsWrong({.nodes = R"({"mesh":0,"scale":[1,1,1],"scale":[2,2,2]})"}, "the key 'scale' twice");
    expectPartsWrong({.nodes = R"({"mesh":0,"me\u0073h":0})"}, "the key 'mesh' twice");
    expectPartsWrong({.more = R"("extras":{"a":[{"b":1},{"b":1,"b":1}]},)"}, "the key 'b' twice");
    EXPECT_TRUE(loadParts({.more = R"("extras":{"a":[{"b":1},{"b":1}]},)"}));
    expectWrong(tetrahedronGltf() + "x", "no valid JSON: parse error at line 1, column ");
    expectWrong("{\n \"asset\": ,}", "no valid JSON: parse error at line 2, column 11");
    expectWrong(tetrahedronGltf() + std::string("\0{}", 3), "a byte of 0");
    EXPECT_TRUE(load(tetrahedronGltf() + std::string("\n\0\0", 3))) << "filled up";
    expectWrong("[]", "no object");
    expectWrong("{", "no valid JSON");
}

TEST(ImportGltf, IndicesThatAreNoVertices) {
    const auto with = [](const char* kind, std::size_t at, const std::string& value) {
        std::string buffer = tetrahedronBuffer();
        buffer.replace(48 + at, value.size(), value);
        const TemporaryFolder folder;
        folder.write("b.bin", buffer);
        return importMeshInWorker(folder.write(
            "t.gltf", tetrahedronGltf({.indices = R"("bufferView":1,"componentType":)" + std::string(kind) +
                                                  R"(,"count":6,"type":"SCALAR")",
                                       .uri = "b.bin"})));
    };
    constexpr ErrorCode kWrong = ErrorCode::kInvalidInput;
    expectError(with("5123", 0, std::string("\x04\0", 2)), kWrong,
                "accessors[1] holds the index 4 of a vertex that does not exist: there are 4");
    expectError(with("5123", 4, "\xff\xff"), kWrong,
                "accessors[1] holds the index 65535, which is not allowed");
    expectError(with("5121", 5, "\xff"), kWrong, "the index 255, which is not allowed");
    expectError(with("5125", 0, "\xff\xff\xff\xff"), kWrong, "the index 4294967295, which is not allowed");
    expectPartsWrong({.indices = R"("bufferView":1,"componentType":5123,"count":11,"type":"SCALAR")"},
                     "meshes[0].primitives[0] has 11 corners, which is no multiple of 3");
    expectPartsWrong({.primitive = R"("attributes":{"POSITION":0},"indices":1,"mode":7)"}, "mode");
    expectPartsWrong({.primitive = R"("attributes":{"POSITION":0},"indices":null)"},
                     "meshes[0].primitives[0].indices is not a whole number");
    expectPartsWrong({.primitive = R"("attributes":{"POSITION":-1})"},
                     "attributes.POSITION is not a whole number");
}

TEST(ImportGltf, BuffersByUri) {
    const auto beside = [](const std::string& file, const std::string& uri, std::size_t size = 72) {
        const TemporaryFolder folder;
        folder.write(file, tetrahedronBuffer().substr(0, size));
        return importMeshInWorker(folder.write("t.gltf", tetrahedronGltf({.uri = uri})));
    };
    for (const auto& [file, uri] :
         {std::pair{"a b.bin", "a%20b.bin"}, std::pair{"a b.bin", "a b.bin"},
          std::pair{"\xc3\xa4.bin", "%C3%a4.bin"}, std::pair{"50%.bin", "50%25.bin"},
          std::pair{"a#1.bin", "a%231.bin"}, std::pair{"a:b.bin", "a%3Ab.bin"}}) {
        SCOPED_TRACE(uri);
        const Result<TriangleMesh> mesh = beside(file, uri);
        ASSERT_TRUE(mesh) << mesh.error().message;
        EXPECT_EQ(mesh->triangles.size(), 4U);
        EXPECT_EQ(fs::path(mesh->dependencies.back()).filename(), file);
    }
    constexpr ErrorCode kWrong = ErrorCode::kInvalidInput;
    expectError(beside("b.bin", "50%.bin"), kWrong, "buffers[0] has a % without two hexadecimal digits");
    expectError(beside("b.bin", "%2e%2e/b.bin"), kWrong, "not below the mesh's folder");
    expectError(beside("b.bin", "%2Fetc%2Fpasswd"), kWrong, "not below the mesh's folder");
    expectError(beside("b.bin", "b.bin%00"), kWrong, "not below the mesh's folder");
    expectError(beside("b.bin", "c.bin"), kWrong, "buffers[0] refers to 'c.bin' (No such file");
    expectError(beside("b.bin", "b.bin", 71), kWrong, "buffers[0] has 71 of the 72 bytes that it announces");
    expectWrong(replaced(tetrahedronGltf(), R"("uri")", R"("url")"), "buffers[0] has no uri");
}

TEST(ImportGltf, DataUris) {
    const auto decoded = [](const std::string& uri) {
        const Result<std::vector<std::byte>> bytes = dataUriBytes(uri);
        return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size())
                     : "error: " + bytes.error().message;
    };
    EXPECT_EQ(decoded("data:application/octet-stream;base64,aGVsbG8="), "hello");
    EXPECT_EQ(decoded("data:;base64,aGVsbG8"), "hello") << "without padding, as browsers take it";
    EXPECT_EQ(decoded("DATA:application/gltf-buffer;BASE64,aGVsbG8%3D"), "hello");
    EXPECT_EQ(decoded("data:;base64,"), "");
    for (const char* wrong :
         {"a", "aGVsbG8=a", "a=Vs", "aGVs bG8=", "aGVs\nbG8=", "aG-_", "====", "aGVsbG8%", "a==="}) {
        EXPECT_EQ(decoded(std::string("data:;base64,") + wrong).substr(0, 6), "error:") << wrong;
    }
    EXPECT_EQ(decoded("data:application/octet-stream,hello").substr(0, 6), "error:");
    EXPECT_EQ(decoded("data:base64").substr(0, 6), "error:");
    expectPartsWrong({.uri = "data:application/octet-stream;base64,AAA*"}, "buffers[0] is no valid base64");
    expectPartsWrong({.uri = "data:application/octet-stream;base64,AAAA"},
                     "buffers[0] has 3 of the 72 bytes");
}

TEST(ImportGltf, BinaryChunks) {
    Dice dice(3);
    GltfCase gltf = makeGltf(dice);
    gltf.container = GltfContainer::kBinary;
    const TemporaryFolder folder;
    const fs::path path = writeGltf(gltf, folder, "m");
    ASSERT_TRUE(importMesh(path));
    std::string text;
    {
        const Result<std::vector<std::byte>> bytes = readFile(path);
        text.assign(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    }
    // Cut off anywhere, it is refused; a word more behind its end is told.
    for (std::size_t size = 5; size < text.size(); size += size < 40 ? 1 : 97) {
        EXPECT_FALSE(load(text.substr(0, size), "c.glb")) << size;
    }
    const Result<TriangleMesh> more = load(text + "more", "m.glb");
    ASSERT_TRUE(more) << more.error().message;
    EXPECT_NE(more->warnings.at(0).find("4 bytes behind the end"), std::string::npos);
    const auto with = [&](std::size_t at, const std::string& bytes) {
        std::string changed = text;
        return load(changed.replace(at, bytes.size(), bytes), "w.glb");
    };
    expectError(with(4, "\x01"), ErrorCode::kUnsupported, "version 1");
    expectError(with(16, "BIN"), ErrorCode::kInvalidInput, "first chunk is no JSON");
    expectError(with(12, "\xf1\xff\xff\x7f"), ErrorCode::kInvalidInput, "ends behind the file");
}

TEST(ImportGltf, SkinnedMorphedSparseAndQuantised) {
    // Bytes of −127 and 127 as −1 and 1, moved by the values of a sparse accessor.
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
    const TemporaryFolder folder;
    folder.write("b.bin", bytes);
    const Result<TriangleMesh> mesh = importMesh(folder.write("q.gltf", text));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->bounds.min, glm::vec3(0, 0, -1));
    EXPECT_EQ(mesh->bounds.max, glm::vec3(1, 1, 0));
    const auto wrong = [&](const std::string& what, const std::string& by, const std::string& says) {
        SCOPED_TRACE(by);
        expectError(importMesh(folder.write("w.gltf", replaced(text, what, by))), ErrorCode::kInvalidInput,
                    says);
    };
    wrong(R"("count":1)", R"("count":4)", "accessors[0].sparse");
    wrong(R"("byteLength":1})", R"("byteLength":0})", "accessors[0].sparse.indices ends behind");
    wrong(R"("values":{"bufferView":2})", R"("values":{"bufferView":1})",
          "accessors[0].sparse.values ends behind");
    wrong(R"("byteStride":4)", R"("byteStride":2)", "accessors[0] has a buffer view of 2 bytes from one");
    wrong(R"("normalized":true)", R"("normalized":1)", "accessors[0].normalized is neither true nor false");
    folder.write("b.bin", std::string(bytes).replace(12, 1, "\3"));
    wrong("q", "q",
          "accessors[0].sparse.indices are not in ascending order, or name an element that does not exist");
}

TEST(ImportGltf, CompressedByALaterMeshoptIsRefused) {
    const std::string view = R"({"buffer":0,"byteOffset":0,"byteLength":48)";
    expectError(
        load(replaced(tetrahedronGltf(), view, view + R"(,"extensions":{"KHR_meshopt_compression":{}})")),
        ErrorCode::kUnsupported, "bufferViews[0] is compressed by KHR_meshopt_compression");
}

TEST(ImportGltf, CompressedByDracoIsRefusedWhereItIsRequired) {
    expectError(importMeshInWorker("/usr/share/assimp/models/glTF2/draco/2CylinderEngine.gltf"),
                ErrorCode::kUnsupported, "KHR_draco_mesh_compression");
    // Its accessors have the same mesh uncompressed where the extension is only used.
    EXPECT_TRUE(loadParts(
        {.primitive = R"("attributes":{"POSITION":0},"indices":1,"extensions":{)"
                      R"("KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})"}));
}

TEST(ImportGltf, ScenesThatShowNothing) {
    expectWrong(replaced(tetrahedronGltf(), R"("scene":0)", R"("scene":1)"),
                "scenes[1], which does not exist");
    expectWrong(replaced(replaced(tetrahedronGltf(), R"("scene":0,)", ""), R"("scenes")", R"("scene_")"),
                "it has no scene");
    expectPartsWrong({.roots = ""}, "no triangles");
    expectPartsWrong({.roots = "7"}, "scenes[0] names nodes[7]");
    expectPartsWrong({.nodes = R"({"mesh":1})"}, "nodes[0] names by mesh meshes[1], which does not exist");
    expectPartsWrong({.nodes = R"({"mesh":0},7)"}, "nodes[1] is not an object");
}

TEST(ImportGltf, TrianglesAreCountedBeforeTheyAreMade) {
    const TemporaryFolder folder;
    std::string nodes = R"({"mesh":0})";
    std::string roots = "0";
    for (int i = 1; i < 100; ++i) {
        nodes += R"(,{"mesh":0})";
        roots += "," + std::to_string(i);
    }
    const fs::path file = folder.write("i.gltf", tetrahedronGltf({.nodes = nodes, .roots = roots}));
    ImportLimits limits;
    limits.triangles = 400;
    EXPECT_TRUE(importMeshInWorker(file, {}, limits));
    limits.triangles = 399;
    expectError(importMeshInWorker(file, {}, limits), ErrorCode::kLimit, "more than 399 triangles");
    expectError(importMeshInWorker(file, {}, limits), ErrorCode::kLimit, "raise --max-triangles");
    limits.triangles = 3;
    expectError(importMeshInWorker(file, {}, limits), ErrorCode::kLimit, "raise --max-triangles");
    // And of every format.
    const fs::path dae = folder.write("t.dae", tetrahedronDae(""));
    expectError(importMeshInWorker(dae, {}, limits), ErrorCode::kLimit, "more than 3 triangles");
    limits.triangles = 0;
    EXPECT_EQ(importMeshInWorker(dae, {}, limits).error().code, ErrorCode::kUsage);
}

}  // namespace
}  // namespace relief::test
