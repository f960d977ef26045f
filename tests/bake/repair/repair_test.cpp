// SPDX-License-Identifier: Apache-2.0
// The guarantees of hole_caps.h, mesh_edges.h, mesh_health.h, repair.h and winding.h.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <random>
#include <set>

#include "bake/import/mesh_import.h"
#include "bake/measure/accuracy.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/triangle_plane.h"
#include "bake/repair/hole_caps.h"
#include "bake/repair/mesh_health.h"
#include "bake/repair/repair.h"
#include "bake/repair/winding.h"
#include "tests/bake/meshes.h"
#include "tests/bake/points.h"
#include "tests/seeds.h"

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

TriangleMesh unitBox(const glm::dvec3& center) {
    return makeBoxMesh(center, glm::dvec3(0.5));
}

TriangleMesh withRandomFlips(TriangleMesh mesh, unsigned seed) {
    std::mt19937 random(seed);
    for (glm::uvec3& t : mesh.triangles) {
        if (random() % 2 == 0) {
            std::swap(t.y, t.z);
        }
    }
    return mesh;
}

/// A strip around the z axis with a half twist.
TriangleMesh makeMoebiusStrip(unsigned around, unsigned across) {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (unsigned i = 0; i < around; ++i) {
        for (unsigned j = 0; j <= across; ++j) {
            const double a = 6.283185307179586 * i / around;
            const double w = 0.4 * (2.0 * j / across - 1.0);
            const double r = 1.0 + w * std::cos(0.5 * a);
            positions.emplace_back(r * std::cos(a), r * std::sin(a), w * std::sin(0.5 * a));
            const auto index = [&](unsigned u, unsigned v) {
                return u < around ? u * (across + 1) + v : across - v;
            };
            if (j < across) {
                triangles.emplace_back(index(i, j), index(i + 1, j), index(i + 1, j + 1));
                triangles.emplace_back(index(i, j), index(i + 1, j + 1), index(i, j + 1));
            }
        }
    }
    return finished(positions, triangles);
}

TEST(MeshHealth, ClosedSolidsHaveNoFaults) {
    for (const TriangleMesh& mesh :
         {unitBox({1, 2, 3}), makeIcosphere({0, 0, 0}, 1.0, 3), makeTorusMesh(1, 0.3, 20, 9)}) {
        const MeshHealth health = inspectMesh(mesh);
        EXPECT_TRUE(health.isSolid() && health.closed && !health.inside_out) << faultsText(health);
        EXPECT_EQ(health.components, 1U);
        EXPECT_EQ(health.closed_components, 1U);
        EXPECT_TRUE(requireSolid(health, "m"));
    }
}

TEST(MeshHealth, EveryFaultIsCounted) {
    TriangleMesh open = unitBox({0, 0, 0});
    open.triangles.pop_back();
    MeshHealth health = inspectMesh(open);
    EXPECT_EQ(health.boundary_edges, 3U);
    EXPECT_FALSE(health.closed);
    EXPECT_EQ(health.closed_components, 0U);
    for (const char* const words : {"open.obj: not a closed solid: 3 boundary edges", "-0.5/0/0.5"}) {
        expectError(requireSolid(health, "open.obj"), ErrorCode::kInvalidInput, words);
    }
    // Triangle 4, 7, 6 is missing. Among its edges, 4–6 has the lowest vertices.
    EXPECT_EQ(health.first_fault->position, glm::vec3(-0.5F, 0.0F, 0.5F));

    TriangleMesh turned = unitBox({0, 0, 0});
    std::swap(turned.triangles[3].y, turned.triangles[3].z);
    health = inspectMesh(turned);
    EXPECT_EQ(health.inconsistent_edges, 3U);
    EXPECT_EQ(health.boundary_edges, 0U);
    EXPECT_TRUE(health.closed);

    TriangleMesh twice = unitBox({0, 0, 0});
    const glm::uvec3 t = twice.triangles[5];
    twice.triangles.emplace_back(t.z, t.y, t.x);
    health = inspectMesh(twice);
    EXPECT_EQ(health.duplicate_triangles, 1U);
    EXPECT_EQ(health.nonmanifold_edges, 3U);

    // Two boxes with a common edge, and two with a common corner.
    health = inspectMesh(joined({unitBox({0, 0, 0}), unitBox({1, 1, 0})}));
    EXPECT_EQ(health.nonmanifold_edges, 1U);
    EXPECT_EQ(health.nonmanifold_vertices, 0U);
    EXPECT_EQ(health.components, 1U);
    health = inspectMesh(joined({unitBox({0, 0, 0}), unitBox({1, 1, 1})}));
    EXPECT_EQ(health.nonmanifold_edges, 0U);
    EXPECT_EQ(health.nonmanifold_vertices, 1U);
    EXPECT_EQ(health.components, 2U);
    EXPECT_EQ(health.first_fault->position, glm::vec3(0.5F));

    health = inspectMesh(reversed(unitBox({0, 0, 0})));
    EXPECT_TRUE(health.inside_out);
    EXPECT_FALSE(health.isSolid());

    const TriangleMesh thin = finished({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 1, 3}});
    EXPECT_EQ(inspectMesh(thin).degenerate_triangles, 1U);

    const MeshHealth strip = inspectMesh(makeMoebiusStrip(40, 4));
    EXPECT_EQ(strip.boundary_edges, 80U);
    EXPECT_EQ(strip.inconsistent_edges, 4U) << "edges of the seam";
}

