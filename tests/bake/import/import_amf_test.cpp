// AMF: a tetrahedron under units and constellations, in closed form.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "bake/import/mesh_import.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

std::string amf(const std::string& root, const std::string& more = "") {
    std::string vertices;
    for (const char* p : {"<x>0</x><y>0</y><z>0</z>", "<x>1</x><y>0</y><z>0</z>",
                          "<z>0</z><y> 2\n</y><x>0</x>", "<x>0</x><y>0</y><z>3</z>"}) {
        vertices += std::string("<vertex><coordinates>") + p + "</coordinates></vertex>";
    }
    std::string triangles;
    for (const char* t : {"<v1>0</v1><v2>2</v2><v3>1</v3>", "<v1>0</v1><v2>1</v2><v3>3</v3>",
                          "<v1>1</v1><v2>2</v2><v3>3</v3>", "<v1>0</v1><v2>3</v2><v3>2</v3>"}) {
        triangles += std::string("<triangle>") + t + "</triangle>";
    }
    return "<?xml version='1.0'?><amf" + root + "><object id='a'><mesh><vertices>" + vertices +
           "</vertices><volume materialid='m'>" + triangles + "</volume></mesh></object>" + more + "</amf>";
}

class ImportAmf : public testing::Test {
  protected:
    Result<TriangleMesh> read(const std::string& text, const ImportOptions& options = {}) {
        return importMesh(folder_.write("t.amf", text), options);
    }
    void expectLiesAt(const Result<TriangleMesh>& mesh, const glm::vec3& low, const glm::vec3& high) {
        ASSERT_TRUE(mesh) << mesh.error().message;
        EXPECT_LT(glm::distance(mesh->bounds.min, low), 1e-5F * glm::distance(low, high))
            << mesh->bounds.min.x << " " << mesh->bounds.min.y << " " << mesh->bounds.min.z;
        EXPECT_LT(glm::distance(mesh->bounds.max, high), 1e-5F * glm::distance(low, high))
            << mesh->bounds.max.x << " " << mesh->bounds.max.y << " " << mesh->bounds.max.z;
        EXPECT_EQ(mesh->unit, "m");
    }
    void expectRefused(const std::string& text, const std::string& words) {
        const Result<TriangleMesh> mesh = read(text);
        ASSERT_FALSE(mesh) << words;
        EXPECT_EQ(mesh.error().code, ErrorCode::kInvalidInput);
        EXPECT_NE(mesh.error().message.find("t.amf"), std::string::npos) << mesh.error().message;
        EXPECT_NE(mesh.error().message.find(words), std::string::npos) << mesh.error().message;
    }

    TemporaryFolder folder_;
};

TEST_F(ImportAmf, UnitsBecomeMetres) {
    for (const auto& [unit, metres] :
         {std::pair{"", 0.001F}, std::pair{" unit='millimeter'", 0.001F}, std::pair{" unit='inch'", 0.0254F},
          std::pair{" unit='feet'", 0.3048F}, std::pair{" unit='meter'", 1.0F},
          std::pair{" unit='micron'", 1e-6F}}) {
        expectLiesAt(read(amf(unit)), glm::vec3(0.0F), metres * glm::vec3(1.0F, 2.0F, 3.0F));
    }
    expectRefused(amf(" unit='parsec'"),
                  "its unit 'parsec' is none of its format; say what it is meant to be (--unit");
    expectLiesAt(read(amf(" unit='parsec'"), {"m", std::nullopt}), glm::vec3(0.0F), {1.0F, 2.0F, 3.0F});
    const Result<TriangleMesh> told = read(amf(" unit='inch'"), {"m", UpAxis::kPlusZ});
    expectLiesAt(told, {0.0F, 0.0F, -2.0F}, {1.0F, 3.0F, 0.0F});
    EXPECT_EQ(told->warnings.size(), 1U);
}

