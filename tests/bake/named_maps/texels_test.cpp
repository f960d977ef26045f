// SPDX-License-Identifier: Apache-2.0
// Texels of named maps: scan conversion compared with exact integer coverage and Embree's rays, the highest surface
// below a point, and encoded texels compared with encodeTexel() of formats/texel.h.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "bake/mesh/triangle_plane.h"
#include "bake/named_maps/encode.h"
#include "bake/named_maps/highest_below.h"
#include "bake/named_maps/ray_probe.h"
#include "bake/named_maps/scan_convert.h"
#include "bake/views/view.h"
#include "tests/bake/meshes.h"
#include "tests/bake/voxels.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

View scanViewOf(const TriangleMesh& mesh, const std::string& text) {
    return required(makeView(*completeSpec(*parseMapSpec(text), mesh, 64), mesh));
}

struct Scanned {
    std::vector<Hit> near;
    std::vector<Hit> far;
};

Scanned scan(const TriangleMesh& mesh, const View& view) {
    const RayScene scene = required(RayScene::build(mesh));
    Scanned hits;
    hits.near.resize(std::size_t{view.width} * view.height);
    hits.far.resize(hits.near.size());
    // In stripes, as for large maps.
    const ScanConverter converter(scene, view);
    for (std::uint32_t y = 0; y < view.height; y += 7) {
        const std::uint32_t end = std::min(y + 7, view.height);
        const std::size_t first = std::size_t{y} * view.width;
        const std::size_t count = std::size_t{end - y} * view.width;
        converter.scan({0, y, end}, std::span(hits.near).subspan(first, count),
                       std::span(hits.far).subspan(first, count));
    }
    return hits;
}

constexpr int kSide = 64;  // side of the box in quarter units

/// Exact coverage of a sample by triangles, with or without their edges.
struct Covered {
    double first = INFINITY;
    double last = -INFINITY;
    bool any = false;

    void add(double depth) {
        first = std::min(first, depth);
        last = std::max(last, depth);
        any = true;
    }
};

using Corner = std::array<std::int64_t, 3>;

/// Adds the depth of a triangle at (x, y), in quarter units, to `within` if the sample is strictly inside, and to
/// `touched` if it is inside or on an edge.
void addCovered(const std::array<Corner, 3>& t, std::int64_t x, std::int64_t y, Covered& within,
                Covered& touched) {
    const auto side = [&](const Corner& a, const Corner& b, std::int64_t px, std::int64_t py) {
        return (b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0]);
    };
    const std::int64_t area = side(t[0], t[1], t[2][0], t[2][1]);
    if (area == 0) {
        return;  // edge-on
    }
    const std::int64_t turn = area > 0 ? 1 : -1;
    const std::int64_t a = turn * side(t[1], t[2], x, y);
    const std::int64_t b = turn * side(t[2], t[0], x, y);
    const std::int64_t c = turn * side(t[0], t[1], x, y);
    if (std::min({a, b, c}) < 0) {
        return;
    }
    const double depth = static_cast<double>(a * t[0][2] + b * t[1][2] + c * t[2][2]) /
                         static_cast<double>(turn * area) / kSide;
    touched.add(depth);
    if (std::min({a, b, c}) > 0) {
        within.add(depth);
    }
}

