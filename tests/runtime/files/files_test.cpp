// SPDX-License-Identifier: Apache-2.0
// Mesh files and flow files, valid and hostile.
#include <gtest/gtest.h>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <limits>
#include <string>

#include "runtime/files/flow_file.h"
#include "runtime/files/mesh_file.h"
#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

using Triangles = std::vector<std::uint32_t>;

Result<PictureMesh> ply(const std::string& text) {
    return parsePictureMesh(std::as_bytes(std::span(text)), ".ply", "'a.ply'");
}

Result<PictureMesh> obj(const std::string& text) {
    return parsePictureMesh(std::as_bytes(std::span(text)), ".obj", "a.obj");
}

void expectError(const Result<PictureMesh>& mesh, const std::string& part,
                 ErrorCode code = ErrorCode::kInvalidInput) {
    relief::expectError(mesh, code, part);
}

TEST(ObjMesh, VerticesAndFaces) {
    const auto mesh = required(obj(
        "\xef\xbb\xbf# a comment\r\no thing\nv 0 0 0\nv 1 0 0 1.0\n  v\t1 1e0 +0\nv 0 1 0\nvn 0 0 1\nvt 0 0\n"
        "f 1/1/1 2//1 3/1 # and a comment\nf -4 -2 -1\nf 1 2 3 4\ns off"));
    EXPECT_EQ(mesh.positions.size(), 4U);
    EXPECT_EQ(mesh.positions[2], glm::vec3(1.0F, 1.0F, 0.0F));
    EXPECT_EQ(mesh.triangles, (Triangles{0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3}));
}

TEST(ObjMesh, ReadsVertexColors) {
    const auto mesh = required(obj("v 0 0 0 1 0 0\nv 1 0 0 1 0.5 2\nv 0 1 0 1 0 -1 1\nf 1 2 3\n"));
    using Color = std::array<std::uint8_t, 4>;
    EXPECT_EQ(mesh.colors, (std::vector<Color>{{255, 0, 0, 255}, {255, 128, 255, 255}, {0, 0, 255, 255}}));
    EXPECT_TRUE(obj("v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")->colors.empty())
        << "only some vertices have colors";
    const PictureMesh smooth = withNormals(mesh);
    ASSERT_EQ(smooth.colors.size(), smooth.positions.size());
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(smooth.colors[smooth.triangles[i]], mesh.colors[i]);
    }
}

// ImportText covers the reader's other errors.
TEST(ObjMesh, RejectsInvalidFiles) {
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    expectError(obj(three + "f 1 2\n"), "a.obj: it has no faces");
    expectError(obj(std::string(1000, '\0')), "no faces");
    for (const char* line :
         {"f 1 2 /1\n", "f 1 2 2x\n", "f 1 2 4\n", "v 0 0 nan\nf 1 2 4\n", "v 0 0 1e39\nf 1 2 4\n"}) {
        expectError(obj(three + line), "a.obj: line 4: ");
    }
    EXPECT_TRUE(obj("f 1 2 3\n" + three)) << "vertices may follow the faces";
}

const std::string kPlyHead =
    "element vertex 4\nproperty float x\nproperty uchar red\nproperty double y\nproperty short z\n"
    "element face 2\nproperty int flags\nproperty list uchar int vertex_indices\nend_header\n";

TEST(PlyMesh, ColorsAsBytesOrFloats) {
    using Color = std::array<std::uint8_t, 4>;
    const auto colors = [](const std::string& type, const std::vector<std::string>& channels,
                           const std::string& vertices) {
        std::string text =
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
        for (const std::string& channel : channels) {
            text += "property " + type + " " + channel + "\n";
        }
        text += "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
        return required(ply(text + vertices + "3 0 1 2\n")).colors;
    };
    const std::vector<std::string> rgb{"red", "green", "blue"};
    const std::vector<Color> primaries{{255, 0, 0, 255}, {0, 128, 0, 255}, {0, 0, 255, 255}};
    EXPECT_EQ(colors("uchar", rgb, "0 0 0 255 0 0\n1 0 0 0 128 0\n0 1 0 0 0 255\n"), primaries);
    EXPECT_EQ(colors("float", rgb, "0 0 0 1 0 0\n1 0 0 0 0.5 0\n0 1 0 0 0 1\n"), primaries);
    EXPECT_EQ(
        colors("uchar", {"red", "green", "blue", "alpha"}, "0 0 0 1 2 3 4\n1 0 0 5 6 7 4\n0 1 0 9 10 11 4\n"),
        (std::vector<Color>{{1, 2, 3, 4}, {5, 6, 7, 4}, {9, 10, 11, 4}}));
}

