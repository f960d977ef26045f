// SPDX-License-Identifier: Apache-2.0
// Each part by its own size, against fields whose mistakes are known: a field that forgets a pillar, one that is right, one
// that makes a sheet thicker than anybody asked for.
#include "bake/measure/part_accuracy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>

#include "tests/bake/meshes.h"
#include "tests/bake/shaped.h"
#include "tests/bake/threads.h"

namespace relief::test {
namespace {

ShapedMesh shaped(const TriangleMesh& mesh, const ShapeOptions& options = {ShapeAs::kAuto, 0.01, {}}) {
    return shapedBy(mesh, options);
}

PartsAccuracy measured(const ShapedMesh& shape, const Field& field, const PartOptions& options = {}) {
    return measureParts(queryOf(shape.mesh), shape.parts, field, options);
}

/// The side of boxes, inside of any.
Field fieldOfBoxes(const std::vector<Bounds>& boxes) {
    return [boxes](const glm::vec3& p) -> std::optional<FieldValue> {
        for (const Bounds& box : boxes) {
            if (glm::max(p, box.min) == p && glm::min(p, box.max) == p) {
                return FieldValue{-1.0F, glm::vec3(0.0F)};
            }
        }
        return FieldValue{1.0F, glm::vec3(0.0F)};
    };
}

/// A slab of 5 km, and a pillar of 2 × 9 × 2 m on it.
const glm::dvec3 kSlabCenter(0.0, -5.0, 0.0);
const glm::dvec3 kSlabHalf(2500.0, 5.0, 2500.0);
const glm::dvec3 kPillarCenter(700.0, 4.6, -900.0);
const glm::dvec3 kPillarHalf(1.0, 4.5, 1.0);

TEST(PartAccuracy, APillarThatIsAbsentIsLostHoweverLittleOfTheAreaItIs) {
    const TriangleMesh slab = makeBoxMesh(kSlabCenter, kSlabHalf);
    const TriangleMesh pillar = makeBoxMesh(kPillarCenter, kPillarHalf);
    const ShapedMesh shape = shaped(joined({slab, pillar}));
    ASSERT_EQ(shape.parts.parts.size(), 2U);

    const PartsAccuracy right = measured(shape, fieldOfBoxes({slab.bounds, pillar.bounds}));
    EXPECT_EQ(right.countOf(PartVerdict::kHeld), 2U);
    EXPECT_LE(right.parts[0].wrong.total(), 0.3);  // floats of 900 m resolve a 700th of the points' distance

    const PartsAccuracy absent = measured(shape, fieldOfBoxes({slab.bounds}));
    EXPECT_EQ(absent.countOf(PartVerdict::kLost), 1U);
    const PartAccuracy& worst = absent.parts.front();
    EXPECT_EQ(worst.part, 1U);
    // A point beside a plane is as likely inside as outside; edges of the pillar make that a little less.
    EXPECT_NEAR(worst.wrong.false_outside, 50.0, 6.0);
    EXPECT_EQ(worst.wrong.false_inside, 0.0);
    EXPECT_NEAR(worst.sigma, 0.005 * 9.0, 1e-6);

    PartOptions options;
    options.detail = 9.5;
    const PartsAccuracy coarse = measured(shape, fieldOfBoxes({slab.bounds}), options);
    EXPECT_EQ(coarse.countOf(PartVerdict::kLost), 0U) << "below the detail";
    EXPECT_EQ(coarse.countOf(PartVerdict::kSmall), 1U);
    EXPECT_DOUBLE_EQ(defaultDetail(shape.parts, ""), 5.0);
    EXPECT_DOUBLE_EQ(defaultDetail(shape.parts, "m"), 0.1);

    // Filled up, as a texel of 20 m would do it.
    Bounds swollen = pillar.bounds;
    swollen.min -= glm::vec3(10.0F, 0.0F, 10.0F);
    swollen.max += glm::vec3(10.0F, 10.0F, 10.0F);
    const PartsAccuracy filled = measured(shape, fieldOfBoxes({slab.bounds, swollen}));
    EXPECT_EQ(filled.countOf(PartVerdict::kLost), 1U);
    EXPECT_GT(filled.parts.front().wrong.false_inside, 40.0);
}

TEST(PartAccuracy, WhatLiesInsideOtherPartsIsHidden) {
    const TriangleMesh outer = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0));
    const TriangleMesh sheet = moved(makePlane(0.1F, 2), [](const glm::dvec3& p) { return 0.5 * p; });
    const ShapedMesh shape = shaped(joined({outer, sheet}));
    const PartsAccuracy found = measured(shape, fieldOfBoxes({outer.bounds}));
    EXPECT_EQ(found.countOf(PartVerdict::kHeld), 1U);
    EXPECT_EQ(found.countOf(PartVerdict::kHidden), 1U);
}

