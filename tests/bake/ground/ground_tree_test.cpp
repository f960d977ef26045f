// SPDX-License-Identifier: Apache-2.0
// Trees of patches baked from heights, compared with closed forms and the exact bilinear surface.
#include "bake/ground/ground_tree.h"

#include <functional>
#include <random>

#include "formats/patch_tree.h"
#include "formats/validate.h"
#include "tests/bake/ground/height_grids.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

Ground checked(const HeightGrid& grid, const GroundPlace& place = {}) {
    Result<Ground> ground = bakeGround(grid, place);
    EXPECT_TRUE(ground) << ground.error().message;
    if (!ground) {
        return {};
    }
    const Result<void> valid =
        validateFrame(ground->map).and_then([&] { return validateTexels(ground->map); });
    EXPECT_TRUE(valid) << valid.error().message;
    return std::move(*ground);
}

/// Float rounding of coordinates.
double roundingOf(const Ground& ground) {
    return 4e-7 * double{ground.bounds.longestSide()} +
           1e-7 * std::max(std::abs(double{ground.bounds.min.y}), std::abs(double{ground.bounds.max.y}));
}

/// Samples points near the surface, most of them within a few bounds.
/// \return the number of points on the wrong side by more than the bound
int wrongPoints(const HeightGrid& grid, const GroundPlace& place, const Ground& ground, int points,
                const std::function<bool(double x, double height, double z)>& beyond = {}) {
    std::mt19937 random(seedFrom(11));
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const double bound = ground.error_max + roundingOf(ground);
    int wrong = 0;
    for (int i = 0; i < points; ++i) {
        const glm::vec3 p(place.origin + glm::dvec3(place.spacing * share(random) * (grid.columns - 1), 0.0,
                                                    place.spacing * share(random) * (grid.rows - 1)));
        // Coordinates after rounding to float.
        const double x = (double{p.x} - place.origin.x) / place.spacing;
        const double z = (double{p.z} - place.origin.z) / place.spacing;
        const std::optional<double> surface = surfaceAt(grid, x, z);
        // Not deeper than the ground.
        const double width = i % 3 == 0 ? 0.05 * double{ground.bounds.longestSide()} : 3.0 * bound;
        const double away = width * (2.0 * share(random) - 1.0);
        const float y =
            static_cast<float>(surface.value_or(double{ground.bounds.min.y}) + place.origin.y + away);
        const double height = double{y} - place.origin.y;
        const bool inside = vote(ground.map, {p.x, y, p.z})->distance < 0.0F;
        const bool close = surface && std::abs(height - *surface) <= bound;
        if (!close && inside != (surface && height < *surface)) {
            wrong += !beyond || beyond(x, height, z) ? 1 : 0;
        }
    }
    return wrong;
}

int wrongPoints(const HeightGrid& grid, const GroundPlace& place, int points = 100'000) {
    const Ground ground = checked(grid, place);
    EXPECT_EQ(ground.steep, 0U);
    EXPECT_EQ(ground.squares, std::uint64_t{grid.columns - 1} * (grid.rows - 1));
    return wrongPoints(grid, place, ground, points);
}

TEST(GroundTree, SlopesHaveExactNormalsAndDepths) {
    const HeightGrid grid = gridOf(65, 49, [](double x, double z) { return 0.5 * x - 0.25 * z + 3.0; });
    const Ground ground = checked(grid);
    EXPECT_EQ(wrongPoints(grid, {}), 0);
    const glm::dvec3 normal = glm::dvec3(-0.5, 1.0, 0.25) / std::sqrt(1.3125);
    std::mt19937 random(seedFrom(3));
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int i = 0; i < 20'000; ++i) {
        const double x = 64.0 * share(random);
        const double z = 48.0 * share(random);
        const double depth = 3.9 * share(random);  // up to the side of a leaf
        const glm::vec3 p(glm::dvec3(x, 0.5 * x - 0.25 * z + 3.0 - depth, z));
        const Vote vote = *relief::vote(ground.map, p);
        // Two heights of a square can have opposite errors.
        EXPECT_NEAR(vote.distance, -depth * normal.y, (1.0 + 2.0 * depth) * ground.error_max + 1e-4) << i;
        EXPECT_GT(glm::dot(glm::dvec3(vote.normal), normal), 0.9999) << i;
    }
}