TEST(PlyMesh, AsciiWithOtherElements) {
    const auto mesh = required(
        ply("ply\r\nformat ascii 1.0\ncomment x\nelement camera 1\nproperty float f\nproperty list uint8 "
            "int32 l\n" +
            kPlyHead + "0.5 2 7 8\n0 255 0 0\n1 255 0.5 2\n1 0 1 0\n0 9 1 -3\n  7 3 0 1 2\n7 4 0 1\n2 3\n"));
    ASSERT_EQ(mesh.positions.size(), 4U);
    EXPECT_EQ(mesh.positions[1], glm::vec3(1.0F, 0.5F, 2.0F));
    EXPECT_EQ(mesh.positions[3], glm::vec3(0.0F, 1.0F, -3.0F));
    EXPECT_EQ(mesh.triangles, (Triangles{0, 1, 2, 0, 1, 2, 0, 2, 3}));
}

/// A number's bytes in either byte order.
template <class T>
void put(std::string& out, T value, bool big) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        out.push_back(bytes[big == (std::endian::native == std::endian::little) ? sizeof(T) - 1 - i : i]);
    }
}

std::string binaryPly(bool big) {
    std::string text = std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
                       " 1.0\n" + kPlyHead;
    for (int i = 0; i < 4; ++i) {
        put(text, 0.25F * static_cast<float>(i), big);
        text.push_back('\n');
        put(text, -1.5 * i, big);
        put(text, static_cast<std::int16_t>(-300 * i), big);
    }
    for (const int corners : {3, 4}) {
        put(text, -1, big);
        text.push_back(static_cast<char>(corners));
        for (int i = 0; i < corners; ++i) {
            put(text, 3 - i, big);
        }
    }
    return text;
}

// ImportPly covers the reader's other errors.
TEST(PlyMesh, RejectsInvalidFiles) {
    const std::string xyz =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\n";
    const std::string face = xyz +
                             "element face 1\nproperty list char int vertex_index\nend_header\n"
                             "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_TRUE(ply(face + "3 0 1 2\n"));
    for (const auto& [text, names] : {std::pair("3 0 1 3\n", "face 0"),
                                      {"3 0 1 -1\n", "face 0"},
                                      {"3 0 1 0.5\n", "face 0"},
                                      {"2 0 1\n", "no faces"},
                                      {"-3 0 1 2\n", "length"},
                                      {"1e9 0 1 2\n", "before the counts"},
                                      {"1e10 0 1 2\n", "length"},
                                      {"3 0 1", "before the counts"}}) {
        expectError(ply(face + text), names);
    }
    // A count beyond the file's size allocates nothing of that size, and many empty faces fail fast.
    std::string many = face;
    many.replace(many.find("vertex 3"), 8, "vertex 20000000");
    expectError(ply(many), "before the counts");
    many.replace(many.find("20000000"), 8, "300000001");
    expectError(ply(many), "vertices", ErrorCode::kLimit);
    expectError(ply(xyz + "element face 18446744073709551615\nend_header\n0 0 0\n1 0 0\n0 1 0\n"), "");
}

TEST(PlyMesh, SurvivesPrefixesAndFlippedBytes) {
    for (const bool big : {false, true}) {
        const std::string text = binaryPly(big);
        ASSERT_TRUE(ply(text));
        EXPECT_EQ(ply(text)->positions[3], glm::vec3(0.75F, -4.5F, -900.0F));
        EXPECT_EQ(ply(text)->triangles, (Triangles{3, 2, 1, 3, 2, 1, 3, 1, 0}));
        for (std::size_t i = 0; i < text.size(); ++i) {
            EXPECT_FALSE(ply(text.substr(0, i))) << i;
            for (const unsigned flip : {1U, 0x20U, 0x80U}) {
                std::string changed = text;
                changed[i] = static_cast<char>(static_cast<unsigned char>(changed[i]) ^ flip);
                if (const auto mesh = ply(changed)) {
                    EXPECT_TRUE(checkMesh(*mesh));
                }
            }
        }
    }
}

TEST(MeshFile, ByExtension) {
    expectError(loadPictureMesh("/nonexistent/a.stl"), "convert it", ErrorCode::kUnsupported);
    expectError(loadPictureMesh("/nonexistent/a.OBJ"), "/nonexistent/a.OBJ", ErrorCode::kIo);
    const TemporaryFolder folder;
    EXPECT_EQ(required(loadPictureMesh(folder.write("a.Ply", binaryPly(false)))).triangles.size(), 9U);
}

