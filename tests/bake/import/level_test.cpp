// SPDX-License-Identifier: Apache-2.0
// Levels: each distinct mesh once, placed by poses that preserve its shape. Also one tetrahedron in every format, with
// units and axes, which must have the same coordinates.
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "bake/import/import_job.h"
#include "bake/import/import_source.h"
#include "bake/import/level.h"
#include "bake/import/mesh_import.h"
#include "bake/import/source_properties.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

class Levels : public testing::Test {
  protected:
    fs::path write(const std::string& name, const std::string& text) { return temporary_.write(name, text); }
    Level level(const fs::path& path, const ImportOptions& options = {}) {
        return required(importLevel(path, options));
    }
    Level gltf(const std::string& nodes, const std::string& roots, const ImportOptions& options = {}) {
        return level(write("l.gltf", tetrahedronGltf({.nodes = nodes, .roots = roots})), options);
    }

    TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
};

glm::dvec3 placed(const LevelBody& body, const glm::dvec3& p) {
    const glm::dvec3 v(body.rotation[0], body.rotation[1], body.rotation[2]);
    const glm::dvec3 t = 2.0 * glm::cross(v, p);
    return glm::dvec3(body.position[0], body.position[1], body.position[2]) +
           body.scale * (p + body.rotation[3] * t + glm::cross(v, t));
}

/// Expects the placed triangles of the level to equal those of the same file as one mesh, in order.
void expectSameCorners(const Level& level, const fs::path& path, const ImportOptions& options = {}) {
    const TriangleMesh whole = required(importMeshInWorker(path, options));
    std::size_t triangle = 0;
    for (const LevelBody& body : level.bodies) {
        const TriangleMesh& mesh = level.meshes.at(body.mesh);
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t, ++triangle) {
            ASSERT_LT(triangle, whole.triangles.size());
            const auto wanted = cornersOf(whole, static_cast<std::uint32_t>(triangle));
            const auto corners = cornersOf(mesh, t);
            for (std::size_t k = 0; k < 3; ++k) {
                EXPECT_LT(glm::distance(placed(body, corners[k]), glm::dvec3(wanted[k])), 1e-5) << triangle;
            }
        }
    }
    EXPECT_EQ(triangle, whole.triangles.size());
}

TEST_F(Levels, SharedMeshIsImportedOnce) {
    const Level read = gltf(
        R"({"mesh":0,"name":"a"},{"mesh":0,"name":"b","translation":[5,0,0],"rotation":[0,0.6,0,0.8],"scale":[2,2,2]},)"
        R"({"name":"group","rotation":[1,0,0,0],"scale":[0.5,0.5,0.5],"children":[3]},{"mesh":0,"name":"c","translation":[1,2,3]})",
        "0,1,2");
    ASSERT_EQ(read.meshes.size(), 1U);
    ASSERT_EQ(read.bodies.size(), 3U);
    EXPECT_EQ(read.bodies[0].node, "a");
    EXPECT_EQ(read.bodies[0].scale, 1.0);
    EXPECT_EQ(read.bodies[1].node, "b");
    EXPECT_NEAR(read.bodies[1].scale, 2.0, 1e-7);
    EXPECT_EQ(read.bodies[2].node, "c");
    EXPECT_EQ(read.meshes[0].bounds.min, glm::vec3(0.0F));
    EXPECT_EQ(read.unit, "m");
    expectSameCorners(read, folder_ / "l.gltf");
}

TEST_F(Levels, RotationsAreRecovered) {
    // Quarter turns, half turns, and quaternions with w near 0 cover every branch of the conversion.
    for (const char* q :
         {"1,0,0,0", "0,1,0,0", "0,0,1,0", "0.70710678,0,0,0.70710678", "0,-0.70710678,0,0.70710678",
          "0.5,0.5,0.5,0.5", "-0.5,0.5,-0.5,-0.5", "0.6,0,0.8,0", "0.1,0.7,0.1,-0.7", "0.36,0.48,0.8,0"}) {
        const Level read =
            gltf(R"({"mesh":0,"translation":[1,2,3],"rotation":[)" + std::string(q) + "]}", "0");
        ASSERT_EQ(read.bodies.size(), 1U);
        EXPECT_GE(read.bodies[0].rotation[3], 0.0) << q;
        expectSameCorners(read, folder_ / "l.gltf");
    }
}

