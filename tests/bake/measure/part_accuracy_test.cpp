// SPDX-License-Identifier: Apache-2.0
// Errors of each part at its own scale, for fields with known errors: a missing pillar, an exact field, and a sheet
// that is too thick.
#include "bake/measure/part_accuracy.h"

#include <algorithm>
#include <cmath>

#include "bake/verdict/parts_report.h"
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

/// A field that is inside in any of the boxes.
Field fieldOfBoxes(const std::vector<Bounds>& boxes) {
    return [boxes](const glm::vec3& p) -> std::optional<FieldValue> {
        const bool inside = std::ranges::any_of(boxes, [&](const Bounds& box) { return box.contains(p); });
        return FieldValue{inside ? -1.0F : 1.0F, glm::vec3(0.0F)};
    };
}

/// The bounds extended by `by` on all sides.
Bounds grown(const Bounds& bounds, const glm::vec3& by) {
    return {bounds.min - by, bounds.max + by};
}

/// A slab of 5 km with a pillar of 2 × 9 × 2 m.
const glm::dvec3 kSlabCenter(0.0, -5.0, 0.0);
const glm::dvec3 kSlabHalf(2500.0, 5.0, 2500.0);
const glm::dvec3 kPillarCenter(700.0, 4.6, -900.0);
const glm::dvec3 kPillarHalf(1.0, 4.5, 1.0);

TEST(PartAccuracy, MissingPillarIsLostDespiteItsSmallArea) {
    const TriangleMesh slab = makeBoxMesh(kSlabCenter, kSlabHalf);
    const TriangleMesh pillar = makeBoxMesh(kPillarCenter, kPillarHalf);
    TriangleMesh mesh = joined({slab, pillar});
    mesh.unit = "m";
    const ShapedMesh shape = shaped(mesh);
    ASSERT_EQ(shape.parts.parts.size(), 2U);

    const PartsAccuracy right = measured(shape, fieldOfBoxes({slab.bounds, pillar.bounds}));
    EXPECT_EQ(right.countOf(PartVerdict::kKept), 2U);
    EXPECT_LE(right.parts[0].wrong.total(),
              0.3);  // floats near 900 m resolve a 700th of the points' distance

    const PartsAccuracy absent = measured(shape, fieldOfBoxes({slab.bounds}));
    EXPECT_EQ(absent.countOf(PartVerdict::kLost), 1U);
    const PartAccuracy& worst = absent.parts.front();
    EXPECT_EQ(worst.part, 1U);
    // Points near a plane are equally often inside and outside; slightly fewer are inside near edges.
    EXPECT_NEAR(worst.wrong.false_outside, 50.0, 6.0);
    EXPECT_EQ(worst.wrong.false_inside, 0.0);
    EXPECT_NEAR(worst.sigma, 0.005 * 9.0, 1e-6);

    const PartsAccuracy coarse = measured(shape, fieldOfBoxes({slab.bounds}), {.min_part = 9.5});
    EXPECT_EQ(coarse.countOf(PartVerdict::kLost), 0U) << "smaller than `min_part`";
    EXPECT_EQ(coarse.countOf(PartVerdict::kMinor), 1U);
    EXPECT_EQ(coarse.ignored.lost, 1U);
    EXPECT_EQ(coarse.ignored.size, 9.0);
    EXPECT_NEAR(defaultMinPart(shape.parts, ""), 0.01 * std::sqrt(2.0) * 5000.0, 0.01);
    EXPECT_DOUBLE_EQ(defaultMinPart(shape.parts, "m"), 0.1);
    EXPECT_DOUBLE_EQ(defaultMinPart(shape.parts, "m", 100.0), 0.001);

    // Filled as by a texel of 20 m.
    Bounds swollen = grown(pillar.bounds, {10.0F, 0.0F, 10.0F});
    swollen.max.y += 10.0F;
    const PartsAccuracy filled = measured(shape, fieldOfBoxes({slab.bounds, swollen}));
    EXPECT_EQ(filled.countOf(PartVerdict::kLost), 1U);
    EXPECT_GT(filled.parts.front().wrong.false_inside, 40.0);
}

constexpr PartOptions kFewPoints{.points = 100};

/// A slab of 200 with 60 boxes, all of which are missing in the field.
PartsAccuracy measuredWithoutBoxes(double side, const std::string& unit) {
    const TriangleMesh slab = makeBoxMesh({0, -1, 0}, {100, 1, 100});
    std::vector<TriangleMesh> all = {slab};
    for (int i = 0; i < 60; ++i) {
        all.push_back(makeBoxMesh({12.0 * (i % 10) - 55.0, 0.4 * side, 12.0 * (i / 10) - 30.0},
                                  glm::dvec3(0.5 * side)));
    }
    TriangleMesh mesh = joined(all);
    mesh.unit = unit;
    return measured(shaped(mesh), fieldOfBoxes({slab.bounds}), kFewPoints);
}

