// Rays that are aimed exactly at vertices and edges of closed meshes: none may pass through.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "bake/mesh/triangle_plane.h"
#include "bake/texels/ray_probe.h"
#include "bake/texels/scan_convert.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

/// A box from -half to half of n × n squares a side, each cut along the diagonal that `turned` says.
TriangleMesh makeGridBox(const glm::dvec3& half, int n, bool turned) {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {-1, 1}) {
            const auto first = static_cast<std::uint32_t>(positions.size());
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            for (int j = 0; j <= n; ++j) {
                for (int i = 0; i <= n; ++i) {
                    glm::dvec3 p(0.0);
                    p[axis] = side * half[axis];
                    p[u] = half[u] * (2.0 * i / n - 1.0);
                    p[v] = half[v] * (2.0 * j / n - 1.0);
                    positions.emplace_back(p);
                }
            }
            for (int j = 0; j < n; ++j) {
                for (int i = 0; i < n; ++i) {
                    const auto at = [&](int di, int dj) {
                        return first + static_cast<std::uint32_t>((j + dj) * (n + 1) + i + di);
                    };
                    std::array<glm::uvec3, 2> both = {glm::uvec3(at(0, 0), at(1, 0), at(1, 1)),
                                                      glm::uvec3(at(0, 0), at(1, 1), at(0, 1))};
                    if (turned) {
                        both = {glm::uvec3(at(0, 0), at(1, 0), at(0, 1)),
                                glm::uvec3(at(1, 0), at(1, 1), at(0, 1))};
                    }
                    for (const glm::uvec3& t : both) {
                        triangles.push_back(side > 0 ? t : glm::uvec3(t.x, t.z, t.y));
                    }
                }
            }
        }
    }
    return finished(positions, triangles);
}

/// An octahedron |x| + |y| + |z| = 1 whose faces are cut into n² triangles: vertices on a grid of 1/n.
TriangleMesh makeOctahedron(int n) {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::map<std::array<int, 3>, std::uint32_t> index;
    const auto vertex = [&](const std::array<int, 3>& key) {
        const auto [at, added] = index.try_emplace(key, static_cast<std::uint32_t>(positions.size()));
        if (added) {
            const glm::dvec3 p(key[0], key[1], key[2]);
            positions.emplace_back(p / static_cast<double>(n));
        }
        return at->second;
    };
    for (int octant = 0; octant < 8; ++octant) {
        const std::array<int, 3> sign = {(octant & 1) != 0 ? -1 : 1, (octant & 2) != 0 ? -1 : 1,
                                         (octant & 4) != 0 ? -1 : 1};
        const bool mirrored = sign[0] * sign[1] * sign[2] < 0;
        const auto at = [&](int i, int j) {
            return vertex({sign[0] * (n - i - j), sign[1] * i, sign[2] * j});
        };
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            triangles.push_back(mirrored ? glm::uvec3(a, c, b) : glm::uvec3(a, b, c));
        };
        for (int i = 0; i < n; ++i) {
            for (int j = 0; i + j < n; ++j) {
                add(at(i, j), at(i + 1, j), at(i, j + 1));
                if (i + j + 1 < n) {
                    add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                }
            }
        }
    }
    return finished(positions, triangles);
}

/// Where a ray enters and leaves a convex solid: half-spaces n·p ≤ d.
std::optional<std::array<double, 2>> clip(const TexelRay& ray, const std::vector<glm::dvec4>& planes,
                                          double slack) {
    double low = -1e9;
    double high = 1e9;
    for (const glm::dvec4& plane : planes) {
        const glm::dvec3 n(plane);
        const double along = dot(n, ray.direction);
        const double ahead = plane.w + slack - dot(n, ray.origin);
        if (std::abs(along) < 1e-12) {
            if (ahead < 0.0) {
                return std::nullopt;
            }
        } else if (along > 0.0) {
            high = std::min(high, ahead / along);
        } else {
            low = std::max(low, ahead / along);
        }
    }
    return low < high ? std::optional(std::array<double, 2>{low, high}) : std::nullopt;
}

/// Traces both ends of a view of a convex solid. Rays that pass within 1e-4 of its silhouette may meet it or
/// not.
void expectNoLeak(const TriangleMesh& mesh, const View& view, const std::vector<glm::dvec4>& planes) {
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
                    const auto exact = clip(ray, planes, 0.0);
                    if (clip(ray, planes, -kRim) && exact) {
                        ++rays;
                        lost += hit.empty() ? 1U : 0U;
                        const bool leaves = end == RayEnd::kFar || view.projection() == Projection::kCube;
                        const double error = std::abs(double{hit.depth()} - (*exact)[leaves ? 1 : 0]);
                        worst = hit.empty() ? worst : std::max(worst, error);
                    } else if (!clip(ray, planes, kRim)) {
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

std::vector<glm::dvec4> boxPlanes(const glm::dvec3& half) {
    std::vector<glm::dvec4> planes;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) {
            glm::dvec4 plane(0.0, 0.0, 0.0, half[axis]);
            plane[axis] = sign;
            planes.push_back(plane);
        }
    }
    return planes;
}

std::vector<glm::dvec4> octahedronPlanes() {
    std::vector<glm::dvec4> planes;
    for (int octant = 0; octant < 8; ++octant) {
        planes.emplace_back((octant & 1) != 0 ? -1 : 1, (octant & 2) != 0 ? -1 : 1,
                            (octant & 4) != 0 ? -1 : 1, 1.0);
    }
    return planes;
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
    const std::vector<glm::dvec4> planes = boxPlanes(glm::dvec3(1.0));
    for (const int n : {8, 16, 60}) {
        for (const bool turned : {false, true}) {
            const TriangleMesh box = makeGridBox(glm::dvec3(1.0), n, turned);
            for (const char* dir : {"-x", "+y", "-z"}) {
                expectNoLeak(box, viewOf(box, gridSpec(dir, n)), planes);
            }
            expectNoLeak(box, viewOf(box, "cube:size=" + std::to_string(n)), planes);
        }
        const TriangleMesh octahedron = makeOctahedron(n);
        for (const char* dir : {"-x", "+y", "-z", "1/1/1", "1/-1/0"}) {
            expectNoLeak(octahedron, viewOf(octahedron, gridSpec(dir, n)), octahedronPlanes());
        }
        expectNoLeak(octahedron, viewOf(octahedron, "cube:size=" + std::to_string(n)), octahedronPlanes());
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
