// SPDX-License-Identifier: Apache-2.0
// Height maps baked into tiles, compared with the exact surface, in particular at seams; and worlds measured against
// their height map: known offsets and missing tiles must be found.
#include <map>
#include <random>

#include "bake/ground/ground_bake.h"
#include "bake/ground/ground_check.h"
#include "bake/report/ground_report.h"
#include "tests/bake/ground/height_grids.h"
#include "tests/bake/threads.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

class GroundBakes : public RawHeights {
  protected:
    HeightGrid writeHills(std::uint32_t columns, std::uint32_t rows) const {
        return write("hills.raw", columns, rows, hills);
    }
    WorldField bakeWorld(const std::string& settings) {
        tiles_ = bake("hills.raw", spec(settings), world());
        return load();
    }
    [[nodiscard]] std::map<std::string, std::vector<std::byte>> worldFiles() const {
        std::map<std::string, std::vector<std::byte>> files;
        for (const auto& entry : std::filesystem::directory_iterator(world())) {
            files[entry.path().filename().string()] = *readFile(entry.path());
        }
        return files;
    }

    GroundResult tiles_;
};

/// A point within `away` squares of a seam between tiles of 64 squares, along x, z or both.
glm::dvec2 nearSeam(std::mt19937& random, double away, std::uint32_t seams) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    glm::dvec2 at(share(random), share(random));
    at *= 64.0 * (seams + 1) - 1.0;
    const auto which = static_cast<unsigned>(random() % 5);
    for (int axis = 0; axis < 2; ++axis) {
        if (which == static_cast<unsigned>(axis) || which >= 2) {
            at[axis] = 64.0 * double(1 + random() % seams) + away * (2.0 * share(random) - 1.0);
        }
    }
    return at;
}

