// Verdicts of `relief diff` that no bake brings about.
#include "bake/report/diff_report.h"

#include <gtest/gtest.h>

namespace relief {
namespace {

/// A map of a cube, empty but for its texels' bytes.
Collider withoutSurface() {
    Collider collider;
    collider.bounds = {glm::vec3(-1.0F), glm::vec3(1.0F)};
    DepthMap map;
    map.format = MapFormat::kCube8;
    map.width = map.height = 4;
    map.object_to_map.row[0] = {1, 0, 0, 0};
    map.object_to_map.row[1] = {0, 1, 0, 0};
    map.object_to_map.row[2] = {0, 0, 1, 0};
    map.object_per_map = glm::vec3(1.0F);
    map.texels.resize(map.texelBytes());
    collider.maps = {map};
    return collider;
}

TEST(DiffReport, WithoutAPointToCompareNothingIsWithinTheLimits) {
    Collider other = withoutSurface();
    other.maps[0].empty_is_outside = !other.maps[0].empty_is_outside;
    DiffReport report;
    report.a = "'a'";
    report.b = "'b'";
    report.max_sides = 100.0;
    report.compare(withoutSurface(), other);
    ASSERT_TRUE(report.points);
    EXPECT_EQ(report.points->distances, 0U);
    EXPECT_EQ(report.verdict(), "no point has a distance to both");
    EXPECT_NE(report.text().find("map 0: empty_is_outside"), std::string::npos) << report.text();
}

}  // namespace
}  // namespace relief
