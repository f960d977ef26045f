// SPDX-License-Identifier: Apache-2.0
// Classification of parts, and the solids that represent them: the guarantees of shape.h and sheet.h.
#include "bake/shape/shape.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "bake/maps/budget_search.h"
#include "bake/measure/accuracy.h"
#include "bake/mesh/surface_sampler.h"
#include "tests/bake/points.h"
#include "tests/bake/shaped.h"
#include "tests/bake/voxels.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

constexpr double kThickness = 0.05;

ShapedMesh shaped(const TriangleMesh& mesh, ShapeAs as = ShapeAs::kAuto, double thickness = kThickness) {
    return shapedBy(mesh, {as, thickness});
}

/// A box of half sides 1 without its lid, at y = 1.
TriangleMesh makeOpenBox() {
    return without(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0)),
                   [](const glm::dvec3& p) { return p.y > 0.99; });
}

/// A surface of revolution about the y axis from radii and heights, open where its ends are not on the axis.
TriangleMesh makeTurned(const std::vector<glm::dvec2>& profile, std::uint32_t sides = 64) {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t k = 0; k < profile.size(); ++k) {
        for (std::uint32_t i = 0; i < sides; ++i) {
            const double a = 2.0 * std::numbers::pi * i / sides;
            positions.emplace_back(profile[k].x * std::cos(a), profile[k].y, profile[k].x * std::sin(a));
            const std::uint32_t here = sides * k + i;
            const std::uint32_t next = sides * k + (i + 1) % sides;
            if (k + 1 < profile.size()) {
                triangles.insert(triangles.end(),
                                 {{here, here + sides, next}, {next, here + sides, next + sides}});
            }
        }
    }
    return finished(positions, triangles);
}

/// A tube around the y axis, closed at the bottom.
TriangleMesh makeCup() {
    return makeTurned({{0.0, -1.0}, {0.7, -1.0}, {0.7, 1.0}});
}

/// Open below, at y = −0.3. The hole cannot be seen from inside the brim, at radii 0.7 to 1.
TriangleMesh makeToadstool() {
    std::vector<glm::dvec2> profile = {{0.7, -0.3}, {0.7, 0.0}};
    for (int i = 0; i <= 8; ++i) {
        const double a = std::numbers::pi * i / 16.0;
        profile.emplace_back(i == 8 ? 0.0 : std::cos(a), 0.5 * std::sin(a));
    }
    return makeTurned(profile);
}

TriangleMesh scaled(const TriangleMesh& mesh, double scale, const glm::dvec3& offset = glm::dvec3(0.0)) {
    return moved(mesh, [&](const glm::dvec3& p) { return scale * p + offset; });
}

TriangleMesh turned(const TriangleMesh& mesh, const glm::dvec3& axis, double degrees) {
    return moved(mesh, [&](const glm::dvec3& p) { return rotation(axis, degrees) * p; });
}

/// The graph y = height(x, z) over [−1, 1]².
template <class Height>
TriangleMesh makeHeights(const Height& height) {
    return moved(makePlane(0.0F, 24),
                 [&](const glm::dvec3& p) { return glm::dvec3(p.x, height(p.x, p.z), p.z); });
}

double hills(double x, double z) {
    return 0.15 * std::sin(3.0 * x) * std::cos(2.0 * z);
}

struct ShellCount {
    int near = 0;
    int hollow = 0;  ///< near but outside
    int filled = 0;  ///< far but inside
};

