// SPDX-License-Identifier: Apache-2.0
// Caps over the holes of nearly closed meshes: the guarantees of hole_caps.h and mesh_edges.h.
#include "bake/repair/hole_caps.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <set>

#include "bake/measure/accuracy.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/triangle_plane.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

TriangleMesh closedBy(const TriangleMesh& mesh) {
    const Result<PreparedMesh> closed = closeHoles(mesh);
    EXPECT_TRUE(closed) << closed.error().message;
    return closed ? **closed : mesh;
}

double volume(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const TrianglePlane plane = planeOf(mesh, i);
        sum += dot(plane.point, plane.normal) / 6.0;
    }
    return sum;
}

/// A unit ball without the triangles above y = `height`.
TriangleMesh makeCutBall(double height, int levels = 4) {
    return without(makeIcosphere(glm::dvec3(0.0), 1.0, levels),
                   [&](const glm::dvec3& p) { return p.y > height; });
}

void expectClosed(const TriangleMesh& mesh, std::uint64_t holes) {
    const TriangleMesh closed = closedBy(mesh);
    EXPECT_EQ(closed.closed_holes, holes);
    EXPECT_EQ(closed.sourceTriangles(), mesh.triangles.size());
    EXPECT_TRUE(std::equal(mesh.triangles.begin(), mesh.triangles.end(), closed.triangles.begin()));
    EXPECT_TRUE(queryOf(closed).watertight());
    EXPECT_EQ(closed.bounds.min, mesh.bounds.min);
    EXPECT_EQ(closed.bounds.max, mesh.bounds.max);
    for (std::uint32_t i = 0; i < closed.triangles.size(); ++i) {
        EXPECT_NE(planeOf(closed, i).normal, glm::dvec3(0.0)) << "triangle " << i << " has no area";
    }
    // Wound like their neighbours: both directions of an edge are used equally often.
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> directed;
    for (const glm::uvec3& t : closed.triangles) {
        for (int i = 0; i < 3; ++i) {
            directed.emplace(t[i], t[(i + 1) % 3]);
        }
    }
    for (const auto& [a, b] : directed) {
        EXPECT_EQ(directed.count({a, b}), directed.count({b, a})) << a << " to " << b;
    }
}

void expectKept(const TriangleMesh& mesh) {
    const TriangleMesh same = closedBy(mesh);
    EXPECT_EQ(same.closed_holes, 0U);
    EXPECT_EQ(same.cap_triangles, 0U);
    EXPECT_EQ(same.triangles, mesh.triangles);
    EXPECT_EQ(same.positions, mesh.positions);
}

TEST(OddEdges, OpenEdgesFollowTheirTriangle) {
    const TriangleMesh box = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0));
    EXPECT_TRUE(oddEdges(edgesOf(box)).empty());
    TriangleMesh open = box;
    open.triangles.erase(open.triangles.begin());  // 0, 4, 6: its neighbours use the opposite directions
    EXPECT_EQ(oddEdges(edgesOf(open)), (std::vector<OddEdge>{{4, 0}, {0, 6}, {6, 4}}));
}

TEST(OddEdges, EqualPositionsAreOneVertex) {
    // Positive and negative zeros are equal; the midpoints of the ball's edges have both.
    TriangleMesh ball = makeIcosphere(glm::dvec3(0.0), 1.0, 2);
    const std::size_t count = ball.positions.size();
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3& p = ball.positions[i];
        ball.positions.emplace_back(p.x == 0.0F ? -p.x : p.x, p.y == 0.0F ? -p.y : p.y,
                                    p.z == 0.0F ? -p.z : p.z);
    }
    for (std::size_t i = 0; i < ball.triangles.size(); i += 2) {
        ball.triangles[i] += static_cast<std::uint32_t>(count);
    }
    EXPECT_TRUE(oddEdges(edgesOf(ball)).empty());
}

