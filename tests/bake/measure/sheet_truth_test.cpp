// SPDX-License-Identifier: Apache-2.0
// The truth of shells compared with closed forms, and errors that it finds in a hollow shell although its own solid has
// none.
#include "bake/bench/sheet_truth.h"

#include <cmath>

#include "bake/measure/accuracy.h"
#include "tests/bake/points.h"
#include "tests/bake/shaped.h"

namespace relief::test {
namespace {

ShapeOptions shellOf(double thickness) {
    return {.as = ShapeAs::kShell, .thickness = thickness};
}

/// The fraction of points that a solid classifies wrongly.
WrongShare wrongIn(const MeshQuery& solid, const std::vector<TruthPoint>& points) {
    return measureNear(points, [&](const glm::vec3& p) {
        return FieldValue{solid.inside(p) ? -1.0F : 1.0F, {}};
    });
}

TEST(SheetTruth, RodInsideItsShellIsSolid) {
    const TriangleMesh rod = makeBoxMesh({0, 0, 0}, {0.5, 0.02, 0.02});
    const ShapedMesh shaped = shapedBy(rod, shellOf(0.1));
    const Result<SheetTruth> truth = SheetTruth::build(PreparedMesh(rod), shaped);
    ASSERT_TRUE(truth && !truth->empty());
    EXPECT_EQ(truth->inside({0, 0, 0}), true);
    EXPECT_EQ(truth->inside({0, 0.069F, 0}), true);
    EXPECT_EQ(truth->inside({0, 0.071F, 0}), false);
    EXPECT_EQ(truth->inside({0, 0.05F, 0.05F}), std::nullopt);  // at the mitre of an edge
    const MeshQuery solid = queryOf(shaped.mesh);
    const std::vector<TruthPoint> points = truth->sample(solid, {.samples = 5000});
    EXPECT_GT(points.size(), 4000U);
    EXPECT_EQ(wrongIn(solid, points).total(), 0.0);
    // A former bug: the inverted inner offset left a hollow of 0.03. Sampling that solid itself finds no error.
    const TriangleMesh hollow = joined(
        {makeBoxMesh({0, 0, 0}, {0.55, 0.07, 0.07}), reversed(makeBoxMesh({0, 0, 0}, {0.47, 0.03, 0.03}))});
    EXPECT_GT(wrongIn(queryOf(hollow), points).false_outside, 20.0);
}

TEST(SheetTruth, SheetAndBlockKeepTheirKinds) {
    // The block stays solid. Only the sheet gets a shell.
    const TriangleMesh mesh = joined({makePlane(0.0F, 4), makeBoxMesh({5, 0, 0}, {1, 1, 1})});
    ShapeOptions options = shellOf(0.1);
    options.as = ShapeAs::kAuto;
    const ShapedMesh shaped = shapedBy(mesh, options);
    expectKinds(shaped.report, 1, 0, 1, 0);
    const Result<SheetTruth> truth = SheetTruth::build(PreparedMesh(mesh), shaped);
    ASSERT_TRUE(truth && !truth->empty());
    EXPECT_EQ(truth->inside({5, 0, 0}), false);
    AccuracyOptions few{.samples = 2000};
    const std::vector<TruthPoint> points = truth->sample(queryOf(shaped.mesh), few);
    EXPECT_GT(points.size(), 1900U);
    for (const TruthPoint& point : points) {
        ASSERT_EQ(point.inside(), std::abs(point.position.y) < 0.05F) << point.position.y;
    }
    // A mesh without sheets has nothing to measure.
    const TriangleMesh block = makeBoxMesh({0, 0, 0}, {1, 1, 1});
    const SheetTruth none = required(SheetTruth::build(PreparedMesh(block), shapedBy(block, options)));
    EXPECT_TRUE(none.empty() && none.sample(queryOf(block), few).empty());
}

}  // namespace
}  // namespace relief::test
