// SPDX-License-Identifier: Apache-2.0
#include "tests/bake/import/import_meshes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "bake/mesh/triangle_plane.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

constexpr std::array<float, 12> kCorners = {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};
constexpr std::array<std::uint16_t, 12> kFaces = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};

template <class Values>
std::string meshBytes(const Values& values) {
    return {reinterpret_cast<const char*>(values.data()), sizeof(values[0]) * values.size()};
}

}  // namespace

std::string tetrahedronObj() {
    return "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
}

std::string tetrahedronPly() {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
}

std::string tetrahedronOff() {
    return "OFF\n4 4 0\n0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
}

std::string tetrahedronStl() {
    constexpr std::array kWords = {"0 0 0", "1 0 0", "0 2 0", "0 0 3"};
    std::string text = "solid t\n";
    for (std::size_t i = 0; i < kFaces.size(); i += 3) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (std::size_t k = i; k < i + 3; ++k) {
            text += std::string("vertex ") + kWords.at(kFaces[k]) + "\n";
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid t\n";
}

std::string tetrahedronBinaryStl(const std::string& header) {
    std::string text =
        header + std::string(80 - header.size(), 'x') + meshBytes(std::array{std::uint32_t{4}});
    for (std::size_t i = 0; i < kFaces.size(); ++i) {
        text += std::string(i % 3 == 0 ? 12 : 0, '\0');
        text.append(reinterpret_cast<const char*>(&kCorners.at(3U * kFaces[i])), 12);
        text += i % 3 == 2 ? "\1\2" : "";
    }
    return text;
}

std::string tetrahedron3ds(float master_scale) {
    const auto chunk = [&](std::uint16_t id, const std::string& contents) {
        const auto size = static_cast<std::uint32_t>(contents.size() + 6);
        std::string text(6, '\0');
        std::memcpy(text.data(), &id, 2);
        std::memcpy(text.data() + 2, &size, 4);
        return text + contents;
    };
    const std::string four("\4\0", 2);
    const std::array<std::uint16_t, 16> faces = {0, 2, 1, 0, 0, 1, 3, 0, 1, 2, 3, 0, 0, 3, 2, 0};
    const std::string mesh =
        chunk(0x4110, four + meshBytes(kCorners)) + chunk(0x4120, four + meshBytes(faces));
    const std::string scaled = master_scale == 1.0F ? "" : chunk(0x0100, meshBytes(std::array{master_scale}));
    return chunk(0x4D4D, chunk(0x3D3D, scaled + chunk(0x4000, std::string("t\0", 2) + chunk(0x4100, mesh))));
}

std::string tetrahedronDae(const std::string& asset) {
    return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
           asset +
           R"(</asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="12">)"
           R"(0 0 0 1 0 0 0 2 0 0 0 3</float_array><technique_common><accessor source="#a" count="4" stride="3">)"
           R"(<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>)"
           R"(</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)"
           R"(<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 1 2 3 0 3 2</p>)"
           R"(</triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s">)"
           R"(<node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene>)"
           R"(<instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string tetrahedronFbx(int up, int sign, const std::string& unit) {
    const auto property = [](const char* name, const char* type, const std::string& value) {
        return std::string("P: \"") + name + "\", " + type + ", \"\"," + value + "\n";
    };
    constexpr const char* kInt = R"("int", "Integer")";
    return "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\nFBXHeaderVersion: 1003\nFBXVersion: 7300\n}\n"
           "GlobalSettings:  {\nVersion: 1000\nProperties70:  {\n" +
           property("UpAxis", kInt, std::to_string(up)) + property("UpAxisSign", kInt, std::to_string(sign)) +
           property("UnitScaleFactor", R"("double", "Number")", unit) +
           "}\n}\nObjects:  {\nGeometry: 1000, \"Geometry::t\", \"Mesh\" {\n"
           "Vertices: *12 {\na: 0,0,0,1,0,0,0,2,0,0,0,3\n}\n"
           "PolygonVertexIndex: *12 {\na: 0,2,-2,0,1,-4,1,2,-4,0,3,-3\n}\nGeometryVersion: 124\n}\n"
           "Model: 2000, \"Model::t\", \"Mesh\" {\nVersion: 232\nProperties70:  {\n}\n}\n}\n"
           "Connections:  {\nC: \"OO\",2000,0\nC: \"OO\",1000,2000\n}\n";
}

