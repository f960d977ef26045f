// SPDX-License-Identifier: Apache-2.0
// Material trees: closed-form lookups, faults that readers reject, and the container's bytes.
#include "formats/materials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "formats/container.h"
#include "formats/inspect.h"
#include "formats/material_response.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"

namespace relief::test {
namespace {

TEST(Materials, LookupFindsTheCell) {
    const Materials materials = someMaterials();
    ASSERT_EQ(faultOfMaterials(materials), "");
    const glm::vec3 up(0.0F, 1.0F, 0.0F);
    const auto at = [&](float x, float y, float z) { return materialAt(materials, {x, y, z}, up); };
    EXPECT_EQ(at(0.5F, 0.5F, 0.5F), 2U);
    EXPECT_EQ(at(1.5F, 0.5F, 0.5F), 1U);
    EXPECT_EQ(at(0.5F, 0.5F, 1.0F), 1U);
    EXPECT_EQ(at(0.0F, 0.0F, 0.0F), 2U);  // points between two cells belong to the upper cell
    EXPECT_EQ(at(-1e-6F, 0.5F, 0.5F), 0U);
    // Points outside the cube, and NaN coordinates, use the nearest cell.
    EXPECT_EQ(at(99.0F, 99.0F, 99.0F), 1U);
    EXPECT_EQ(at(1e30F, 0.5F, 0.5F), 1U);
    EXPECT_EQ(at(std::nanf(""), -99.0F, 0.5F), 0U);
    // A pair of sides along x − y.
    const glm::vec3 low(-1.0F);
    EXPECT_EQ(materialAt(materials, low, {1.0F, 0.0F, 0.0F}), 1U);
    EXPECT_EQ(materialAt(materials, low, {0.0F, 1.0F, 0.0F}), 2U);
    EXPECT_EQ(materialAt(materials, low, {0.0F, -9.0F, 0.0F}), 1U);
}

TEST(Materials, NineAxesDistinguishSides) {
    const glm::vec3 v(1.0F, 2.0F, 4.0F);
    const std::array<float, kMaterialAxes> along{1.0F, 2.0F, 4.0F, 3.0F, -1.0F, 5.0F, -3.0F, 6.0F, -2.0F};
    for (int axis = 0; axis < kMaterialAxes; ++axis) {
        EXPECT_EQ(alongMaterialAxis(v, axis), along[static_cast<std::size_t>(axis)]) << axis;
    }
}

TEST(Materials, EveryFaultIsDetected) {
    struct Case {
        const char* message;
        std::function<void(Materials&)> change;
    };
    for (const Case& wrong : std::vector<Case>{
             {"a material tree, but no materials", [](auto& m) { m.list.clear(); }},
             {"materials[1] has the name 'oak'", [](auto& m) { m.list[1].name = "oak"; }},
             {"materials[0] has a name that is not clean UTF-8", [](auto& m) { m.list[0].name = "\x80"; }},
             {"longer than 256 bytes", [](auto& m) { m.list[0].name.assign(257, 'a'); }},
             {"materials[2] has a restitution", [](auto& m) { m.list[2].restitution = 1.5F; }},
             {"materials[2] has a restitution", [](auto& m) { m.list[2].friction = std::nanf(""); }},
             {"materials[1] has a lifetime_loss", [](auto& m) { m.list[1].lifetime_loss = -1.0F; }},
             {"there are 256 materials", [](auto& m) { m.list.resize(256); }},
             {"together with the materials, more than 256", [](auto& m) { m.sides.resize(254); }},
             {"a pair of sides", [](auto& m) { m.sides[0].axis = 9; }},
             {"a pair of sides", [](auto& m) { m.sides[0].against = 3; }},
             {"the cube of the materials", [](auto& m) { m.size = 0.0F; }},
             {"the cube of the materials", [](auto& m) { m.origin.x = std::nanf(""); }},
             {"node 0 has its octants", [](auto& m) { m.nodes[0].head = 0x80U; }},
             {"node 0 has its octants", [](auto& m) { m.nodes[0].head = 2U << 8U | 0x80U; }},
             {"node 1 has its octants", [](auto& m) { m.nodes[1].head = 1U << 8U; }},
             {"material node 1 has no parent", [](auto& m) { m.nodes[0].head = 0; }},
             {"material nodes are missing",
              [](auto& m) {
                  m.nodes[1].head = 2U << 8U | 1U;
                  m.nodes[1].leaves[0] = 0;
              }},
             {"octant with an invalid material", [](auto& m) { m.nodes[1].leaves[3] = 4; }},
             {"octant with an invalid material", [](auto& m) { m.nodes[0].leaves[7] = 1; }}}) {
        Materials materials = someMaterials();
        wrong.change(materials);
        const std::string fault = faultOfMaterials(materials);
        EXPECT_NE(fault.find(wrong.message), std::string::npos) << wrong.message << ": " << fault;
    }
    // A chain of nodes is rejected if it is too deep for a lookup.
    Materials deep = someMaterials();
    deep.nodes.assign(kMaterialLevelsMax + 1, {});
    for (std::size_t i = 0; i + 1 < deep.nodes.size(); ++i) {
        deep.nodes[i].head = static_cast<std::uint32_t>(i + 1) << 8U | 1U;
    }
    EXPECT_NE(faultOfMaterials(deep).find("is too deep"), std::string::npos) << faultOfMaterials(deep);
    deep.nodes.pop_back();
    deep.nodes.back().head = 0;
    EXPECT_EQ(faultOfMaterials(deep), "");
}

TEST(Materials, RoundTripInContainersAndLeaveOthersUnchanged) {
    Collider collider = readmeExample();
    const std::vector<std::byte> without = written(collider);
    collider.materials = someMaterials();
    for (const int level : {0, 9}) {
        const std::vector<std::byte> bytes = written(collider, level);
        const Collider read = required(readContainer(bytes));
        EXPECT_EQ(read, collider);
        EXPECT_FALSE(required(inspectContainer(bytes)).damaged());
    }
    collider.materials = {};
    EXPECT_EQ(written(collider), without);
    collider.materials = someMaterials();
    collider.materials.nodes[0].head = 0x80U;
    EXPECT_FALSE(writeContainer(collider));
}

TEST(Materials, ResponsesAreSetByName) {
    Materials materials = someMaterials();
    const std::vector<MaterialResponse> responses{{"stone", 0.1F, {}, 5.0F}, {"stove", {}, {}, {}}};
    EXPECT_EQ(repeatedName(responses), std::nullopt);
    MaterialResponses given(responses);
    given.apply(materials);
    EXPECT_EQ(materials.list[0], someMaterials().list[0]);
    EXPECT_EQ(materials.list[1], (Material{"stone", 0.1F, 0.0F, 5.0F, 0.25F}));
    EXPECT_EQ(given.faultOf("stone"), std::nullopt);
    EXPECT_EQ(given.faultOf("stoen").value_or(""),
              "is not the name of a material; did you mean 'stone'? There are '', 'oak', 'stone'");
    EXPECT_EQ(MaterialResponses({}).faultOf("x").value_or(""),
              "is not the name of a material: the colliders have none; bake a mesh with several, or with "
              "--materials keep");
    const std::vector<MaterialResponse> twice{{"a", {}, {}, {}}, {"b", {}, {}, {}}, {"a", {}, {}, {}}};
    EXPECT_EQ(repeatedName(twice), 2U);
}

}  // namespace
}  // namespace relief::test