TEST_F(Levels, NonRigidInstancesAreSeparateMeshes) {
    const Level read = gltf(
        R"({"mesh":0,"name":"plain"},{"mesh":0,"scale":[1,2,1]},{"mesh":0,"scale":[1,2,1],"translation":[9,0,0]},)"
        R"({"mesh":0,"scale":[-1,1,1]},{"mesh":0,"scale":[2,2,-2],"translation":[0,9,0]},)"
        R"({"mesh":0,"matrix":[1,0,0,0, 0.5,1,0,0, 0,0,1,0, 4,0,0,1]})",
        "0,1,2,3,4,5");
    ASSERT_EQ(read.bodies.size(), 6U);
    EXPECT_EQ(read.meshes.size(), 4U) << "original, stretched, mirrored and sheared";
    EXPECT_EQ(read.bodies[1].mesh, read.bodies[2].mesh) << "a translation is a pose";
    EXPECT_EQ(read.bodies[3].mesh, read.bodies[4].mesh) << "mirrored instances differ only by a rotation";
    EXPECT_NEAR(read.bodies[4].scale, 2.0, 1e-9);
    expectSameCorners(read, folder_ / "l.gltf");
}

TEST_F(Levels, UnitsAndAxesMatchTheMeshes) {
    const fs::path path = write("l.obj", tetrahedronObj());
    const ImportOptions options = {"cm", UpAxis::kPlusZ};
    const Level read = level(path, options);
    ASSERT_EQ(read.meshes.size(), 1U);
    EXPECT_TRUE(read.bodies[0].scale == 1.0 && read.bodies[0].rotation[3] == 1.0);
    EXPECT_FLOAT_EQ(read.meshes[0].bounds.max.x, 0.01F);
    expectSameCorners(read, path, options);
}

TEST_F(Levels, ObjObjectsAreMeshesWithOneBody) {
    const std::string shape = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    const Level read = level(write("l.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no one\nusemtl a\n" + shape +
                                                "o two\n" + shape + "usemtl b\nf 1 2 3\n"));
    ASSERT_EQ(read.meshes.size(), 2U);
    ASSERT_EQ(read.bodies.size(), 2U);
    EXPECT_EQ(read.bodies[0].node, "one");
    EXPECT_EQ(read.bodies[1].node, "two");
    EXPECT_EQ(read.meshes[1].triangles.size(), 5U) << "one object has both materials";
    EXPECT_EQ(read.meshes[1].surface_names.size(), 2U);
}

TEST_F(Levels, EqualMeshesAreMergedAndFlatOnesDropped) {
    const std::string a = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no a\nf 1 3 2\nf 1 2 4\n";
    const std::string b = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no b\nf 5 7 6\nf 5 6 8\n";
    const Level read = level(write("l.obj", a + b + "o flat\nf 1 1 2\n"));
    EXPECT_EQ(read.meshes.size(), 1U);
    EXPECT_EQ(read.bodies.size(), 2U);
    ASSERT_EQ(read.warnings.size(), 1U);
    EXPECT_NE(read.warnings[0].find("'flat'"), std::string::npos) << read.warnings[0];
    EXPECT_FALSE(importLevel(write("m.obj", "v 0 0 0\nv 1 0 0\no flat\nf 1 1 2\n")));
}