std::string tetrahedronBuffer() {
    return meshBytes(kCorners) + meshBytes(kFaces);
}

std::string tetrahedronGltf(const GltfParts& parts) {
    const std::string uri =
        parts.uri.empty() ? "data:application/octet-stream;base64," + base64(tetrahedronBuffer()) : parts.uri;
    return "{" + parts.more + R"("asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + parts.roots +
           R"(]}],"nodes":[)" + parts.nodes + R"(],"meshes":[{"primitives":[{)" + parts.primitive +
           R"(}]}],"accessors":[{)" + parts.position + "},{" + parts.indices +
           R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},)"
           R"({"buffer":0,"byteOffset":48,"byteLength":24}],"buffers":[{"byteLength":72,"uri":")" +
           uri + R"("}]})";
}

std::string manyNodes(std::size_t count) {
    GltfParts parts;
    for (std::size_t i = 1; i < count; ++i) {
        parts.nodes += R"(,{"mesh":0})";
        parts.roots += "," + std::to_string(i);
    }
    return tetrahedronGltf(parts);
}

std::string base64(std::string_view bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : kDigits[group >> (18U - 6U * k) & 63U];
        }
    }
    return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    EXPECT_NE(text.find(from), std::string::npos) << from;
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
    return text;
}

Result<TriangleMesh> importText(const std::string& name, std::string_view contents,
                                const ImportOptions& options) {
    const TemporaryFolder folder;
    return importMesh(folder.write(name, contents), options);
}

Result<TriangleMesh> importTextInWorker(const std::string& name, std::string_view contents,
                                        const ImportOptions& options) {
    const TemporaryFolder folder;
    return importMeshInWorker(folder.write(name, contents), options);
}

TriangleMesh imported(const std::string& name, std::string_view contents, const ImportOptions& options) {
    return required(importText(name, contents, options));
}

void expectFault(const Error& error, const std::string& words, ErrorCode code) {
    EXPECT_EQ(error.code, code) << error.message;
    EXPECT_NE(error.message.find(words), std::string::npos) << error.message << "\nexpected: " << words;
    EXPECT_NE(error.message.find("; "), std::string::npos) << "no advice: " << error.message;
    EXPECT_EQ(error.message.find_first_of("\n\r\x1b"), std::string::npos) << error.message;
}

void expectWrong(const std::string& name, const std::vector<Wrong>& cases) {
    for (const Wrong& wrong : cases) {
        SCOPED_TRACE(wrong.words + " in " + wrong.text);
        const Result<TriangleMesh> mesh = importText(name, wrong.text);
        expectRejected(mesh, wrong.words, wrong.code);
        EXPECT_TRUE(mesh || mesh.error().message.find(name) != std::string::npos);
    }
}

void expectInvalidRejected(const TriangleMesh& honest,
                           const std::vector<std::function<void(TriangleMesh&)>>& lies,
                           const std::function<bool(TriangleMesh)>& accepts) {
    EXPECT_TRUE(accepts(honest));
    for (std::size_t i = 0; i < lies.size(); ++i) {
        TriangleMesh answer = honest;
        lies[i](answer);
        EXPECT_FALSE(accepts(std::move(answer))) << "invalid result " << i;
    }
}

bool warns(const TriangleMesh& mesh, const std::string& words) {
    return std::any_of(mesh.warnings.begin(), mesh.warnings.end(),
                       [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
}

double signedVolume(const TriangleMesh& mesh) {
    double volume = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const TrianglePlane plane = planeOf(mesh, i);
        volume += dot(plane.point, plane.normal) / 6.0;
    }
    return volume;
}

}  // namespace relief::test