/// Counts points nearer to the sheet than `near`, or farther than `far`, by their side of a shell of thickness 0.1.
ShellCount countAtShell(const TriangleMesh& mesh, double near, double far, double y_most = 9.0) {
    const MeshQuery sheet = queryOf(mesh);
    const MeshQuery shell = queryOf(shaped(mesh, ShapeAs::kShell, 0.1).mesh);
    EXPECT_TRUE(shell.watertight());
    ShellCount count;
    for (const glm::vec3& p : pointsIn(mesh.bounds, 20'000)) {
        const double distance = sheet.closest(p).distance;
        const bool is_near = distance < near && std::abs(double{p.y}) <= y_most;
        count.near += is_near ? 1 : 0;
        count.hollow += is_near && !shell.inside(p) ? 1 : 0;
        count.filled += distance > far && shell.inside(p) ? 1 : 0;
    }
    return count;
}

Collider patchesOf(const ShapedMesh& shape, std::uint64_t budget) {
    return required(bakePatchesWithin(queryOf(shape.mesh), budget, {})).collider;
}

TEST(Shape, SolidIsUnchanged) {
    const TriangleMesh ball = makeIcosphere(glm::dvec3(0.0), 1.0, 3);
    const ShapedMesh shape = shaped(ball);
    expectKinds(shape.report, 1, 0, 0, 0);
    EXPECT_TRUE(shape.mesh->triangles == ball.triangles && shape.mesh->positions == ball.positions);
    EXPECT_TRUE(asOptionWords(shape.report).empty() && !thicknessOf(shape.report));
    // A missing triangle is a hole.
    const ShapedMesh holed =
        shaped(finished(ball.positions, {ball.triangles.begin() + 1, ball.triangles.end()}));
    expectKinds(holed.report, 0, 1, 0, 0);
    EXPECT_TRUE(queryOf(holed.mesh).inside(glm::vec3(0.0F)));
    EXPECT_EQ(holed.mesh->closed_holes, 1U);
}

// The mouth of a vessel faces up. A bell, a lampshade or an inverted box shows all of its inside.
TEST(Shape, BodyOpenBelowIsSolidButVesselIsNot) {
    const TriangleMesh toadstool = makeToadstool();
    const ShapedMesh shape = shaped(toadstool);
    expectKinds(shape.report, 0, 1, 0, 0);
    EXPECT_EQ(shape.report.closable_sheets, 0U);
    const MeshQuery query = queryOf(shape.mesh);
    for (const glm::vec2& at : {glm::vec2(0.0F, 0.2F), {0.65F, -0.29F}, {0.9F, 0.02F}, {0.0F, -0.299F}}) {
        EXPECT_TRUE(query.inside({at.x, at.y, 0.1F})) << at.x << ' ' << at.y;
    }
    EXPECT_FALSE(query.inside({0.0F, -0.301F, 0.0F}) || query.inside({0.8F, -0.01F, 0.0F}));
    const glm::dvec3 x(1, 0, 0);
    const TriangleMesh z_up = turned(toadstool, x, 90.0);
    expectKinds(shaped(z_up).report, 0, 1, 0, 0);
    TriangleMesh in_metres = z_up;  // here y is up
    in_metres.unit = "m";
    const std::vector<TriangleMesh> vessels = {in_metres,
                                               turned(toadstool, x, 180.0),
                                               turned(toadstool, x, -90.0),
                                               turned(toadstool, {0, 0, 1}, 90.0),
                                               makeOpenBox(),
                                               turned(makeOpenBox(), x, 180.0),
                                               makeCup(),
                                               turned(makeCup(), x, 180.0),
                                               makeTurned({{0.5, -0.6}, {0.4, 0.3}, {0.0, 0.5}}),
                                               makeTurned({{0.5, -1.5}, {0.3, 0.5}})};
    for (std::size_t i = 0; i < vessels.size(); ++i) {
        SCOPED_TRACE(i);
        const ShapeReport report = shaped(vessels[i]).report;
        expectKinds(report, 0, 0, 1, 0);
        EXPECT_EQ(report.closable_sheets, 1U);  // --as solid is suggested
        expectKinds(shaped(vessels[i], ShapeAs::kSolid).report, 0, 1, 0, 0);
    }
    EXPECT_EQ(shaped(makePlane(0.0F, 1)).report.closable_sheets, 0U);
    EXPECT_EQ(shaped(joined({makeOpenBox(), scaled(makePlane(-1.0F, 2), 9.0)})).report.closable_sheets, 0U);
}

/// Two open shells with separate rims, and points in the space that they enclose and in the wall between them.
struct Wall {
    TriangleMesh outer;
    TriangleMesh inner;
    std::vector<glm::dvec3> free;
    std::vector<glm::dvec3> full;
};

/// Expects one solid in the place of the shells, turned about z, and returns it.
MeshQuery expectWall(const Wall& wall, double degrees = 0.0) {
    const ShapedMesh shape = shaped(turned(joined({wall.outer, wall.inner}), {0, 0, 1}, degrees));
    expectKinds(shape.report, 0, 1, 0, 0);
    MeshQuery query = queryOf(shape.mesh);
    const auto inside = [&](const glm::dvec3& p) {
        return query.inside(glm::vec3(rotation(glm::dvec3(0, 0, 1), degrees) * p));
    };
    EXPECT_TRUE(std::ranges::none_of(wall.free, inside));
    EXPECT_TRUE(std::ranges::all_of(wall.full, inside));
    EXPECT_FALSE(inside({2.0, 0.5, 0.0}));
    return query;
}

/// Mugs, bowls, lampshades and pipes, as radii and heights.
TEST(Shape, ShellsWithFacingRimsFormAWall) {
    struct Profiles {
        std::vector<glm::dvec2> outer;
        std::vector<glm::dvec2> inner;
        std::vector<glm::dvec3> free;
        std::vector<glm::dvec3> full;
    };
    const std::vector<Profiles> walls = {{{{0.0, 0.0}, {0.35, 0.0}, {0.5, 1.2}},
                                          {{0.0, 0.02}, {0.33, 0.02}, {0.48, 1.2}},
                                          {{0, 0.6, 0}, {0, 1.19, 0.4}, {0.3, 0.03, 0}},
                                          {{0, 0.01, 0.3}, {0.4926, 1.19, 0}, {0.0, 0.6, 0.415}}},
                                         {{{0.0, 0.0}, {0.5, 0.05}, {0.8, 0.4}, {0.85, 0.9}},
                                          {{0.0, 0.05}, {0.47, 0.1}, {0.76, 0.42}, {0.81, 0.92}},
                                          {{0, 0.1, 0}, {0.5, 0.4, 0}, {0, 0.9, 0.79}},
                                          {{0.0, 0.03, 0.05}, {0.0, 0.4, 0.78}, {0.82, 0.88, 0}}},
                                         {{{0.5, 0.0}, {0.3, 1.0}},
                                          {{0.48, 0.0}, {0.28, 1.0}},
                                          {{0, 0.5, 0}, {0, 0.01, 0}, {0, 0.99, 0.2}},
                                          {{0.391, 0.5, 0.0}, {0.0, 0.1, 0.47}}},
                                         {{{0.5, 0.0}, {0.5, 4.0}},
                                          {{0.45, 0.0}, {0.45, 4.01}},
                                          {{0, 2, 0}, {0.4, 0.01, 0}, {0, 3.99, 0.4}},
                                          {{0.475, 2, 0}, {0, 3.9, 0.475}}},
                                         // Many rays escape through the gap between the rims.
                                         {{{0.37, 0.0}, {0.33, 1.0}},
                                          {{0.31, 0.0}, {0.27, 1.0}},
                                          {{0, 0.5, 0}, {0.25, 0.98, 0}, {0, 0.02, 0.28}},
                                          {{0.32, 0.5, 0}, {0, 0.9, 0.305}}},
                                         {{{0.5, 0.0}, {0.5, 0.3}},
                                          {{0.44, 0.0}, {0.44, 0.3}},
                                          {{0, 0.15, 0}, {0.4, 0.02, 0}, {0, 0.28, 0.4}},
                                          {{0.47, 0.15, 0}, {0, 0.28, 0.47}}},
                                         {{{0.0, 0.0}, {1.0, 0.5}},
                                          {{0.0, 0.05}, {0.95, 0.52}},
                                          {{0, 0.2, 0}, {0.5, 0.35, 0}, {0, 0.48, 0.8}},
                                          {{0.0, 0.025, 0.01}, {0.5, 0.28, 0}, {0, 0.49, 0.95}}}};
    for (std::size_t i = 0; i < walls.size(); ++i) {
        SCOPED_TRACE(i);
        const TriangleMesh inner = makeTurned(walls[i].inner);
        for (const TriangleMesh& either : {inner, reversed(inner)}) {
            const Wall wall{makeTurned(walls[i].outer), either, walls[i].free, walls[i].full};
            EXPECT_TRUE(expectWall(wall, 90.0).watertight());
        }
    }
    // Two open boxes side by side do not form a wall.
    expectKinds(shaped(joined({makeOpenBox(), scaled(makeOpenBox(), 1.0, {2.1, 0, 0})})).report, 0, 0, 2, 0);
}

/// Vessels with a narrow mouth, a flared, thick, square or eccentric rim, or a missing triangle, as radii and heights.
TEST(Shape, ShellsWithUnlikeRimsFormAWall) {
    const auto turn = [](const std::vector<glm::dvec2>& profile) { return makeTurned(profile, 16); };
    const auto lessOne = [](const TriangleMesh& mesh) {
        const std::size_t middle = mesh.triangles.size() / 2;
        std::vector<glm::uvec3> triangles = mesh.triangles;
        triangles.erase(triangles.begin() + static_cast<std::ptrdiff_t>(middle));
        return finished(mesh.positions, triangles);
    };
    // The rim then has a spike as long as the wall is high.
    const auto lessOneAtRim = [](const TriangleMesh& mesh) {
        std::vector<glm::uvec3> triangles = mesh.triangles;
        triangles.erase(std::ranges::find_if(triangles, [&](const glm::uvec3& t) {
            int high = 0;
            for (int i = 0; i < 3; ++i) {
                high += mesh.positions[t[i]].y == mesh.bounds.max.y ? 1 : 0;
            }
            return high == 2;
        }));
        return finished(mesh.positions, triangles);
    };
    // Teeth that the mesh has are no spikes: they and the gaps between them stay.
    const auto withTeeth = [](const TriangleMesh& mesh, std::size_t teeth, float height) {
        std::vector<glm::vec3> positions = mesh.positions;
        std::vector<glm::uvec3> triangles = mesh.triangles;
        for (const glm::uvec3& t : mesh.triangles) {
            for (int i = 0; i < 3; ++i) {
                const std::uint32_t a = t[i];
                const std::uint32_t b = t[(i + 1) % 3];
                const float top = mesh.bounds.max.y;
                if (teeth > 0 && mesh.positions[a].y == top && mesh.positions[b].y == top) {
                    --teeth;
                    triangles.emplace_back(b, a, static_cast<std::uint32_t>(positions.size()));
                    positions.push_back(0.5F * (positions[a] + positions[b]) + glm::vec3(0, height, 0));
                }
            }
        }
        return finished(positions, triangles);
    };
    const TriangleMesh mug = turn({{0.0, 0.0}, {0.5, 0.0}, {0.5, 1.2}});
    const TriangleMesh liner = turn({{0.0, 0.02}, {0.48, 0.02}, {0.48, 1.2}});
    const TriangleMesh vase = turn({{0.0, 0.0}, {0.5, 0.0}, {0.6, 0.5}, {0.15, 1.2}});
    const TriangleMesh in_vase = turn({{0.0, 0.03}, {0.47, 0.03}, {0.57, 0.5}, {0.12, 1.2}});
    const std::vector<Wall> walls = {
        {vase, in_vase, {{0, 0.5, 0}}, {{0.58, 0.5, 0}}},
        {vase, turn({{0.0, 0.06}, {0.44, 0.06}, {0.54, 0.5}, {0.08, 1.2}}), {{0, 0.5, 0}}, {{0.1, 0.03, 0}}},
        {turn({{0.0, 0.0}, {0.4, 0.0}, {0.4, 1.0}, {0.12, 1.3}, {0.12, 1.7}}),
         turn({{0.0, 0.02}, {0.38, 0.02}, {0.38, 1.0}, {0.1, 1.3}, {0.1, 1.7}}),
         {{0, 0.5, 0}},
         {{0.39, 0.5, 0}}},
        {turn({{0.0, 0.0}, {0.5, 0.0}, {0.4, 1.0}, {0.55, 1.2}}),
         turn({{0.0, 0.03}, {0.47, 0.03}, {0.37, 1.0}}),
         {{0, 0.5, 0}},
         {{0.1, 0.015, 0}}},
        {mug, turn({{0.0, 0.2}, {0.35, 0.2}, {0.35, 1.2}}), {{0, 0.6, 0}}, {{0.42, 0.6, 0}}},
        {mug, makeTurned({{0.0, 0.05}, {0.45, 0.05}, {0.45, 1.2}}, 4), {{0, 0.6, 0}}, {{0.1, 0.02, 0}}},
        {mug,
         scaled(turn({{0.0, 0.03}, {0.4, 0.03}, {0.4, 1.2}}), 1.0, {0.08, 0, 0}),
         {{0, 0.6, 0}},
         {{-0.4, 0.6, 0}}},
        {mug, lessOne(liner), {{0, 0.6, 0}}, {{0.1, 0.01, 0}}},
        {lessOne(mug), liner, {{0, 0.6, 0}}, {{0.1, 0.01, 0}}},
        {mug, lessOneAtRim(liner), {{0, 0.6, 0}}, {{0.1, 0.01, 0}}},
        {lessOneAtRim(mug), liner, {{0, 0.6, 0}}, {{0.1, 0.01, 0}}},
        {lessOneAtRim(mug), lessOneAtRim(liner), {{0, 0.6, 0}}, {{0.1, 0.01, 0}}},
        {withTeeth(mug, 1, 0.4F), liner, {{0, 0.6, 0}}, {{0.4791, 1.35, 0.0953}}},
        {withTeeth(mug, 16, 0.4F), withTeeth(liner, 16, 0.4F), {{0.485, 1.4, 0}}, {{0.471, 1.3, 0.094}}}};
    for (std::size_t i = 0; i < walls.size(); ++i) {
        SCOPED_TRACE(i);
        expectWall(walls[i]);
    }
    // A small vessel in a large scene.
    const ShapedMesh scene = shaped(joined({vase, in_vase, scaled(makePlane(-1.0F, 2), 9.0)}));
    expectKinds(scene.report, 0, 1, 1, 0);
    EXPECT_FALSE(queryOf(scene.mesh).inside({0.0F, 0.5F, 0.0F}));
}

/// If the inner shell ends far below the outer rim, the vessel is filled and a warning reports it.
TEST(Shape, VesselWithSeparateShellsIsReported) {
    const auto turn = [](const std::vector<glm::dvec2>& profile) { return makeTurned(profile, 16); };
    const TriangleMesh mug = turn({{0.0, 0.0}, {0.5, 0.0}, {0.5, 1.2}});
    const TriangleMesh jug = turn({{0.0, 0.0}, {0.5, 0.0}, {0.5, 0.8}, {0.15, 1.2}});
    const TriangleMesh low = turn({{0.0, 0.02}, {0.3, 0.02}, {0.3, 0.6}});
    for (const TriangleMesh& outer : {mug, jug}) {
        const ShapedMesh shape = shaped(joined({outer, low}));
        EXPECT_EQ(shape.report.unjoined_shells, 1U);
        EXPECT_TRUE(queryOf(shape.mesh).inside({0.0F, 0.3F, 0.0F}));
    }
    const auto unjoined = [](const std::vector<TriangleMesh>& meshes) {
        return shaped(joined(meshes)).report.unjoined_shells;
    };
    const TriangleMesh liner = turn({{0.0, 0.02}, {0.48, 0.02}, {0.48, 1.2}});
    EXPECT_EQ(unjoined({mug, liner}), 0U);
    EXPECT_EQ(unjoined({mug, scaled(mug, 1.0, {3, 0, 0})}), 0U);
    // An open crate in an open crate: both stay open.
    const auto crate = [](const glm::dvec3& scale, double y) {
        return moved(makeOpenBox(), [&](const glm::dvec3& p) { return p * scale + glm::dvec3(0.0, y, 0.0); });
    };
    const ShapedMesh crates =
        shaped(joined({crate({1.0, 0.5, 1.0}, 0.0), crate({0.55, 0.425, 0.55}, -0.05)}));
    expectKinds(crates.report, 0, 0, 2, 0);
    EXPECT_FALSE(queryOf(crates.mesh).inside(glm::vec3(0.0F)));
    EXPECT_EQ(crates.report.unjoined_shells, 0U);
}

/// A clothed body has the same shells as a vessel, possibly with different winding.
TEST(Shape, WallThatMayBeAClothedBodyIsReported) {
    const auto turn = [](const std::vector<glm::dvec2>& profile) { return makeTurned(profile, 24); };
    const TriangleMesh torso = turn({{0.3, 0.0}, {0.34, 0.5}, {0.3, 0.9}, {0.12, 1.0}});
    const TriangleMesh jacket = turn({{0.36, -0.05}, {0.4, 0.5}, {0.36, 0.92}, {0.16, 1.0}});
    const TriangleMesh mixed = reversed(reversed(torso), 3);
    const TriangleMesh ball = makeIcosphere({2.0, 0.5, 0.0}, 0.2, 1);
    const auto unclear = [&](const TriangleMesh& outer, const TriangleMesh& inner) {
        // Duplicates restart the classification.
        const ShapeReport report = shaped(joined({inner, outer, ball, ball})).report;
        expectKinds(report, 1, 1, 0, 0);
        const ShapeReport pair = shaped(joined({inner, outer})).report;
        expectKinds(pair, 0, 1, 0, 0);
        EXPECT_EQ(pair.ambiguous_walls, report.ambiguous_walls);
        return pair.ambiguous_walls;
    };
    EXPECT_EQ(unclear(jacket, torso), 1U);
    EXPECT_EQ(unclear(reversed(jacket), reversed(torso)), 1U);
    EXPECT_EQ(unclear(jacket, mixed), 1U);
    EXPECT_EQ(unclear(jacket, reversed(torso)), 0U);
    EXPECT_EQ(unclear(reversed(jacket), torso), 0U);
    const ShapedMesh solid = shaped(joined({torso, jacket}), ShapeAs::kSolid);
    expectKinds(solid.report, 0, 2, 0, 0);
    EXPECT_EQ(solid.report.ambiguous_walls, 0U);
    EXPECT_TRUE(queryOf(solid.mesh).inside({0.0F, 0.5F, 0.0F}));
}

TEST(Shape, ShellContainsAllPointsNearItsSheet) {
    for (const TriangleMesh& sheet : {reversed(makeOpenBox(), 2), makeCup()}) {
        const MeshQuery open = queryOf(sheet);
        const MeshQuery shell = queryOf(shaped(sheet).mesh);
        EXPECT_TRUE(shell.watertight());
        int inside = 0;
        int outside = 0;
        for (const glm::vec3& p : pointsIn(sheet.bounds, 200'000)) {
            const double distance = open.closest(p).distance;
            if (p.y > 0.95F) {
                continue;  // the shell has flat ends at the border
            }
            if (distance < 0.48 * kThickness) {
                ++inside;
                ASSERT_TRUE(shell.inside(p)) << p.x << ' ' << p.y << ' ' << p.z << ": " << distance;
            } else if (distance > 0.5 * std::numbers::sqrt3 * kThickness + 1e-4) {  // the mitre at a corner
                ++outside;
                ASSERT_FALSE(shell.inside(p)) << p.x << ' ' << p.y << ' ' << p.z << ": " << distance;
            }
        }
        EXPECT_GT(inside, 1000);
        EXPECT_GT(outside, 10'000);
    }
}

/// Rods thinner than their shell, a straw, a pin on a block, a pit in one, a thin bar between two ends, and a thin
/// flange around a hollow body.
TEST(Shape, ShellThickerThanItsPartIsNotHollow) {
    const TriangleMesh rod = makeBoxMesh(glm::dvec3(0.0), {0.5, 0.02, 0.02});
    const std::vector<glm::dvec2> bar = {{0.0, -0.5}, {0.3, -0.4}, {0.3, -0.3}, {0.02, -0.2},
                                         {0.02, 0.2}, {0.3, 0.3},  {0.3, 0.4},  {0.0, 0.5}};
    const std::vector<glm::dvec2> flange = {{0.0, -0.5}, {0.4, -0.3}, {0.4, -0.02}, {0.7, -0.02},
                                            {0.7, 0.02}, {0.4, 0.02}, {0.4, 0.3},   {0.0, 0.5}};
    const std::vector<TriangleMesh> meshes = {
        rod,
        turned(rod, {0.3, 1.0, 0.2}, 33.0),
        makeTurned({{0.02, -0.5}, {0.02, 0.5}}),
        makeTurned({{0.0, -0.5}, {0.5, -0.5}, {0.5, 0.0}, {0.02, 0.0}, {0.02, 0.5}, {0.0, 0.5}}),
        makeTurned({{0.0, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {0.02, 0.5}, {0.02, 0.1}, {0.0, 0.1}}),
        makeTurned(bar),
        makeTurned(flange)};
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        SCOPED_TRACE(i);
        const double flat_ends = i == 2 ? 0.49 : 9.0;  // the straw has flat ends
        const ShellCount count = countAtShell(meshes[i], 0.045, 0.09, flat_ends);
        EXPECT_EQ(count.hollow, 0);
        EXPECT_EQ(count.filled, 0);
    }
    EXPECT_LT(queryOf(shaped(rod, ShapeAs::kShell, 0.1).mesh).signedDistance(glm::vec3(0.0F)), -0.06);
}

/// A gable, a needle, a blade, a wedge, two cones and a tapered rod in a shell of 0.1. At most a twentieth of the
/// points within 0.04 may be outside.
TEST(Shape, ShellOfASharpWedgeHasFullThickness) {
    const std::vector<glm::uvec3> wedge = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                                           {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    const auto prism = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, float length) {
        const glm::vec3 along(0.0F, 0.0F, length);
        return finished({a, b, c, a + along, b + along, c + along}, wedge);
    };
    const auto cone = [](double radius, std::uint32_t sides) {
        return makeTurned({{0.0, 0.0}, {radius, 0.0}, {0.0, 1.0}}, sides);
    };
    const glm::vec3 x(1.0F, 0.0F, 0.0F);
    const std::vector<TriangleMesh> meshes = {
        prism(glm::vec3(0.0F), x, {0.5F, 0.12F, 0.0F}, 2.0F),
        cone(0.04, 6),
        prism(glm::vec3(0.0F), x, {0.0F, 0.1F, 0.0F}, 1.0F),
        prism(glm::vec3(0.0F), x, {0.0F, 0.3F, 0.0F}, 1.0F),
        cone(0.2, 12),
        cone(0.2, 4),
        makeTurned({{0.0, 0.0}, {0.15, 0.0}, {0.005, 1.0}, {0.0, 1.0}}, 12)};
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        SCOPED_TRACE(i);
        const ShellCount count = countAtShell(meshes[i], 0.04, 0.11);
        EXPECT_LT(count.hollow, 0.05 * count.near) << count.near;
        EXPECT_EQ(count.filled, 0);
        // A mitre is at most two halves of the thickness long, also at the tip of a needle.
        const MeshQuery sheet = queryOf(meshes[i]);
        const ShapedMesh shell = shaped(meshes[i], ShapeAs::kShell, 0.1);
        for (const glm::vec3& p : shell.mesh->positions) {
            ASSERT_LT(sheet.closest(p).distance, 0.1 + 1e-5) << p.x << ' ' << p.y << ' ' << p.z;
        }
    }
}

/// A shell is at least 1/10,000 of its sheet thick, and thicker than the resolution of floats at the mesh's far end.
TEST(Shape, ShellsHaveALeastThickness) {
    const TriangleMesh plane = makePlane(0.0F, 4);
    const double side = double{plane.bounds.longestSide()};
    EXPECT_TRUE(shapeMesh(PreparedMesh(plane), {ShapeAs::kShell, 1.01e-4 * side}));
    const TriangleMesh far = joined(
        {plane, moved(plane, [&](const glm::dvec3& p) { return p + glm::dvec3(100.0 * side, 0.0, 0.0); })});
    for (const auto& [mesh, thickness] : {std::pair(plane, 0.99e-4), {far, 3.9e-4}}) {
        SCOPED_TRACE(thickness);
        expectError(shapeMesh(PreparedMesh(mesh), {ShapeAs::kShell, thickness * side}), ErrorCode::kUsage,
                    "thick; increase it");
    }
}

TEST(Shape, TwoSidedSheetIsOneSheet) {
    const TriangleMesh plane = makePlane(0.0F, 4);
    const ShapedMesh shape = shaped(joined({plane, reversed(plane)}));
    expectKinds(shape.report, 0, 0, 1, 0);
    EXPECT_EQ(fieldText(thicknessOf(shape.report).value()), "0.05");
    EXPECT_EQ(shape.report.coincident_triangles, plane.triangles.size());
    const MeshQuery query = queryOf(shape.mesh);
    EXPECT_TRUE(query.inside({0.1F, 0.02F, 0.2F}) && query.inside({0.1F, -0.02F, 0.2F}));
    EXPECT_FALSE(query.inside({0.1F, 0.03F, 0.2F}));
}

// The gap between near copies is thinner than any wall. It is not treated as a hollow, and a warning reports it.
TEST(Shape, CopiesOfASolidAreOneSolid) {
    const TriangleMesh ball = makeIcosphere(glm::dvec3(0.0), 1.0, 3);
    const TriangleMesh half = finished(
        ball.positions, {ball.triangles.begin(), ball.triangles.begin() + ball.triangles.size() / 2});
    const std::uint64_t all = ball.triangles.size();
    struct Case {
        const char* name;
        TriangleMesh mesh;
        std::uint64_t coincident;
        std::uint64_t near;
    };
    const std::vector<Case> cases = {
        {"twice", joined({ball, ball}), all, 0},
        {"half of it twice", joined({ball, half}), half.triangles.size(), 0},
        {"grown by a millionth", joined({ball, scaled(ball, 1.0 + 1e-6)}), 0, 1},
        {"shrunk, first in the file", joined({scaled(ball, 1.0 - 5e-5), ball}), 0, 1},
        {"near its back", joined({ball, reversed(scaled(ball, 1.0 + 2e-6))}), 0, 1},
        {"moved", joined({ball, scaled(ball, 1.0, {1e-5, -2e-5, 0.0})}), 0, 1},
        {"three", joined({ball, scaled(ball, 1.0 + 3e-6), scaled(ball, 1.0 - 3e-6)}), 0, 2},
        {"exact ones too", joined({ball, ball, scaled(ball, 1.0 + 1e-6)}), all, 1}};
    const MeshQuery truth = queryOf(ball);
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        const ShapedMesh shape = shaped(c.mesh);
        expectKinds(shape.report, 1, 0, 0, 0);
        EXPECT_EQ(shape.report.coincident_triangles, c.coincident);
        EXPECT_EQ(shape.report.near_copies, c.near);
        EXPECT_EQ(shape.mesh->warnings.size(), c.near > 0 ? 1U : 0U);
        const MeshQuery query = queryOf(shape.mesh);
        for (const glm::vec3& p : pointsIn(ball.bounds, 3000)) {
            // For near copies, skip points at the surface.
            if (c.near == 0 || truth.inside(0.9998F * p) == truth.inside(1.0002F * p)) {
                ASSERT_EQ(query.inside(p), truth.inside(p));
            }
        }
    }
}

TEST(Shape, DistinctPartsAreNotMerged) {
    const TriangleMesh ball = makeIcosphere(glm::dvec3(0.0), 1.0, 3);
    for (const TriangleMesh& other : {scaled(ball, 0.999), scaled(ball, 1.0, {1e-3, 0.0, 0.0}),
                                      makeIcosphere(glm::dvec3(0.0), 1.0, 2), scaled(ball, 0.5)}) {
        const ShapedMesh shape = shaped(joined({ball, other}));
        expectKinds(shape.report, 2, 0, 0, 0);
        EXPECT_EQ(shape.report.near_copies, 0U);
        EXPECT_TRUE(shape.mesh->warnings.empty());
    }
    // Hollows are kept.
    EXPECT_FALSE(queryOf(shaped(joined({ball, reversed(scaled(ball, 0.99))})).mesh).inside(glm::dvec3(0.0)));
    // Many adjacent parts of equal size are distinct.
    std::vector<TriangleMesh> many;
    for (int i = 0; i < 50; ++i) {
        many.push_back(makeBoxMesh({0.0, 0.0, double(i)}, glm::dvec3(0.5)));
    }
    EXPECT_EQ(shaped(joined(many)).report.near_copies, 0U);
}

TEST(Shape, CopiesOfVoxelSolidsDoNotChangeThem) {
    for (std::uint32_t seed = seedFrom(301), end = seed + 60; seed < end; ++seed) {
        SCOPED_TRACE(seed);
        const VoxelGrid grid = VoxelGrid::random(seed);
        TriangleMesh mesh = grid.mesh();
        std::mt19937 random(seed);
        const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
        // Up to three more copies of all or half of the triangles, with random winding, first corner and position.
        const std::uint32_t most = 2 + below(3);
        const std::size_t copied = below(2) == 0 ? mesh.triangles.size() : mesh.triangles.size() / 2;
        for (std::size_t i = 0; i < copied; ++i) {
            for (std::uint32_t copy = below(most); copy > 0; --copy) {
                glm::uvec3 t = mesh.triangles[i];
                t = below(2) == 0 ? glm::uvec3(t.y, t.z, t.x) : t;
                mesh.triangles.push_back(below(2) == 0 ? glm::uvec3(t.x, t.z, t.y) : t);
            }
        }
        for (std::size_t i = mesh.triangles.size(); i > 1; --i) {
            std::swap(mesh.triangles[i - 1], mesh.triangles[below(static_cast<std::uint32_t>(i))]);
        }
        const ShapedMesh shape = shaped(finished(mesh.positions, mesh.triangles));
        EXPECT_EQ(shape.report.sheets + shape.report.terrains + shape.report.solids_with_holes, 0U);
        const MeshQuery query = queryOf(shape.mesh);
        const auto share = [&] { return static_cast<float>(random() >> 8) * 0x1p-24F; };
        for (int i = 0; i < 500; ++i) {
            const float x = share();
            const float y = share();
            const glm::vec3 p = glm::vec3(grid.size()) * glm::vec3(x, y, share());
            if (grid.distance(p, 1) > 1e-4) {
                ASSERT_EQ(query.inside(p), grid.inside(p)) << p.x << " " << p.y << " " << p.z;
            }
        }
    }
}

TEST(Shape, SeparatePanelsEncloseASolid) {
    // The faces of a cube, each slightly too small.
    std::vector<TriangleMesh> panels;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.50075, 1.50075}) {
            panels.push_back(makePanel(axis, side));
        }
    }
    const ShapedMesh shape = shaped(joined(panels));
    expectKinds(shape.report, 0, 1, 0, 0);
    const MeshQuery query = queryOf(shape.mesh);
    const MeshQuery whole = queryOf(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.50075)));
    int differ = 0;
    for (const glm::vec3& p : pointsIn(whole.mesh().bounds, 20'000)) {
        differ += query.inside(p) != whole.inside(p) ? 1 : 0;
    }
    EXPECT_LT(differ, 20);
}