TEST(ScanConverter, MatchesIntegerCoverage) {
    std::mt19937_64 random(seedFrom(3));
    std::uint64_t compared = 0;
    for (int round = 0; round < 60; ++round) {
        // Coarse coordinates put edges and vertices on samples, and make slivers.
        const int step = round % 3 == 0 ? 1 : round % 3 == 1 ? 2 : 8;
        const auto number = [&] {
            return static_cast<std::int64_t>(random() % (kSide / step + 1)) * step + (step > 1 ? 1 : 0);
        };
        std::vector<std::array<Corner, 3>> exact(static_cast<std::size_t>(1 + round % 20));
        std::vector<glm::vec3> positions;
        std::vector<glm::uvec3> triangles;
        for (std::array<Corner, 3>& t : exact) {
            for (Corner& corner : t) {
                for (std::int64_t& coordinate : corner) {
                    coordinate = std::min<std::int64_t>(number(), kSide);
                }
                positions.push_back(0.25F * glm::vec3(corner[0], corner[1], corner[2]));
            }
            const auto first = static_cast<std::uint32_t>(positions.size() - 3);
            triangles.emplace_back(first, first + 1, first + 2);
        }
        TriangleMesh mesh;
        mesh.positions = positions;
        mesh.triangles = triangles;
        mesh.bounds = {glm::vec3(0.0F), glm::vec3(16.0F)};
        const View view = scanViewOf(mesh, "front-back:dir=+z,up=+y,size=34,box=0/0/0/16/16/16");
        const Scanned hits = scan(mesh, view);
        for (std::uint32_t row = 0; row < view.height; ++row) {
            for (std::uint32_t column = 0; column < view.width; ++column) {
                // The texel centre in quarter units; texels are half a unit wide.
                const glm::dvec3 at = 4.0 * view.ray(0, column, row).origin;
                const auto x = static_cast<std::int64_t>(std::lround(at.x));
                const auto y = static_cast<std::int64_t>(std::lround(at.y));
                ASSERT_NEAR(at.x, static_cast<double>(x), 1e-9);
                Covered within;
                Covered touched;
                for (const std::array<Corner, 3>& t : exact) {
                    addCovered(t, x, y, within, touched);
                }
                const Hit& near = hits.near[std::size_t{row} * view.width + column];
                const Hit& far = hits.far[std::size_t{row} * view.width + column];
                ASSERT_EQ(near.empty(), far.empty());
                if (within.any) {
                    ASSERT_FALSE(near.empty()) << round << ": " << column << ", " << row;
                    ++compared;
                } else if (!touched.any) {
                    ASSERT_TRUE(near.empty()) << round << ": " << column << ", " << row;
                }
                if (!near.empty()) {
                    EXPECT_GE(near.depth(), touched.first - 1e-5);
                    EXPECT_LE(near.depth(), (within.any ? within.first : touched.last) + 1e-5);
                    EXPECT_LE(far.depth(), touched.last + 1e-5);
                    EXPECT_GE(far.depth(), (within.any ? within.last : touched.first) - 1e-5);
                }
            }
        }
    }
    EXPECT_GT(compared, 10'000U);
}

TEST(ScanConverter, MatchesRays) {
    for (const TriangleMesh& mesh : {makeTorusMesh(1.0, 0.4, 90, 50), makeIcosphere({0.3, -0.2, 5.0}, 2.0, 4),
                                     makeBoxMesh({1, 2, 3}, {0.5, 2.0, 0.01}, rotation({1, 2, 3}, 40.0))}) {
        const RayScene scene = required(RayScene::build(mesh));
        for (const char* spec :
             {"front-back:dir=+z,size=150", "front-back:dir=1/2/-3,size=97x201",
              "front-back:dir=-y,up=1/0/2,size=33", "front-back:dir=-1/-1/-1,size=200x30"}) {
            const View view = scanViewOf(mesh, spec);
            const Scanned hits = scan(mesh, view);
            RayProbe near(scene, view, RayEnd::kNear);
            RayProbe far(scene, view, RayEnd::kFar);
            std::uint64_t met = 0;
            std::uint64_t others = 0;
            for (std::uint32_t y = 0; y < view.height; ++y) {
                for (std::uint32_t x = 0; x < view.width; ++x) {
                    const std::size_t at = std::size_t{y} * view.width + x;
                    for (const auto& [scanned, traced] : {std::pair{hits.near[at], near.trace(0, x, y)},
                                                          std::pair{hits.far[at], far.trace(0, x, y)}}) {
                        const bool same =
                            scanned.empty() == traced.empty() &&
                            (scanned.empty() || (std::abs(scanned.depth() - traced.depth()) < 1e-6F &&
                                                 scanned.fromBehind() == traced.fromBehind()));
                        others += same ? 0U : 1U;
                        met += scanned.empty() ? 0U : 1U;
                    }
                }
            }
            EXPECT_GT(met, 100U) << spec;
            EXPECT_LE(others, met / 2000) << spec;  // rays that pass an edge within the tracer's rounding
        }
    }
}

TEST(ScanConverter, FrontFaceWinsInCoplanarSurfaces) {
    // Two back-to-back squares, in both orders.
    for (const bool turned : {false, true}) {
        TriangleMesh mesh = makePlane(0.0F, 1);
        const std::size_t count = mesh.triangles.size();
        for (std::size_t i = 0; i < count; ++i) {
            const glm::uvec3 t = mesh.triangles[i];
            mesh.triangles.emplace_back(t.x, t.z, t.y);
        }
        if (turned) {
            std::ranges::reverse(mesh.triangles);
        }
        mesh = finished(mesh.positions, mesh.triangles);
        const View view = scanViewOf(mesh, "front-back:dir=-y,size=20,box=-1/-1/-1/1/1/1");
        const Scanned hits = scan(mesh, view);
        for (std::uint32_t y = 1; y < 19; ++y) {
            for (std::uint32_t x = 1; x < 19; ++x) {
                const Hit& near = hits.near[std::size_t{y} * 20 + x];
                const Hit& far = hits.far[std::size_t{y} * 20 + x];
                ASSERT_FALSE(near.empty());
                ASSERT_FALSE(far.empty());
                const double up = planeOf(mesh, near.triangle()).normal.y;
                const double down = planeOf(mesh, far.triangle()).normal.y;
                EXPECT_LT(up * down, 0.0) << x << ", " << y;
            }
        }
    }
}

/// Two of four columns around an edge, diagonally opposite. A ray through the edge leaves one column and enters the
/// other, or passes between the two.
TEST(ScanConverter, RayThroughSharedEdgeKeepsItsSide) {
    for (const bool starts_inside : {true, false}) {
        VoxelGrid grid({2, 2, 1});
        grid.set({0, 0, 0}, starts_inside);
        grid.set({1, 1, 0}, starts_inside);
        grid.set({1, 0, 0}, !starts_inside);
        grid.set({0, 1, 0}, !starts_inside);
        const TriangleMesh mesh = grid.mesh();
        const RayScene scene = required(RayScene::build(mesh));

        // The volume starts and ends inside columns. The middle column of texels looks at the edge.
        const View part = scanViewOf(mesh, "front-back:dir=1/1/0,up=+z,size=33,box=0.25/0.25/0/1.75/1.75/1");
        ASSERT_EQ(part.starts_free[0], !starts_inside);
        ASSERT_EQ(part.starts_free[1], !starts_inside);
        const Scanned hits = scan(mesh, part);
        for (std::uint32_t y = 1; y < 32; ++y) {
            for (const Hit& hit : {hits.near[std::size_t{y} * 33 + 16], hits.far[std::size_t{y} * 33 + 16]}) {
                ASSERT_FALSE(hit.empty());
                EXPECT_NEAR(hit.depth(), 0.5F, 1e-6F);
                EXPECT_EQ(hit.fromBehind(), starts_inside) << y;
            }
        }

        // A cube map centred on the first column's side. Its rays through the same edge test only two of the six faces.
        View cube = scanViewOf(mesh, "cube:size=6,compare=less,box=-2/-1.5/-1.5/2/2.5/2.5");
        cube.centre_on_surface = true;
        ASSERT_TRUE(centreMayBeInSolid(scene, cube, RayEnd::kNear));
        std::vector<Hit> face(36);
        ScanConverter(scene, cube).scan({0, 0, 6}, face, {});
        for (const std::uint32_t x : {2U, 3U}) {
            const Hit& hit = face[std::size_t{1} * 6 + x];  // y points down: the direction (1, 1/2, ±1/6)
            ASSERT_FALSE(hit.empty());
            EXPECT_NEAR(hit.depth(), 0.5 * std::sqrt(1.0 + 1.0 / 4.0 + 1.0 / 36.0), 1e-6);
            EXPECT_EQ(hit.fromBehind(), starts_inside);
        }
    }
}

using Points = std::vector<glm::dvec3>;

Points centred(Points points) {
    glm::dvec3 mean(0.0);
    for (const glm::dvec3& p : points) {
        mean += p / static_cast<double>(points.size());
    }
    for (glm::dvec3& p : points) {
        p -= glm::dvec3(mean.x, mean.y, 0.0);
    }
    return points;
}

/// Height over the origin of the highest plane with these slopes that is below all points.
double heightBelow(const Points& points, double along_x, double along_y) {
    double height = INFINITY;
    for (const glm::dvec3& p : points) {
        height = std::min(height, p.z - along_x * p.x - along_y * p.y);
    }
    return height;
}

/// The highest plane among those through three of the points. One of them is the facet of the hull over the origin.
double highestOfAll(const Points& points) {
    double highest = -INFINITY;
    for (const glm::dvec3& a : points) {
        for (const glm::dvec3& b : points) {
            for (const glm::dvec3& c : points) {
                const glm::dvec3 u = b - a;
                const glm::dvec3 v = c - a;
                const double area = u.x * v.y - u.y * v.x;
                if (std::abs(area) > 1e-9) {
                    highest = std::max(highest, heightBelow(points, (u.z * v.y - v.z * u.y) / area,
                                                            (v.z * u.x - u.z * v.x) / area));
                }
            }
        }
    }
    return highest;
}

Points grid(int side, const auto& height) {
    Points points;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            points.emplace_back(i, j, height(i, j));
        }
    }
    return centred(points);
}

