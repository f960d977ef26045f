// SPDX-License-Identifier: Apache-2.0
// Counted faults, rejection, repair and winding: the guarantees of mesh_health.h, mesh_repair.h and winding.h.
#include "bake/repair/mesh_health.h"

#include <cmath>
#include <random>

#include "bake/import/mesh_import.h"
#include "bake/repair/mesh_repair.h"
#include "bake/repair/winding.h"
#include "tests/bake/meshes.h"
#include "tests/bake/points.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

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