TEST(Shape, PartsAreAUnion) {
    // Two overlapping boxes, and a sheet that protrudes from one of them.
    const TriangleMesh sheet = scaled(makePlane(0.0F, 2), 1.0, {1.0, 0.0, 0.0});
    const ShapedMesh shape = shaped(joined(
        {makeBoxMesh({0, 0, 0}, glm::dvec3(1.0)), makeBoxMesh({0.5, 0.5, 0}, glm::dvec3(1.0)), sheet}));
    expectKinds(shape.report, 2, 0, 1, 0);
    const MeshQuery query = queryOf(shape.mesh);
    EXPECT_TRUE(query.inside({0.2F, 0.2F, 0.1F}));   // in both boxes
    EXPECT_TRUE(query.inside({0.6F, 0.01F, 0.1F}));  // and in the sheet
    EXPECT_TRUE(query.inside({1.9F, 0.02F, 0.1F}));  // only in the sheet
    EXPECT_FALSE(query.inside({1.9F, 0.03F, 0.1F}));
}

TEST(Shape, HeightFieldIsSolidBelow) {
    const TriangleMesh terrain = makeHeights(hills);
    for (const TriangleMesh& mesh : {terrain, reversed(terrain)}) {
        const ShapedMesh shape = shaped(mesh);
        expectKinds(shape.report, 0, 0, 0, 1);
        const MeshQuery query = queryOf(shape.mesh);
        EXPECT_TRUE(query.watertight());
        MersenneRandom random(5);
        for (int i = 0; i < 2000; ++i) {
            const double x = 1.98 * random.uniform() - 0.99;
            const double z = 1.98 * random.uniform() - 0.99;
            const double y = hills(x, z);
            EXPECT_FALSE(query.inside(glm::vec3(x, y + 0.01, z)));
            EXPECT_TRUE(query.inside(glm::vec3(x, y - 0.01, z)));
        }
    }
}