TEST(GroundTree, ErrorsAreWithinTheBound) {
    const auto cone = [](double x, double z) { return 60.0 - 0.9 * std::hypot(x - 64.3, z - 50.1); };
    const auto step = [](double x, double) { return x < 33.5 ? 0.0 : 2.5; };
    const std::pair<HeightGrid, GroundPlace> cases[] = {
        {gridOf(130, 101, cone), {}},
        {gridOf(150, 131, hills), {}},
        {gridOf(70, 66, step), {}},
        {gridOf(97, 61, [](double x, double z) { return 0.3 * hills(x, z) + 8000.0; }),
         {0.3, {-700.25, 41.0, 12.5}}},
        {gridOf(97, 61, [](double x, double z) { return 50.0 * hills(x, z); }), {50.0, {}}},
        {gridOf(2, 2, [](double x, double z) { return x + 0.5 * z; }), {}},
        {gridOf(2, 300, [](double x, double z) { return x + 0.1 * z; }), {}}};
    for (const auto& [grid, place] : cases) {
        EXPECT_EQ(wrongPoints(grid, place), 0) << grid.columns << " x " << grid.rows;
    }
}

TEST(GroundTree, FlatGroundIsExact) {
    for (const double height : {0.0, 4.0, 64.0, -64.0, 1.25, -0.001}) {
        const HeightGrid flat = gridOf(80, 80, [&](double, double) { return height; });
        EXPECT_EQ(wrongPoints(flat, {}, 10'000), 0) << height;
        const Ground ground = checked(flat);
        EXPECT_LT(ground.error_max, 2e-5) << height;
        const Vote vote = *relief::vote(ground.map, {30.2F, static_cast<float>(height) - 0.5F, 17.9F});
        EXPECT_NEAR(vote.distance, -0.5F, 1e-3F) << height;
        EXPECT_EQ(vote.normal, glm::vec3(0.0F, 1.0F, 0.0F)) << height;
    }
}

/// Tests the stored heights of all leaves: random points could miss the worst one.
TEST(GroundTree, BoundIsHalfAStepOfTheSteepestLeaf) {
    const HeightGrid grid = gridOf(129, 129, hills);
    const Ground ground = checked(grid);
    double worst = 0.0;
    double range = 0.0;
    for (std::uint32_t z = 0; z + 4 < 129; z += 4) {
        for (std::uint32_t x = 0; x + 4 < 129; x += 4) {
            float low = grid.at(x, z);
            float high = low;
            for (std::uint32_t j = 0; j <= 4; ++j) {
                for (std::uint32_t i = 0; i <= 4; ++i) {
                    const float height = grid.at(x + i, z + j);
                    low = std::min(low, height);
                    high = std::max(high, height);
                    // Stay inside the leaf: neighbours share its edges.
                    const glm::vec3 p(std::clamp(float(x + i), float(x) + 1e-3F, float(x) + 3.999F),
                                      height - 0.5F,
                                      std::clamp(float(z + j), float(z) + 1e-3F, float(z) + 3.999F));
                    const Vote vote = *relief::vote(ground.map, p);
                    const double surface = double{p.y} - double{vote.distance} / double{vote.normal.y};
                    worst = std::max(worst, std::abs(surface - *surfaceAt(grid, p.x, p.z)));
                }
            }
            range = std::max(range, double{high} - double{low});
        }
    }
    EXPECT_LE(worst, ground.error_max + roundingOf(ground));
    EXPECT_GT(worst, 0.8 * ground.error_max);
    EXPECT_LE(ground.error_max, 0.5 * (range + 4.0 / 512.0) * 17.0 / 16.0 / 255.0);
}

TEST(GroundTree, SquaresAtHolesAreEmpty) {
    std::mt19937 random(seedFrom(5));
    HeightGrid grid = gridOf(90, 75, hills);
    for (int i = 0; i < 120; ++i) {
        grid.heights[random() % grid.heights.size()] = kHole;
    }
    const Ground ground = checked(grid);
    std::uint64_t squares = 0;
    for (std::uint32_t z = 0; z + 1 < grid.rows; ++z) {
        for (std::uint32_t x = 0; x + 1 < grid.columns; ++x) {
            squares += surfaceAt(grid, x + 0.5, z + 0.5) ? 1 : 0;
        }
    }
    EXPECT_EQ(ground.squares, squares);
    EXPECT_LT(squares, 89U * 74U - 300U);
    EXPECT_EQ(wrongPoints(grid, {}, ground, 200'000), 0);
    // Holes extend down through the ground.
    const Ground cut = checked(gridOf(9, 9, [](double x, double) { return x == 4.0 ? double{kHole} : 5.0; }));
    EXPECT_EQ(cut.squares, 48U);
    EXPECT_GE(vote(cut.map, {4.5F, 4.9F, 2.5F})->distance, 0.0F);
    EXPECT_GE(vote(cut.map, {3.5F, 4.7F, 2.5F})->distance, 0.0F);
    EXPECT_LT(vote(cut.map, {5.5F, 4.9F, 2.5F})->distance, 0.0F);
    // A map without a complete square has no ground.
    const Ground none = required(
        bakeGround(gridOf(5, 5, [](double x, double) { return x == 2.0 ? 1.0 : double{kHole}; }), {}));
    EXPECT_EQ(none.squares, 0U);
}

TEST(GroundTree, SteepSquaresHaveSmallSidewaysErrors) {
    std::mt19937 random(seedFrom(8));
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const HeightGrid cliffs = gridOf(40, 37, [&](double x, double z) {
        return (x < 15.5 ? 0.0 : 60.0) + (z < 20.5 ? 0.0 : 8.0 * share(random));
    });
    const Ground ground = checked(cliffs);
    EXPECT_GT(ground.steep, 100U);
    const double bound = ground.error_max + roundingOf(ground);
    const int wrong = wrongPoints(cliffs, {}, ground, 200'000, [&](double x, double height, double z) {
        // Not an error if the exact surface passes the point nearby.
        for (int i = 0; i <= 200; ++i) {
            const double turn = 0.0314159 * i;
            for (const double far : {0.02, 0.05, 0.1, 0.15, 0.2, kAside}) {
                const std::optional<double> other =
                    surfaceAt(cliffs, x + far * std::cos(turn), z + far * std::sin(turn));
                if (!other || ((*other - height) * (*surfaceAt(cliffs, x, z) - height) <= 0.0) ||
                    std::abs(*other - height) <= bound) {
                    return false;
                }
            }
        }
        return true;
    });
    EXPECT_EQ(wrong, 0);
}

TEST(GroundTree, GroundIsSolidToATwentiethBelowItsLowestPoint) {
    const HeightGrid grid = gridOf(201, 101, hills);
    const Ground ground = checked(grid);
    const float lowest = ground.bounds.min.y;
    EXPECT_EQ(ground.bounds.max.x, 200.0F);
    EXPECT_EQ(ground.bounds.max.z, 100.0F);
    EXPECT_LT(vote(ground.map, {150.3F, lowest - 9.9F, 70.7F})->distance, -5.0F);
    EXPECT_EQ(vote(ground.map, {150.3F, lowest - 80.0F, 70.7F})->distance, kFarOutside);
    EXPECT_GE(vote(ground.map, {200.01F, lowest - 1.0F, 70.7F})->distance, 0.0F);
    EXPECT_GE(vote(ground.map, {150.0F, lowest - 1.0F, 100.01F})->distance, 0.0F);
    EXPECT_EQ(vote(ground.map, {-0.01F, lowest - 1.0F, 50.0F})->distance, kFarOutside);
    EXPECT_EQ(vote(ground.map, {10.0F, 200.0F, 50.0F})->distance, kFarOutside);
}

TEST(GroundTree, OversizedGridsAreRejectedBeforeAllocation) {
    std::mt19937 random(seedFrom(2));
    const HeightGrid noise = gridOf(600, 600, [&](double, double) { return 1e5 * double(random() % 1000); });
    for (const GroundPlace& place : {GroundPlace{1.0, {}}, GroundPlace{1e-3, {}}, GroundPlace{1e-6, {}}}) {
        expectError(bakeGround(noise, place), ErrorCode::kLimit, "larger spacing");
    }
}

}  // namespace
}  // namespace relief::test