TEST_F(GroundBakes, SeamsAreWithinTheBound) {
    for (const double spacing : {1.0, 0.7}) {
        const HeightGrid grid = writeHills(64 * 4, 64 * 3 + 7);
        const std::string settings =
            "width=256,tile=64,offset=-300.5/12/41,spacing=" + std::to_string(spacing);
        const WorldField field = bakeWorld(settings);
        EXPECT_EQ(field.world().bodies.size(), 16U);
        // The second term covers float rounding at a few hundred metres.
        const double bound = tiles_.errorMax() + 2e-4;
        std::mt19937 random(seedFrom(31));
        std::uniform_real_distribution<double> share(-1.0, 1.0);
        int wrong = 0;
        int close = 0;
        int turned = 0;
        for (int i = 0; i < 120'000; ++i) {
            const double away = i % 2 == 0 ? 1e-6 * 300.0 : 0.05;
            const glm::dvec2 at = nearSeam(random, away / spacing, 2);
            const double about = i % 4 < 2 ? 3.0 * bound : 5.0;
            const double surface = *surfaceAt(grid, at.x, at.y) + 12.0;
            const glm::vec3 p(
                glm::dvec3(-300.5 + spacing * at.x, surface + about * share(random), 41.0 + spacing * at.y));
            const double x = (double{p.x} + 300.5) / spacing;
            const double z = (double{p.z} - 41.0) / spacing;
            const double height = double{p.y} - 12.0;
            const double exact = *surfaceAt(grid, x, z);
            const WorldSample sample = field.evaluate(p);
            if (std::abs(height - exact) <= bound) {
                ++close;
                const auto slope = [&](double dx, double dz) {
                    return (surfaceAt(grid, x + dx, z + dz).value_or(exact) -
                            surfaceAt(grid, x - dx, z - dz).value_or(exact)) /
                           (0.5 * spacing);
                };
                const glm::dvec3 normal =
                    glm::normalize(glm::dvec3(-slope(0.25, 0.0), 1.0, -slope(0.0, 0.25)));
                turned += sample.body < 0 || glm::dot(glm::dvec3(sample.normal), normal) < 0.95 ? 1 : 0;
                continue;
            }
            wrong += sample.inside() != (height < exact) ? 1 : 0;
        }
        EXPECT_EQ(wrong, 0) << spacing;
        EXPECT_LE(turned, close / 100) << "a ball would be kicked";
        EXPECT_LT(close, 40'000);
    }
}

/// Coarse tiles match the ground of every fourth sample, including the seams. Each has the box of its fine tile.
TEST_F(GroundBakes, CoarseTilesMatchEveryFourthSample) {
    const HeightGrid grid = writeHills(64 * 12 - 5, 64 * 8 + 3);
    HeightGrid fewer{(grid.columns + 2) / 4 + 1, (grid.rows + 2) / 4 + 1, {}};
    for (std::size_t row = 0; row < fewer.rows; ++row) {
        for (std::size_t column = 0; column < fewer.columns; ++column) {
            fewer.heights.push_back(grid.at(std::min<std::size_t>(4 * column, grid.columns - 1),
                                            std::min<std::size_t>(4 * row, grid.rows - 1)));
        }
    }
    const WorldField fine = bakeWorld("width=763,tile=256");
    const WorldField coarse = load(WorldDetail::kCoarse);
    ASSERT_EQ(fine.world().bodies.size(), 9U);
    std::size_t smaller = 0;
    for (std::size_t i = 0; i < 9; ++i) {
        const std::optional<WorldFile>& file = fine.world().colliders[i].coarse;
        if (file) {
            ++smaller;
            EXPECT_LT(10 * file->gpu_bytes, fine.world().colliders[i].gpu_bytes);
            EXPECT_EQ(insideBox(coarse.colliderOf(i)), insideBox(fine.colliderOf(i)));
        }
    }
    EXPECT_EQ(smaller, 6U) << "tiles of the last row are too small";
    std::mt19937 random(seedFrom(34));
    std::uniform_real_distribution<double> share(0.0, 1.0);
    int below = 0;
    for (int i = 0; i < 100'000; ++i) {
        // Only whole coarse squares, in the first two rows of tiles.
        const double x = i % 2 == 0 ? 760.0 * share(random) : 256.0 + 0.02 * share(random) - 0.01;
        const double z = i % 4 < 2 ? 512.0 * share(random) : 256.0 + 0.02 * share(random) - 0.01;
        const double surface = *surfaceAt(fewer, x / 4.0, z / 4.0);
        const glm::vec3 p(glm::dvec3(x, surface + 3.0 * (2.0 * share(random) - 1.0), z));
        const double exact = *surfaceAt(fewer, double{p.x} / 4.0, double{p.z} / 4.0);
        if (std::abs(double{p.y} - exact) > 0.08) {
            ++below;
            ASSERT_EQ(coarse.evaluate(p).inside(), double{p.y} < exact) << p.x << " " << p.y << " " << p.z;
        }
    }
    EXPECT_GT(below, 90'000);
}

TEST_F(GroundBakes, OnlyCoarseTilesFillSmallHoles) {
    write("hills.raw", 257, 257, [](double x, double z) {
        const bool small = x == 100 && z == 100;  // at a coarse sample
        return small || (x >= 200 && z >= 200) ? double{kHole} : 9.0;
    });
    const WorldField fine = bakeWorld("tile=256,hole=0");
    const WorldField coarse = load(WorldDetail::kCoarse);
    const float below = 8.0F;
    EXPECT_FALSE(fine.evaluate({100.2F, below, 100.2F}).inside());
    EXPECT_TRUE(coarse.evaluate({100.2F, below, 100.2F}).inside());
    for (const WorldField* field : {&fine, &coarse}) {
        EXPECT_TRUE(field->evaluate({90.0F, below, 90.0F}).inside());
        EXPECT_FALSE(field->evaluate({220.0F, below, 220.0F}).inside());
    }
}

TEST_F(GroundBakes, OutputIsDeterministicAndReplacesOldTiles) {
    writeHills(150, 150);
    static_cast<void>(bakeWorld("tile=64"));
    const auto first = worldFiles();
    EXPECT_EQ(first.size(), 10U);
    static_cast<void>(onThreads(1, [&] { return bakeWorld("tile=64").world().bodies.size(); }));
    EXPECT_EQ(worldFiles(), first);
    EXPECT_TRUE(tiles_.removed.empty());
    static_cast<void>(bakeWorld("tile=128"));
    EXPECT_EQ(tiles_.removed.size(), 9U);
    EXPECT_EQ(worldFiles().size(), 5U);
}

TEST_F(GroundBakes, TilesNeedAFolder) {
    writeHills(70, 70);
    expectError(tryBake("hills.raw", spec("tile=64"), {}), ErrorCode::kUsage, "tile=");
}

TEST_F(GroundBakes, EmptyTilesAreOmitted) {
    write("hills.raw", 129, 129, [](double x, double) { return x > 40 ? double{kHole} : 0.0; });
    const WorldField field = bakeWorld("tile=64,hole=0");
    EXPECT_EQ(field.world().bodies.size(), 2U);
    EXPECT_EQ(tiles_.tiles[0].squares, 40U * 68U);
    write("none.raw", 129, 129, [](double, double) { return double{kHole}; });
    for (const std::filesystem::path& into : {std::filesystem::path(), world()}) {
        const Result<GroundResult> none = tryBake("none.raw", spec("hole=0"), into);
        ASSERT_FALSE(none);
        EXPECT_EQ(none.error().code, ErrorCode::kInvalidInput);
        EXPECT_EQ(none.error().message.find("none.raw: "), 0U) << none.error().message;
    }
}

void expectHas(const std::string& text, std::string_view words) {
    EXPECT_NE(text.find(words), std::string::npos) << text;
}

/// A warning suggests the right settings if the samples reveal them.
TEST_F(GroundBakes, WrongSampleFormatsGetAdvice) {
    const auto warned = [&](const std::string& settings) {
        std::string all;
        for (const std::string& warning : bake("h.raw", parseHeightsSpec(settings).value()).warnings) {
            all += warning + "\n";
        }
        return all;
    };
    write("h.raw", 17, 17, hills);
    EXPECT_EQ(warned("low=-20,high=44"), "");
    EXPECT_NE(warned("low=-20,high=44,order=big")
                  .find("h.raw: its samples look like those of another format; try --heights order=little\n"),
              std::string::npos);
    // Errors contain the same advice.
    const auto tooFar = [&](const std::string& settings) {
        const Result<GroundResult> far =
            tryBake("h.raw", parseHeightsSpec("spacing=0.01," + settings).value(), {});
        EXPECT_FALSE(far);
        EXPECT_EQ(far.error().code, ErrorCode::kLimit);
        return far ? "" : far.error().message;
    };
    const std::string right = "low=0,high=65535";
    expectHas(tooFar(right + ",order=big"),
              "; its samples look like those of another format; try --heights order=little");
    EXPECT_EQ(tooFar(right).find("order"), std::string::npos) << "already smooth";
    EXPECT_NE(warned("low=-2000,high=4400")
                  .find("h.raw: most of its squares are steep; check --heights spacing, low "),
              std::string::npos);
    write("h.raw", 17, 17,
          [](double x, double z) { return x == 9 && z == 4 ? double{kHole} : hills(x, z) + 25.0; });
    const std::string hole = warned("low=-20,high=44");
    expectHas(hole, "h.raw: its lowest sample, 0, lies");
    expectHas(hole, " far below all others; if it stands for no data, give --heights hole=0\n");
    EXPECT_EQ(warned("low=-20,high=44,hole=0"), "");
    // -1 as int16, or a hole as uint16, beside heights of 0 to 2.
    const auto sample = [](double value) { return kLow + value * (kHigh - kLow) / 65535.0; };
    write("h.raw", 17, 17,
          [&](double x, double z) { return sample(x == 9 && z == 4 ? 65535.0 : std::round(x / 8.0)); });
    const std::string sign = warned("spacing=10000,low=0,high=65535");
    EXPECT_NE(sign.find("try --heights type=int16, without low and high; or, if its highest sample, 65535, "
                        "stands for no data, --heights hole=65535\n"),
              std::string::npos)
        << sign;
    std::mt19937 random(1);
    write("h.raw", 17, 17, [&](double, double) { return sample(static_cast<double>(random() % 65536)); });
    expectHas(tooFar(right), "; check --heights type and order too");
    // Flat at half of the range, which is -32768 as int16.
    write("h.raw", 17, 17,
          [&](double x, double z) { return sample(32768.0 + (x > 10 ? 3.0 * (x - 10) + z : 0.0)); });
    EXPECT_EQ(warned("spacing=1000,low=0,high=65535"), "");
    // Passes 32768 between two samples: that value is -32768 as int16, which the search takes for a hole.
    write("h.raw", 17, 17, [&](double x, double) { return sample(32768.0 + 1000.0 * (x - 8.5)); });
    EXPECT_EQ(tooFar(right).find("order"), std::string::npos);
    expectHas(tooFar("type=int16"), "type");
    // Ambiguous: correct as given, or heights up to 200 m in the other byte order.
    write("h.raw", 17, 17, [&](double x, double z) { return sample(256.0 * std::round(6.0 * (x + z))); });
    EXPECT_NE(warned("spacing=100,low=0,high=100")
                  .find("try --heights order=big, unless they are 8 bits times 256\n"),
              std::string::npos);
    // -2 and -1 beside 0.
    write("h.raw", 17, 17, [&](double x, double z) {
        return sample(x == 9 && z == 4 ? 0.0 : x > 8.0 ? 65534.0 : 65535.0);
    });
    const std::string below = warned("spacing=100,low=0,high=65535");
    EXPECT_NE(below.find("; or, if its lowest sample, 0, stands for no data, --heights hole=0\n"),
              std::string::npos)
        << below;
    write("h.raw", 17, 17, [&](double x, double z) {
        return sample(x == 9 && z == 4 ? 65535.0 : x == 10 && z == 4 ? 65000.0 : 3000.0 + x + z);
    });
    const std::string several = warned("spacing=1000,low=0,high=65535");
    expectHas(several,
              "its highest samples, 65000 to 65535, lie far above all others; if they stand for "
              "no data, save them as one value and give it as --heights hole\n");
}

/// A square that rises by 66° along its diagonal has no bound, although each of its sides rises by 58°.
TEST_F(GroundBakes, SteepSquaresAreCountedAndHaveNoBound) {
    const auto report = [&](double slope, double kink) {
        write("slope.raw", 9, 9, [&](double x, double z) {
            return slope * std::max(x - kink, 0.0) + slope * std::max(z - kink, 0.0);
        });
        const GroundResult result = bake("slope.raw", spec(""));
        return (result.warnings.empty() ? "" : result.warnings.front()) + "\n" + groundText(result, "g", 0.0);
    };
    const std::string all = report(1.6, 0.0);
    expectHas(all,
              "64 squares are steep: they rise by more than 2.9 times their side (64 degrees along a "
              "diagonal, 71 along a row); ");
    expectHas(all, "samples, steep everywhere; ");
    EXPECT_EQ(all.find(" mm"), std::string::npos) << all;
    const std::string some = report(1.6, 4.0);
    expectHas(some, "16 squares are steep");
    expectHas(some, " mm along y except at steep squares; ");
    expectHas(report(1.4, 0.0), " mm along y; ");
}

class GroundChecks : public RawHeights {
  protected:
    /// A collider, or a world if `tiles` is true.
    [[nodiscard]] WorldField baked(const char* name, const HeightsSpec& heights, bool tiles = false) const {
        const GroundResult result = bake(name, heights, tiles ? world() : std::filesystem::path());
        if (tiles) {
            return load();
        }
        LoadedWorld single;
        single.world.colliders.emplace_back();
        single.world.bodies.emplace_back();
        single.colliders.push_back(*readContainer(result.container));
        return WorldField(std::move(single));
    }
    [[nodiscard]] Result<GroundAccuracy> tryCheck(const char* name, const HeightsSpec& heights,
                                                  const WorldField& field,
                                                  std::uint64_t samples = 20'000) const {
        return checkGround({folder_.path() / name, heights, samples, 1, {}}, field, "ground");
    }
    [[nodiscard]] GroundAccuracy check(const char* name, const std::string& settings,
                                       const WorldField& field) const {
        return required(tryCheck(name, spec(settings), field));
    }
};

TEST_F(GroundChecks, PlaneIsWithinTheBakeError) {
    const auto plane = [](double x, double z) { return 3.0 + 0.25 * x - 0.125 * z; };
    write("plane.raw", 90, 70, plane);
    const std::string settings = "width=90,offset=7/1/-3";
    const WorldField field = baked("plane.raw", spec(settings));
    const GroundAccuracy result = check("plane.raw", settings, field);
    EXPECT_EQ(result.squares, 89U * 69U);
    EXPECT_EQ(result.holes, 0U);
    EXPECT_EQ(result.near.points, 20'000U);
    EXPECT_EQ(result.near.missing, 0U);
    EXPECT_LT(result.near.most, 0.01);  // half a quantization step of a leaf with a range of 1.5
    EXPECT_LT(result.near.wrong.total(), 0.5);
    EXPECT_LT(result.uniform.total(), 0.1);
    EXPECT_FALSE(result.seams);
    EXPECT_EQ(result.worst.size(), 10U);
    EXPECT_TRUE(result.warnings.empty());
}

TEST_F(GroundChecks, ShiftIsMeasured) {
    write("hills.raw", 150, 150, hills);
    const WorldField field = baked("hills.raw", spec("tile=64"), true);
    ASSERT_EQ(field.world().bodies.size(), 9U);
    const GroundAccuracy right = check("hills.raw", "tile=64", field);
    ASSERT_TRUE(right.seams);
    const GroundAccuracy single = onThreads(1, [&] { return check("hills.raw", "tile=64", field); });
    EXPECT_EQ(single.near.mean, right.near.mean);
    EXPECT_EQ(single.seams->p99, right.seams->p99);
    EXPECT_EQ(single.uniform.total(), right.uniform.total());
    EXPECT_EQ(single.worst.front().position, right.worst.front().position);
    EXPECT_LT(right.near.mean_abs, 0.01);
    EXPECT_LT(right.near.wrong.total(), 0.5);
    EXPECT_LT(right.seams->wrong.total(), 0.5);
    EXPECT_EQ(right.near.missing + right.seams->missing, 0U);
    // Points are within ±1 of the surface. Those between the two surfaces are wrong: 0.2 of 2.
    const GroundAccuracy lower = check("hills.raw", "tile=64,offset=0/-0.2/0", field);
    EXPECT_NEAR(lower.near.mean, 0.2 + right.near.mean, 1e-4);
    EXPECT_NEAR(lower.seams->mean, 0.2 + right.seams->mean, 1e-4);
    EXPECT_NEAR(lower.near.wrong.false_inside, 10.0, 1.0);
    EXPECT_LT(lower.near.wrong.false_outside, 0.1);
    for (const GroundWorstPlace& place : right.worst) {
        EXPECT_EQ(place.node.substr(0, 5), "tile ");
        ASSERT_TRUE(place.error);
        EXPECT_LE(std::abs(*place.error), std::max(right.near.most, right.seams->most) + 1e-6);
    }
    // Points without a surface in range count as missing, not as an error of 0.
    const GroundAccuracy far = check("hills.raw", "tile=64,offset=0/5/0", field);
    EXPECT_EQ(far.near.missing, far.near.points);
    EXPECT_FALSE(far.worst.front().error);
    EXPECT_NEAR(far.near.wrong.false_outside, 50.0, 2.0);
}

TEST_F(GroundChecks, HolesAreOutside) {
    const auto holed = [](double x, double z) {
        return x > 20 && x < 40 && z > 10 && z < 50 ? double{kHole} : hills(x, z);
    };
    write("holed.raw", 100, 100, holed);
    const WorldField field = baked("holed.raw", spec("hole=0"));
    const GroundAccuracy right = check("holed.raw", "hole=0", field);
    EXPECT_EQ(right.holes, 20U * 40U);
    EXPECT_LT(right.near.wrong.total(), 0.5);
    EXPECT_LT(right.uniform.total(), 0.2);
    EXPECT_EQ(right.near.missing, 0U);
    // Filled holes are wrong inside points. Holes where the map has ground are missing points.
    write("whole.raw", 100, 100, hills);
    const WorldField filled = baked("whole.raw", spec(""));
    const GroundAccuracy more = check("holed.raw", "hole=0", filled);
    EXPECT_GT(more.uniform.false_inside, 2.0);
    EXPECT_LT(more.uniform.false_outside, 0.1);
    ASSERT_EQ(more.warnings.size(), 1U);
    EXPECT_NE(more.warnings[0].find("holed.raw is not the file"), std::string::npos);
    const GroundAccuracy less = check("whole.raw", "", field);
    EXPECT_NEAR(100.0 * double(less.near.missing) / double(less.near.points), 100.0 * 800 / (99 * 99), 0.2);
    EXPECT_GT(less.uniform.false_outside, 2.0);
}

TEST_F(GroundChecks, LostTileIsMissing) {
    write("hills.raw", 200, 200, hills);
    LoadedWorld loaded = baked("hills.raw", spec("tile=64"), true).loaded();
    ASSERT_EQ(loaded.world.bodies[5].node, "tile 1 1");
    loaded.world.bodies.erase(loaded.world.bodies.begin() + 5);
    const WorldField field(std::move(loaded));
    const GroundAccuracy result = check("hills.raw", "tile=64", field);
    // The neighbouring tiles overlap it by four squares.
    EXPECT_NEAR(100.0 * double(result.near.missing) / double(result.near.points),
                100.0 * 56 * 56 / (199 * 199), 0.3);
    EXPECT_FALSE(result.worst.back().error);
}

TEST_F(GroundChecks, WrongMapsAndBodiesAreRejected) {
    write("hills.raw", 100, 100, hills);
    write("other.raw", 120, 120, hills);
    const WorldField field = baked("hills.raw", spec(""));
    LoadedWorld loaded = field.loaded();
    loaded.world.bodies[0].rotation = {0.0F, 1.0F, 0.0F, 0.0F};
    const WorldField turned(std::move(loaded));
    const auto refused = [&](const char* name, const char* settings, const WorldField& ground,
                             std::uint64_t samples, ErrorCode code, const char* words) {
        expectError(tryCheck(name, spec(settings), ground, samples), code, words);
    };
    refused("other.raw", "", field, 100, ErrorCode::kInvalidInput,
            "other.raw: its ground lies from (0, 0) to (119, 119)");
    refused("hills.raw", "spacing=2", field, 100, ErrorCode::kInvalidInput, "to (198, 198)");
    refused("none.raw", "", field, 100, ErrorCode::kIo, "none.raw");
    refused("hills.raw", "", turned, 100, ErrorCode::kInvalidInput, "rotated or scaled");
    refused("hills.raw", "", field, kGroundSamplesMax + 1, ErrorCode::kLimit, "");
}

}  // namespace
}  // namespace relief::test