TEST(HoleCaps, BallWithoutItsTopBecomesSolid) {
    const TriangleMesh mesh = makeCutBall(0.8);
    expectClosed(mesh, 1);
    const TriangleMesh closed = closedBy(mesh);
    // A ball without a cap of height 0.2, within the error of facets and the jagged cut.
    EXPECT_NEAR(volume(closed), 3.14159265 * (4.0 / 3.0 - 0.04 * (3.0 - 0.2) / 3.0), 0.06);
    const MeshQuery query = queryOf(closed);
    EXPECT_TRUE(query.inside({0.0F, 0.7F, 0.0F}));
    EXPECT_FALSE(query.inside({0.0F, 0.9F, 0.0F}));
}

TEST(HoleCaps, TriangularHolesGetOneTriangle) {
    // Two triangles of an icosahedron with one common vertex: two holes.
    TriangleMesh mesh = makeIcosphere(glm::dvec3(0.0), 1.0, 0);
    std::erase_if(mesh.triangles,
                  [](const glm::uvec3& t) { return t == glm::uvec3(0, 11, 5) || t == glm::uvec3(0, 1, 7); });
    expectClosed(mesh, 2);
    EXPECT_EQ(closedBy(mesh).cap_triangles, 2U);
}

TEST(HoleCaps, HolesSharingTwoVerticesKeepTheWinding) {
    // Only the two triangles of an edge remain at its ends. Their tips belong to both holes, so a walk can continue
    // there in either direction.
    const TriangleMesh ball = makeIcosphere(glm::dvec3(0.0), 1.0, 4);
    const auto has = [](const glm::uvec3& t, std::uint32_t v) { return t.x == v || t.y == v || t.z == v; };
    for (std::size_t i = 0; i < ball.triangles.size(); i += 397) {
        SCOPED_TRACE(i);
        const std::uint32_t a = ball.triangles[i].x;
        const std::uint32_t b = ball.triangles[i].y;
        std::vector<glm::uvec3> kept;
        for (const glm::uvec3& t : ball.triangles) {
            if (has(t, a) == has(t, b)) {
                kept.push_back(t);
            }
        }
        expectClosed(finished(ball.positions, kept), 2);
    }
}

TEST(HoleCaps, CentroidMayBeCollinearWithEdges) {
    // A prism whose section is two adjacent rectangles, one shifted up. It is point-symmetric, and two edges are
    // collinear with the centre.
    const glm::vec2 section[] = {{-2, -1}, {0, -1}, {0, -3}, {2, -3}, {2, 1}, {0, 1}, {0, 3}, {-2, 3}};
    std::vector<glm::vec3> positions;
    for (const float y : {20.0F, 0.0F}) {
        for (const glm::vec2& p : section) {
            positions.emplace_back(p.x, y, p.y);
        }
    }
    std::vector<glm::uvec3> triangles = {{8, 9, 13},   {8, 13, 14}, {8, 14, 15},
                                         {11, 12, 13}, {11, 13, 9}, {11, 9, 10}};
    for (std::uint32_t i = 0; i < 8; ++i) {
        const std::uint32_t j = (i + 1) % 8;
        triangles.emplace_back(j + 8, i + 8, i);
        triangles.emplace_back(j + 8, i, j);
    }
    const TriangleMesh mesh = finished(positions, triangles);
    expectClosed(mesh, 1);
    const glm::vec3 apex = closedBy(mesh).positions.back();
    EXPECT_NE(apex, glm::vec3(0.0F, 20.0F, 0.0F));
    EXPECT_LT(glm::length(apex - glm::vec3(0.0F, 20.0F, 0.0F)), 1e-3F);
}

TEST(HoleCaps, ClosesTJunctions) {
    // One triangle of a box has an extra vertex in the middle of an edge, which its neighbour lacks: a hole without
    // area.
    TriangleMesh mesh = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0));
    const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::uvec3 split = mesh.triangles.front();
    mesh.positions.push_back(0.5F * (mesh.positions[split.x] + mesh.positions[split.y]));
    mesh.triangles.front() = {split.x, middle, split.z};
    mesh.triangles.emplace_back(middle, split.y, split.z);
    ASSERT_EQ(oddEdges(edgesOf(mesh)).size(), 3U);
    expectClosed(mesh, 1);
    EXPECT_NEAR(volume(closedBy(mesh)), 8.0, 1e-5);
}