TEST(PartAccuracy, SmallLostPartsAreCountedButIgnored) {
    for (const auto& [side, unit] : {std::pair{0.05, "m"}, {0.05, ""}, {0.19, ""}, {2.0, ""}}) {
        const PartsAccuracy found = measuredWithoutBoxes(side, unit);
        EXPECT_EQ(found.countOf(PartVerdict::kLost), 0U) << side;
        EXPECT_EQ(found.ignored.parts, 61U);
        EXPECT_EQ(found.ignored.lost, 60U) << side;
        EXPECT_NEAR(found.ignored.size, side, 1e-5);
        const Verdict verdict = verdictOf(0.015, found, unit);
        EXPECT_EQ(verdict.grade, "good");
        EXPECT_NE(verdict.text.find("; 60 of 61 parts, at most "), std::string::npos) << verdict.text;
        EXPECT_NE(verdict.text.find(" not represented"), std::string::npos) << verdict.text;
    }
    // Boxes of 10 cm matter to people; boxes of 4 matter relative to the slab.
    for (const auto& [side, unit] : {std::pair{0.101, "m"}, {4.0, ""}}) {
        const PartsAccuracy found = measuredWithoutBoxes(side, unit);
        EXPECT_EQ(found.countOf(PartVerdict::kLost), 60U) << side;
        EXPECT_EQ(verdictOf(0.015, found, unit).grade, "poor");
    }
}

TEST(PartAccuracy, ManySmallLostPartsMatter) {
    // 200 cubes, each 0.6 % of the total diagonal: the loss of one is unnoticeable.
    std::vector<TriangleMesh> cubes;
    for (int i = 0; i < 200; ++i) {
        cubes.push_back(makeBoxMesh({i % 10, i / 10 % 10, i / 100}, glm::dvec3(0.04)));
    }
    const ShapedMesh shape = shaped(joined(cubes));
    EXPECT_GT(defaultMinPart(shape.parts, ""), 0.08);
    EXPECT_EQ(measured(shape, fieldOfBoxes({}), kFewPoints).countOf(PartVerdict::kLost), 200U);
    // A hundredth of the surface is missing, and half of the points near it are wrong.
    std::vector<Bounds> most;
    for (std::size_t i = 2; i < cubes.size(); ++i) {
        most.push_back(cubes[i].bounds);
    }
    const PartsAccuracy few = measured(shape, fieldOfBoxes(most), kFewPoints);
    EXPECT_EQ(few.countOf(PartVerdict::kLost), 0U);
    EXPECT_EQ(few.ignored.lost, 2U);
    // An explicit `min_part` overrides the default.
    PartOptions options = kFewPoints;
    options.min_part = 0.1;
    EXPECT_EQ(measured(shape, fieldOfBoxes({}), options).ignored.lost, 200U);
    options.min_part = 0.05;
    EXPECT_EQ(measured(shape, fieldOfBoxes(most), options).countOf(PartVerdict::kLost), 2U);
}

TEST(PartAccuracy, LatticeRodCountsByItsLength) {
    std::vector<TriangleMesh> rods;
    std::vector<Bounds> bounds;
    for (int i = 0; i < 10; ++i) {
        rods.push_back(makeBoxMesh({0.0, i, 0.0}, {5.0, 0.02, 0.02}));
        rods.push_back(makeBoxMesh({i - 4.5, 4.5, 0.1}, {0.02, 5.0, 0.02}));
    }
    for (const TriangleMesh& rod : rods) {
        bounds.push_back(rod.bounds);
    }
    bounds.pop_back();
    const PartsAccuracy found = measured(shaped(joined(rods)), fieldOfBoxes(bounds));
    EXPECT_EQ(found.countOf(PartVerdict::kLost), 1U);
    EXPECT_EQ(verdictOf(0.5, found, "").grade, "poor");
}