TEST(Shape, SmallOrSlantedSheetIsNotTerrain) {
    // An overhang, and a sheet with a circular outline.
    const TriangleMesh overhang = makeHeights([](double x, double) { return x < 0.0 ? 0.0 : 0.3; });
    const TriangleMesh folded =
        moved(overhang, [](const glm::dvec3& p) { return p - glm::dvec3(p.y > 0.1 ? 0.3 : 0.0, 0.0, 0.0); });
    expectKinds(shaped(folded).report, 0, 0, 1, 0);
    const TriangleMesh disc =
        without(makeHeights(hills), [](const glm::dvec3& p) { return p.x * p.x + p.z * p.z > 0.9; });
    expectKinds(shaped(disc).report, 0, 0, 1, 0);
    // A sheet as long as its mesh, but only half as wide.
    for (const int axis : {0, 2}) {
        const TriangleMesh strip = moved(makeHeights(hills), [&](glm::dvec3 p) {
            p[axis] *= 0.5;
            return p;
        });
        glm::dvec3 post(0.0);
        post[axis] = 0.9;
        expectKinds(shaped(joined({strip, makeBoxMesh(post, glm::dvec3(0.1))})).report, 1, 0, 1, 0);
    }
}

TEST(Shape, AsOverridesRays) {
    // A room: the walls of a closed box.
    const ShapedMesh room = shaped(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0)), ShapeAs::kShell);
    expectKinds(room.report, 0, 0, 1, 0);
    EXPECT_FALSE(queryOf(room.mesh).inside(glm::vec3(0.0F)));
    EXPECT_TRUE(queryOf(room.mesh).inside({0.99F, 0.3F, 0.2F}));
    const ShapedMesh ground = shaped(makePlane(0.0F, 2), ShapeAs::kTerrain);
    expectKinds(ground.report, 0, 0, 0, 1);
    EXPECT_TRUE(queryOf(ground.mesh).inside({0.3F, -0.05F, 0.2F}));
    EXPECT_FALSE(queryOf(ground.mesh).inside({0.3F, 0.01F, 0.2F}));
}