TEST(HoleCaps, ClosedMeshesAreUnchanged) {
    expectKept(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0), rotation({1, 2, 3}, 25)));
    expectKept(makeTorusMesh(1.0, 0.3, 24, 12));
}

TEST(HoleCaps, SheetsTerrainsAndBowlsStayOpen) {
    // For any rotation. Rotated bounds are not flat, and one side always has more of the seven directions of
    // MeshQuery::inside.
    for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 2, 3)}) {
        for (const double degrees : {0.0, 30.0, 210.0}) {
            expectKept(
                moved(makePlane(0.0F, 8), [&](const glm::dvec3& p) { return rotation(axis, degrees) * p; }));
        }
    }
    const TriangleMesh terrain = moved(makePlane(0.0F, 32), [&](const glm::dvec3& p) {
        const double y = 0.5 * (std::sin(5.0 * p.x) * std::cos(4.0 * p.z) + 0.3 * p.x);
        return glm::dvec3(p.x, y, p.z);
    });
    expectKept(terrain);
    expectKept(reversed(terrain));
    for (const double height : {-0.5, 0.0, 0.1}) {
        expectKept(makeCutBall(height));
    }
}

TEST(HoleCaps, DisconnectedTrianglesAreNotCapped) {
    // Every triangle of a ball is shrunk: caps would only cover the triangles themselves.
    const TriangleMesh ball = makeIcosphere(glm::dvec3(0.0), 1.0, 3);
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (const glm::uvec3& t : ball.triangles) {
        const glm::vec3 middle = (ball.positions[t.x] + ball.positions[t.y] + ball.positions[t.z]) / 3.0F;
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const std::uint32_t v : {t.x, t.y, t.z}) {
            positions.push_back(ball.positions[v] + 1e-3F * (middle - ball.positions[v]));
        }
        triangles.emplace_back(first, first + 1, first + 2);
    }
    const TriangleMesh mesh = finished(positions, triangles);
    EXPECT_GT(measureEnclosure(queryOf(mesh)).agreement, 0.95);
    expectKept(mesh);
}

TEST(HoleCaps, EnclosureMatchesClosedForms) {
    const Enclosure ball = measureEnclosure(queryOf(makeIcosphere(glm::dvec3(0.0), 1.0, 4)));
    EXPECT_EQ(ball.one_sided, 1.0);
    EXPECT_NEAR(ball.agreement, 1.0, 1e-3);
    const Enclosure sheet = measureEnclosure(queryOf(makePlane(0.0F, 8)));
    EXPECT_LE(sheet.one_sided, 0.02);
    EXPECT_NEAR(sheet.agreement, 0.5, 0.01);
    // Half a ball: a fifth of the directions leave through the opening. This is the mean solid angle of the disc from
    // the hemisphere, between (1 - √½) / 2 at the bottom and ¼ at the rim.
    const Enclosure half = measureEnclosure(queryOf(makeCutBall(0.0, 5)));
    EXPECT_GT(half.one_sided, 0.99);
    EXPECT_NEAR(half.agreement, 0.8, 0.015);
}

TEST(HoleCaps, BakeUsesTheSolidAndNamesTheSource) {
    const TriangleMesh mesh = makeCutBall(0.8);
    const std::vector<TruthPoint> near = sampleNear(queryOf(mesh), {.samples = 20'000});
    const auto falseOutside = [&](const TriangleMesh& baked) {
        const Collider collider =
            bakeSpecs(baked, {"front-back:dir=-x,decode=plane", "front-back:dir=-y,decode=plane",
                              "front-back:dir=-z,decode=plane"});
        EXPECT_EQ(collider.provenance.triangles, mesh.triangles.size());
        return measureNear(near, fieldOf(collider)).false_outside;
    };
    EXPECT_GT(falseOutside(mesh), 3.0);
    EXPECT_LT(falseOutside(closedBy(mesh)), 1.0);
}

}  // namespace
}  // namespace relief::test
