// SPDX-License-Identifier: Apache-2.0
// Rays aimed exactly at vertices and edges of closed meshes must not pass through. Voxels.* covers vertices over texel
// centres.
#include <algorithm>
#include <array>
#include <cmath>

#include "bake/mesh/triangle_plane.h"
#include "bake/named_maps/ray_probe.h"
#include "bake/named_maps/scan_convert.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

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

/// Embree by itself misses a few of a thousand such rays.
TEST(Pinholes, RaysAtVerticesAndEdgesHit) {
    for (const glm::dvec3& center : {glm::dvec3(0.0), glm::dvec3(100.1, 50.3, -20.7)}) {
        for (const int levels : {2, 3, 4}) {
            const TriangleMesh ball = makeIcosphere(center, 1.0, levels);
            const RayScene scene = required(RayScene::build(ball));
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
                        continue;  // too near the silhouette for eight texels
                    }
                    const View view = aimedAt(p, d);
                    const RayEnd end = cosine < 0.0 ? RayEnd::kNear : RayEnd::kFar;
                    const auto count = [&](const Hit& hit) {
                        ++rays;
                        lost += hit.empty() ? 1U : 0U;
                        worst = hit.empty() ? worst : std::max(worst, std::abs(double{hit.depth()} - 0.5));
                    };
                    count(RayProbe(scene, view, end).trace(0, 3, 4));
                    if (i % 16 < 2) {  // few, because each scans the whole mesh
                        std::array<Hit, 64> near;
                        std::array<Hit, 64> far;
                        ScanConverter(scene, view).scan({0, 0, 8}, near, far);
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