// A cube's corners have three normals each, a flat square's corners one, and the ridge of a low roof has the mean of
// both sides.
TEST(MeshNormals, KeepCreasesAndSmoothCurves) {
    PictureMesh cube;
    for (int i = 0; i < 8; ++i) {
        cube.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
    }
    for (const Triangles& q :
         {Triangles{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
        cube.triangles.insert(cube.triangles.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
    }
    const PictureMesh sharp = withNormals(cube);
    EXPECT_EQ(sharp.positions.size(), 24U);
    for (std::size_t t = 0; t < sharp.triangles.size(); t += 3) {
        const glm::vec3 a = sharp.positions[sharp.triangles[t]];
        const glm::vec3 face = glm::cross(sharp.positions[sharp.triangles[t + 1]] - a,
                                          sharp.positions[sharp.triangles[t + 2]] - a);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(glm::dot(sharp.normals[sharp.triangles[t + i]], face), 1.0F, 1e-6F);
            EXPECT_EQ(sharp.positions[sharp.triangles[t + i]], cube.positions[cube.triangles[t + i]]);
        }
    }
    PictureMesh roof;
    roof.positions = {{0, 0.2F, 0}, {0, 0.2F, 1}, {1, 0, 0}, {1, 0, 1}, {-1, 0, 0}, {-1, 0, 1}};
    roof.triangles = {0, 1, 2, 1, 3, 2, 0, 4, 1, 1, 4, 5};
    const PictureMesh smooth = withNormals(roof);
    EXPECT_EQ(smooth.positions.size(), 6U);
    EXPECT_NEAR(smooth.normals[smooth.triangles[1]].y, 1.0F, 1e-3F);
    EXPECT_EQ(withNormals(roof, 0.1F).positions.size(), 8U);
}

// A tube bends by 90°: rims stay sharp, and normals along its side rotate with their positions.
TEST(MeshNormals, MovingMeshesKeepCreasesAndRotateNormals) {
    constexpr std::uint32_t kRound = 24;
    constexpr std::uint32_t kRings = 9;
    PictureMesh tube;
    std::vector<glm::vec3> bent;
    const auto turned = [](float along, const glm::vec3& v) {
        const float angle = 1.57079633F * along;
        return glm::vec3(v.x, std::cos(angle) * v.y + std::sin(angle) * v.z,
                         std::cos(angle) * v.z - std::sin(angle) * v.y);
    };
    for (std::uint32_t ring = 0; ring < kRings; ++ring) {
        const float along = static_cast<float>(ring) / (kRings - 1);
        for (std::uint32_t i = 0; i < kRound; ++i) {
            const float angle = 6.28318531F * static_cast<float>(i) / kRound;
            const glm::vec3 side(std::cos(angle), std::sin(angle), 0.0F);
            tube.positions.push_back(side + glm::vec3(0.0F, 0.0F, 8.0F * along));
            const glm::vec3 pivot(0.0F, 5.0F, 0.0F);
            bent.push_back(turned(along, side) + pivot - turned(along, pivot));
            const std::uint32_t at = ring * kRound + i;
            const std::uint32_t next = ring * kRound + (i + 1) % kRound;
            if (ring + 1 < kRings) {
                tube.triangles.insert(tube.triangles.end(),
                                      {at, next, at + kRound, next, next + kRound, at + kRound});
            }
        }
    }
    for (std::uint32_t i = 2; i < kRound; ++i) {  // a lid
        tube.triangles.insert(tube.triangles.end(), {0, i, i - 1});
    }
    MovingMesh moving(tube);
    ASSERT_EQ(moving.mesh().positions.size(), (kRings + 1) * kRound) << "a crease around the lid";
    moving.setPositions(bent);
    const PictureMesh& mesh = moving.mesh();
    ASSERT_EQ(mesh.triangles.size(), tube.triangles.size());
    for (std::size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
        const std::uint32_t vertex = tube.triangles[corner];
        const glm::vec3& normal = mesh.normals[mesh.triangles[corner]];
        EXPECT_EQ(mesh.positions[mesh.triangles[corner]], bent[vertex]);
        const float along = static_cast<float>(vertex / kRound) / (kRings - 1);
        const float angle = 6.28318531F * static_cast<float>(vertex % kRound) / kRound;
        const bool lid = corner >= tube.triangles.size() - 3 * (kRound - 2);
        const glm::vec3 wanted =
            lid ? glm::vec3(0.0F, 0.0F, -1.0F) : turned(along, {std::cos(angle), std::sin(angle), 0.0F});
        EXPECT_GT(glm::dot(normal, wanted), 0.98F) << "corner " << corner;
    }
}

// Three walls, each at 50° to the previous one: the first and the last are split at their common corners, and both are
// smooth towards the middle one.
TEST(MeshNormals, MovingMeshesAreAsSmoothAsAtRest) {
    PictureMesh walls;
    walls.positions = {{0.0F, 1.0F, 0.0F}};
    glm::vec3 at(1.0F, 0.0F, 0.0F);
    walls.positions.push_back(at);
    for (int i = 0; i < 3; ++i) {
        const float angle = 0.87266463F * static_cast<float>(i);
        at += glm::vec3(std::sin(angle), 0.0F, -std::cos(angle));
        walls.positions.push_back(at);
        walls.triangles.insert(walls.triangles.end(),
                               {0, static_cast<std::uint32_t>(i) + 1, static_cast<std::uint32_t>(i) + 2});
    }
    const PictureMesh rest = withNormals(walls);
    MovingMesh moving(walls);
    moving.setPositions(walls.positions);
    ASSERT_EQ(moving.mesh().triangles, rest.triangles);
    for (std::size_t i = 0; i < rest.normals.size(); ++i) {
        EXPECT_GT(glm::dot(moving.mesh().normals[i], rest.normals[i]), 0.97F) << i;
    }
    EXPECT_GT(rest.positions.size(), walls.positions.size());
}

TEST(MeshNormals, DegenerateTrianglesHaveNone) {
    PictureMesh flat;
    flat.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {0, 0, 0}};
    flat.triangles = {0, 1, 2, 0, 3, 0};
    for (const glm::vec3& n : withNormals(flat).normals) {
        EXPECT_TRUE(glm::length(n) < 1e-3F || std::abs(glm::length(n) - 1.0F) < 1e-5F);
    }
}

namespace fs = std::filesystem;

class FlowFileTest : public testing::Test {
  protected:
    fs::path bytes(const std::string& name, const void* data, std::size_t size) const {
        return folder_.write(name, {static_cast<const char*>(data), size});
    }
    [[nodiscard]] FlowFile file(const fs::path& path) const {
        return {.path = path, .origin = "scene.toml:3:8: flow.x: "};
    }
    void expectError(const FlowFile& flow, ErrorCode code, const std::string& name,
                     const std::string& part) const {
        const auto loaded = loadFlow(flow);
        expectErrorStart(loaded, code, flow.origin);
        relief::expectError(loaded, code, name);
        relief::expectError(loaded, code, part);
    }

    const test::TemporaryFolder folder_;
};

TEST_F(FlowFileTest, RawVolumesRunAlongXFirst) {
    for (const std::uint32_t components : {2U, 3U}) {
        std::vector<float> values;
        for (std::uint32_t i = 0; i < 4 * 3 * 2 * components; ++i) {
            values.push_back(0.5F * static_cast<float>(i));
        }
        FlowFile from = file(bytes("a.raw", values.data(), values.size() * sizeof(float)));
        from.size = {4, 3, 2};
        from.components = components;
        const auto flow = required(loadFlow(from));
        const std::uint32_t node = 1 + 4 * (2 + 3 * 1);
        EXPECT_EQ(flow.nodes.at(node), glm::vec3(values[node * components], values[node * components + 1],
                                                 components == 3 ? values[node * components + 2] : 0.0F));

        // One byte too many, one too few.
        values.push_back(0.0F);
        for (const std::size_t size :
             {values.size() * sizeof(float) - 3, values.size() * sizeof(float) - 5}) {
            from.path = bytes("b.raw", values.data(), size);
            expectError(from, ErrorCode::kInvalidInput, "b.raw", std::to_string(size) + " bytes");
        }
    }
}

TEST_F(FlowFileTest, MissingFilesAreNamed) {
    FlowFile from = file(folder_.path() / "none.raw");
    from.size = {1, 1, 1};
    expectError(from, ErrorCode::kIo, "none.raw", "");
}

TEST_F(FlowFileTest, VelocitiesMustBeFiniteAndBounded) {
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), -1.1e6F}) {
        float values[12] = {};
        values[10] = bad;  // y of node 3: x = 1, y = 1
        FlowFile from = file(bytes("a.raw", values, sizeof(values)));
        from.size = {2, 2, 1};
        expectError(from, ErrorCode::kInvalidInput, "a.raw", "node 1, 1, 0");
    }
}

}  // namespace
}  // namespace relief::test
