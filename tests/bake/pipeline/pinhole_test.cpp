// Rays that are aimed exactly at vertices and edges of closed meshes: none may pass through.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "bake/mesh/triangle_plane.h"
#include "bake/texels/ray_probe.h"
#include "bake/texels/scan_convert.h"
#include "tests/bake/meshes.h"
#include "tests/bake/voxels.h"

namespace relief::test {
namespace {

/// Where a ray enters and leaves the box of half sides 1, grown by `slack`.
std::optional<std::array<double, 2>> clip(const TexelRay& ray, double slack) {
    double low = -1e9;
    double high = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double along = ray.direction[axis];
        if (std::abs(along) < 1e-12) {
            low = std::abs(ray.origin[axis]) > 1.0 + slack ? high : low;
            continue;
        }
        const double ahead = (1.0 + slack) / std::abs(along);
        low = std::max(low, -ray.origin[axis] / along - ahead);
        high = std::min(high, -ray.origin[axis] / along + ahead);
    }
    return low < high ? std::optional(std::array<double, 2>{low, high}) : std::nullopt;
}

/// Traces both ends of a view of the box of half sides 1. Rays that pass within 1e-4 of its silhouette may meet it or not.
void expectNoLeak(const TriangleMesh& mesh, const View& view) {
    constexpr double kRim = 1e-4;
    const Result<RayScene> scene = RayScene::build(mesh);
    ASSERT_TRUE(scene);
    std::uint64_t rays = 0;
    std::uint64_t lost = 0;
    std::uint64_t beside = 0;
    double worst = 0.0;
    const ScanConverter scan(*scene, view);
    for (const RayEnd end : {RayEnd::kNear, RayEnd::kFar}) {
        for (std::uint32_t face = 0; face < view.faceCount(); ++face) {
            std::vector<Hit> hits(std::size_t{view.width} * view.height);
            const bool near = end == RayEnd::kNear;
            scan.scan({face, 0, view.height}, near ? std::span(hits) : std::span<Hit>(),
                      near ? std::span<Hit>() : std::span(hits));
            for (std::uint32_t y = 0; y < view.height; ++y) {
                for (std::uint32_t x = 0; x < view.width; ++x) {
                    const TexelRay ray = view.ray(face, x, y);
                    const Hit& hit = hits[std::size_t{y} * view.width + x];
                    const auto exact = clip(ray, 0.0);
                    if (clip(ray, -kRim) && exact) {
                        ++rays;
                        lost += hit.empty() ? 1U : 0U;
                        const bool leaves = end == RayEnd::kFar || view.projection() == Projection::kCube;
                        const double error = std::abs(double{hit.depth()} - (*exact)[leaves ? 1 : 0]);
                        worst = hit.empty() ? worst : std::max(worst, error);
                    } else if (!clip(ray, kRim)) {
                        beside += hit.empty() ? 0U : 1U;
                    }
                }
            }
        }
    }
    EXPECT_GT(rays, 10U);
    EXPECT_EQ(lost, 0U);
    EXPECT_EQ(beside, 0U);
    EXPECT_LT(worst, 2e-5);
}

View viewOf(const TriangleMesh& mesh, const std::string& text) {
    const Result<MapSpec> spec = parseMapSpec(text, kPaperDefaults);
    EXPECT_TRUE(spec) << spec.error().message;
    const Result<MapSpec> complete = completeSpec(*spec, mesh, 64);
    EXPECT_TRUE(complete) << complete.error().message;
    const Result<View> view = makeView(*complete, mesh);
    EXPECT_TRUE(view) << view.error().message;
    return *view;
}

/// A view along an axis whose texels' centres lie on the grid of 2/n over [−1, 1]².
std::string gridSpec(const std::string& dir, int n) {
    // n + 1 texels from −1 − 1/n to 1 + 1/n, and the border.
    const double edge = 1.0 + 1.0 / n;
    const std::string e = std::to_string(edge);
    return "front-back:dir=" + dir + ",size=" + std::to_string(n + 3) + ",box=-" + e + "/-" + e + "/-" + e +
           "/" + e + "/" + e + "/" + e;
}

/// An orthographic view of 8×8 texels whose texel (3, 4) is aimed at a point.
View aimedAt(const glm::dvec3& at, const glm::dvec3& d) {
    const double texel = 0.01;
    const double depth = 6.0;
    View view;
    view.format = MapFormat::kFloat32;
    view.compare = Compare::kBoth;
    view.width = view.height = 8;
    const glm::dvec3 other = std::abs(d.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    glm::dvec3 r = cross(d, other);
    r = r / std::sqrt(dot(r, r));
    const glm::dvec3 u = cross(r, d);
    view.axis[0] = 8.0 * texel * r;
    view.axis[1] = 8.0 * texel * u;
    view.axis[2] = depth * d;
    view.origin = at - 0.5 * depth * d - (3.5 / 8.0) * view.axis[0] - (4.5 / 8.0) * view.axis[1];
    return view;
}

TEST(Pinholes, VerticesOverTexelCentresAreMet) {
    for (const int n : {8, 16, 60}) {
        VoxelGrid grid({n, n, n});
        for (int i = 0; i < n * n * n; ++i) {
            grid.set({i % n, i / n % n, i / n / n}, true);
        }
        const TriangleMesh box = grid.mesh(glm::dvec3(-1.0), 2.0 / n);
        for (const char* dir : {"-x", "+y", "-z"}) {
            expectNoLeak(box, viewOf(box, gridSpec(dir, n)));
        }
        expectNoLeak(box, viewOf(box, "cube:size=" + std::to_string(n)));
    }
}

/// Embree alone lets a few of a thousand such rays through, to the far side.
TEST(Pinholes, RaysAimedAtVerticesAndEdgesAreMet) {
    for (const glm::dvec3& center : {glm::dvec3(0.0), glm::dvec3(100.1, 50.3, -20.7)}) {
        for (const int levels : {2, 3, 4}) {
            const TriangleMesh ball = makeIcosphere(center, 1.0, levels);
            const Result<RayScene> scene = RayScene::build(ball);
            ASSERT_TRUE(scene);
            std::uint64_t rays = 0;
            std::uint64_t lost = 0;
            double worst = 0.0;
            for (int k = 0; k < 60; ++k) {
                glm::dvec3 d(std::sin(k * 1.7), std::cos(k * 2.3), std::sin(k * 0.9 + 1.0));
                if (k < 6) {
                    d = glm::dvec3(0.0);
                    d[k / 2] = k % 2 == 0 ? 1.0 : -1.0;
                }
                d = d / std::sqrt(dot(d, d));
                for (std::size_t i = 0; i < 1000; ++i) {
                    glm::dvec3 p = ball.positions[i / 2 % ball.positions.size()];
                    if (i % 2 == 1) {
                        const glm::uvec3& t = ball.triangles[i % ball.triangles.size()];
                        p = 0.5 * (glm::dvec3(ball.positions[t.x]) + glm::dvec3(ball.positions[t.y]));
                    }
                    const double cosine = dot(p - center, d);
                    if (std::abs(cosine) < 0.5) {
                        continue;  // too near to the silhouette for eight texels
                    }
                    const View view = aimedAt(p, d);
                    const RayEnd end = cosine < 0.0 ? RayEnd::kNear : RayEnd::kFar;
                    const auto count = [&](const Hit& hit) {
                        ++rays;
                        lost += hit.empty() ? 1U : 0U;
                        worst = hit.empty() ? worst : std::max(worst, std::abs(double{hit.depth()} - 0.5));
                    };
                    count(RayProbe(*scene, view, end).trace(0, 3, 4));
                    if (i % 16 < 2) {  // the whole mesh is scanned for the few texels of each
                        std::array<Hit, 64> near;
                        std::array<Hit, 64> far;
                        ScanConverter(*scene, view).scan({0, 0, 8}, near, far);
                        count((end == RayEnd::kNear ? near : far)[4 * 8 + 3]);
                    }
                }
            }
            EXPECT_GT(rays, 10'000U);
            EXPECT_EQ(lost, 0U) << levels << " levels";
            EXPECT_LT(worst, 1e-6) << levels << " levels";
        }
    }
}

}  // namespace
}  // namespace relief::test
