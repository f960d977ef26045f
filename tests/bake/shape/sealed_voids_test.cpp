// SPDX-License-Identifier: Apache-2.0
// Space sealed off by several sheets: the guarantees of sealed_voids.h, on a shape with a closed-form inside.
#include "bake/shape/sealed_voids.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "bake/measure/truth.h"
#include "bake/patches/patch_planner.h"
#include "tests/bake/points.h"
#include "tests/bake/shaped.h"

namespace relief::test {
namespace {

constexpr double kWallThickness = 0.06;

bool inPanel(const glm::dvec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec2 across(p[(axis + 1) % 3], p[(axis + 2) % 3]);
        if (std::abs(std::abs(p[axis]) - 0.5) < 0.5 * kWallThickness &&
            std::max(std::abs(across.x), std::abs(across.y)) < 1.5) {
            return true;
        }
    }
    return false;
}
bool inMiddle(const glm::dvec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 0.5;
}

TriangleMesh transformed(const TriangleMesh& mesh, const glm::dmat3& turn) {
    return moved(mesh, [&](const glm::dvec3& p) { return turn * p; });
}

ShapedMesh walled(const TriangleMesh& mesh, ShapeOptions options = {}) {
    options.thickness = kWallThickness;
    return shapedBy(mesh, options);
}

/// Whether the middle room is filled, tested at its centre.
bool isFull(const TriangleMesh& mesh, const ShapeOptions& options = {}) {
    const ShapedMesh shape = walled(mesh, options);
    const bool full = queryOf(shape.mesh).inside(glm::vec3(0.01F, 0.02F, 0.03F));
    EXPECT_EQ(shape.report.voids, full ? 1U : 0U);
    return full;
}

TEST(SealedVoids, AreInsideAndEndNoRay) {
    const glm::dmat3 turn = rotation(glm::dvec3(0.3, 1.0, 0.2), 33.0);
    const ShapedMesh shape = walled(transformed(makeRooms(), turn));
    EXPECT_EQ(shape.report.sheets, 6U);
    EXPECT_EQ(shape.report.voids, 1U);
    const MeshQuery query = queryOf(shape.mesh);
    int of_middle = 0;
    for (const glm::dvec3 p : pointsIn(makeRooms().bounds, 100'000)) {
        const bool inside = inPanel(p) || inMiddle(p);
        bool clear = true;  // not within float errors of the surface
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 step(0.0);
            step[axis] = 1e-3;
            clear = clear && inPanel(p + step) == inPanel(p) && inPanel(p - step) == inPanel(p);
        }
        if (clear) {
            of_middle += inMiddle(p) && !inPanel(p) ? 1 : 0;
            ASSERT_EQ(query.inside(glm::vec3(turn * p)), inside) << p.x << ' ' << p.y << ' ' << p.z;
        }
    }
    EXPECT_GT(of_middle, 1000);
    std::vector<LineSpan> spans;
    const glm::dvec3 middle = turn * glm::dvec3(0.01, 0.02, 0.03);
    const glm::dvec3 x = turn * glm::dvec3(1.0, 0.0, 0.0);
    ASSERT_TRUE(query.spansInside(middle, x, spans));
    ASSERT_EQ(spans.size(), 1U);
    EXPECT_NEAR(spans[0].begin, -0.54, 1e-5);
    EXPECT_NEAR(spans[0].end, 0.52, 1e-5);

    for (const SurfacePoint& point : sampleSurface(query, {.samples = 5'000})) {
        const glm::dvec3 p = glm::transpose(turn) * glm::dvec3(point.position);
        const bool faces_room = inMiddle(p + 0.01 * (glm::transpose(turn) * glm::dvec3(point.normal)));
        EXPECT_TRUE(!faces_room || point.buried);
    }
}

TEST(SealedVoid, IsFilled) {
    const MeshQuery query = queryOf(walled(makeRooms()).mesh);
    const DepthMap map = bakePatches(query, {.bytes = 200'000})->map;
    for (const glm::vec3& p : pointsIn(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(0.4)).bounds, 20'000)) {
        ASSERT_LT(vote(map, p)->distance, 0.0F);
    }
    int wrong = 0;
    for (const TruthPoint& point : sampleNear(query, {.samples = 20'000})) {
        wrong += (vote(map, point.position)->distance < 0.0F) != point.inside() ? 1 : 0;
    }
    EXPECT_LT(wrong, 60);
}

TEST(SealedVoid, HasNoWindowAndCanStayHollow) {
    EXPECT_TRUE(isFull(makeRooms()));
    EXPECT_FALSE(isFull(makeRooms(0.08)));
    EXPECT_FALSE(isFull(makeRooms(), {.voids = VoidsAs::kKeep}));
    EXPECT_FALSE(isFull(makeRooms(), {.as = ShapeAs::kShell}));
}

TEST(SealedVoid, ExcludesHollowsOfSolids) {
    const TriangleMesh hollow = joined({makeBoxMesh(glm::dvec3(0.0), glm::dvec3(0.4)),
                                        reversed(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(0.3)))});
    EXPECT_FALSE(isFull(joined({hollow, makePanel(1, 1.2)})));
}

}  // namespace
}  // namespace relief::test
