// Text formats as people write them: each file below is valid and was misread, or is wrong and was read.
#include <gtest/gtest.h>

#include <cstring>

#include "bake/import/mesh_import.h"
#include "bake/mesh/triangle_plane.h"
#include "formats/polygons/decimal.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

Result<TriangleMesh> load(const std::string& name, std::string_view contents) {
    const TemporaryFolder folder;
    return importMesh(folder.write(name, contents));
}

/// Of a tetrahedron with corners at the origin and 1 along each axis.
void expectTetrahedron(const std::string& name, std::string_view contents) {
    const Result<TriangleMesh> mesh = load(name, contents);
    ASSERT_TRUE(mesh) << contents << ": " << mesh.error().message;
    double volume = 0.0;
    for (std::uint32_t i = 0; i < mesh->triangles.size(); ++i) {
        const TrianglePlane plane = planeOf(*mesh, i);
        volume += dot(plane.point, plane.normal) / 6.0;
    }
    EXPECT_EQ(mesh->triangles.size(), 4U) << contents;
    EXPECT_NEAR(volume, 1.0 / 6.0, 1e-6) << contents;
    EXPECT_TRUE(mesh->warnings.empty()) << mesh->warnings[0];
}

void expectRefused(const std::string& name, std::string_view contents, const std::string& says) {
    const Result<TriangleMesh> mesh = load(name, contents);
    ASSERT_FALSE(mesh) << contents;
    const std::string& message = mesh.error().message;
    EXPECT_EQ(mesh.error().code, ErrorCode::kInvalidInput) << message;
    EXPECT_NE(message.find(says), std::string::npos) << message;
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << "no cure: " << message;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
    return text;
}

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
const std::string kOff = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

TEST(ImportText, Numbers) {
    for (const auto& [word, value] :
         {std::pair{".5", 0.5F}, std::pair{"-.5", -0.5F}, std::pair{"5.", 5.0F}, std::pair{"+5", 5.0F},
          std::pair{"1e3", 1000.0F}, std::pair{"1.5E-2", 0.015F}, std::pair{".25e+1", 2.5F},
          std::pair{"1e-400", 0.0F}, std::pair{"0.000001e40", 1e34F}, std::pair{"0e99", 0.0F},
          std::pair{"123456789012345678901234567890", 1.2345679e29F},
          std::pair{"0.1234567890123456789", 0.12345679F}}) {
        const std::optional<float> read = readDecimal(word);
        ASSERT_TRUE(read) << word;
        EXPECT_FLOAT_EQ(*read, value) << word;
    }
    for (const char* word :
         {"", ".", "-", "+-1", "1e", "1e+", "0x1", "1,5", "1.2.3", "1f", "e5", "--1", "in"}) {
        EXPECT_FALSE(readDecimal(word)) << word;
    }
    EXPECT_TRUE(std::isnan(*readDecimal("NaN")) && std::isinf(*readDecimal("-inf")));
}

TEST(ImportText, Obj) {
    expectTetrahedron("a.obj", kObj);
    expectTetrahedron("a.obj", replaced(kObj, "\n", "\r"));
    expectTetrahedron("a.obj", replaced(kObj, "\n", "\r\n"));
    expectTetrahedron("a.obj", replaced(replaced(kObj, "0\n", "0\r"), "3\n", "3\r\n"));
    expectTetrahedron("a.obj", replaced(kObj, "f", " \tf"));
    expectTetrahedron("a.obj", replaced(kObj, "\n", " # a note\n"));
    expectTetrahedron("a.obj", replaced(kObj, "\n", "#\n"));
    expectTetrahedron("a.obj", replaced(replaced(kObj, " 0", " .0"), " 1 0", " +1. -.0e1"));
    expectTetrahedron("a.obj", replaced(kObj, "f 1 2", "f \\\r\n\t1 2 \\ \n"));
    expectTetrahedron("a.obj",
                      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf -4 -2 -3\nf -4 -3 -1\nf -3 -2 -1\nf -4 -1 -2");
    expectTetrahedron("a.obj", kObj.substr(32) + kObj.substr(0, 32));  // faces first
    expectTetrahedron("a.obj", "v 0 0 0 2\nv 2 0 0 2\nv 0 1 0 .5 .5 .5\nv 0 0 1 1 1 1 1\n" + kObj.substr(32));
    expectRefused("a.obj", replaced(kObj, "f 2 3 4", "f 2 3 5"),
                  "line 7: vertex 5 does not exist: there are 4;");
    expectRefused("a.obj", replaced(kObj, "f 2 3 4", "f 2 3 -5"), "line 7: vertex '-5' does not exist");
    expectRefused("a.obj", replaced(kObj, "f 2 3 4", "f 2 3 0"), "line 7: vertex '0' does not exist");
    expectRefused("a.obj", replaced(kObj, "f 2 3 4", "f 2 3 x"), "line 7: 'x' names no vertex");
    expectRefused("a.obj", replaced(kObj, "f 2 3 4", "f 2 3 99999999999999999999"), "line 7: ");
    expectRefused("a.obj", replaced(kObj, "f 2 3 4", "f"), "line 7: a face without corners");
    expectRefused("a.obj", replaced(kObj, "v 0 0 1", "v 0 0"), "line 4: a vertex of 2 numbers");
    expectRefused("a.obj", replaced(kObj, "v 0 0 1", "v 0 0,0 1"), "line 4: '0,0' has a comma");
    expectRefused("a.obj", replaced(kObj, "v 0 0 1", "v 0 0 1 0"), "line 4: a vertex of weight 0");
}

TEST(ImportText, APolygonFarAwayStaysASolid) {
    // A box whose bottom has corners in the middle of its edges, as its walls have.
    std::string obj;
    for (const char* z : {"0", "1"}) {
        for (const char* xy : {"0 0", ".5 0", "1 0", "1 .5", "1 1", ".5 1", "0 1", "0 .5"}) {
            const std::string at(xy);
            const std::size_t blank = at.find(' ');
            obj += "v " + std::to_string(140000.37 + std::stod(at.substr(0, blank))) + " " +
                   std::to_string(-140000.21 + std::stod(at.substr(blank))) + " " + z + "\n";
        }
    }
    obj += "f 8 7 6 5 4 3 2 1\nf 9 10 11 12 13 14 15 16\n";
    for (int i = 1; i <= 8; ++i) {
        const int next = i % 8 + 1;
        obj += "f " + std::to_string(i) + " " + std::to_string(next) + " " + std::to_string(next + 8) + " " +
               std::to_string(i + 8) + "\n";
    }
    const Result<TriangleMesh> mesh = load("far.obj", obj);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 28U);
    EXPECT_EQ(mesh->dropped_triangles, 0U);
}