TEST(PartAccuracy, ExcessCountsAtTheScaleOfTheAsset) {
    // A plate of 0.4 beside a cube of 10 is too thick: by 0.01, which is unnoticeable, and by 0.1, which is not.
    const TriangleMesh cube = makeBoxMesh({0, 0, 0}, glm::dvec3(5.0));
    const TriangleMesh plate = makeBoxMesh({0, 8, 0}, {0.2, 0.01, 0.2});
    const ShapedMesh shape = shaped(joined({cube, plate}));
    for (const auto& [excess, lost] : {std::pair{0.01F, 0U}, {0.1F, 1U}}) {
        const Bounds thick = grown(plate.bounds, glm::vec3(excess));
        const PartsAccuracy found = measured(shape, fieldOfBoxes({cube.bounds, thick}));
        EXPECT_EQ(found.countOf(PartVerdict::kLost), lost) << excess;
        EXPECT_EQ(found.ignored.lost, 0U) << excess;
        const std::string text = verdictOf(0.5, found, "").text;
        EXPECT_EQ(text.find("not represented"), std::string::npos) << text;
        EXPECT_EQ(text.ends_with("; 1 of 2 parts is thicker than in the mesh"), lost == 0) << text;
    }
    // A missing plate counts even if it is thin.
    EXPECT_EQ(measured(shape, fieldOfBoxes({cube.bounds})).countOf(PartVerdict::kLost), 1U);
}

TEST(PartAccuracy, LostPartsAreConfirmedWithMorePoints) {
    // Boxes too large by half the distance of their points: about 20 % of the points are wrong. With few points, the
    // measured fraction is sometimes 25 %.
    std::vector<TriangleMesh> boxes;
    std::vector<Bounds> bounds;
    for (int i = 0; i < 40; ++i) {
        boxes.push_back(makeBoxMesh({3.0 * i, 0.0, 0.0}, glm::dvec3(1.0)));
        bounds.push_back(grown(boxes.back().bounds, glm::vec3(0.005F)));
    }
    const PartsAccuracy found = measured(shaped(joined(boxes)), fieldOfBoxes(bounds), {.points = 64});
    EXPECT_EQ(found.countOf(PartVerdict::kLost), 0U);
    EXPECT_EQ(found.countOf(PartVerdict::kCoarse), 40U);
}

TEST(PartAccuracy, CoarsePartsCountByArea) {
    // Cubes too small by half the distance of their points.
    for (const double side : {10.0, 0.5}) {
        const TriangleMesh other = makeBoxMesh({0, 0, 0}, glm::dvec3(5.0));
        const TriangleMesh cube = makeBoxMesh({0, 12, 0}, glm::dvec3(0.5 * side));
        const Bounds less = grown(cube.bounds, glm::vec3(static_cast<float>(-0.0025 * side)));
        const PartsAccuracy found =
            measured(shaped(joined({other, cube})), fieldOfBoxes({other.bounds, less}));
        EXPECT_EQ(found.countOf(PartVerdict::kCoarse), 1U);
        EXPECT_EQ(verdictOf(0.5, found, "").grade, side > 1.0 ? "fair" : "good");
    }
}

TEST(PartAccuracy, PartsInsideOthersAreHidden) {
    const TriangleMesh outer = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0));
    const TriangleMesh sheet = moved(makePlane(0.1F, 2), [](const glm::dvec3& p) { return 0.5 * p; });
    const PartsAccuracy found = measured(shaped(joined({outer, sheet})), fieldOfBoxes({outer.bounds}));
    EXPECT_EQ(found.countOf(PartVerdict::kKept), 1U);
    EXPECT_EQ(found.countOf(PartVerdict::kHidden), 1U);
}

TEST(PartAccuracy, ShellIsWrongBeyondItsThickness) {
    // A leaf of 0.1 beside a body of 10. The default thickness of 0.02 is a fifth of the leaf.
    const TriangleMesh leaf =
        moved(makePlane(0.0F, 2), [](const glm::dvec3& p) { return 0.05 * p + glm::dvec3(0.0, 8.0, 0.0); });
    const TriangleMesh body = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(5.0));
    const TriangleMesh mesh = joined({body, leaf});
    constexpr double kThick = 0.02;
    Bounds shell = leaf.bounds;
    shell.min.y = 8.0F - static_cast<float>(0.5 * kThick);
    shell.max.y = 8.0F + static_cast<float>(0.5 * kThick);
    const Field baked = fieldOfBoxes({body.bounds, shell});

    const PartOptions fine{.min_part = 0.01};
    const PartsAccuracy asked = measured(shaped(mesh, {ShapeAs::kAuto, kThick, {}}), baked, fine);
    EXPECT_EQ(asked.countOf(PartVerdict::kKept), 2U);

    const ShapedMesh by_default = shaped(mesh, {ShapeAs::kAuto, kThick, {}, true});
    EXPECT_DOUBLE_EQ(by_default.parts.parts[1].thickness, kThick);
    EXPECT_NEAR(by_default.parts.parts[1].target_thickness, 0.01, 1e-6);
    const PartsAccuracy thick = measured(by_default, baked, fine);
    EXPECT_EQ(thick.countOf(PartVerdict::kLost), 1U);
    EXPECT_EQ(thick.parts.front().part, 1U);
    EXPECT_GT(thick.parts.front().wrong.false_inside, 40.0);

    // The leaf is too thick in the solid, but a field without the leaf is also wrong.
    const PartsAccuracy absent = measured(by_default, fieldOfBoxes({body.bounds}), fine);
    EXPECT_EQ(absent.countOf(PartVerdict::kLost), 1U);
    EXPECT_EQ(absent.parts.front().part, 1U);
    EXPECT_GT(absent.parts.front().wrong.false_outside, 40.0);
    shell.min.y = 8.0F - 0.005F;
    shell.max.y = 8.0F + 0.005F;
    EXPECT_EQ(measured(by_default, fieldOfBoxes({body.bounds, shell}), fine).countOf(PartVerdict::kKept), 2U);
}

