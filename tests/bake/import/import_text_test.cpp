// SPDX-License-Identifier: Apache-2.0
// Text formats as found in practice: valid files that other readers misread, and invalid files that they accept.

#include <algorithm>
#include <cctype>

#include "bake/import/mesh_import.h"
#include "formats/polygons/decimal.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

void expectTetrahedron(const std::string& name, std::string_view contents) {
    SCOPED_TRACE(contents);
    const TriangleMesh mesh = imported(name, contents);
    EXPECT_EQ(mesh.triangles.size(), 4U);
    EXPECT_NEAR(signedVolume(mesh), 1.0, 1e-6);
    EXPECT_TRUE(mesh.warnings.empty());
}

/// Files with this name that contain the tetrahedron.
void expectTetrahedra(const std::string& name, const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
        expectTetrahedron(name, text);
    }
}

const std::string kObj = tetrahedronObj();
const std::string kOff = tetrahedronOff();

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
    const std::string faces = kObj.substr(32);
    expectTetrahedra(
        "a.obj",
        {kObj, replaced(kObj, "\n", "\r"), replaced(kObj, "\n", "\r\n"),
         replaced(replaced(kObj, "0\n", "0\r"), "3\n", "3\r\n"), replaced(kObj, "f", " \tf"),
         replaced(kObj, "\n", " # a note\n"), replaced(kObj, "\n", "#\n"),
         replaced(replaced(kObj, " 0", " .0"), " 1 .0", " +1. -.0e1"),
         replaced(kObj, "f 1 2", "f \\\r\n\t1 2 \\ \n"),
         kObj.substr(0, 32) + "f -4 -2 -3\nf -4 -3 -1\nf -3 -2 -1\nf -4 -1 -2", faces + kObj.substr(0, 32),
         "v 0 0 0 2\nv 2 0 0 2\nv 0 2 0 .5 .5 .5\nv 0 0 3 1 1 1 1\n" + faces});
    const auto face = [](const std::string& by) { return replaced(kObj, "f 2 3 4", by); };
    const auto vertex = [](const std::string& by) { return replaced(kObj, "v 0 0 3", by); };
    expectWrong("a.obj", {{face("f 2 3 5"), "line 7: vertex 5 does not exist: there are 4;"},
                          {face("f 2 3 -5"), "line 7: vertex '-5'"},
                          {face("f 2 3 0"), "line 7: vertex '0'"},
                          {face("f 2 3 x"), "line 7: 'x'"},
                          {face("f 2 3 99999999999999999999"), "line 7: "},
                          {face("f"), "line 7: "},
                          {vertex("v 0 0"), "line 4: a vertex of 2 numbers"},
                          {vertex("v 0 0,0 1"), "line 4: '0,0' contains a comma"},
                          {vertex("v 0 0x3 1"), "line 4: '0x3' is hexadecimal"},
                          {vertex("v 0 0 1 0"), "line 4: a vertex has weight 0"}});
}