void expectHighest(const Points& points) {
    const glm::dvec2 slope = highestBelow(points).value();
    const double extent =
        1.0 +
        std::abs(std::ranges::max_element(points, {}, [](const glm::dvec3& p) { return std::abs(p.z); })->z);
    EXPECT_NEAR(heightBelow(points, slope.x, slope.y), highestOfAll(points), 1e-7 * extent);
}

TEST(HighestBelow, IsTheBestPlaneThroughThreePoints) {
    std::mt19937_64 random(test::seedFrom(17));
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int round = 0; round < 200; ++round) {
        Points points(static_cast<std::size_t>(3 + round % 14));
        for (glm::dvec3& p : points) {
            p = {number(random), number(random), std::pow(10.0, round % 7 - 3) * number(random)};
        }
        expectHighest(centred(points));
        expectHighest(grid(2 + round % 5, [&](int, int) { return number(random); }));
        // Repeated heights, as on steps.
        expectHighest(grid(2 + round % 5, [&](int, int) { return std::floor(2.0 * number(random)); }));
    }
}

TEST(HighestBelow, MatchesFlatAndTouchesCurvedSurfaces) {
    const std::optional<glm::dvec2> flat =
        highestBelow(grid(4, [](int i, int j) { return 3.0 + 0.5 * i - 2.0 * j; }));
    EXPECT_LT(glm::distance(flat.value(), glm::dvec2(0.5, -2.0)), 1e-9);
    const std::optional<glm::dvec2> hill = highestBelow(grid(4, [](int i, int j) {
        return -(i - 1.5) * (i - 1.5) - (j - 1.5) * (j - 1.5);  // the corners are the hull
    }));
    EXPECT_LT(glm::length(hill.value()), 1e-9);
}