// --- winding ---

/// Some maps of a mesh after windOutwards(), as in a bake.
Collider bakedOutwards(const TriangleMesh& mesh) {
    Winding winding = required(windOutwards(mesh));
    return bakeSpecs(winding.mesh,
                     {"front-back:dir=1/2/3,decode=plane", "fixed8:dir=-y", "cube:decode=plane",
                      "float:dir=-x,box=-5/-5/-5/0/5/5"},
                     48);
}

TEST(Winding, ValidMeshesAreUnchanged) {
    for (const TriangleMesh& mesh :
         {unitBox({1, 2, 3}), reversed(unitBox({0, 0, 0})), makePlane(0, 5),
          joined({unitBox({0, 0, 0}), unitBox({3, 0, 0})}),
          joined({makeIcosphere({0, 0, 0}, 1, 2), reversed(makeIcosphere({0, 0, 0}, 0.5, 2))})}) {
        const Winding winding = required(windOutwards(mesh));
        EXPECT_EQ(winding.turned, 0U);
        EXPECT_EQ(winding.mesh->triangles, mesh.triangles);
    }
}

TEST(Winding, SheetKeepsItsMajorityWinding) {
    const TriangleMesh sheet = makePlane(0, 5);
    TriangleMesh mixed = sheet;
    for (const std::size_t triangle : {3U, 20U, 41U}) {
        std::swap(mixed.triangles[triangle].y, mixed.triangles[triangle].z);
    }
    const Winding winding = required(windOutwards(mixed));
    EXPECT_EQ(winding.turned, 3U);
    EXPECT_EQ(winding.mesh->triangles, sheet.triangles);
}

TEST(Winding, FlippedTrianglesAreRestored) {
    const TriangleMesh bunny = required(importMesh("/usr/share/glmark2/models/bunny.obj"));
    const TriangleMesh hollow =
        joined({makeIcosphere({0, 0, 0}, 1, 3), reversed(makeIcosphere({0, 0, 0}, 0.5, 3))});
    const TriangleMesh crossing = joined({unitBox({0, 0, 0}), unitBox({0.4, 0.3, 0.2})});
    unsigned seed = seedFrom(1);
    for (const TriangleMesh& mesh : {bunny, hollow, crossing, makeTorusMesh(1, 0.3, 40, 20)}) {
        const Collider truth = bakedOutwards(mesh);
        const TriangleMesh flipped = withRandomFlips(mesh, seed++);
        const Winding winding = required(windOutwards(flipped));
        EXPECT_GT(winding.turned, mesh.triangles.size() / 3);
        EXPECT_EQ(winding.mesh->triangles, mesh.triangles);
        EXPECT_EQ(bakedOutwards(flipped).maps, truth.maps);
    }
    // An inner ball remains a hollow, even if wound outward.
    const TriangleMesh nested = joined({makeIcosphere({0, 0, 0}, 1, 3), makeIcosphere({0, 0, 0}, 0.5, 3)});
    EXPECT_EQ(required(windOutwards(nested)).mesh->triangles, hollow.triangles);
}

/// A former bug: hollows were filled if their wall was thinner than the ray offset, 1e-4 of the longest side.
TEST(Winding, ThinWalledHollowStaysHollow) {
    for (const double wall : {1e-3, 1e-4, 1e-5, 1e-6}) {
        SCOPED_TRACE(wall);
        const TriangleMesh outer = makeBoxMesh({0, 0, 0}, {1, 1, 1});
        const TriangleMesh inner = makeBoxMesh({0, 0, 0}, glm::dvec3(1.0 - wall));
        for (const TriangleMesh& mesh : {joined({outer, inner}), joined({reversed(inner), outer})}) {
            const MeshQuery query = queryOf(required(windOutwards(mesh)).mesh);
            EXPECT_FALSE(query.inside({0.1F, 0.2F, 0.3F}));
            EXPECT_TRUE(query.inside({static_cast<float>(1.0 - 0.5 * wall), 0.2F, 0.3F}));
        }
    }
}