TEST(ImportText, Off) {
    const std::string faces = kOff.substr(34);
    expectTetrahedra(
        "a.off",
        {kOff, replaced(kOff, "\n", "\r"), replaced(kOff, "OFF\n", "OFF "),
         replaced(kOff, "OFF\n", "# made by hand\n\noff # as text\n"), replaced(kOff, "4 4 0", "4 4"),
         replaced(kOff, "4 4 0", "4\n4\n6"), replaced(kOff, "3 1 2 3", "3\n1\n\n2 # two\n3"),
         replaced(kOff, "3 1 2 3", "3 1 2 3 255 0 0"), replaced(kOff, "3 0 1 3", "3 0 1 3 # 9"),
         "4 4 6\n" + replaced(kOff.substr(10), "0\n", "-.0e0\n"),
         "COFF\n4 4 6\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 2 0 1 1 1 1\n0 0 3 1 1 1 1\n" + faces,
         "STCNOFF 4 4 6\n0 0 0 0 0 1 9 9 9 9 .5 .5\n1 0 0 0 0 1 9 9 9 9 0 0\n"
         "0 2 0 0 0 1 9 9 9 9 0 0\n0 0 3 0 0 1 9 9 9 9 0 0\n" +
             faces});
    expectWrong("a.off", {{replaced(kOff, "3 1 2 3", "3 1 2 4"), "line 9: face 2 uses the vertex '4'"},
                          {replaced(kOff, "3 0 3 2\n", "3 0 3\n"), "line 10: it ends in face 3"},
                          {replaced(kOff, "3 0 1 3\n", "3 0 1\n"), "line 10: it ends after face 3 of 4"},
                          {replaced(kOff, "4 4 0", "4 5 6"), "line 10: it ends after face 4 of 5"},
                          {replaced(kOff, "4 4 0", "4 3 6"), "line 10: '3' follows the last"},
                          {replaced(kOff, "OFF", "OFF BINARY"), "binary"},
                          {replaced(kOff, "OFF", "nOFF"), "three-dimensional"}});
    // A convex polygon with many corners on a parabola. assimp read polygons up to 9 corners and skipped the others.
    std::string corners;
    std::string face = "100";
    for (int i = 0; i < 100; ++i) {
        corners += std::to_string(i) + " " + std::to_string(i * i) + " 0\n";
        face += " " + std::to_string(i);
    }
    EXPECT_EQ(imported("large.off", "OFF\n100 1 0\n" + corners + face + "\n").triangles.size(), 98U);
}

TEST(ImportText, OffRecordsCanSpanLines) {
    const std::string head = kOff.substr(0, 10);
    const std::string vertices = kOff.substr(10, 24);
    const std::string faces = kOff.substr(34);
    const auto oneLine = [](const std::string& text) { return replaced(text, "\n", " "); };
    expectTetrahedra(
        "a.off", {head + vertices + oneLine(faces), head + oneLine(vertices) + "\n" + faces, oneLine(kOff),
                  // A colour ends at the end of the line with the last index.
                  head + vertices + "3 0 2\n1 255 0 0\n3 0\n1\n3 .5 .5 .5 1\n3 1 2 3 7\n3 0 3 2 9 9 9",
                  oneLine("C" + head + replaced(vertices, "\n", " 1 .5 0 1\n") + faces),
                  oneLine("STCN" + head + replaced(vertices, "\n", " 0 0 1 9 9 9 9 .5 0\n") + faces)});
    // Breaks lines after this many words, regardless of records.
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
    // Colours would be ambiguous with further faces.
    expectWrong("a.off", {{head + vertices + oneLine(replaced(faces, "\n", " 255 0 0\n")),
                           "line 7: it ends after face 1 of 4"}});
    const std::string whole = oneLine(kOff);
    for (std::size_t end = head.size(); end + 2 < whole.size(); ++end) {
        expectWrong("a.off", {{whole.substr(0, end), "cut off"}});
    }
}

TEST(ImportText, Stl) {
    const std::string stl = tetrahedronStl();
    expectTetrahedra(
        "a.stl",
        {stl, replaced(stl, "\n", "\r"),
         "solid t\n" + replaced(stl.substr(8, stl.size() - 19), " ", "\n\t") + "endsolid t",
         replaced(stl, "solid t", "solid vertex of a facet"), replaced(stl, "solid t", "solid"),
         replaced(stl, "normal 0 0 0", "normal -nan(ind) 1.#QNAN nan"),
         replaced(stl, "facet normal 0 0 0", "facet"), replaced(stl, "1 0 0\nvertex", "1. +0 -.0\nvertex"),
         "solid empty\nendsolid empty\n" + stl, stl + std::string(40, '\0')});
    for (const char* end : {"", "\r\n", "\n\n "}) {
        expectTetrahedron("a.stl", stl.substr(0, stl.size() - 1) + end);
    }
    std::string capitals = stl;
    std::transform(stl.begin(), stl.end(), capitals.begin(), [](unsigned char c) { return std::toupper(c); });
    ImportOptions options;
    options.names = {"T"};
    EXPECT_TRUE(importText("a.stl", capitals, options)) << "names are case-sensitive";
    for (const char* first : {"SOLID T\n", "Solid T\n", "solid T\n"}) {
        expectTetrahedron("a.stl", capitals.replace(0, 8, first));
    }
    expectWrong("a.stl",
                {{replaced(stl, "\n", " "), "it ends without 'facet' or 'endsolid'"},
                 {replaced(stl, "vertex 0 0 3\nendloop", "endloop"), "'endloop' appears instead of 'vertex'"},
                 {replaced(stl, "endloop", "vertex 0 0 0\nendloop"), "line 7: 'vertex' appears instead of"},
                 {replaced(stl, "vertex 0 0 3", "vertx 0 0 1"), "'vertx' appears instead of 'vertex'"},
                 {replaced(stl, "endsolid t\n", ""), "line 29: it ends without"}});
}