TEST_F(Levels, EachFileOfAFolderIsAMesh) {
    write("b.obj", tetrahedronObj());
    write("a.ply", tetrahedronPly());
    write("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    write("readme.txt", "not a mesh");
    fs::create_directory(folder_ / "d.obj");
    const Level read = level(folder_);
    ASSERT_EQ(read.bodies.size(), 3U);
    EXPECT_EQ(read.bodies[0].node, "a.ply");
    EXPECT_EQ(read.bodies[2].node, "c.obj");
    EXPECT_EQ(read.meshes.at(read.bodies[2].mesh).name, "c");
    EXPECT_EQ(read.dependencies.size(), 3U);
    ImportOptions options;
    options.names = {"a"};
    EXPECT_EQ(importLevel(folder_, options).error().code, ErrorCode::kUsage);
    EXPECT_EQ(importLevel(folder_, {}, {.triangles = 9}).error().code, ErrorCode::kLimit)
        << "12 triangles in total";
    write("e.gltf", tetrahedronGltf());
    expectRejected(importLevel(folder_), "has a unit, unlike earlier files; give --unit");
    options.names.clear();
    options.unit = "m";
    EXPECT_TRUE(importLevel(folder_, options));
    for (const char* file : {"a.ply", "b.obj", "c.obj", "e.gltf"}) {
        fs::remove(folder_ / file);
    }
    expectRejected(importLevel(folder_), "contains no mesh files");
}

TEST_F(Levels, TriangleAndBodyLimits) {
    const fs::path path = write("l.gltf", manyNodes(100));
    ImportLimits limits{.triangles = 50};
    EXPECT_FALSE(importMeshInWorker(path, {}, limits));
    EXPECT_EQ(required(importLevelInWorker(path, {}, limits)).bodies.size(), 100U);
    limits.triangles = 3;
    expectRejected(importLevelInWorker(path, {}, limits), "--max-triangles", ErrorCode::kLimit);
    expectRejected(importLevelInWorker(write("m.gltf", manyNodes(kLevelBodiesMax + 1))), "65536",
                   ErrorCode::kLimit);
}

TEST_F(Levels, InstancesAreBodies) {
    const Level read = gltf(
        R"({"mesh":0,"name":"trees","translation":[0,0,7],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}})",
        "0");
    EXPECT_EQ(read.meshes.size(), 1U);
    ASSERT_EQ(read.bodies.size(), 4U);
    EXPECT_EQ(read.bodies[3].node, "trees");
    EXPECT_EQ(read.bodies[3].position, (std::array<double, 3>{0, 0, 10}));
    expectSameCorners(read, folder_ / "l.gltf");
}

TEST_F(Levels, InvalidPosesAreRejected) {
    const auto lost = [&](const std::string& place) {
        return importLevel(
            write("l.gltf", tetrahedronGltf({.nodes = R"({"mesh":0,"name":"lost",)" + place + "}"})));
    };
    for (const char* place : {R"("translation":[1e20,0,0])", R"("translation":[1e39,0,0])",
                              R"("scale":[1e-12,1e-12,1e-12])", R"("scale":[1e12,1e12,1e12])"}) {
        expectRejected(lost(place), "the node 'lost' is beyond");
    }
    EXPECT_FALSE(lost(R"("scale":[0,0,0])"));
}

TEST_F(Levels, NamesMarkTrianglesOfNodes) {
    ImportOptions options;
    options.names = {"a"};
    const Level read =
        gltf(R"({"mesh":0,"name":"a"},{"mesh":0,"name":"b"},{"mesh":0,"name":"a"})", "0,1,2", options);
    ASSERT_EQ(read.meshes.size(), 2U) << "one mesh, split because one node is named";
    EXPECT_EQ(read.meshes[0].marks, std::vector<std::uint8_t>(4, 1));
    EXPECT_EQ(read.meshes[1].marks, std::vector<std::uint8_t>(4, 0));
    EXPECT_EQ(read.bodies[2].mesh, 0U);
}

TEST_F(Levels, InvalidWorkerResultsAreRejected) {
    TriangleMesh honest;
    honest.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    honest.triangles = {{0, 1, 2}};
    honest.level_meshes = {{"m", 3, 1}};
    honest.level_bodies = {{0, "n", {0, 0, 0}, {0, 0, 0, 1}, 1.0}};
    const ImportSource source = required(ImportSource::open(write("l.obj", "v 0 0 0\n")));
    EXPECT_FALSE(source.finish(honest)) << "a level that was not requested";
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expectInvalidRejected(honest,
                          {[](TriangleMesh& raw) { raw.level_meshes[0].positions = 2; },
                           [](TriangleMesh& raw) { raw.level_meshes[0].triangles = 2; },
                           [](TriangleMesh& raw) { raw.level_meshes[0].triangles = ~std::uint64_t{0}; },
                           [](TriangleMesh& raw) {
                               raw.level_meshes.push_back(LevelMesh{"m", ~std::uint64_t{0}, 0});
                           },
                           [](TriangleMesh& raw) { raw.level_meshes.clear(); },
                           [](TriangleMesh& raw) { raw.level_bodies.clear(); },
                           [](TriangleMesh& raw) { raw.level_bodies[0].mesh = 1; },
                           [](TriangleMesh& raw) { raw.level_bodies[0].scale = 0.0; },
                           [&](TriangleMesh& raw) { raw.level_bodies[0].scale = nan; },
                           [&](TriangleMesh& raw) { raw.level_bodies[0].position[1] = nan; },
                           [&](TriangleMesh& raw) { raw.level_bodies[0].rotation[1] = nan; },
                           [](TriangleMesh& raw) { raw.level_bodies[0].rotation[3] = 0.5; },
                           [](TriangleMesh& raw) { raw.triangles[0].x = 3; },
                           [&](TriangleMesh& raw) { raw.positions[0].x = static_cast<float>(nan); }},
                          [&](TriangleMesh raw) { return source.finishLevel(std::move(raw)).has_value(); });
}

/// A file, its import options, and its bounds in metres or object units.
struct Placed {
    std::string name;
    std::string text;
    std::string unit_option;
    std::optional<UpAxis> up_option;
    glm::vec3 low;
    glm::vec3 high;
    std::string unit = "m";
    std::size_t warnings = 0;
};

void expectPlaced(const std::vector<Placed>& cases) {
    for (const Placed& c : cases) {
        SCOPED_TRACE(c.name + ", " + c.unit_option);
        const TriangleMesh mesh = imported(c.name, c.text, {c.unit_option, c.up_option});
        const glm::vec3 size = c.high - c.low;
        const float tolerance = 1e-5F * glm::length(size);
        EXPECT_LT(glm::distance(mesh.bounds.min, c.low), tolerance);
        EXPECT_LT(glm::distance(mesh.bounds.max, c.high), tolerance);
        EXPECT_EQ(mesh.unit, c.unit);
        EXPECT_EQ(mesh.warnings.size(), c.warnings);
        EXPECT_NEAR(signedVolume(mesh) / double{size.x * size.y * size.z / 6.0F}, 1.0, 1e-4) << "inverted";
    }
}

constexpr glm::vec3 kLow(0.0F);
constexpr glm::vec3 kHigh(1, 2, 3);
const glm::vec3 kLowZ(0, 0, -2);  // with z up
const glm::vec3 kHighZ(1, 3, 0);
constexpr std::optional<UpAxis> kOwnAxis;

TEST(ImportUnits, EveryUpAxisIsARotation) {
    for (const char* name : {"+x", "-x", "+y", "-y", "+z", "-z"}) {
        SCOPED_TRACE(name);
        const std::optional<UpAxis> up = fromWord<UpAxis>(name);
        ASSERT_TRUE(up);
        const glm::dmat3 turn = rotationToUp(*up);
        const int axis = (name[1] | 0x20) - 'x';
        EXPECT_EQ(turn[axis], glm::dvec3(0, name[0] == '-' ? -1 : 1, 0));
        EXPECT_EQ(glm::transpose(turn) * turn, glm::dmat3(1.0));
        EXPECT_EQ(glm::dot(glm::cross(turn[0], turn[1]), turn[2]), 1.0);
    }
    for (const char* wrong : {"", "z", "up", "+w", "+zz"}) {
        EXPECT_FALSE(fromWord<UpAxis>(wrong)) << wrong;
    }
}

TEST(ImportUnits, UnitNamesAreMetres) {
    EXPECT_DOUBLE_EQ(metresPer("ft").value_or(0), 12 * 0.0254);
    EXPECT_DOUBLE_EQ(metresPer("yd").value_or(0), 36 * 0.0254);
    EXPECT_FALSE(metresPer(""));
    EXPECT_FALSE(metresPer("inch"));
    for (const std::string_view unit : kLengthUnits) {
        EXPECT_TRUE(metresPer(unit)) << unit;
    }
}

TEST(ImportUnits, FormatsWithoutUnitsAreUnchanged) {
    for (const auto& [name, text] :
         {std::pair{"t.obj", tetrahedronObj()}, std::pair{"t.ply", tetrahedronPly()},
          std::pair{"t.off", tetrahedronOff()}, std::pair{"t.stl", tetrahedronStl()}}) {
        expectPlaced({{name, text, "", kOwnAxis, kLow, kHigh, ""},
                      {name, text, "m", kOwnAxis, kLow, kHigh},
                      {name, text, "in", kOwnAxis, kLow, 0.0254F * kHigh},
                      {name, text, "", UpAxis::kPlusZ, kLowZ, kHighZ, ""},
                      {name, text, "mm", UpAxis::kMinusX, {0, -0.001F, 0}, {0.002F, 0, 0.003F}}});
    }
}

TEST(ImportUnits, FormatsWithUnitsAndAxesAgree) {
    const std::string whole =
        replaced(tetrahedronFbx(1, 1, "100"), R"("double", "Number")", R"("int", "Integer")");
    expectPlaced(
        {{"z.fbx", tetrahedronFbx(2, 1, "100"), "", kOwnAxis, kLowZ, kHighZ},
         {"z.gltf", tetrahedronGltf(), "", UpAxis::kPlusZ, kLowZ, kHighZ, "m", 1},
         // Centimetres times the file's factor.
         {"y.fbx", tetrahedronFbx(1, 1, "1"), "", kOwnAxis, kLow, 0.01F * kHigh},
         {"in.fbx", tetrahedronFbx(1, 1, "2.54"), "", kOwnAxis, kLow, 0.0254F * kHigh},
         {"x.fbx", tetrahedronFbx(0, 1, "100"), "", kOwnAxis, {-2, 0, 0}, {0, 1, 3}},
         {"ny.fbx", tetrahedronFbx(1, -1, "100"), "", kOwnAxis, {0, -2, -3}, {1, 0, 0}},
         {"whole.fbx", whole, "", kOwnAxis, kLow, kHigh},
         {"no.dae", tetrahedronDae(""), "", kOwnAxis, kLow, kHigh},
         {"in.dae", tetrahedronDae("<unit meter=\"0.0254\"/>"), "", kOwnAxis, kLow, 0.0254F * kHigh},
         {"x.dae", tetrahedronDae("<up_axis>X_UP</up_axis>"), "", kOwnAxis, {-2, 0, 0}, {0, 1, 3}},
         // XML allows these variants.
         {"odd.dae", tetrahedronDae("<unit name=\"meter\"\n meter = '0.5'/><up_axis>\nZ_UP </up_axis>"), "",
          kOwnAxis, 0.5F * kLowZ, 0.5F * kHighZ},
         // Coordinates are divided by the master scale; 0 means none.
         {"t.3ds", tetrahedron3ds(), "", kOwnAxis, kLowZ, kHighZ, ""},
         {"half.3ds", tetrahedron3ds(0.5F), "", kOwnAxis, 2.0F * kLowZ, 2.0F * kHighZ, ""},
         {"zero.3ds", tetrahedron3ds(0.0F), "", kOwnAxis, kLowZ, kHighZ, ""}});
}

template <class T>
std::string packed(const std::vector<T>& values, bool big_endian = false) {
    std::string text;
    for (const T value : values) {
        const std::string bytes(reinterpret_cast<const char*>(&value), sizeof(T));
        text += big_endian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
    }
    return text;
}

std::string chunk(const std::string& name, const std::string& data, bool big_endian = false) {
    return name + packed<std::uint32_t>({static_cast<std::uint32_t>(data.size())}, big_endian) + data;
}

const std::vector<float> kTetrahedron = {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};

std::string tetrahedronB3d() {
    const std::string mesh = packed<int>({-1}) +
                             chunk("VRTS", packed<int>({0, 0, 0}) + packed(kTetrahedron)) +
                             chunk("TRIS", packed<int>({-1, 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}));
    return chunk("BB3D", packed<int>({1}) + chunk("NODE", std::string("b\0", 2) +
                                                              packed<float>({0, 0, 0, 1, 1, 1, 1, 0, 0, 0}) +
                                                              chunk("MESH", mesh)));
}

std::string tetrahedronLwo() {
    using Words = std::vector<std::uint16_t>;
    const std::string faces = packed<std::uint16_t>({3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 3, 2}, true);
    return chunk("FORM",
                 "LWO2" + chunk("TAGS", std::string("Default\0", 8), true) +
                     chunk("LAYR", std::string(18, '\0'), true) +
                     chunk("PNTS", packed(kTetrahedron, true), true) + chunk("POLS", "FACE" + faces, true) +
                     chunk("PTAG", "SURF" + packed(Words{0, 0, 1, 0, 2, 0, 3, 0}, true), true) +
                     chunk("SURF", std::string("Default\0\0\0", 10), true),
                 true);
}

std::string tetrahedronSmd() {
    std::string text = replaced(tetrahedronStl(), "endsolid t", "end");
    text =
        replaced(text, "solid t\n",
                 "version 1\nnodes\n0 \"root\" -1\nend\nskeleton\ntime 0\n0 0 0 0 0 0 0\nend\ntriangles\n");
    text = replaced(text, "facet normal 0 0 0\nouter loop\nvertex", "mat\n0");
    text = replaced(text, "\nvertex", " 0 0 1 0 0\n0");
    return replaced(text, "\nendloop\nendfacet", " 0 0 1 0 0");
}

TEST(ImportUnits, AssimpFormatsKeepTheirCoordinates) {
    const std::string x =
        "xof 0303txt 0032\nMesh t {\n4;\n0;0;0;,\n1;0;0;,\n0;2;0;,\n0;0;3;;\n4;\n"
        "3;0,2,1;,\n3;0,1,3;,\n3;1,2,3;,\n3;0,3,2;;\n}\n";
    for (const auto& [name, text] :
         {std::pair{"t.x", x}, std::pair{"t.b3d", tetrahedronB3d()}, std::pair{"t.lwo", tetrahedronLwo()}}) {
        // z is negated. The up axis remains that of the file.
        expectPlaced({{name, text, "", kOwnAxis, {0, 0, -3}, {1, 2, 0}, ""},
                      {name, text, "in", kOwnAxis, {0, 0, -3 * 0.0254F}, {0.0254F, 2 * 0.0254F, 0}},
                      {name, text, "", UpAxis::kPlusZ, {0, 0, 0}, {1, 3, 2}, ""}});
    }
    // Decimal commas are read as points. An SMD is skinned and may reference an animation.
    const std::string smd = tetrahedronSmd();
    expectPlaced({{"t.smd", smd, "", kOwnAxis, kLow, kHigh, "", 2},
                  {"t.smd", smd, "cm", UpAxis::kPlusZ, 0.01F * kLowZ, 0.01F * kHighZ, "m", 2},
                  {"t.smd", replaced(smd, " 3 ", " 3,5 "), "", kOwnAxis, kLow, {1, 2, 3.5F}, "", 2},
                  {"t.dae", replaced(tetrahedronDae(""), " 3<", " 3,5<"), "", kOwnAxis, kLow, {1, 2, 3.5F}}});
}

TEST(ImportUnits, OptionsOverrideTheFileWithAWarning) {
    const std::string dae = tetrahedronDae("<unit meter=\"0.0254\"/><up_axis>Z_UP</up_axis>");
    expectPlaced({{"same.dae", dae, "in", UpAxis::kPlusZ, 0.0254F * kLowZ, 0.0254F * kHighZ},
                  {"t.gltf", tetrahedronGltf(), "mm", kOwnAxis, kLow, 0.001F * kHigh, "m", 1},
                  {"t.3ds", tetrahedron3ds(), "mm", UpAxis::kPlusY, kLow, 0.001F * kHigh, "m", 1},
                  {"t.fbx", tetrahedronFbx(2, 1, "1"), "m", UpAxis::kPlusY, kLow, kHigh, "m", 2},
                  {"in.dae", dae, "cm", UpAxis::kPlusX, {-0.02F, 0, 0}, {0, 0.01F, 0.03F}, "m", 2}});
    const TriangleMesh mesh = imported("in.dae", dae, {"cm", UpAxis::kPlusX});
    EXPECT_TRUE(warns(mesh, "--unit cm overrides the file's unit, 0.0254 m"));
    EXPECT_TRUE(warns(mesh, "--up +x overrides the file's up axis, +z"));
}

TEST(ImportUnits, ColladaHeadersAreParsed) {
    const auto frame = [](const std::string& asset, const char* begin = "<asset>") {
        const std::string text = "<COLLADA>" + (begin + asset) + "</asset></COLLADA>";
        return colladaFrame(std::as_bytes(std::span(text)));
    };
    EXPECT_EQ(frame("<up_axis> Z_UP\n</up_axis>").up, UpAxis::kPlusZ);
    EXPECT_EQ(frame("<up_axis>X_UP</up_axis>").up, UpAxis::kPlusX);
    EXPECT_EQ(frame("<up_axis>Z_UP</up_axis>", "<asset xmlns='x'><!-- <up_axis>Y_UP</up_axis> -->").up,
              UpAxis::kPlusZ);
    EXPECT_EQ(frame("<x><up_axis>Z_UP</up_axis></x>").up, UpAxis::kPlusY) << "not a child of <asset>";
    EXPECT_EQ(frame("").up, UpAxis::kPlusY);
    EXPECT_EQ(frame("").metres, 1.0);
    EXPECT_EQ(frame("<unit name='a>b' meter=' 1e-2 '/>").metres, 0.01);
    EXPECT_EQ(frame("<up_axis>W_UP</up_axis>").up_fault, "its up_axis 'W_UP' is not an axis of COLLADA");
    EXPECT_EQ(frame("<unit meter='0,010000'/>").metres, 0.01);
    for (const char* meter : {"-1", "0", "0,0,1", "1,000.5", "nan", "inf", "", "1e-400", "1 m"}) {
        const SourceFrame faulty = frame("<unit meter='" + std::string(meter) + "'/>");
        EXPECT_FALSE(faulty.metres) << meter;
        EXPECT_EQ(faulty.unit_fault,
                  "its unit is '" + std::string(meter) + "' metres, which is not a length");
    }
}

// Files with implausible units are rejected unless an option gives the unit.
TEST(ImportUnits, ImplausibleUnitsNeedAnOption) {
    struct Case {
        std::string name;
        std::string text;
        const char* fault;
        const char* cure;
        const char* unit_option;
        std::optional<UpAxis> up_option;
    };
    std::vector<Case> cases = {
        {"up.fbx", tetrahedronFbx(5, 1, "1"), "UpAxis is 5", "--up", "", UpAxis::kPlusY},
        {"up.dae", tetrahedronDae("<unit meter='0.01'/><up_axis>W_UP</up_axis>"), "'W_UP'", "--up", "",
         UpAxis::kPlusY}};
    for (const char* meter : {"-1", "0,0,1", "inf", "none"}) {
        cases.push_back({"t.dae", tetrahedronDae("<unit meter=\"" + std::string(meter) + "\"/>"), meter,
                         "--unit", "cm", kOwnAxis});
    }
    for (const char* factor : {"-100", "nan", "10,5"}) {
        cases.push_back({"t.fbx", tetrahedronFbx(1, 1, factor), factor, "--unit", "cm", kOwnAxis});
    }
    for (const float scale :
         {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        cases.push_back({"t.3ds", tetrahedron3ds(scale), "master scale", "--unit", "cm", UpAxis::kPlusY});
    }
    for (const Case& c : cases) {
        expectWrong(c.name, {{c.text, c.fault}, {c.text, c.cure}});
        const TriangleMesh cured = imported(c.name, c.text, {c.unit_option, c.up_option});
        EXPECT_LT(glm::distance(cured.bounds.max, 0.01F * kHigh), 1e-6F);
    }
    // assimp's FBX importer fails in this case.
    expectRejected(importText("zero.fbx", tetrahedronFbx(1, 1, "0"), {"cm", kOwnAxis}),
                   "UnitScaleFactor is 0, which is not a length; export it again");
}

TEST(ImportUnits, FbxUnitsAreReadFromTextAndBinary) {
    const auto unit = [](const std::string& document) { return fbxUnit(std::as_bytes(std::span(document))); };
    const auto value = [&](const std::string& document) { return unit(document).value().value; };
    EXPECT_EQ(value("; FBX\n P: \"UnitScaleFactor\", \"double\", \"Number\", \"\", 2.54\r\n P: 1"), 2.54);
    EXPECT_EQ(value("; FBX\nProperty: \"UnitScaleFactor\", \"double\", \"\",100\n"), 100.0);
    const std::string comma = "; FBX\n P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",10,5";
    EXPECT_EQ(unit(comma).value().text, "10,5");
    EXPECT_FALSE(value(comma));
    EXPECT_FALSE(value("; FBX\n P: \"UnitScaleFactor\""));
    EXPECT_FALSE(unit("; FBX\n P: \"OriginalUnitScaleFactor\", \"double\", \"Number\", \"\",7"));
    using namespace std::string_literals;
    const std::string head =
        "Kaydara FBX Binary  S\x0f\0\0\0UnitScaleFactorS\x06\0\0\0doubleS\x06\0\0\0NumberS\0\0\0\0"s;
    EXPECT_EQ(value(head + "D\0\0\0\0\0\0\x59\x40"s), 100.0);
    EXPECT_EQ(value(head + "I\x64\0\0\0"s), 100.0);
    EXPECT_EQ(value(head + "F\0\0\xc8\xc2"s), -100.0);
    EXPECT_FALSE(value(head + "D\0\0\0\0\0\0\xf8\x7f"s));
    EXPECT_FALSE(value(head + "X"));
    EXPECT_FALSE(value(head));
    EXPECT_FALSE(unit("Kaydara FBX Binary  "));
}

// Requesting another up axis converts z of a left-handed file.
TEST(ImportUnits, UpAxisOfLeftHandedFiles) {
    SourceFrame left;
    left.mirrored = true;
    EXPECT_EQ(changeOf(left, "", UpAxis::kPlusZ).turn, rotationToUp(UpAxis::kMinusZ));
    EXPECT_EQ(changeOf(left, "", UpAxis::kMinusZ).turn, rotationToUp(UpAxis::kPlusZ));
    EXPECT_EQ(changeOf(left, "", UpAxis::kPlusX).turn, rotationToUp(UpAxis::kPlusX));
    EXPECT_EQ(changeOf(left, "", std::nullopt).turn, glm::dmat3(1.0));
}

}  // namespace
}  // namespace relief::test
