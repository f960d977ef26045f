// SPDX-License-Identifier: Apache-2.0
// Levels: each distinct mesh once, placed by poses that preserve its shape.
#include "bake/import/level_folder.h"

#include <limits>

#include "bake/import/import_source.h"
#include "bake/import/mesh_import.h"
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
                          {
                              [](TriangleMesh& raw) { raw.level_meshes[0].positions = 2; },
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
                              [&](TriangleMesh& raw) { raw.positions[0].x = static_cast<float>(nan); },
                          },
                          [&](TriangleMesh raw) { return source.finishLevel(std::move(raw)).has_value(); });
}

}  // namespace
}  // namespace relief::test
