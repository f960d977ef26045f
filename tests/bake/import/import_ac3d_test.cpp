// SPDX-License-Identifier: Apache-2.0
// AC3D: node hierarchies, all kinds of surfaces, and files as TORCS and other programs write them.
#include "bake/import/level_folder.h"
#include "bake/import/mesh_import.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

const std::string kHead =
    "AC3Db\n"
    "MATERIAL \"red paint\" rgb 1 0 0  amb 1 1 1  emis 0 0 0  spec 0 0 0  shi 10  trans 0\n"
    "MATERIAL \"\" rgb 1 1 1  amb 1 1 1  emis 0 0 0  spec 0 0 0  shi 10  trans 0\n";

/// A tetrahedron with two materials. \param keys  lines before its vertices. \param after  text after 'kids'
std::string tetrahedron(const std::string& name, const std::string& keys = "",
                        const std::string& kids = "0") {
    return "OBJECT poly\nname \"" + name + "\"\n" + keys +
           "numvert 4\n0 0 0\n1 0 0\n0 2 0\n0 0 3\nnumsurf 4\n"
           "SURF 0x0\nmat 0\nrefs 3\n0 0 0\n2 0 1\n1 1 0\nSURF 0X30\nmat 1\nrefs 3\n0 0 0\n1 0 1\n3 1 0\n"
           "SURF 0x20\nmat 0\nrefs 3\n1 0 0\n2 0 1\n3 1 0\nSURF 0x10\nrefs 3\n0 0 0\n3 0 1\n2 1 0\nkids " +
           kids + "\n";
}

TEST(Ac3d, ObjectsInheritTransforms) {
    // Children inherit the parent's offset. 'rot' maps x to y: its triples are the images of the axes.
    const TemporaryFolder folder;
    const Level read = required(importLevel(folder.write(
        "l.acc", kHead + "OBJECT world\nkids 2\nOBJECT group\nname \"yard\"\nloc 10 0 0\nkids 1\n" +
                     tetrahedron("tower", "loc 0 1 0\nrot 0 1 0 -1 0 0 0 0 1\n", "1") +
                     tetrahedron("flag", "loc 5 0 0\n") + tetrahedron("tree"))));
    ASSERT_EQ(read.bodies.size(), 3U);
    ASSERT_EQ(read.meshes.size(), 1U);
    EXPECT_EQ(read.meshes[0].triangles.size(), 4U);
    EXPECT_EQ(read.unit, "");
    EXPECT_TRUE(read.warnings.empty());
    const std::array<std::string, 3> nodes = {"tower", "flag", "tree"};
    const std::array<std::array<double, 3>, 3> places = {{{10, 1, 0}, {10, 6, 0}, {0, 0, 0}}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(read.bodies[i].node, nodes[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(read.bodies[i].position[k], places[i][k], 1e-6) << nodes[i];
        }
        EXPECT_NEAR(read.bodies[i].rotation[2], i < 2 ? std::sqrt(0.5) : 0.0, 1e-6);
    }
}

TEST(Ac3d, SurfacesOfEveryKind) {
    // A quad as a strip with normals and two textures, joined to another quad by duplicate vertices, and two lines.
    const std::string strip =
        "OBJECT poly\nname plain\ntexture \"a b.rgb\" base\ntexture empty_texture_no_mapping skids\ndata "
        "13\nOBJECT\nkids 9\n"
        "crease 45\nnumvert 6\n0 0 0 0 1 0\n0 0 1 0 1 0\n1 0 0 0 1 0\n1 0 1 0 1 0\n3 0 0 0 1 0\n3 0 1 0 1 "
        "0\nnumsurf 3\n"
        "SURF 0x14\nmat 0\nrefs 10\n0 0 0 0 0\n1 0 1 0 1\n2 1 0 1 0\n3 1 1 1 1\n3 1 1\n2 1 0\n2 1 0\n3 1 "
        "1\n4 1 0\n5 1 1\n"
        "SURF 0x1\nmat 0\nrefs 3\n0 0 0\n1 0 0\n2 0 0\nSURF 0x2\nmat 0\nrefs 2\n0 0 0\n1 0 0\nkids 0\n";
    const TriangleMesh mesh = imported("a.ac", kHead + "OBJECT world\r\nkids 1\r\n" + strip);
    ASSERT_EQ(mesh.triangles.size(), 4U);
    double area = 0.0;
    for (std::uint32_t t = 0; t < 4; ++t) {
        const auto [a, b, c] = cornersOf(mesh, t);
        const glm::dvec3 normal = glm::cross(glm::dvec3(b - a), glm::dvec3(c - a));
        EXPECT_GT(normal.y, 0.5) << "triangle " << t;
        area += 0.5 * normal.y;
    }
    EXPECT_NEAR(area, 3.0, 1e-6);
    EXPECT_TRUE(mesh.warnings.size() == 1 && warns(mesh, "left out 2 lines"));
}

TEST(Ac3d, NamesAndMaterialsAreSelectable) {
    ImportOptions options;
    options.names = {"red paint", "big tower"};
    const std::string one = kHead + "OBJECT world\nkids 1\n" + tetrahedron("big tower");
    EXPECT_EQ(imported("n.ac", one, options).marks, std::vector<std::uint8_t>(4, 2));
}

TEST(Ac3d, OddFilesWarnOrFailWithTheLine) {
    const std::string one = kHead + "OBJECT world\nkids 1\n" + tetrahedron("t");
    const TriangleMesh fewer =
        imported("a.ac", kHead + "OBJECT world\nkids 3\n" + tetrahedron("t", "subdiv 2\n"));
    EXPECT_EQ(fewer.warnings.size(), 2U);
    EXPECT_TRUE(warns(fewer, "it has 2 objects fewer than its 'kids' declare"));
    EXPECT_TRUE(warns(fewer, "1 of its objects use subdivision"));
    for (std::size_t length = kHead.size(); length + 8 < one.size(); length += 7) {
        ASSERT_FALSE(importText("a.ac", one.substr(0, length))) << "truncated to " << length << " bytes";
    }
    std::string deep = kHead;
    for (int i = 0; i < 1100; ++i) {
        deep += "OBJECT group\nkids 1\n";
    }
    const auto with = [&](const std::string& from, const std::string& to) {
        return std::string(one).replace(one.find(from), from.size(), to);
    };
    expectWrong("a.ac", {{with("1 0 0\n", "1 zero 0\n"), "line 10: 'zero'"},
                         {with("2 0 1\n", "4 0 1\n"),
                          "the vertex '4', but its object has 4 vertices, numbered from 0"},
                         {with("SURF 0x0", "SURF green"), "'green' is not a number such as 0x20"},
                         {with("numvert 4", "numvert 5"), "not a number"},
                         {with("numvert 4", "numvert 99999999999"), "", ErrorCode::kLimit},
                         {with("kids 1", "kids many"), "'many' is not a number of kids"},
                         {with("refs 3", "refs 4000000000"), "line "},
                         {with("\nkids 0", "\n"), "no 'kids'"},
                         {kHead, "no triangles"},
                         {"AC4D\n", "does not begin with AC3D"},
                         {deep + tetrahedron("t"), "", ErrorCode::kLimit}});
}

}  // namespace
}  // namespace relief::test
