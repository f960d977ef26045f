// The difference of two fields against shapes whose difference is known in closed form.
#include "formats/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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

TEST(CompareFields, TheSameColliderDiffersNowhere) {
    const Collider sphere = threeMaps(*makeSphere({0, 0, 0}, 1.0), 1.0, 48);
    const FieldsDifference difference = compareFields(sphere, sphere, {.points = 500});
    EXPECT_EQ(difference.box.points, 500U);
    EXPECT_GT(difference.near.points, 900U);
    for (const PointsDifference& points : {difference.box, difference.near}) {
        EXPECT_EQ(points.sidesPercent(), 0.0);
        EXPECT_EQ(points.distance, DifferenceStatistics());
        EXPECT_EQ(points.one_known, 0U);
    }
}

/// A sphere and one that is larger by a tenth: the shell between them is on another side, and distances differ by 0.1.
TEST(CompareFields, SpheresOfTwoSizesDifferByTheShellBetweenThem) {
    const Collider small = threeMaps(*makeSphere({0, 0, 0}, 1.0), 1.0, 128);
    const Collider large = oneCube(*makeSphere({0, 0, 0}, 1.1), 1.1, 128);
    const FieldsDifference difference = compareFields(small, large, {.points = 4000});
    const double side = 2.2 * 1.2;
    const double shell = 4.0 / 3.0 * std::numbers::pi * (std::pow(1.1, 3.0) - 1.0) / (side * side * side);
    EXPECT_NEAR(difference.box.sidesPercent(), 100.0 * shell, 0.5);
    EXPECT_EQ(difference.box.only_a, 0U);
    EXPECT_NEAR(difference.box.distance.mean, 0.1, 0.01);
    // Near the surfaces, 0.022 away at most, the halves that lie between the two of them: of either some half.
    EXPECT_NEAR(difference.near.sidesPercent(), 50.0, 3.0);
    EXPECT_NEAR(difference.near.distance.mean, 0.1, 0.005);
    EXPECT_NEAR(difference.near.distance.percentile_99, 0.1, 0.02);
}

TEST(CompareFields, OtherMapsOfTheSameSphereAgree) {
    const auto sphere = makeSphere({0, 0, 0}, 1.0);
    const FieldsDifference difference =
        compareFields(threeMaps(*sphere, 1.0, 128), oneCube(*sphere, 1.0, 128), {.points = 2000});
    EXPECT_LT(difference.near.sidesPercent(), 2.0);
    EXPECT_LT(difference.near.distance.mean, 0.002);
    EXPECT_GT(difference.near.distance.mean, 0.0);
}

TEST(CompareFields, TheOrderSwapsOnlyWhoIsInside) {
    const Collider a = threeMaps(*makeSphere({0.1, 0, 0}, 0.9), 1.0, 48);
    const Collider b = oneCube(*makeBox({0, 0, 0}, {0.7, 0.8, 0.9}), 1.0, 48);
    const FieldsDifference there = compareFields(a, b, {.points = 500});
    FieldsDifference back = compareFields(b, a, {.points = 500});
    EXPECT_GT(there.box.only_a, 0U);
    EXPECT_GT(there.box.only_b, 0U);
    for (PointsDifference* points : {&back.box, &back.near}) {
        std::swap(points->only_a, points->only_b);
    }
    EXPECT_EQ(there, back);
}

/// Each map is asked about each point: of a thousand maps few points are asked.
TEST(CompareFields, ManyMapsAreAskedAboutFewerPoints) {
    Collider many = threeMaps(*makeSphere({0, 0, 0}, 1.0), 1.0, 8);
    while (many.maps.size() < 128) {
        many.maps.push_back(many.maps[many.maps.size() % 3]);
    }
    EXPECT_EQ(compareFields(many, many, {.points = 160}).box.points, 10U);
    many.maps.resize(8);
    EXPECT_EQ(compareFields(many, many, {.points = 160}).box.points, 160U);
}

}  // namespace
}  // namespace relief