TEST(HighestBelow, CollinearPointsSpanNoPlane) {
    EXPECT_FALSE(highestBelow({}));
    EXPECT_FALSE(highestBelow(Points{{0, 0, 1}}));
    EXPECT_FALSE(highestBelow(Points{{-1, 0, 1}, {1, 0, 2}}));
    EXPECT_FALSE(highestBelow(Points{{-1, -1, 1}, {0, 0, 2}, {1, 1, 0}}));
}

TEST(Encode, MatchesEncodeTexel) {
    const TriangleMesh mesh = makeIcosphere({0.1, 0.2, 0.3}, 0.7, 3);
    const RayScene scene = required(RayScene::build(mesh));
    for (const std::string text :
         {"float:size=40", "fixed8:size=40", "front-back:size=40,dir=1/1/1,depth=half",
          "front-back:size=40,dir=1/1/1,depth=unorm16", "cube:size=20"}) {
        const Result<MapSpec> spec = completeSpec(*parseMapSpec(text), mesh, 40);
        const View view = required(makeView(*spec, mesh));
        // The table of normals does not change a byte.
        for (const std::uint64_t texels : {std::uint64_t{0}, std::uint64_t{1} << 30}) {
            const NormalTable normals(mesh, scene.winding(), texels);
            DepthMap map = view.emptyMap();
            std::uint64_t covered = 0;
            std::uint64_t expected_covered = 0;
            for (std::uint32_t face = 0; face < view.faceCount(); ++face) {
                const RowRange rows{face, 0, view.height};
                std::vector<Hit> hits[2];
                for (const RayEnd end : {RayEnd::kNear, RayEnd::kFar}) {
                    if (view.keeps(end)) {
                        hits[static_cast<std::size_t>(end)].resize(std::size_t{view.width} * view.height);
                    }
                }
                ScanConverter(scene, view).scan(rows, hits[0], hits[1]);
                covered += encodeRows(scene, normals, view, rows, hits[0], hits[1], map);
                for (std::uint32_t y = 0; y < view.height; ++y) {
                    for (std::uint32_t x = 0; x < view.width; ++x) {
                        const auto surface = [&](const std::vector<Hit>& end) -> std::optional<Surface> {
                            if (end.empty() || end[std::size_t{y} * view.width + x].empty()) {
                                return std::nullopt;
                            }
                            const Hit& hit = end[std::size_t{y} * view.width + x];
                            const glm::dvec3 n = planeOf(mesh, hit.triangle()).normal;
                            const glm::vec3 unit = n / std::sqrt(dot(n, n));
                            return Surface{hit.depth(), (hit.fromBehind() ? -unit : unit) + 0.0F};
                        };
                        Texel texel{surface(hits[0]), surface(hits[1])};
                        if (view.compare == Compare::kGreater) {
                            texel.front = texel.back;
                        }
                        expected_covered += texel.front || texel.back ? 1 : 0;
                        std::vector<std::byte> expected(texelSize(view.format));
                        encodeTexel(view.format, texel, expected);
                        const std::span<const std::byte> written = map.texelAt(face, x, y);
                        ASSERT_TRUE(std::equal(written.begin(), written.end(), expected.begin()))
                            << text << " " << x << ", " << y;
                    }
                }
            }
            EXPECT_EQ(covered, expected_covered);
            EXPECT_GT(covered, 500U);
        }
    }
}

}  // namespace
}  // namespace relief::test