TEST(ImportText, Off) {
    expectTetrahedron("a.off", kOff);
    expectTetrahedron("a.off", replaced(kOff, "\n", "\r"));
    expectTetrahedron("a.off", replaced(kOff, "OFF\n", "OFF "));
    expectTetrahedron("a.off", replaced(kOff, "OFF\n", "# made by hand\n\noff # as text\n"));
    expectTetrahedron("a.off", replaced(kOff, "4 4 6", "4 4"));
    expectTetrahedron("a.off", replaced(kOff, "4 4 6", "4\n4\n6"));
    expectTetrahedron("a.off", replaced(kOff, "3 1 2 3", "3\n1\n\n2 # two\n3"));
    expectTetrahedron("a.off", replaced(kOff, "3 1 2 3", "3 1 2 3 255 0 0"));
    expectTetrahedron("a.off", replaced(kOff.substr(4), "0\n", "-.0e0\n"));
    expectTetrahedron("a.off", "COFF\n4 4 6\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n0 0 1 1 1 1 1\n" +
                                   kOff.substr(34));
    expectTetrahedron("a.off",
                      "STCNOFF 4 4 6\n0 0 0 0 0 1 9 9 9 9 .5 .5\n1 0 0 0 0 1 9 9 9 9 0 0\n"
                      "0 1 0 0 0 1 9 9 9 9 0 0\n0 0 1 0 0 1 9 9 9 9 0 0\n" +
                          kOff.substr(34));
    expectRefused("a.off", replaced(kOff, "3 1 2 3", "3 1 2 4"), "line 9: face 2 names the vertex '4'");
    expectRefused("a.off", replaced(kOff, "4 4 6", "4 5 6"), "line 10: it ends after face 4 of 5");
    expectRefused("a.off", replaced(kOff, "4 4 6", "4 3 6"), "line 10: '3' stands behind the last");
    expectRefused("a.off", replaced(kOff, "OFF", "OFF BINARY"), "binary");
    expectRefused("a.off", replaced(kOff, "OFF", "nOFF"), "three dimensions");
}

TEST(ImportText, OffOverAnyLines) {
    const std::string head = kOff.substr(0, 10);
    const std::string vertices = kOff.substr(10, 24);
    const std::string faces = kOff.substr(34);
    const auto oneLine = [](const std::string& text) { return replaced(text, "\n", " "); };
    expectTetrahedron("a.off", head + vertices + oneLine(faces));
    expectTetrahedron("a.off", head + oneLine(vertices) + "\n" + faces);
    expectTetrahedron("a.off", oneLine(kOff));
    // A colour ends with the line that the last index stands in.
    expectTetrahedron("a.off",
                      head + vertices + "3 0 2\n1 255 0 0\n3 0\n1\n3 .5 .5 .5 1\n3 1 2 3 7\n3 0 3 2 9 9 9");
    // This many words on a line, wherever a record ends.
    const auto wrapped = [&](const std::string& lines, std::size_t words) {
        std::string text = oneLine(lines);
        std::size_t count = 0;
        for (char& c : text) {
            c = c == ' ' && ++count % words == 0 ? '\n' : c;
        }
        return text;
    };
    for (std::size_t words = 1; words <= 12; ++words) {
        expectTetrahedron("a.off", head + wrapped(vertices + faces, words));
        expectTetrahedron("a.off", head + replaced(vertices, "\n", " 9 9 9\n") + wrapped(faces, words));
    }
    expectTetrahedron("a.off", oneLine("C" + head + replaced(vertices, "\n", " 1 .5 0 1\n") + faces));
    expectTetrahedron("a.off",
                      oneLine("STCN" + head + replaced(vertices, "\n", " 0 0 1 9 9 9 9 .5 0\n") + faces));
    // Colours cannot be told from further faces.
    expectRefused("a.off", head + vertices + oneLine(replaced(faces, "\n", " 255 0 0\n")),
                  "line 7: it ends after face 1 of 4");
    const std::string whole = oneLine(kOff);
    for (std::size_t end = head.size(); end + 2 < whole.size(); ++end) {
        expectRefused("a.off", whole.substr(0, end), "cut off");
    }
}

