// SPDX-License-Identifier: Apache-2.0
// Parts split by labels, and outlier parts.
#include "bake/mesh/surface_parts.h"

#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

SurfacePart part(const glm::vec3& low, const glm::vec3& high, double area) {
    SurfacePart made;
    made.bounds.add(low);
    made.bounds.add(high);
    made.area = area;
    made.triangles = 1;
    return made;
}

TEST(SurfaceParts, OutliersAreFarAndSmall) {
    const SurfacePart body = part(glm::vec3(-5.0F), glm::vec3(5.0F), 600.0);
    const SurfacePart knob = part(glm::vec3(5.0F), glm::vec3(6.0F), 0.1);
    const SurfacePart stray = part(glm::vec3(1e6F, 0.0F, 0.0F), glm::vec3(1e6F, 1.0F, 1.0F), 0.5);
    const OutlierParts found = straysOf({stray, body, knob});
    EXPECT_EQ(found.parts, std::vector<std::uint32_t>({0}));
    EXPECT_EQ(found.rest.max, glm::vec3(6.0F));

    EXPECT_TRUE(straysOf({body, knob}).parts.empty());
    EXPECT_TRUE(straysOf({body}).parts.empty());
    EXPECT_TRUE(straysOf({}).parts.empty());
    // Two boxes 100 km apart are a scene of two boxes, not outliers.
    EXPECT_TRUE(straysOf({body, part(glm::vec3(1e5F), glm::vec3(1e5F + 10.0F), 600.0)}).parts.empty());
    // A small part within one body length belongs to the body.
    EXPECT_TRUE(straysOf({body, part(glm::vec3(12.0F), glm::vec3(13.0F), 0.1)}).parts.empty());
}

TEST(SurfaceParts, LabelsSplitPieces) {
    TriangleMesh mesh = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0));
    mesh.surface_names = {{3, "box", "wood"}, {3, "box", "glass"}};
    mesh.labels.assign(12, 0);
    mesh.labels[5] = 1;
    SurfacePartsBuilder builder(mesh);
    builder.add({0, 1, 2, 3, 4, 5, 6}, PartKind::kSheet);
    ASSERT_EQ(builder.parts().size(), 2U);
    EXPECT_EQ(builder.parts()[0].triangles, 6U);
    EXPECT_EQ(builder.parts()[1].material, "glass");
    EXPECT_EQ(builder.parts()[1].node_index, 3U);
    EXPECT_DOUBLE_EQ(builder.parts()[1].area, 2.0);
    EXPECT_EQ(builder.partOf()[5], 1U);
    EXPECT_EQ(builder.partOf()[7], kNoLabel);
}

}  // namespace
}  // namespace relief::test