TEST(PartAccuracy, AShellIsWrongBeyondTheThicknessThatWasAskedFor) {
    // A leaf of 0.1 beside a body of 10: a default of 0.02 is a fifth of it.
    const TriangleMesh leaf =
        moved(makePlane(0.0F, 2), [](const glm::dvec3& p) { return 0.05 * p + glm::dvec3(0.0, 8.0, 0.0); });
    const TriangleMesh body = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(5.0));
    const TriangleMesh mesh = joined({body, leaf});
    constexpr double kThick = 0.02;
    Bounds shell = leaf.bounds;
    shell.min.y = 8.0F - static_cast<float>(0.5 * kThick);
    shell.max.y = 8.0F + static_cast<float>(0.5 * kThick);
    const Field baked = fieldOfBoxes({body.bounds, shell});

    const PartsAccuracy asked = measured(shaped(mesh, {ShapeAs::kAuto, kThick, {}}), baked);
    EXPECT_EQ(asked.countOf(PartVerdict::kHeld), 2U);

    const ShapedMesh by_default = shaped(mesh, {ShapeAs::kAuto, kThick, {}, true});
    EXPECT_DOUBLE_EQ(by_default.parts.parts[1].thickness, kThick);
    EXPECT_NEAR(by_default.parts.parts[1].right_thickness, 0.01, 1e-6);
    const PartsAccuracy thick = measured(by_default, baked);
    EXPECT_EQ(thick.countOf(PartVerdict::kLost), 1U);
    EXPECT_EQ(thick.parts.front().part, 1U);
    EXPECT_GT(thick.parts.front().wrong.false_inside, 40.0);

    // The leaf may be too thick in the solid, but a field without it is no better.
    const PartsAccuracy absent = measured(by_default, fieldOfBoxes({body.bounds}));
    EXPECT_EQ(absent.countOf(PartVerdict::kLost), 1U);
    EXPECT_EQ(absent.parts.front().part, 1U);
    EXPECT_GT(absent.parts.front().wrong.false_outside, 40.0);
    shell.min.y = 8.0F - 0.005F;
    shell.max.y = 8.0F + 0.005F;
    EXPECT_EQ(measured(by_default, fieldOfBoxes({body.bounds, shell})).countOf(PartVerdict::kHeld), 2U);
}

TEST(PartAccuracy, TheDefaultThicknessGoesByThePart) {
    EXPECT_DOUBLE_EQ(partThickness(1.0, 100.0), 1.0);
    EXPECT_DOUBLE_EQ(partThickness(1.0, 1000.0), 4.0);  // at least 0.4 %
    EXPECT_DOUBLE_EQ(partThickness(1.0, 0.8), 0.2);     // at most a quarter
    // By a texel that is given, a large part takes no more than it.
    EXPECT_DOUBLE_EQ(partThickness(1.0, 1000.0, true), 1.0);
    EXPECT_DOUBLE_EQ(partThickness(1.0, 0.8, true), 0.2);
    // A single box: one and a half texels, clamped to 0.4 to 4 % of its side.
    const Bounds cube{glm::vec3(0.0F), glm::vec3(1.0F)};
    for (const auto& [texels, expected] :
         {std::pair{1'000'000U, 1.5 * std::sqrt(36.0 / 1e6)}, {1'000'000'000U, 0.004}, {1'000U, 0.04}}) {
        EXPECT_NEAR(partThickness(defaultThickness(cube, texels), 1.0), expected, 1e-9);
    }
}

TEST(PartAccuracy, NodesAndMaterialsAreTheirPartsByArea) {
    // Two nodes: "tower" of two boxes, of which the field forgets the smaller, and "hut".
    const TriangleMesh big = makeBoxMesh({0, 0, 0}, glm::dvec3(2.0));
    const TriangleMesh small = makeBoxMesh({10, 0, 0}, glm::dvec3(1.0));
    const TriangleMesh hut = makeBoxMesh({0, 10, 0}, glm::dvec3(1.0));
    TriangleMesh mesh = joined({big, small, hut});
    mesh.surface_names = {{0, "tower", "stone"}, {1, "hut", "wood"}};
    mesh.labels.assign(24, 0);
    mesh.labels.resize(36, 1);
    const ShapedMesh shape = shaped(mesh);
    ASSERT_EQ(shape.parts.parts.size(), 3U);
    const PartsAccuracy found = measured(shape, fieldOfBoxes({big.bounds, hut.bounds}));
    EXPECT_EQ(found.parts.front().part, 1U);
    ASSERT_EQ(found.groups.size(), 4U);
    EXPECT_EQ(found.groups[0].name, "tower");
    EXPECT_EQ(found.groups[0].parts, 2U);
    EXPECT_EQ(found.groups[0].lost, 1U);
    // The areas are as 4 to 1.
    EXPECT_NEAR(found.groups[0].wrong.total(), found.parts.front().wrong.total() / 5.0, 1e-9);
    EXPECT_EQ(found.groups[1].name, "hut");
    EXPECT_EQ(found.groups[1].wrong.total(), 0.0);
    EXPECT_TRUE(found.groups[2].is_material);
}

TEST(PartAccuracy, IsTheSameForAnyNumberOfThreads) {
    std::vector<TriangleMesh> boxes;
    for (int i = 0; i < 40; ++i) {
        boxes.push_back(makeBoxMesh({3.0 * i, 0.0, 0.0}, glm::dvec3(0.1 + 0.03 * i)));
    }
    const ShapedMesh shape = shaped(joined(boxes));
    PartOptions options;
    options.parts_max = 30;
    options.points_all = 3000;
    const auto measure = [&] {
        return measured(shape, fieldOfBoxes({boxes[5].bounds, boxes[30].bounds}), options);
    };
    const PartsAccuracy all = measure();
    const PartsAccuracy again = onThreads(1, measure);
    EXPECT_EQ(all.countOf(PartVerdict::kRest), 10U);
    ASSERT_EQ(all.parts.size(), again.parts.size());
    for (std::size_t i = 0; i < all.parts.size(); ++i) {
        EXPECT_EQ(all.parts[i].part, again.parts[i].part);
        EXPECT_EQ(all.parts[i].wrong.total(), again.parts[i].wrong.total());
    }
}

}  // namespace
}  // namespace relief::test