TEST(ImportText, TruncationsAreRejected) {
    for (const auto& [name, text] :
         {std::pair{"a.stl", tetrahedronStl()}, std::pair{"a.off", tetrahedronOff()},
          std::pair{"a.ply", tetrahedronPly()}}) {
        // 'endsolid' needs no name.
        const std::size_t last = text.find_last_of(" \n", text.size() - (name[2] == 's' ? 4 : 2));
        for (std::size_t at = text.find_first_of(" \n"); at <= last; at = text.find_first_of(" \n", at + 1)) {
            ASSERT_FALSE(importText(name, text.substr(0, at))) << name << ", " << at << " bytes";
            ASSERT_FALSE(importText(name, text.substr(0, at + 1))) << name << ", " << at + 1 << " bytes";
        }
    }
}

// The size decides: the header can start like any other format.
TEST(ImportText, BinaryStlWithAnyHeaderAndLength) {
    for (const char* header : {"solid vertex", "OFF", "ply\n", "glTF\x02", "BB3D", "\x1f\x8b", "\xff\xfe",
                               "{\"asset\"", "v 0 0 0\nf 1 2 3\n", "MM", "<COLLADA"}) {
        expectTetrahedron("a.stl", tetrahedronBinaryStl(header));
    }
    const TriangleMesh more = imported("a.stl", tetrahedronBinaryStl("solid vertex") + "and so on");
    EXPECT_EQ(more.triangles.size(), 4U);
    EXPECT_TRUE(warns(more, "left out 9 bytes"));
    const std::string stl = tetrahedronBinaryStl("binary solid");
    expectWrong("a.stl", {{stl.substr(0, stl.size() - 1), "declares 4 triangles, but it has 3"}});
}

TEST(ImportText, PlyByLinesWithTrueCounts) {
    const std::string ply = tetrahedronPly();
    const std::size_t size = ply.find("0 0 0\n");
    const std::string head = ply.substr(0, size);
    const std::string body = ply.substr(size);
    expectTetrahedra("a.ply", {ply, replaced(ply, "\n", "\r"), head + replaced(body, "\n", "\n\n"),
                               head + replaced(body, " ", "\n")});
    expectWrong("a.ply",
                {{head + replaced(body, "\n", " "), "line 10: element vertex 0 does not end with its line"},
                 {replaced(ply, "vertex 4", "vertex 5"), "does not end with its line"},
                 {replaced(ply, "vertex 4", "vertex 3"), "does not end with its line"},
                 {replaced(ply, "vertex 4", "vertex 6"), "does not end with its line"},
                 {replaced(ply, "face 4", "face 5"), "line 17: it ends before the counts"},
                 {replaced(ply, "face 4", "face 3"), "line 17: it contains more numbers"},
                 {replaced(ply, "3 1 2 3", "3 1 2 4"), "vertex"},
                 {replaced(ply, "3 1 2 3", "3 1 2 -1"), "vertex"},
                 {replaced(ply, "3 1 2 3", "4 1 2 3 2147483647"), "vertex"}});
}

}  // namespace
}  // namespace relief::test