TEST(PartAccuracy, DefaultThicknessDependsOnThePart) {
    EXPECT_DOUBLE_EQ(partThickness(1.0, 100.0), 1.0);
    EXPECT_DOUBLE_EQ(partThickness(1.0, 1000.0), 4.0);  // at least 0.4 %
    EXPECT_DOUBLE_EQ(partThickness(1.0, 0.8), 0.2);     // at most a quarter
    // With an explicit texel, the thickness of a large part is at most that of the default.
    EXPECT_DOUBLE_EQ(partThickness(1.0, 1000.0, true), 1.0);
    EXPECT_DOUBLE_EQ(partThickness(1.0, 0.8, true), 0.2);
    // A single box: one and a half texels, clamped to 0.4 to 4 % of its side.
    const Bounds cube{glm::vec3(0.0F), glm::vec3(1.0F)};
    for (const auto& [texels, expected] :
         {std::pair{1'000'000U, 1.5 * std::sqrt(36.0 / 1e6)}, {1'000'000'000U, 0.004}, {1'000U, 0.04}}) {
        EXPECT_NEAR(partThickness(defaultThickness(cube, texels), 1.0), expected, 1e-9);
    }
}

TEST(PartAccuracy, NodesAndMaterialsWeightPartsByArea) {
    // Two nodes: "tower" with two boxes, the smaller of which is missing in the field, and "hut".
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
    // The areas have a ratio of 4 to 1.
    EXPECT_NEAR(found.groups[0].wrong.total(), found.parts.front().wrong.total() / 5.0, 1e-9);
    EXPECT_EQ(found.groups[1].name, "hut");
    EXPECT_EQ(found.groups[1].wrong.total(), 0.0);
    EXPECT_TRUE(found.groups[2].is_material);
}

TEST(PartAccuracy, OnlyTheLargestOfTooManyPartsAreMeasuredDeterministically) {
    std::vector<TriangleMesh> boxes;
    for (int i = 0; i < 40; ++i) {
        boxes.push_back(makeBoxMesh({3.0 * i, 0.0, 0.0}, glm::dvec3(0.1 + 0.03 * i)));
    }
    const ShapedMesh shape = shaped(joined(boxes));
    const auto measure = [&] {
        return measured(shape, fieldOfBoxes({boxes[5].bounds, boxes[30].bounds}),
                        {.points_all = 3000, .parts_max = 30});
    };
    const PartsAccuracy all = measure();
    const PartsAccuracy again = onThreads(1, measure);
    EXPECT_EQ(all.countOf(PartVerdict::kUnmeasured), 10U);
    EXPECT_EQ(all.ignored.unmeasured, 10U);
    EXPECT_NE(verdictOf(0.0, all, "").text.find("10 parts are not measured"), std::string::npos);
    EXPECT_TRUE(std::ranges::all_of(all.parts, [&](const PartAccuracy& part) {
        const bool small = shape.parts.parts[part.part].bounds.longestSide() < 0.77F;
        return (part.state == PartVerdict::kUnmeasured) == small;
    }));
    ASSERT_EQ(all.parts.size(), again.parts.size());
    for (std::size_t i = 0; i < all.parts.size(); ++i) {
        EXPECT_EQ(all.parts[i].part, again.parts[i].part);
        EXPECT_EQ(all.parts[i].wrong.total(), again.parts[i].wrong.total());
    }
}

}  // namespace
}  // namespace relief::test