/// A sheet, a thin box and a single triangle, across each axis.
TEST(Shape, FlatMeshesAreViewedFaceOn) {
    const TriangleMesh triangle = finished({{-1, 0, -1}, {1, 0, -0.8F}, {0.2F, 0, 1}}, {{0, 1, 2}});
    for (int axis = 0; axis < 3; ++axis) {
        const auto facing = [&](const glm::dvec3& p) {
            glm::dvec3 q;
            q[axis] = p.y;
            q[(axis + 1) % 3] = p.z;
            q[(axis + 2) % 3] = p.x;
            return q;
        };
        for (const TriangleMesh& mesh :
             {makePlane(0.0F, 16), makeBoxMesh(glm::dvec3(0.0), {1.0, 1e-5, 1.0}), triangle}) {
            const ShapedMesh shape = shaped(moved(mesh, facing), ShapeAs::kAuto, 0.02);
            const std::vector<TruthPoint> near = sampleNear(queryOf(shape.mesh), {.samples = 20'000});
            EXPECT_LT(measureNear(near, fieldOf(patchesOf(shape, 65'536))).total(), 1.0)
                << shape.report.text();
        }
    }
}

/// Particles that take at least two steps through a shell never pass it, from either side.
TEST(Shape, StepsBelowHalfAThicknessNeverPassAShell) {
    constexpr int kParticles = 80'000;
    constexpr double kSpeed = kThickness / 2.0;
    struct Target {
        const char* name;
        TriangleMesh mesh;
        glm::dvec3 low;  ///< lower bound of the targets on the sheet
        glm::dvec3 high;
        glm::dvec3 through;  ///< the direction of flight; its negative is also tested
    };
    const std::vector<Target> targets = {
        {"sheet", makePlane(0.0F, 1), {-0.97, 0, -0.97}, {0.97, 0, 0.97}, {0, 1, 0}},
        {"wall of a box without lid", makeOpenBox(), {1, -0.97, -0.97}, {1, 0.97, 0.97}, {1, 0, 0}},
        {"bottom of a cup", makeCup(), {-0.45, -1, -0.45}, {0.45, -1, 0.45}, {0, 1, 0}},
    };
    for (const Target& target : targets) {
        const Collider collider = patchesOf(shaped(target.mesh), 1'000'000);
        MersenneRandom random(11);
        int passed = 0;
        for (int i = 0; i < kParticles; ++i) {
            const glm::dvec3 share{random.uniform(), random.uniform(), random.uniform()};
            const glm::dvec3 at = target.low + share * (target.high - target.low);
            const glm::dvec3 slant = 0.3 * random.direction() * (1.0 - glm::abs(target.through));
            glm::dvec3 along = glm::normalize((i % 2 == 0 ? 1.0 : -1.0) * target.through + slant);
            // From two thicknesses before the sheet to two behind it, with a random first step.
            bool stopped = false;
            for (double way = random.uniform() * kSpeed; way < 4.0 * kThickness && !stopped; way += kSpeed) {
                stopped = evaluateInside(collider, glm::vec3(at + (way - 2.0 * kThickness) * along)).inside;
            }
            passed += stopped ? 0 : 1;
        }
        EXPECT_EQ(passed, 0) << target.name << ", of " << kParticles;
    }
}

}  // namespace
}  // namespace relief::test
