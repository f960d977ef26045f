// SPDX-License-Identifier: Apache-2.0
// Texels that know the other maps, and the bias that users ask for: measured by points that the refinement
// never saw.
#include "bake/texels/refine.h"

#include "bake/measure/accuracy.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/pipeline/bake.h"
#include "tests/bake/meshes.h"
#include "tests/bake/plan_views.h"

namespace relief::test {
namespace {

WrongShare wrongNear(const MeshQuery& query, const Collider& collider) {
    return measureNear(sampleNear(query, {.samples = 120'000, .seed = 99}), fieldOf(collider));
}

Collider bakePlanned(const TriangleMesh& mesh, const MeshQuery& query, Quality quality, Prefer prefer) {
    PlanOptions plan_options;
    plan_options.budget_bytes = 65536;
    plan_options.views.prefer = prefer;
    return bakeMaps(mesh, specsOf(required(planViews(query, plan_options))), quality, prefer);
}

std::vector<TriangleMesh> shapes() {
    return {makeTorusMesh(1.0, 0.4, 64, 32), makeIcosphere({1, 2, 3}, 2.0, 4),
            makeBoxMesh({0, 0, 0}, {1, 0.6, 0.3}, rotation({1, 2, 3}, 33.0))};
}

TEST(Refine, MakesFewerMistakesAmongPointsItNeverSaw) {
    int better = 0;
    for (const TriangleMesh& mesh : shapes()) {
        const MeshQuery query = queryOf(mesh);
        Collider collider = bakePlanned(mesh, query, Quality::kFast, Prefer::kNeither);
        const WrongShare before = wrongNear(query, collider);
        refineTexels(collider, query, {});
        const WrongShare after = wrongNear(query, collider);
        EXPECT_LE(after.total(), before.total());
        better += after.total() < 0.98 * before.total() ? 1 : 0;
    }
    EXPECT_GE(better, 2);  // the turned box has little left to gain
}

/// The rest of the points is asked only where a part of them had something to mend.
TEST(Refine, GoesOnWhereSomethingWasMended) {
    const auto refined = [](Collider collider, const MeshQuery& query, double worth_mending) {
        refineTexels(collider, query, {.worth_mending = worth_mending});
        return collider.maps[0].texels;
    };
    const double as_usual = RefineOptions().worth_mending;
    constexpr double kAlways = -1e9;
    constexpr double kNever = 1e9;
    {
        const TriangleMesh torus = makeTorusMesh(1.0, 0.4, 64, 32);
        const MeshQuery query = queryOf(torus);
        const Collider coarse = bakePlanned(torus, query, Quality::kFast, Prefer::kNeither);
        EXPECT_EQ(refined(coarse, query, as_usual), refined(coarse, query, kAlways));
        EXPECT_NE(refined(coarse, query, as_usual), refined(coarse, query, kNever));
    }
    {  // a smooth mesh has nothing to mend, not even for all points
        const TriangleMesh ball = makeIcosphere({1, 2, 3}, 2.0, 4);
        const MeshQuery query = queryOf(ball);
        const Collider smooth = bakePlanned(ball, query, Quality::kNormal, Prefer::kNeither);
        EXPECT_EQ(refined(smooth, query, as_usual), smooth.maps[0].texels);
        EXPECT_EQ(refined(smooth, query, kAlways), smooth.maps[0].texels);
    }
}

TEST(Refine, LeavesMapsOfProjectedDepthAlone) {
    const TriangleMesh mesh = makeTorusMesh(1.0, 0.4, 48, 24);
    const MeshQuery query = queryOf(mesh);
    Collider collider = bakeSpecs(mesh, {"front-back:dir=-z,size=40,depth=unorm16,decode=projected",
                                         "front-back:dir=-x,size=40,depth=half,decode=plane"});
    const std::vector<DepthMap> before = collider.maps;
    refineTexels(collider, query, {});
    EXPECT_EQ(collider.maps, before);
}

TEST(Prefer, ShiftsTheMistakesToTheOtherKind) {
    for (const TriangleMesh& mesh : shapes()) {
        const MeshQuery query = queryOf(mesh);
        const auto wrong = [&](Prefer prefer) {
            return wrongNear(query, bakePlanned(mesh, query, Quality::kNormal, prefer));
        };
        const WrongShare neither = wrong(Prefer::kNeither);
        const WrongShare inside = wrong(Prefer::kInside);
        const WrongShare outside = wrong(Prefer::kOutside);
        // 0.04 % is 48 points.
        EXPECT_LE(inside.false_outside, std::max(0.5 * neither.false_outside, 0.04));
        EXPECT_LE(outside.false_inside, 0.6 * neither.false_inside);
    }
}

/// Every label as the majority of rays has it.
void expectTrueLabels(const TriangleMesh& mesh) {
    const MeshQuery query = queryOf(mesh);
    const double sigma = 0.02 * mesh.bounds.longestSide();
    const std::vector<LabelledPoint> points = drawNearSurface(query, 20'000, sigma, 3);
    ASSERT_GE(points.size(), 5000U);
    std::size_t inside = 0;
    std::size_t wrong = 0;
    for (const LabelledPoint& point : points) {
        inside += point.inside ? 1 : 0;
        wrong += point.inside != query.inside(point.position) ? 1 : 0;
    }
    EXPECT_GT(inside, points.size() / 3);
    EXPECT_LT(inside, points.size() * 2 / 3);
    EXPECT_LE(wrong, points.size() / 2000);  // points on the surface itself may go either way
}

TEST(NearSurface, LabelsAreTrueWhateverTheWinding) {
    TriangleMesh mesh = makeTorusMesh(1.0, 0.4, 48, 24);
    expectTrueLabels(mesh);
    for (glm::uvec3& t : mesh.triangles) {
        std::swap(t.y, t.z);  // inside out
    }
    expectTrueLabels(mesh);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
        std::swap(mesh.triangles[i].y, mesh.triangles[i].z);  // no winding at all
    }
    expectTrueLabels(mesh);
    mesh.triangles.pop_back();  // open
    expectTrueLabels(mesh);
}

}  // namespace
}  // namespace relief::test
