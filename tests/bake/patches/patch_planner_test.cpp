// SPDX-License-Identifier: Apache-2.0
// Trees of patches compared with closed forms, rays through the mesh, and byte counts.
#include "bake/patches/patch_planner.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "bake/measure/truth.h"
#include "bake/mesh/flat_faces.h"
#include "bake/patches/cell_columns.h"
#include "bake/repair/winding.h"
#include "formats/validate.h"
#include "tests/bake/meshes.h"
#include "tests/bake/points.h"
#include "tests/bake/threads.h"

namespace relief::test {
namespace {

DepthMap checked(const MeshQuery& query, std::uint64_t bytes) {
    DepthMap map = bakePatches(query, {.bytes = bytes})->map;
    EXPECT_TRUE(validateFrame(map) && validateTexels(map));
    EXPECT_LE(map.texels.size(), bytes);
    return map;
}

double wrongPercent(const MeshQuery& query, const DepthMap& map, std::uint32_t points) {
    int wrong = 0;
    for (const TruthPoint& point : sampleNear(query, {.samples = points, .seed = 5})) {
        wrong += (vote(map, point.position)->distance < 0.0F) != point.inside() ? 1 : 0;
    }
    return 100.0 * wrong / points;
}

/// Expects the columns of a cube around a mesh to match rays through the whole mesh.
void expectColumnsAgree(const MeshQuery& query, int wrong_max) {
    MeshCell cell;
    const Bounds& bounds = query.mesh().bounds;
    cell.size = 1.1 * double{bounds.longestSide()};
    cell.low = glm::dvec3(bounds.center()) - 0.5 * cell.size;
    for (std::uint32_t t = 0; t < query.mesh().triangles.size(); ++t) {
        cell.triangles.push_back(t);
    }
    cell.bodies = query.bodiesAt(glm::vec3(cell.low + cell.size * MeshCell::kKnown));
    std::vector<MeshCell> cells = {cell};
    for (unsigned i = 0; i < 8; ++i) {
        const auto child = [&](const MeshCell& of, unsigned octant) {
            return childrenOf(query, of, unitTriangles(query.mesh(), of))[octant];
        };
        cells.push_back(child(cell, i));
        cells.push_back(child(cells.back(), 7 - i));
    }
    int wrong = 0;
    for (const MeshCell& one : cells) {
        EXPECT_EQ(one.bodies.inside(), query.inside(glm::vec3(one.low + one.size * MeshCell::kKnown)));
        for (const PatchFrame& frame : patchFrames()) {
            constexpr unsigned kAcross = 12;
            const LineGrid grid(frame, kAcross);
            const auto place = [](unsigned at) { return (at + LineGrid::kOffset) / kAcross; };
            const CellColumns columns(query, one, unitTriangles(query.mesh(), one), grid);
            const glm::dvec3 zero = frame.across(glm::dvec3(0.0));
            const glm::dmat3 back = glm::inverse(glm::dmat3(frame.across(glm::dvec3(1, 0, 0)) - zero,
                                                            frame.across(glm::dvec3(0, 1, 0)) - zero,
                                                            frame.across(glm::dvec3(0, 0, 1)) - zero));
            for (unsigned i = 0; i < kAcross * kAcross; ++i) {
                const std::uint32_t line = grid.lineAt(i % kAcross, i / kAcross);
                if (grid.lines()[line].misses()) {
                    continue;
                }
                const CellColumn column = columns[line];
                std::vector<double> ends(column.turns.begin(), column.turns.end());
                ends.push_back(column.leaves);
                bool inside = column.inside;
                double from = column.enters;
                for (const double to : ends) {
                    const glm::dvec3 middle(place(i % kAcross), place(i / kAcross), 0.5 * (from + to));
                    const glm::vec3 p(one.low + one.size * (back * (middle - zero)));
                    wrong += to - from > 1e-4 && query.inside(p) != inside ? 1 : 0;
                    from = to;
                    inside = !inside;
                }
            }
        }
    }
    EXPECT_LE(wrong, wrong_max);
}

/// Volume of wrong points in the bounds of the mesh, enlarged by a fifth.
double wrongVolume(const MeshQuery& query, const DepthMap& map, int points) {
    int wrong = 0;
    for (const glm::vec3& p : pointsIn(query.mesh().bounds, points)) {
        wrong += (vote(map, p)->distance < 0.0F) != query.inside(p) ? 1 : 0;
    }
    const glm::dvec3 size = 1.2 * glm::dvec3(query.mesh().bounds.size());
    return size.x * size.y * size.z * wrong / points;
}

TEST(PatchPlanner, CurveMatchesTheErrorsOfBakedTrees) {
    const MeshQuery query = queryOf(makeTorusMesh(1.0, 0.35, 48, 32));
    const ErrorCurve curve = planErrors(query, {.bytes = 20'000});
    ASSERT_GE(curve.size(), 3U);
    for (std::size_t i = 1; i < curve.size(); ++i) {
        EXPECT_GT(curve[i].bytes, curve[i - 1].bytes);
        EXPECT_LT(curve[i].wrong, curve[i - 1].wrong);
        if (curve[i].bytes > 4000.0) {
            const auto bytes = static_cast<std::uint64_t>(curve[i].bytes);
            const double wrong = wrongVolume(query, bakePatches(query, {.bytes = bytes})->map, 400'000);
            // A separate tree has other roots and newly fitted heights.
            EXPECT_NEAR(curve[i].wrong / wrong, 1.0, 0.4) << bytes;
        }
    }
    EXPECT_GT(curve.back().bytes, 12'000.0);
    EXPECT_TRUE(onThreads(1, [&] { return planErrors(query, {.bytes = 20'000}); }) == curve);
}

TEST(CellColumns, MatchRaysThroughTheMesh) {
    expectColumnsAgree(queryOf(makeTorusMesh(1.0, 0.4, 48, 24)), 0);
    // Even numbers would put cell faces on the mesh.
    expectColumnsAgree(queryOf(makeBoxMesh({0, 0, 0}, {1, 0.5, 0.25})), 0);
    // Two overlapping balls are one solid by the winding number.
    const auto balls =
        windOutwards(joined({makeIcosphere({-0.3, 0, 0}, 1.0, 3), makeIcosphere({0.6, 0.2, 0.1}, 0.8, 3)}));
    expectColumnsAgree(queryOf(required(balls).mesh), 0);
}

TEST(CellColumns, ClippedTrianglesKeepTheirArea) {
    MersenneRandom random(3);
    for (int i = 0; i < 500; ++i) {
        // The 3³ cubes of the grid contain the whole triangle.
        std::array<glm::dvec3, 3> corners;
        for (glm::dvec3& p : corners) {
            p = 0.5 + 1.1 * inCube(random);
        }
        double area = 0.0;
        for (int cube = 0; cube < 27; ++cube) {
            const glm::dvec3 low(cube % 3 - 1, cube / 3 % 3 - 1, cube / 9 - 1);
            const std::array<glm::dvec3, 3> moved = {corners[0] - low, corners[1] - low, corners[2] - low};
            const ClippedTriangle piece = clipToUnitCube(moved);
            area += piece.area;
            EXPECT_EQ(piece.area > 0.0, meetsUnitCube(moved));
        }
        EXPECT_NEAR(area, 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])),
                    1e-9);
    }
}

TEST(PatchPlanner, BoxFacesAreExactToQuantization) {
    const glm::dmat3 axes = rotation({1, 2, 0}, 35.0);
    const MeshQuery query = queryOf(makeBoxMesh({0, 0, 0}, {1, 1, 1}, axes));
    const DepthMap map = checked(query, 64'000);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 2000; ++i) {
        const double z = 0.6 * unit(random);  // the same points with every compiler
        const double y = 1.0 + 0.01 * unit(random);
        const glm::dvec3 local(0.6 * unit(random), y, z);
        const Vote said = vote(map, glm::vec3(axes * local)).value();
        ASSERT_NEAR(said.distance, local.y - 1.0, 0.02 * double{map.object_per_map.x});
        ASSERT_TRUE((said.distance < 0.0F) == (local.y < 1.0) || std::abs(local.y - 1.0) < 1e-3);
        ASSERT_GT(glm::dot(glm::dvec3(said.normal), axes[1]), 0.99985);  // 1 degree
    }
    // Below the middle of a face, cells have no patch, but the plane of that face.
    for (int i = 0; i < 500; ++i) {
        const double y = 0.8 + 0.1 * unit(random);
        const Vote said = vote(map, glm::vec3(axes * glm::dvec3(0.2 * unit(random), y, 0.0))).value();
        ASSERT_NEAR(said.distance, y - 1.0, 0.02);
        ASSERT_GT(glm::dot(glm::dvec3(said.normal), axes[1]), 0.999);
    }
}

TEST(PatchPlanner, FlatShapesUseOnlyTheBytesTheyNeed) {
    // A small box beside a large one is judged at its own size.
    const MeshQuery query =
        queryOf(joined({makeBoxMesh({0, 0, 0}, {1, 1, 1}), makeBoxMesh({1.5, 0, 0}, {0.01, 0.01, 0.01})}));
    const DepthMap map = checked(query, 4'000'000);
    EXPECT_LT(map.texels.size(), 1'500'000);
    EXPECT_EQ(wrongPercent(query, map, 20'000), 0.0);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    for (int i = 0; i < 2000; ++i) {
        const float z = 0.008F * unit(random);
        const float y = 0.01F + 1e-4F * unit(random);
        const std::optional<Vote> found = vote(map, {1.5F + 0.008F * unit(random), y, z});
        ASSERT_TRUE(found && ((found->distance < 0.0F) == (y < 0.01F) || std::abs(y - 0.01F) < 3e-6F)) << y;
    }
}

/// Splits each triangle into four.
TriangleMesh divided(const TriangleMesh& mesh) {
    TriangleMesh fine;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = cornersOf(mesh, i);
        const auto first = static_cast<std::uint32_t>(fine.positions.size());
        for (const glm::vec3& p : {a, b, c, 0.5F * (a + b), 0.5F * (b + c), 0.5F * (c + a)}) {
            fine.positions.push_back(p);
        }
        for (const glm::uvec3& t : {glm::uvec3(0, 3, 5), {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}) {
            fine.triangles.push_back(first + t);
        }
    }
    fine.bounds = mesh.bounds;
    return fine;
}

TEST(PatchPlanner, SubdividedFacesCostNoExtraBytes) {
    const TriangleMesh box = makeBoxMesh({0, 0, 0}, {1, 1, 1});
    const DepthMap whole = checked(queryOf(box), 2'000'000);
    const MeshQuery query = queryOf(divided(divided(box)));
    const DepthMap map = checked(query, 2'000'000);
    EXPECT_LE(map.texels.size(), whole.texels.size() + whole.texels.size() / 4);
    EXPECT_LT(map.texels.size(), 1'500'000);
    EXPECT_EQ(wrongPercent(query, map, 20'000), 0.0);
}

// Rounding to six decimals, as in exported files, changes the normals of the 49,152 triangles by up to 2e-4.
TEST(FlatFaces, RoundedCoordinatesStayFlat) {
    TriangleMesh box = makeBoxMesh({0, 0, 0}, glm::dvec3(0.5), rotation({1, 2, 3}, 40.0));
    for (int i = 0; i < 6; ++i) {
        box = divided(box);
    }
    for (glm::vec3& position : box.positions) {
        position = glm::vec3(glm::round(glm::dvec3(position) * 1e6) * 1e-6);
    }
    for (const FlatFace& face : flatFacesOf(finished(box.positions, box.triangles))) {
        ASSERT_NEAR(face.area, 1.0, 1e-3);
    }
}

TEST(PatchPlanner, ThinWallsAndNarrowGapsArePreserved) {
    // Both sides of the wall are in one cell. The wall's volume is too small to justify smaller cells.
    const glm::dmat3 axes = rotation({1, 2, 0}, 35.0);
    for (const double half : {0.01, 0.001}) {
        const auto plate = [&](double y, double thick) {
            return makeBoxMesh(axes * glm::dvec3(0, y, 0), {1, thick, 1}, axes);
        };
        const MeshQuery query =
            queryOf(joined({plate(0.2, half), plate(-0.2, 0.1), plate(-0.4 - 2.0 * half, 0.1)}));
        const DepthMap map = checked(query, 150'000);
        int holes = 0;
        MersenneRandom random(4);
        for (int i = 0; i < 4000; ++i) {
            const glm::dvec3 beside = glm::dvec3(0.98, 0.78 * half, 0.98) * inCube(random);
            const glm::dvec3 in_wall = beside + glm::dvec3(0, 0.2, 0);
            const glm::dvec3 in_gap = beside - glm::dvec3(0, 0.3 + half, 0);
            holes += vote(map, glm::vec3(axes * in_wall))->distance >= 0.0F ? 1 : 0;
            holes += vote(map, glm::vec3(axes * in_gap))->distance <= 0.0F ? 1 : 0;
        }
        // A wall that cuts the corner of a cell can have too little volume there to justify a record.
        EXPECT_LE(holes, 8) << half;
        EXPECT_LT(wrongPercent(query, map, 40'000), 0.1);
    }
}

TEST(PatchPlanner, BallsErrorsFallWithBytes) {
    const MeshQuery query = queryOf(makeIcosphere({0, 0, 0}, 1.0, 5));
    double before = 100.0;
    for (const std::uint64_t bytes : {4'000ULL, 16'000ULL, 64'000ULL, 256'000ULL}) {
        const double wrong = wrongPercent(query, checked(query, bytes), 40'000);
        // A cell's surface grows with the square of its size, and so does the error of its heights. So four times the
        // bytes give a quarter of the errors, until triangle edges dominate.
        EXPECT_LT(wrong, 0.5 * before) << bytes;
        before = wrong;
    }
    EXPECT_LT(before, 0.15);
}

DepthMap byTexel(const MeshQuery& query, double texel) {
    PatchTree tree = required(bakePatches(query, {.bytes = kPatchBytesMax, .texel = texel}));
    EXPECT_EQ(tree.texel, texel);
    EXPECT_TRUE(validateFrame(tree.map) && validateTexels(tree.map));
    return std::move(tree.map);
}

TEST(PatchTexel, BallErrorsAreBelowTheTexel) {
    // Relative to the sphere; the triangles are up to 3e-5 inside it.
    const MeshQuery query = queryOf(makeIcosphere({0.1, 0.2, 0.3}, 1.0, 7));
    double before = 1.0;
    for (const double texel : {0.08, 0.04, 0.02, 0.01}) {
        const DepthMap map = byTexel(query, texel);
        MersenneRandom random(4);
        double sum = 0.0;
        constexpr int kPoints = 20'000;
        for (int i = 0; i < kPoints; ++i) {
            const glm::dvec3 way = random.direction();
            const double away = (random.uniform() - 0.5) * texel;
            const glm::vec3 p(glm::dvec3(0.1, 0.2, 0.3) + (1.0 + away) * way);
            const bool wrong = (vote(map, p)->distance < 0.0F) != (away < 0.0);
            EXPECT_FALSE(wrong && std::abs(away) > 0.3 * texel) << texel << " " << away;
            sum += wrong ? texel : 0.0;  // in a layer one texel thick, this sums to the mean error
        }
        // The mean error is proportional to the texel, but changes in steps with octree levels.
        EXPECT_LT(sum / kPoints, 0.65 * before) << texel;
        EXPECT_LT(sum / kPoints, 0.15 * texel) << texel;
        before = sum / kPoints;
    }
}

TEST(PatchTexel, ThinHandleOfALargePlateIsPreserved) {
    // A bar two texels thick on two legs, on a plate a hundred times as long. The bar has 5e-6 of the plate's volume.
    constexpr double kTexel = 0.01;
    struct Box {
        glm::dvec3 center;
        glm::dvec3 half;
    };
    const Box boxes[] = {{{0, -0.05, 0}, {6, 0.05, 6}},
                         {{2.37, 0.05, 1.21}, {0.06, 0.01, 0.01}},
                         {{2.32, 0.02, 1.21}, {0.01, 0.03, 0.01}},
                         {{2.42, 0.02, 1.21}, {0.01, 0.03, 0.01}}};
    std::vector<TriangleMesh> parts;
    for (const Box& box : boxes) {
        parts.push_back(makeBoxMesh(box.center, box.half));
    }
    const MeshQuery query = queryOf(required(windOutwards(joined(parts))).mesh);
    const DepthMap map = byTexel(query, kTexel);
    MersenneRandom random(4);
    int inside = 0;
    for (int i = 0; i < 50'000; ++i) {
        const glm::dvec3 p = glm::dvec3(2.37, 0.035, 1.21) + glm::dvec3(0.1, 0.05, 0.05) * inCube(random);
        double distance = 1.0;
        for (const Box& box : boxes) {
            distance = std::min(distance, boxDistance(p - box.center, box.half));
        }
        if (std::abs(distance) > 0.5 * kTexel) {
            ASSERT_EQ(vote(map, glm::vec3(p))->distance < 0.0F, distance < 0.0)
                << p.x << " " << p.y << " " << p.z << ": " << distance;
            inside += distance < 0.0 ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 500);
    // The plate's faces cost nothing. Most bytes are along its edges: 48 m, or 4800 texels.
    EXPECT_LT(map.texels.size(), 300'000U);
    const MeshQuery plain = queryOf(makeBoxMesh(boxes[0].center, boxes[0].half));
    // About half of this is for depth planes, and for planes beside the flat faces of the bars.
    EXPECT_LT(map.texels.size(), byTexel(plain, kTexel).texels.size() + 55'000);
}

TEST(PatchTexel, BudgetLimitsTheTexel) {
    const MeshQuery query = queryOf(makeIcosphere({0, 0, 0}, 1.0, 5));
    PatchOptions options{.bytes = 20'000, .texel = 0.001, .coarsen = true};
    const PatchTree tree = required(bakePatches(query, options));
    EXPECT_LE(tree.map.texels.size(), 20'000U);
    EXPECT_GT(tree.texel, 0.001);
    // Trees that fit are not coarsened, and trees slightly over the budget are rejected. The tree without a budget has
    // the same surface and possibly more depth planes.
    const DepthMap whole = byTexel(query, tree.texel);
    EXPECT_GE(whole.texels.size(), tree.map.texels.size());
    MersenneRandom random(5);
    for (int i = 0; i < 10'000; ++i) {
        const glm::vec3 p(2.0 * inCube(random));
        const std::optional<Vote> bounded = vote(tree.map, p);
        ASSERT_EQ(bounded.has_value(), vote(whole, p).has_value());
        ASSERT_TRUE(!bounded || (bounded->distance < 0.0F) == (vote(whole, p)->distance < 0.0F));
    }
    EXPECT_GT(byTexel(query, 0.9 * tree.texel).texels.size(), 20'000U);
    options.texel = 2.0 * tree.texel;
    EXPECT_EQ(bakePatches(query, options)->texel, options.texel);
    options.coarsen = false;
    options.texel = 0.9 * tree.texel;
    expectError(bakePatches(query, options), ErrorCode::kLimit);
    options.texel = 1e-7;
    EXPECT_EQ(bakePatches(query, options).error().code, ErrorCode::kUsage);
    EXPECT_LE(byTexel(query, 100.0).texels.size(), 256U) << "one cell";
}

TEST(PatchPlanner, UnseenInteriorsArePreserved) {
    // A ball in a hollow ball: rays from outside do not hit the inner surfaces.
    const MeshQuery query =
        queryOf(joined({makeIcosphere({0, 0, 0}, 1.0, 4), reversed(makeIcosphere({0, 0, 0}, 0.8, 4)),
                        makeIcosphere({0.1, 0, 0}, 0.4, 4)}));
    EXPECT_LT(wrongPercent(query, checked(query, 250'000), 40'000), 0.4);
}

TEST(PatchPlanner, SmallPartsBetweenLinesAreFound) {
    // The small ball is a thousandth of the longest side, less than the line spacing of the largest cells.
    const MeshQuery query =
        queryOf(joined({makeIcosphere({0, 0, 0}, 1.0, 4), makeIcosphere({40, 0.3, 0.1}, 0.02, 2)}));
    const DepthMap map = checked(query, 100'000);
    EXPECT_LT(vote(map, {40, 0.3F, 0.1F})->distance, 0.0F);
    EXPECT_GT(vote(map, {40.03F, 0.3F, 0.1F})->distance, 0.0F);
    EXPECT_LT(vote(map, {0.5F, 0.5F, 0.5F})->distance, 0.0F);
}

TEST(PatchPlanner, SmallestBudgetIsKept) {
    const DepthMap map = checked(queryOf(makeTorusMesh(1.0, 0.4, 48, 24)), kPatchBytesMin);
    EXPECT_LT(vote(map, {1, 0, 0})->distance, 0.0F);
    EXPECT_GT(vote(map, {0, 0, 1.3F})->distance, 0.0F);
}

TEST(PatchPlanner, IsDeterministic) {
    const MeshQuery query = queryOf(makeTorusMesh(1.0, 0.4, 48, 24));
    const auto made = [&] {
        return std::vector<DepthMap>{bakePatches(query, {.bytes = 60'000})->map, byTexel(query, 0.01)};
    };
    const std::vector<DepthMap> one = onThreads(1, made);
    EXPECT_EQ(one, onThreads(5, made));
}

}  // namespace
}  // namespace relief::test
