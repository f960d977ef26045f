// Trees of patches against closed forms, the mesh's own rays, and their bytes.
#include "bake/patches/patch_planner.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "bake/measure/truth.h"
#include "bake/patches/cell_columns.h"
#include "bake/repair/winding.h"
#include "formats/validate.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

DepthMap checked(const MeshQuery& query, std::uint64_t bytes) {
    DepthMap map = bakePatches(query, {.bytes = bytes});
    const Result<void> valid = validateFrame(map).and_then([&] { return validateTexels(map); });
    EXPECT_TRUE(valid) << valid.error().message;
    EXPECT_LE(map.texels.size(), bytes);
    return map;
}

double wrongPercent(const MeshQuery& query, const DepthMap& map, std::uint32_t points) {
    AccuracyOptions options;
    options.samples = points;
    options.seed = 5;
    int wrong = 0;
    for (const TruthPoint& point : sampleNear(query, options)) {
        wrong += (vote(map, point.position)->distance < 0.0F) != point.inside() ? 1 : 0;
    }
    return 100.0 * wrong / points;
}

/// The columns of a whole mesh in a cube about it agree with rays through all of it.
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
            for (unsigned i = 0; i < kAcross * kAcross; ++i) {
                const std::uint32_t line = grid.lineAt(i % kAcross, i / kAcross);
                if (grid.lines()[line].misses()) {
                    continue;
                }
                const CellColumn column = columns[line];
                bool inside = column.inside;
                double from = column.enters;
                const auto check = [&](double to) {
                    // The middle of the stretch, by the inverse of across().
                    const glm::dvec3 zero = frame.across(glm::dvec3(0.0));
                    const glm::dmat3 across(frame.across(glm::dvec3(1, 0, 0)) - zero,
                                            frame.across(glm::dvec3(0, 1, 0)) - zero,
                                            frame.across(glm::dvec3(0, 0, 1)) - zero);
                    const glm::dvec3 p =
                        glm::inverse(across) *
                        (glm::dvec3(place(i % kAcross), place(i / kAcross), 0.5 * (from + to)) - zero);
                    if (to - from > 1e-4) {
                        wrong += query.inside(glm::vec3(one.low + one.size * p)) != inside ? 1 : 0;
                    }
                    from = to;
                    inside = !inside;
                };
                for (const double turn : column.turns) {
                    check(turn);
                }
                check(column.leaves);
            }
        }
    }
    EXPECT_LE(wrong, wrong_max);
}

TEST(CellColumns, AgreeWithRaysThroughTheMesh) {
    expectColumnsAgree(queryOf(makeTorusMesh(1.0, 0.4, 48, 24)), 0);
    // Even numbers, in whose planes the cells' faces would lie.
    expectColumnsAgree(queryOf(makeBoxMesh({0, 0, 0}, {1, 0.5, 0.25})), 0);
    // Two balls that overlap are one solid by the winding number.
    TriangleMesh balls =
        joined({makeIcosphere({-0.3, 0, 0}, 1.0, 3), makeIcosphere({0.6, 0.2, 0.1}, 0.8, 3)});
    const auto wound = windOutwards(std::move(balls));
    ASSERT_TRUE(wound);
    expectColumnsAgree(queryOf(wound->mesh), 0);
}

TEST(CellColumns, ClippedTrianglesAddUpToTheirArea) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-0.6, 1.6);
    for (int i = 0; i < 500; ++i) {
        // Of the cubes of a grid of 3³, which hold all of it.
        std::array<glm::dvec3, 3> corners;
        for (glm::dvec3& p : corners) {
            p = {unit(random), unit(random), unit(random)};
        }
        double area = 0.0;
        for (int cube = 0; cube < 27; ++cube) {
            const glm::dvec3 low(cube % 3 - 1, cube / 3 % 3 - 1, cube / 9 - 1);
            const ClippedTriangle piece =
                clipToUnitCube({corners[0] - low, corners[1] - low, corners[2] - low});
            area += piece.area;
            EXPECT_EQ(piece.area > 0.0,
                      meetsUnitCube({corners[0] - low, corners[1] - low, corners[2] - low}));
        }
        EXPECT_NEAR(area, 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])),
                    1e-9);
    }
}

TEST(PatchPlanner, FacesOfABoxAreExactButForTheCodes) {
    const glm::dmat3 axes = rotation({1, 2, 0}, 35.0);
    const MeshQuery query = queryOf(makeBoxMesh({0, 0, 0}, {1, 1, 1}, axes));
    const DepthMap map = checked(query, 64'000);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 local(0.6 * unit(random), 1.0 + 0.01 * unit(random), 0.6 * unit(random));
        const std::optional<Vote> said = vote(map, glm::vec3(axes * local));
        ASSERT_TRUE(said);
        // Beside the patches a cell has a coarse plane alone, whose normal is up to 2 degrees off: none has an edge of the box in it here.
        ASSERT_NEAR(said->distance, local.y - 1.0, 0.02 * double{map.object_per_map.x});
        ASSERT_TRUE((said->distance < 0.0F) == (local.y < 1.0) || std::abs(local.y - 1.0) < 1e-3);
        ASSERT_GT(glm::dot(glm::dvec3(said->normal), axes[1]), 0.999);
    }
}

