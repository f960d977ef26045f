// Pairs of colliders with one known difference each.
#include "formats/compare.h"

#include <gtest/gtest.h>

#include "tests/formats/sample_colliders.h"

namespace relief {
namespace {

TEST(Compare, TheSameHasNoDifferenceAndOneBitIsOne) {
    const Collider a = test::oneMapOfEveryFormat();
    EXPECT_FALSE(compareColliders(a, a).any());
    for (std::size_t i = 0; i < a.maps.size(); ++i) {
        Collider b = a;
        b.maps[i].texels.back() ^= std::byte{1};
        const ColliderDifference d = compareColliders(a, b);
        EXPECT_TRUE(d.any());
        ASSERT_EQ(d.maps.size(), a.maps.size());
        for (std::size_t k = 0; k < a.maps.size(); ++k) {
            EXPECT_TRUE(d.maps[k].structure.empty());
            EXPECT_EQ(d.maps[k].same_texels, k != i);
        }
    }
}

std::vector<std::string> names(const std::vector<Difference>& differences) {
    std::vector<std::string> list;
    for (const Difference& one : differences) {
        list.push_back(one.what);
    }
    return list;
}

TEST(Compare, StructureIsNamed) {
    using Names = std::vector<std::string>;
    const Collider a = test::oneMapOfEveryFormat();
    Collider b = a;
    b.unit = "";
    b.bounds.max.y = 0.9375F;
    b.maps.pop_back();
    b.maps[0].decode = Decode::kPlane;
    b.maps[0].encloses = false;
    b.maps[0].object_to_map.row[1].w += 0.5F;
    b.maps[0].object_per_map.z *= 1.0001F;
    b.maps[1].compare = Compare::kGreater;
    b.maps[1].empty_is_outside = false;
    b.maps[2].format = MapFormat::kFrontBackFixed;
    b.maps[3].width = b.maps[3].height = 5;
    b.maps[3].texels.resize(b.maps[3].texelBytes());
    b.provenance.mesh_hash = "";
    b.provenance.options[0].value += ",x";
    const ColliderDifference d = compareColliders(a, b);
    EXPECT_EQ(names(d.structure), (Names{"maps", "bounds", "unit"}));
    EXPECT_EQ(d.structure[0], (Difference{"maps", "5", "4"}));
    EXPECT_EQ(d.structure[1].b, "(-0.125, -0.375, -1.125) to (1.125, 0.9375, 0.125)");
    EXPECT_EQ(d.structure[2], (Difference{"unit", "'m'", "''"}));
    EXPECT_EQ(names(d.provenance), (Names{"mesh_hash", "options"}));
    ASSERT_EQ(d.maps.size(), 4U);
    EXPECT_EQ(names(d.maps[0].structure),
              (Names{"decode", "object_to_map row 1", "object_per_map", "encloses"}));
    EXPECT_TRUE(d.maps[0].same_texels);
    EXPECT_EQ(names(d.maps[1].structure), (Names{"compare", "empty_is_outside"}));
    EXPECT_EQ(d.maps[2].structure[0], (Difference{"format", "front-back (half)", "front-back (unorm16)"}));
    EXPECT_EQ(d.maps[3].structure[0], (Difference{"size", "4x4", "5x5"}));
    EXPECT_FALSE(d.maps[3].same_texels);
    EXPECT_TRUE(d.any());

    Collider only_from = a;
    only_from.provenance.tool_version = "relief 0.2.0";
    EXPECT_FALSE(compareColliders(a, only_from).any());
    EXPECT_EQ(names(compareColliders(a, only_from).provenance), Names{"tool_version"});
}

}  // namespace
}  // namespace relief
