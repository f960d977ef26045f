// Differences at points of shapes whose difference is known in closed form.
#include "formats/compare.h"

#include <gtest/gtest.h>

#include <utility>

#include "tests/formats/analytic_shapes.h"

namespace relief {
namespace {

using namespace test;

/// Three front-back maps of planes around a shape of the given half side.
Collider threeMaps(const Shape& shape, double half, std::uint32_t size) {
    Collider collider;
    const double side = 2.0 * half * size / (size - 6);
    collider.bounds = {glm::vec3(static_cast<float>(-half)), glm::vec3(static_cast<float>(half))};
    const glm::dmat3 axes(1.0);
    for (int k = 0; k < 3; ++k) {
        const glm::dmat3 look(axes[(k + 1) % 3], axes[(k + 2) % 3], axes[k]);
        collider.maps.push_back(makeMap(shape, centeredFrame({0, 0, 0}, look, glm::dvec3(side)),
                                        MapFormat::kFrontBackFixed, Compare::kBoth, size, size));
        collider.maps.back().decode = Decode::kPlane;
    }
    return collider;
}

/// A cube map from the middle, as fine.
Collider oneCube(const Shape& shape, double half, std::uint32_t size) {
    Collider collider;
    collider.bounds = {glm::vec3(static_cast<float>(-half)), glm::vec3(static_cast<float>(half))};
    collider.maps.push_back(
        makeMap(shape, {{0, 0, 0}, glm::dmat3(1.0), glm::dvec3(1.2 * half)}, Compare::kGreater, size));
    collider.maps.back().decode = Decode::kPlane;
    return collider;
}

TEST(ComparePoints, TheSameColliderDiffersNowhere) {
    const Collider sphere = threeMaps(*makeSphere({0, 0, 0}, 1.0), 1.0, 48);
    const PointsDifference difference = comparePoints(sphere, sphere, 500);
    EXPECT_GT(difference.points, 900U);
    EXPECT_EQ(difference.sidesPercent(), 0.0);
    EXPECT_EQ(difference.mean, 0.0);
    EXPECT_EQ(difference.percentile_99, 0.0);
    EXPECT_EQ(difference.distances, difference.points);
}

/// A sphere and one that is larger by a tenth: the shell between them is on another side, and distances differ by 0.1.
TEST(ComparePoints, SpheresOfTwoSizesDifferByTheShellBetweenThem) {
    const Collider small = threeMaps(*makeSphere({0, 0, 0}, 1.0), 1.0, 128);
    const Collider large = oneCube(*makeSphere({0, 0, 0}, 1.1), 1.1, 128);
    const PointsDifference difference = comparePoints(small, large, 4000);
    // 0.022 away from either surface at most, some half of the points lie between the two.
    EXPECT_NEAR(difference.sidesPercent(), 50.0, 3.0);
    EXPECT_EQ(difference.only_a, 0U);
    EXPECT_NEAR(difference.mean, 0.1, 0.005);
    EXPECT_NEAR(difference.percentile_99, 0.1, 0.02);
}

TEST(ComparePoints, OtherMapsOfTheSameSphereAgree) {
    const auto sphere = makeSphere({0, 0, 0}, 1.0);
    const PointsDifference difference =
        comparePoints(threeMaps(*sphere, 1.0, 128), oneCube(*sphere, 1.0, 128), 2000);
    EXPECT_LT(difference.sidesPercent(), 2.0);
    EXPECT_LT(difference.mean, 0.002);
    EXPECT_GT(difference.mean, 0.0);
}

TEST(ComparePoints, TheOrderSwapsOnlyWhoIsInside) {
    const Collider a = threeMaps(*makeSphere({0.1, 0, 0}, 0.9), 1.0, 48);
    const Collider b = oneCube(*makeBox({0, 0, 0}, {0.7, 0.8, 0.9}), 1.0, 48);
    const PointsDifference there = comparePoints(a, b, 500);
    PointsDifference back = comparePoints(b, a, 500);
    EXPECT_GT(there.only_a, 0U);
    EXPECT_GT(there.only_b, 0U);
    std::swap(back.only_a, back.only_b);
    EXPECT_EQ(there, back);
}

/// Each map is evaluated at each point: the more maps, the fewer points.
TEST(ComparePoints, ManyMapsAreEvaluatedAtFewerPoints) {
    Collider many = threeMaps(*makeSphere({0, 0, 0}, 1.0), 1.0, 8);
    while (many.maps.size() < 128) {
        many.maps.push_back(many.maps[many.maps.size() % 3]);
    }
    EXPECT_LE(comparePoints(many, many, 160).points, 20U);
    many.maps.resize(8);
    EXPECT_GT(comparePoints(many, many, 160).points, 200U);
}

}  // namespace
}  // namespace relief