/// Each ray classifies all surfaces it crosses: separate rays would take quadratic time.
TEST(Winding, HandlesThousandsOfNestedSurfaces) {
    constexpr int kShells = 2000;
    std::vector<TriangleMesh> shells;
    for (int i = 0; i < kShells; ++i) {
        const TriangleMesh box = makeBoxMesh({0, 0, 0}, glm::dvec3(1.0 - 0.9 * i / kShells));
        shells.push_back(i % 3 == 0 ? reversed(box) : box);
    }
    const MeshQuery query = queryOf(required(windOutwards(joined(shells))).mesh);
    for (int i = 0; i < kShells; i += 37) {  // between a shell and the next one
        const auto x = static_cast<float>(1.0 - 0.9 * (i + 0.5) / kShells);
        EXPECT_EQ(query.inside({x, 0.03F, -0.02F}), i % 2 == 0) << i;
    }
}

/// With coincident copies every edge has thousands of triangles, each of which is a separate patch.
TEST(Winding, ThousandsOfCopiesStayOutward) {
    const TriangleMesh box = makeBoxMesh({0, 0, 0}, {1, 1, 1});
    std::vector<glm::uvec3> triangles;
    for (int i = 0; i < 2001; ++i) {
        triangles.insert(triangles.end(), box.triangles.begin(), box.triangles.end());
    }
    EXPECT_EQ(required(windOutwards(finished(box.positions, triangles))).turned, 0U);
}

TEST(Winding, OneSidedStripsBakeTheSameField) {
    const TriangleMesh strip = makeMoebiusStrip(60, 6);
    const Collider truth = bakedOutwards(strip);
    const Collider flipped = bakedOutwards(withRandomFlips(strip, 7));
    for (const glm::vec3& p : pointsIn(strip.bounds, 20'000)) {
        const FieldSample a = evaluate(truth, p);
        const FieldSample b = evaluate(flipped, p);
        ASSERT_TRUE(a.inside() == b.inside() && std::abs(a.distance - b.distance) <= 1e-4F);
    }
}

TEST(Winding, OverlapOfSolidsIsInside) {
    const TriangleMesh crossing = joined({unitBox({0, 0, 0}), unitBox({0.4, 0.3, 0.2})});
    const TriangleMesh hollow = joined({makeBoxMesh({0, 0, 0}, {2, 2, 2}), reversed(unitBox({0, 0, 0}))});
    const TriangleMesh island = joined({hollow, makeBoxMesh({0, 0, 0}, {0.2, 0.2, 0.2})});
    const auto insideAt = [](const TriangleMesh& mesh, const glm::vec3& p) {
        return queryOf(windOutwards(withRandomFlips(mesh, 11))->mesh).inside(p);
    };
    EXPECT_TRUE(insideAt(crossing, {0.2F, 0.1F, 0.1F})) << "inside both";
    EXPECT_TRUE(insideAt(crossing, {-0.4F, 0.1F, 0.1F}));
    EXPECT_FALSE(insideAt(crossing, {-0.4F, 0.7F, 0.1F}));
    EXPECT_FALSE(insideAt(hollow, {0.1F, 0.1F, 0.1F}));
    EXPECT_TRUE(insideAt(island, {0.1F, 0.1F, 0.1F}));
    EXPECT_FALSE(insideAt(island, {0.3F, 0.3F, 0.3F}));
    EXPECT_TRUE(insideAt(island, {1.0F, 1.0F, 1.0F}));
    const Collider collider = bakedOutwards(crossing);
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 p(-0.08F + 0.0005F * static_cast<float>(i), 0.1F, 0.05F);  // passes through both
        EXPECT_TRUE(evaluate(collider, p).inside()) << p.x;
    }
}

// --- repair ---

TEST(MeshRepair, WrapIsASolidAroundTheMesh) {
    TriangleMesh open = makeIcosphere({5, 0, 0}, 2.0, 3);
    open.triangles.resize(open.triangles.size() - 2);
    const TriangleMesh soup = joined({withRandomFlips(open, 3), unitBox({6.5, 0.5, 0.1})});
    for (const double alpha : {0.1, 0.05}) {
        const TriangleMesh wrap = required(wrapMesh(soup, alpha));
        const MeshHealth health = inspectMesh(wrap);
        EXPECT_TRUE(health.isSolid()) << faultsText(health);
        EXPECT_EQ(wrap.name, soup.name);
        const MeshQuery query = queryOf(wrap);
        for (const glm::vec3& p : soup.positions) {
            EXPECT_TRUE(query.inside(p));
        }
        const MeshQuery source = queryOf(soup);
        const double offset = alpha / 30.0 * static_cast<double>(soup.bounds.longestSide());
        for (const glm::vec3& p : wrap.positions) {
            EXPECT_NEAR(source.closest(p).distance, offset, 0.01 * offset);
        }
        const TriangleMesh again = required(wrapMesh(soup, alpha));
        EXPECT_TRUE(again.positions == wrap.positions && again.triangles == wrap.triangles);
    }
    for (const double alpha : {0.0, -1.0, 1.0, std::nan("")}) {
        expectError(wrapMesh(soup, alpha), ErrorCode::kUsage);
    }
}

}  // namespace
}  // namespace relief::test
