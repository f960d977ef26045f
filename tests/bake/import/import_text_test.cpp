// SPDX-License-Identifier: Apache-2.0
// Text formats as found in practice: valid files that other readers misread, and invalid files that they accept; and
// PLY files with a closed-form surface.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <limits>

#include "bake/import/mesh_import.h"
#include "bake/mesh/triangle_plane.h"
#include "formats/polygons/decimal.h"
#include "formats/polygons/polygon_mesh.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

// Text formats as found in practice: valid files that other readers misread, and invalid files that they accept.

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
    expectWrong("a.off",
                {{replaced(kOff, "3 1 2 3", "3 1 2 4"), "line 9: face 2 uses the vertex '4'"},
                 {replaced(kOff, "3 0 3 2\n", "3 0 3\n"), "line 10: it ends in face 3"},
                 {replaced(kOff, "3 0 1 3\n", "3 0 1\n"), "line 10: it ends after face 3 of 4"},
                 {replaced(kOff, "4 4 0", "4 5 6"), "line 10: it ends after face 4 of 5"},
                 {replaced(kOff, "4 4 0", "4 3 6"), "line 10: '3' follows the 4 vertices and 3 faces"},
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

// PLY files with a closed-form surface: faces, strips, and files without either.

constexpr std::array kEncodings = {"ascii", "binary_little_endian", "binary_big_endian"};

/// Builds a PLY file item by item, in any encoding.
class PlyWriter {
  public:
    explicit PlyWriter(std::string encoding) : encoding_(std::move(encoding)) {
        text_ = "ply\nformat " + encoding_ + " 1.0\n";
    }
    PlyWriter& line(const std::string& words) {
        text_ += words + "\n";
        return *this;
    }
    template <class T>
    PlyWriter& put(T value) {
        if (encoding_ == "ascii") {
            text_ += std::to_string(value) + " ";
            return *this;
        }
        std::array<char, sizeof(T)> bytes{};
        std::memcpy(bytes.data(), &value, sizeof(T));
        if (encoding_ == "binary_big_endian") {
            std::reverse(bytes.begin(), bytes.end());
        }
        text_.append(bytes.data(), bytes.size());
        return *this;
    }
    template <class Length, class Item>
    PlyWriter& list(const std::vector<std::int64_t>& items) {
        put(static_cast<Length>(items.size()));
        for (const std::int64_t item : items) {
            put(static_cast<Item>(item));
        }
        return *this;
    }
    /// Data of one element.
    PlyWriter& end() {
        text_ += encoding_ == "ascii" ? "\n" : "";
        return *this;
    }
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    std::string encoding_;
    std::string text_;
};

// A box of 1 × 2 × 3 at the origin. Bits 0, 1 and 2 of a vertex index select x, y and z.
constexpr const char* kBoxHeader =
    "element vertex 8\nproperty float x\nproperty uchar red\nproperty double y\nproperty float z";

// Three strips for the sides, two for the ends. The first two have odd lengths: winding parity that outlives its strip
// would reverse the next one.
const std::vector<std::int64_t> kBoxStrip = {0, 1, 4, 5,  6, 7, 2, -1, 2,  7, 3, -1, 2,
                                             3, 0, 1, -1, 0, 4, 2, 6,  -1, 1, 3, 5,  7};

// The same triangles in the same order.
const std::vector<std::vector<std::int64_t>> kBoxTriangles = {{0, 1, 4}, {4, 1, 5}, {4, 5, 6}, {6, 5, 7},
                                                              {6, 7, 2}, {2, 7, 3}, {2, 3, 0}, {0, 3, 1},
                                                              {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {5, 3, 7}};

/// \param triangles  whether to write triangles instead of strips
std::string boxOf(const std::string& encoding, bool triangles = false) {
    PlyWriter ply(encoding);
    ply.line("obj_info a box").line(kBoxHeader);
    ply.line(triangles ? "element face 12\nproperty list uchar int vertex_indices"
                       : "element tristrips 1\nproperty list int int vertex_indices");
    ply.line("end_header");
    for (int i = 0; i < 8; ++i) {
        ply.put(static_cast<float>(i & 1)).put(std::uint8_t{7}).put(static_cast<double>(i & 2));
        ply.put(i < 4 ? 0.0F : 3.0F).end();
    }
    if (!triangles) {
        return ply.list<std::int32_t, std::int32_t>(kBoxStrip).end().text();
    }
    for (const std::vector<std::int64_t>& triangle : kBoxTriangles) {
        ply.list<std::uint8_t, std::int32_t>(triangle).end();
    }
    return ply.text();
}

Result<PolygonMesh> read(const std::string& text) {
    return readPly(std::as_bytes(std::span(text)));
}

PolygonMesh polygons(const std::string& text) {
    return required(read(text));
}

// Four vertices in a plane, as text.
const std::string kHead =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kPlyCorners = "0 0 0\n1 0 0\n0 1 0\n1 1 1\n";

std::string strips(const std::string& element, const std::string& lists,
                   const std::string& type = "list int int") {
    return kHead + element + "\nproperty " + type + " vertex_indices\nend_header\n" + kPlyCorners + lists;
}

TEST(ImportPly, StripsMatchTheirTriangles) {
    const TriangleMesh truth = imported("triangles.ply", boxOf(kEncodings[1], true));
    const DepthMap expected = bakeMap(truth, "float:dir=-z,size=32");
    for (const char* encoding : kEncodings) {
        SCOPED_TRACE(encoding);
        const TriangleMesh mesh = required(importTextInWorker("strips.ply", boxOf(encoding)));
        EXPECT_EQ(mesh.positions, truth.positions);
        EXPECT_EQ(mesh.triangles, truth.triangles);
        EXPECT_NEAR(signedVolume(mesh), 6.0, 1e-12);
        EXPECT_EQ(mesh.unused_vertices, 0U);
        EXPECT_TRUE(mesh.warnings.empty());
        EXPECT_EQ(bakeMap(mesh, "float:dir=-z,size=32").texels, expected.texels);
    }
}

TEST(ImportPly, StripsRestartAndAlternate) {
    using Corners = std::vector<std::uint32_t>;
    struct Case {
        const char* lists;
        Corners corners;
        const char* element = "element tristrips 1";
        const char* type = "list int int";
    };
    for (
        const Case& c : std::vector<Case>{
            {"4 0 1 2 3\n", {0, 1, 2, 2, 1, 3}},
            // One triangle, repeated restarts, and strips too short for a triangle. Every strip starts with even
            // parity.
            {"13 -1 0 1 2 -1 -1 1 3 -1 3 1 2 0\n", {0, 1, 2, 3, 1, 2, 2, 1, 0}},
            // One list per strip.
            {"3 0 1 2\n0\n4 3 1 2 -1\n", {0, 1, 2, 3, 1, 2}, "element tristrips 3"},
            // Repeated vertices join two parts. They make no triangles, but the parity continues.
            {"8 0 1 2 2 3 3 1 0\n", {0, 1, 2, 1, 3, 0}},
            // -1 in unsigned lists, in binary and as text.
            {"7 0 1 2 4294967295 3 1 2\n", {0, 1, 2, 3, 1, 2}, "element tristrips 1", "list uint uint"},
            {"7 0 1 2 -1 3 1 2\n", {0, 1, 2, 3, 1, 2}, "element tristrips 1", "list uint uint"}}) {
        SCOPED_TRACE(c.lists);
        EXPECT_EQ(polygons(strips(c.element, c.lists, c.type)).corners, c.corners);
    }
    // Faces beside strips. The vertices may come last.
    const std::string both =
        "ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_index\n"
        "element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\n" +
        kHead.substr(kHead.find("element")) + "end_header\n3 0 1 2\n4 3 2 1 0 255\n" + kPlyCorners;
    const PolygonMesh mesh = polygons(both);
    EXPECT_EQ(mesh.corners, (Corners{0, 1, 2, 3, 2, 1, 0}));
    EXPECT_EQ(mesh.sizes, (Corners{3, 4}));
    ASSERT_EQ(mesh.positions.size(), 4U);
    EXPECT_EQ(mesh.positions[3], glm::vec3(1));
}

TEST(ImportPly, HostileStripsAreRejected) {
    for (const char* list : {"3 0 1 4\n", "3 0 1 -2\n", "4 0 1 2 2147483647\n", "3 0 1 0.5\n", "3 0 1 nan\n",
                             "3 0 1 4294967295\n"}) {
        expectWrong("p.ply", {{strips("element tristrips 1", list), "refers to vertex"}});
    }
    const auto vertices = [](const std::string& count) {
        return replaced(strips("element tristrips 1", ""), "vertex 4", "vertex " + count);
    };
    expectWrong("p.ply",
                {{strips("element tristrips 1", "-3 0 1 2\n"), "invalid length"},
                 {strips("element tristrips 1", "2147483647 0 1 2\n"), "ends before the counts"},
                 {strips("element tristrips 4000000000", "3 0 1 2\n"), "ends before the counts"},
                 {strips("element tristrips 18446744073709551615", "3 0 1 2\n"), "ends before the counts"},
                 {strips("element tristrips 18446744073709551616", "3 0 1 2\n"), "ends before the counts"},
                 {strips("element tristrips -1", "3 0 1 2\n"), "malformed"},
                 {strips("element tristrips 1", "3 0 one 2\n"), "line 14: 'one'"},
                 {strips("element tristrips 1", "4 0 0 1 1\n"), "no faces"},
                 {vertices("200000000"), "ends before the counts"},
                 {vertices("99999999999"), "", ErrorCode::kLimit}});
}

TEST(ImportPly, TruncationsAreRejected) {
    for (const char* encoding : kEncodings) {
        const std::string whole = boxOf(encoding);
        ASSERT_TRUE(read(whole));
        // Only the last number of a text file can lose digits. Here it has one digit, followed by a space and a
        // newline.
        const std::size_t last = encoding == std::string("ascii") ? whole.size() - 2 : whole.size();
        for (std::size_t size = 0; size < last; ++size) {
            ASSERT_FALSE(read(whole.substr(0, size))) << encoding << ", " << size << " bytes";
        }
    }
}

TEST(ImportPly, TrailingBytes) {
    // An extra number in a line shifts all following ones: four columns instead of three.
    expectWrong("p.ply",
                {{strips("element face 1", "3 0 1 2 9\n", "list uchar int"), "does not end with its line"}});
    const std::string binary = boxOf("binary_little_endian");
    for (const std::string& padding : {std::string("\n"), std::string("\r\n"), std::string(3, '\0')}) {
        EXPECT_TRUE(polygons(binary + padding).warnings.empty());
    }
    const TriangleMesh more = imported("m.ply", binary + "more");
    EXPECT_TRUE(more.warnings.size() == 1 && warns(more, "4 bytes"));
}

TEST(ImportPly, MalformedHeaders) {
    expectWrong("p.ply", {{"ply\nformat ascii 1.0\n", "header does not end"},
                          {"solid t\nend_header\n", "not a PLY"},
                          {"ply\nelement vertex 1\nend_header\n", "not name a supported format"},
                          {"ply\nformat ascii 1.0\nend_header\n", "exactly one element 'vertex'"},
                          {kHead + "element vertex 1\nproperty float x\nend_header\n",
                           "exactly one element 'vertex'"}});
    for (const char* z : {"float w", "float x", "float y", "list uchar float z"}) {
        expectWrong("p.ply", {{replaced(kHead, "float z", z) + kFace + "end_header\n", "x, y and z"}});
    }
}

TEST(ImportPly, UnknownFaceListsAreRejectedOrNamed) {
    const std::string polygon = replaced(kFace, "face", "polygon");
    const std::string rest = "end_header\n" + kPlyCorners + "3 0 1 2\n";
    expectWrong(
        "p.ply",
        {{kHead + polygon + rest, "'polygon' is not read"},
         {kHead + "element tri_strips 1\nproperty list int int strip\n" + rest, "'tri_strips' is not read"},
         {kHead + "element cells 1\nproperty list uchar int vertexIndex\n" + rest, "'cells' is not read"},
         {kHead + replaced(kFace, "vertex_indices", "corners") + rest, "'face' has no list vertex_indices"}});
    const PolygonMesh part = polygons(kHead + kFace + polygon + rest + "3 1 2 3\n");
    EXPECT_EQ(part.sizes.size(), 1U);
    ASSERT_EQ(part.warnings.size(), 1U);
    EXPECT_NE(part.warnings[0].find("'polygon' is not read"), std::string::npos) << part.warnings[0];
    // Common elements beside faces do not warn.
    EXPECT_TRUE(polygons(kHead + kFace +
                         "property list uchar float texcoord\nproperty int material_index\nelement edge 1\n"
                         "property int vertex1\nproperty int vertex2\nelement multi_texture_face 1\n"
                         "property list uchar int texture_vertex_indices\nelement material 1\n"
                         "property float shininess\nend_header\n" +
                         kPlyCorners + "3 0 1 2 6 0 0 1 0 0 1 5\n0 1\n3 0 1 2\n0.5\n")
                    .warnings.empty());
}

TEST(ImportPly, PointsAndEdgesAreNotASurface) {
    const std::string rest = "end_header\n" + kPlyCorners;
    expectWrong(
        "p.ply",
        {{kHead + rest, "it has 4 vertices but no faces; for a scan"},
         // Also a truncated cloud: more points would not help.
         {kHead + "end_header\n0 0 0\n", "for a scan"},
         {kHead + replaced(kFace, "face 1", "face 0") + rest, "for a scan"},
         {kHead + replaced(kFace, "face 1", "range_grid 4") + rest + "1 0\n1 1\n0\n1 2\n", "for a scan"},
         {kHead + "element edge 1\nproperty int vertex1\nproperty int vertex2\n" + rest + "0 1\n",
          "4 vertices and edges but no faces; export"}});
}

TEST(ImportPly, CoordinatesRoundToTheNearestFloat) {
    const PolygonMesh mesh =
        polygons(replaced(kHead, "vertex 4", "vertex 3") + kFace +
                 "end_header\n0.1 7.941797 -0.927566\n16777217 1e-3 +3.4028235e38\n0 1 0\n3 0 1 2\n");
    ASSERT_EQ(mesh.positions.size(), 3U);
    EXPECT_EQ(mesh.positions[0], glm::vec3(0.1F, 7.941797F, -0.927566F));
    EXPECT_EQ(mesh.positions[1], glm::vec3(16777216.0F, 0.001F, std::numeric_limits<float>::max()));
}

TEST(ImportPly, ConcavePolygonsStayConcave) {
    // An L with six corners and an area of 3: a fan around its first corner would reverse some triangles.
    const TriangleMesh mesh =
        imported("l.ply", replaced(kHead, "vertex 4", "vertex 6") + kFace +
                              "end_header\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 0\n2 0 0\n6 0 1 2 3 4 5\n");
    ASSERT_EQ(mesh.triangles.size(), 4U);
    double area = 0.0;
    for (std::uint32_t i = 0; i < 4; ++i) {
        const TrianglePlane plane = planeOf(mesh, i);
        EXPECT_GT(plane.normal.z, 0.0);
        area += plane.normal.z / 2.0;
    }
    EXPECT_DOUBLE_EQ(area, 3.0);
}

}  // namespace
}  // namespace relief::test