TEST_F(ImportAmf, ConstellationsTurnThenMove) {
    const auto placed = [](const std::string& instance, const std::string& more = "") {
        return amf(" unit='meter'", "<constellation id='c'><instance objectid='a'>" + instance +
                                        "</instance></constellation>" + more);
    };
    expectLiesAt(read(placed("")), glm::vec3(0.0F), {1.0F, 2.0F, 3.0F});
    expectLiesAt(read(placed("<deltax>10</deltax><deltaz>-5</deltaz>")), {10.0F, 0.0F, -5.0F},
                 {11.0F, 2.0F, -2.0F});
    // x to y, y to -x
    expectLiesAt(read(placed("<rz>90</rz>")), {-2.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 3.0F});
    expectLiesAt(read(placed("<rx>-450</rx>")), {0.0F, 0.0F, -2.0F}, {1.0F, 3.0F, 0.0F});
    // About x first: z to -y; then about z: -y to x.
    expectLiesAt(read(placed("<rz>90</rz><rx>90</rx><deltay>7</deltay>")), {0.0F, 7.0F, 0.0F},
                 {3.0F, 8.0F, 2.0F});
    // A half of a right angle: corners at 1 and 2 on the diagonals.
    const float c = std::sqrt(0.5F);
    expectLiesAt(read(placed("<rz>45</rz>")), {-2.0F * c, 0.0F, 0.0F}, {c, 2.0F * c, 3.0F});
    // Constellations of constellations, in any order; what is placed is not shown by itself.
    const Result<TriangleMesh> nested =
        read(placed("<deltax>1</deltax>",
                    "<constellation id='d'><instance objectid='c'><deltay>4</deltay></instance>"
                    "<instance objectid='c'><rz>180</rz></instance></constellation>"));
    expectLiesAt(nested, {-2.0F, -2.0F, 0.0F}, {2.0F, 6.0F, 3.0F});
    EXPECT_EQ(nested->triangles.size(), 8U);
}

TEST_F(ImportAmf, WhatCannotBeIsRefused) {
    const auto with = [](const std::string& from, const std::string& to) {
        std::string text =
            amf("", "<constellation id='c'><instance objectid='a'><rx>0</rx></instance></constellation>");
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    expectRefused(with("<x>1</x>", "<x>1,5</x>"), "line 1: '1,5' is no number; write a point for the comma");
    expectRefused(with("<x>1</x>", "<x>nan</x>"), "no finite number");
    expectRefused(with("<x>1</x>", ""), "without x, y and z");
    expectRefused(with("<v3>1</v3>", "<v3>4</v3>"), "vertex 4 of 4");
    expectRefused(with("<v3>1</v3>", "<v3>-1</v3>"), "'-1' is no index");
    expectRefused(with("<v3>1</v3>", ""), "without v1, v2 and v3");
    expectRefused(with("<rx>0</rx>", "<rx>1,5</rx>"), "write a point");
    expectRefused(with("objectid='a'", "objectid='b'"), "the object 'b', which does not exist");
    expectRefused(with("objectid='a'", "objectid='c'"), "within itself");
    expectRefused(with("id='c'", "id='a'"), "another object with the id 'a'");
    expectRefused(with("</mesh>", ""), "an end tag does not end <mesh>, which is open");
    expectRefused("<stl/>", "not <amf>");
}

// A few kilobytes can place more triangles than any memory holds.
TEST_F(ImportAmf, InstancesAreCountedBeforeTheyAreMade) {
    std::string more = "<object id='none'/>";
    for (const std::string leaf : {"a", "none"}) {
        std::string below = leaf;
        for (int level = 0; level < 40; ++level) {
            const std::string id = leaf + std::to_string(level);
            more += "<constellation id='" + id + "'><instance objectid='" + below +
                    "'/><instance objectid='" + below + "'/></constellation>";
            below = id;
        }
    }
    const Result<TriangleMesh> mesh = read(amf("", more));
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, ErrorCode::kLimit);
}

TEST_F(ImportAmf, NamesAreThoseOfObjectsAndMaterials) {
    const std::string text = amf("",
                                 "<material id='m'><metadata type='name'>steel</metadata></material>"
                                 "<constellation id='c'><instance objectid='a'/></constellation>");
    for (const char* name : {"a", "c", "steel"}) {
        ImportOptions options;
        options.names = {name};
        const Result<TriangleMesh> mesh = read(text, options);
        ASSERT_TRUE(mesh) << mesh.error().message;
        EXPECT_EQ(mesh->marks, std::vector<std::uint8_t>(4, 1)) << name;
    }
}

}  // namespace
}  // namespace relief::test