TEST(ImportText, Stl) {
    std::string stl = "solid t\n";
    for (const char* corners :
         {"0 0 0|0 1 0|1 0 0", "0 0 0|1 0 0|0 0 1", "1 0 0|0 1 0|0 0 1", "0 0 0|0 0 1|0 1 0"}) {
        stl += "facet normal 0 0 1\nouter loop\nvertex " + replaced(corners, "|", "\nvertex ") +
               "\nendloop\nendfacet\n";
    }
    stl += "endsolid t\n";
    expectTetrahedron("a.stl", stl);
    expectTetrahedron("a.stl", replaced(stl, "\n", "\r"));
    expectRefused("a.stl", replaced(stl, "\n", " "), "it ends without 'facet' or 'endsolid'");
    expectTetrahedron("a.stl",
                      "solid t\n" + replaced(stl.substr(8, stl.size() - 19), " ", "\n\t") + "endsolid t");
    expectTetrahedron("a.stl", replaced(stl, "solid t", "solid vertex of a facet"));
    expectTetrahedron("a.stl", replaced(stl, "solid t", "solid"));
    expectTetrahedron("a.stl", replaced(stl, "normal 0 0 1", "normal -nan(ind) 1.#QNAN nan"));
    expectTetrahedron("a.stl", replaced(stl, "facet normal 0 0 1", "facet"));
    expectTetrahedron("a.stl", replaced(stl, "1 0 0\nvertex", "1. +0 -.0\nvertex"));
    expectTetrahedron("a.stl", "solid empty\nendsolid empty\n" + stl);
    expectRefused("a.stl", replaced(stl, "vertex 0 0 1\nendloop", "endloop"),
                  "'endloop' stands where 'vertex'");
    expectRefused("a.stl", replaced(stl, "endloop", "vertex 0 0 0\nendloop"),
                  "line 7: 'vertex' stands where");
    expectRefused("a.stl", replaced(stl, "vertex 0 0 1", "vertx 0 0 1"), "'vertx' stands where 'vertex'");
    expectRefused("a.stl", replaced(stl, "endsolid t\n", ""), "line 29: it ends without");
}

TEST(ImportText, BinaryStlOfAnyLength) {
    std::string stl(84, ' ');
    stl.replace(0, 12, "solid vertex");
    const float corners[4][9] = {{0, 0, 0, 0, 1, 0, 1, 0, 0},
                                 {0, 0, 0, 1, 0, 0, 0, 0, 1},
                                 {1, 0, 0, 0, 1, 0, 0, 0, 1},
                                 {0, 0, 0, 0, 0, 1, 0, 1, 0}};
    const std::uint32_t count = 4;
    std::memcpy(stl.data() + 80, &count, 4);
    for (const auto& triangle : corners) {
        stl += std::string(12, '\0') + std::string(reinterpret_cast<const char*>(triangle), 36) + "\1\2";
    }
    expectTetrahedron("a.stl", stl);
    const Result<TriangleMesh> more = load("a.stl", stl + "and so on");
    ASSERT_TRUE(more) << more.error().message;
    EXPECT_EQ(more->triangles.size(), 4U);
    ASSERT_EQ(more->warnings.size(), 1U);
    EXPECT_NE(more->warnings[0].find("left out 9 bytes"), std::string::npos) << more->warnings[0];
    stl.replace(0, 12, "binary solid");
    expectRefused("a.stl", stl.substr(0, stl.size() - 1), "announces 4 triangles, but it holds 3");
}

TEST(ImportText, PlyByLinesWithTrueCounts) {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string body = kOff.substr(10);
    expectTetrahedron("a.ply", head + body);
    expectTetrahedron("a.ply", replaced(head + body, "\n", "\r"));
    expectTetrahedron("a.ply", head + replaced(body, "\n", "\n\n"));
    expectRefused("a.ply", head + replaced(body, "\n", " "),
                  "line 10: element vertex 0 does not end with its line");
    expectTetrahedron("a.ply", head + replaced(body, " ", "\n"));
    for (const char* wrong : {"vertex 5", "vertex 3", "vertex 6"}) {
        expectRefused("a.ply", replaced(head, "vertex 4", wrong) + body, "does not end with its line");
    }
    expectRefused("a.ply", replaced(head, "face 4", "face 5") + body, "line 17: it ends too early");
    expectRefused("a.ply", replaced(head, "face 4", "face 3") + body, "line 17: it holds more numbers");
}

}  // namespace
}  // namespace relief::test