TEST(PatchPlanner, ThinWallsAndNarrowGapsAreWhole) {
    // Both sides of a wall lie in one cell, and so thin a wall has too little volume to be worth a cell of its own size.
    const glm::dmat3 axes = rotation({1, 2, 0}, 35.0);
    for (const double half : {0.01, 0.001}) {
        const TriangleMesh plates[] = {
            makeBoxMesh(axes * glm::dvec3(0, 0.2, 0), {1, half, 1}, axes),
            makeBoxMesh(axes * glm::dvec3(0, -0.2, 0), {1, 0.1, 1}, axes),
            makeBoxMesh(axes * glm::dvec3(0, -0.4 - 2.0 * half, 0), {1, 0.1, 1}, axes)};
        const MeshQuery query = queryOf(joined({plates[0], plates[1], plates[2]}));
        const DepthMap map = checked(query, 150'000);
        int holes = 0;
        std::mt19937 random(4);
        std::uniform_real_distribution<double> unit(-0.98, 0.98);
        for (int i = 0; i < 4000; ++i) {
            const glm::dvec3 in_wall(unit(random), 0.2 + 0.8 * half * unit(random), unit(random));
            const glm::dvec3 in_gap(unit(random), -0.3 - half + 0.8 * half * unit(random), unit(random));
            holes += vote(map, glm::vec3(axes * in_wall))->distance >= 0.0F ? 1 : 0;
            holes += vote(map, glm::vec3(axes * in_gap))->distance <= 0.0F ? 1 : 0;
        }
        // A wall that cuts a corner of a cell may have too little volume there to be worth a record.
        EXPECT_LE(holes, 8) << half;
        EXPECT_LT(wrongPercent(query, map, 40'000), 0.1);
    }
}

TEST(PatchPlanner, BallsMistakesFallWithTheBytes) {
    const MeshQuery query = queryOf(makeIcosphere({0, 0, 0}, 1.0, 5));
    double before = 100.0;
    for (const std::uint64_t bytes : {4'000ULL, 16'000ULL, 64'000ULL, 256'000ULL}) {
        const double wrong = wrongPercent(query, checked(query, bytes), 40'000);
        // A cell has the square of its size of surface, and a height's error goes by that square: four times the bytes make a
        // quarter of the mistakes, until the triangles' edges show.
        EXPECT_LT(wrong, 0.5 * before) << bytes;
        before = wrong;
    }
    EXPECT_LT(before, 0.15);
}

TEST(PatchPlanner, InsidesThatNoViewSeesAreThere) {
    // A ball in a hollow ball: no ray from outside meets the inner surfaces.
    const MeshQuery query =
        queryOf(joined({makeIcosphere({0, 0, 0}, 1.0, 4), reversed(makeIcosphere({0, 0, 0}, 0.8, 4)),
                        makeIcosphere({0.1, 0, 0}, 0.4, 4)}));
    const DepthMap map = checked(query, 250'000);
    EXPECT_LT(wrongPercent(query, map, 40'000), 0.4);
    EXPECT_LT(vote(map, {0.9F, 0, 0})->distance, 0.0F);
    EXPECT_GT(vote(map, {0.65F, 0, 0})->distance, 0.0F);
    EXPECT_LT(vote(map, {0.1F, 0, 0})->distance, 0.0F);
    EXPECT_GT(vote(map, {1.2F, 0, 0})->distance, 0.0F);
}

TEST(PatchPlanner, OverlappingShellsAreOneSolid) {
    const auto wound =
        windOutwards(joined({makeIcosphere({-0.5, 0, 0}, 1.0, 4),
                             makeBoxMesh({0.5, 0, 0}, {0.6, 0.4, 0.4}, rotation({1, 1, 0}, 30.0))}));
    ASSERT_TRUE(wound);
    const MeshQuery query = queryOf(wound->mesh);
    EXPECT_LT(wrongPercent(query, checked(query, 250'000), 40'000), 0.3);
}

TEST(PatchPlanner, PartsBetweenTheLinesAreFound) {
    // Of a thousandth of the longest side, where the lines of the largest cells are more than that apart.
    const TriangleMesh speck = makeIcosphere({40, 0.3, 0.1}, 0.02, 2);
    const MeshQuery query = queryOf(joined({makeIcosphere({0, 0, 0}, 1.0, 4), speck}));
    const DepthMap map = checked(query, 100'000);
    EXPECT_LT(vote(map, {40, 0.3F, 0.1F})->distance, 0.0F);
    EXPECT_GT(vote(map, {40.03F, 0.3F, 0.1F})->distance, 0.0F);
    EXPECT_LT(vote(map, {0.5F, 0.5F, 0.5F})->distance, 0.0F);
}

TEST(PatchPlanner, BytesAreKeptDownToTheLeast) {
    const MeshQuery query = queryOf(makeTorusMesh(1.0, 0.4, 48, 24));
    for (const std::uint64_t bytes : {kPatchBytesMin, std::uint64_t{2000}, std::uint64_t{9999}}) {
        const DepthMap map = checked(query, bytes);
        EXPECT_LT(vote(map, {1, 0, 0})->distance, 0.0F) << bytes;
        EXPECT_GT(vote(map, {0, 0, 1.3F})->distance, 0.0F) << bytes;
    }
}

TEST(PatchPlanner, SameOnAnyNumberOfThreads) {
    const MeshQuery query = queryOf(makeTorusMesh(1.0, 0.4, 48, 24));
    std::vector<DepthMap> maps;
    for (const int threads : {1, 2, 5}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads));
        tbb::task_arena arena(threads);
        arena.execute([&] { maps.push_back(bakePatches(query, {.bytes = 60'000})); });
    }
    EXPECT_EQ(maps[0], maps[1]);
    EXPECT_EQ(maps[0], maps[2]);
}

}  // namespace
}  // namespace relief::test
