// Ground measured against its height map: what is off by a known length, and what is lost, must be found.
#include "bake/ground/ground_check.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "bake/ground/ground_bake.h"
#include "formats/base/file_io.h"
#include "formats/container.h"
#include "tests/bake/ground/height_grids.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

constexpr double kLow = -20.0;
constexpr double kHigh = 44.0;

class GroundChecks : public testing::Test {
  protected:
    /// Writes heights as samples of 16 bits. \param height  of (column, row); NaN: a hole, sample 0
    template <class Height>
    std::filesystem::path write(const std::string& name, std::uint32_t columns, std::uint32_t rows,
                                const Height& height) const {
        std::vector<std::uint16_t> samples;
        for (std::uint32_t row = 0; row < rows; ++row) {
            for (std::uint32_t column = 0; column < columns; ++column) {
                const double h = height(double(column), double(row));
                samples.push_back(std::isnan(h) ? 0
                                                : static_cast<std::uint16_t>(
                                                      std::lround((h - kLow) / (kHigh - kLow) * 65535.0)));
            }
        }
        EXPECT_TRUE(writeFile(folder_.path() / name, std::as_bytes(std::span(samples))));
        return folder_.path() / name;
    }
    static HeightsSpec spec(const std::string& more) {
        return parseHeightsSpec("low=-20,high=44" + (more.empty() ? "" : "," + more)).value();
    }

    /// A collider, or with tiles a world.
    WorldField bake(const std::filesystem::path& map_file, const HeightsSpec& heights, bool tiles) const {
        Result<HeightMap> map = HeightMap::open(map_file, heights);
        EXPECT_TRUE(map) << map.error().message;
        GroundOptions options;
        options.heights = heights;
        options.folder = tiles ? folder_.path() / "world" : std::filesystem::path();
        std::filesystem::create_directories(folder_.path() / "world");
        Result<GroundResult> result = bakeGroundOf(*map, options);
        EXPECT_TRUE(result) << result.error().message;
        if (tiles) {
            Result<LoadedWorld> loaded = loadWorld(folder_.path() / "world" / kWorldFileName);
            EXPECT_TRUE(loaded) << loaded.error().message;
            return WorldField(std::move(*loaded));
        }
        LoadedWorld alone;
        alone.world.colliders.emplace_back();
        alone.world.bodies.emplace_back();
        alone.colliders.push_back(*readContainer(result->container));
        return WorldField(std::move(alone));
    }
    static Result<GroundAccuracy> check(const std::filesystem::path& map, const HeightsSpec& heights,
                                        const WorldField& field, std::uint64_t samples = 20'000) {
        return checkGround({map, heights, samples, 1, {}}, field, "ground");
    }

    TemporaryFolder folder_;
};

TEST_F(GroundChecks, APlaneIsRightWithinTheErrorOfTheBake) {
    const auto plane = [](double x, double z) { return 3.0 + 0.25 * x - 0.125 * z; };
    const auto file = write("plane.raw", 90, 70, plane);
    const HeightsSpec heights = spec("width=90,offset=7/1/-3");
    const WorldField field = bake(file, heights, false);
    const Result<GroundAccuracy> result = check(file, heights, field);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->squares, 89U * 69U);
    EXPECT_EQ(result->holes, 0U);
    EXPECT_EQ(result->near.points, 20'000U);
    EXPECT_EQ(result->near.missing, 0U);
    EXPECT_LT(result->near.most, 0.01);  // half a step of a leaf, whose range is 1.5
    EXPECT_LT(result->near.wrong.total(), 0.5);
    EXPECT_LT(result->anywhere.total(), 0.1);
    EXPECT_FALSE(result->seams);
    EXPECT_EQ(result->worst.size(), 10U);
    EXPECT_TRUE(result->warnings.empty());
}

TEST_F(GroundChecks, AShiftIsMeasured) {
    const auto file = write("hills.raw", 150, 150, hills);
    const WorldField field = bake(file, spec("tile=64"), true);
    ASSERT_EQ(field.world().bodies.size(), 9U);
    Result<GroundAccuracy> right = check(file, spec("tile=64"), field);
    ASSERT_TRUE(right) << right.error().message;
    ASSERT_TRUE(right->seams);
    EXPECT_LT(right->near.mean_abs, 0.01);
    EXPECT_LT(right->near.wrong.total(), 0.5);
    EXPECT_LT(right->seams->wrong.total(), 0.5);
    EXPECT_EQ(right->near.missing + right->seams->missing, 0U);
    // Of two lengths y the points between the surfaces are wrong: 0.2 of 2.
    const Result<GroundAccuracy> lower = check(file, spec("tile=64,offset=0/-0.2/0"), field);
    ASSERT_TRUE(lower) << lower.error().message;
    EXPECT_NEAR(lower->near.mean, 0.2 + right->near.mean, 1e-4);
    EXPECT_NEAR(lower->seams->mean, 0.2 + right->seams->mean, 1e-4);
    EXPECT_NEAR(lower->near.wrong.false_inside, 10.0, 1.0);
    EXPECT_LT(lower->near.wrong.false_outside, 0.1);
    for (const GroundWorstPlace& place : right->worst) {
        EXPECT_EQ(place.node.substr(0, 5), "tile ");
        ASSERT_TRUE(place.error);
        EXPECT_LE(std::abs(*place.error), std::max(right->near.most, right->seams->most) + 1e-6);
    }
    // Beyond reach there is no surface, which is no error of 0.
    const Result<GroundAccuracy> far = check(file, spec("tile=64,offset=0/5/0"), field);
    ASSERT_TRUE(far) << far.error().message;
    EXPECT_EQ(far->near.missing, far->near.points);
    EXPECT_FALSE(far->worst.front().error);
    EXPECT_NEAR(far->near.wrong.false_outside, 50.0, 2.0);
}

TEST_F(GroundChecks, APlaneShiftedAlongXIsOffByItsRise) {
    const auto file = write("plane.raw", 64, 64, [](double x, double) { return 0.25 * x; });
    const WorldField field = bake(file, spec(""), false);
    const Result<GroundAccuracy> result = check(file, spec("offset=2/0/0"), field);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_GT(result->near.missing, 0U);  // beyond x = 63 there is no ground
    EXPECT_NEAR(result->near.mean, 0.5, 0.01);
    EXPECT_NEAR(result->near.p99, 0.5, 0.02);
}

TEST_F(GroundChecks, HolesAreOutside) {
    const auto holed = [](double x, double z) {
        return x > 20 && x < 40 && z > 10 && z < 50 ? double{kHole} : hills(x, z);
    };
    const auto file = write("holed.raw", 100, 100, holed);
    const WorldField field = bake(file, spec("hole=0"), false);
    const Result<GroundAccuracy> right = check(file, spec("hole=0"), field);
    ASSERT_TRUE(right) << right.error().message;
    EXPECT_EQ(right->holes, 20U * 40U);
    EXPECT_LT(right->near.wrong.total(), 0.5);
    EXPECT_LT(right->anywhere.total(), 0.2);
    EXPECT_EQ(right->near.missing, 0U);
    // Ground where the map has holes is inside by mistake anywhere, and holes where it has ground are missing.
    const auto whole = write("whole.raw", 100, 100, hills);
    const WorldField filled = bake(whole, spec(""), false);
    const Result<GroundAccuracy> more = check(file, spec("hole=0"), filled);
    ASSERT_TRUE(more) << more.error().message;
    EXPECT_GT(more->anywhere.false_inside, 2.0);
    EXPECT_LT(more->anywhere.false_outside, 0.1);
    ASSERT_EQ(more->warnings.size(), 1U);
    EXPECT_NE(more->warnings[0].find("holed.raw is another file"), std::string::npos);
    const Result<GroundAccuracy> less = check(whole, spec(""), field);
    ASSERT_TRUE(less) << less.error().message;
    EXPECT_NEAR(100.0 * double(less->near.missing) / double(less->near.points), 100.0 * 800 / (99 * 99), 0.2);
    EXPECT_GT(less->anywhere.false_outside, 2.0);
}

TEST_F(GroundChecks, ALostTileIsMissing) {
    const auto file = write("hills.raw", 200, 200, hills);
    const HeightsSpec heights = spec("tile=64");
    LoadedWorld loaded = bake(file, heights, true).loaded();
    ASSERT_EQ(loaded.world.bodies[5].node, "tile 1 1");
    loaded.world.bodies.erase(loaded.world.bodies.begin() + 5);
    const WorldField field(std::move(loaded));
    const Result<GroundAccuracy> result = check(file, heights, field);
    ASSERT_TRUE(result) << result.error().message;
    // Its neighbours reach four squares into it.
    EXPECT_NEAR(100.0 * double(result->near.missing) / double(result->near.points),
                100.0 * 56 * 56 / (199 * 199), 0.3);
    EXPECT_FALSE(result->worst.back().error);
}

TEST_F(GroundChecks, ThreadsChangeNothing) {
    const auto file = write("hills.raw", 150, 150, hills);
    const WorldField field = bake(file, spec("tile=64"), true);
    const Result<GroundAccuracy> many = check(file, spec("tile=64"), field);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Result<GroundAccuracy> alone = check(file, spec("tile=64"), field);
    ASSERT_TRUE(many && alone);
    EXPECT_EQ(many->near.mean, alone->near.mean);
    EXPECT_EQ(many->seams->p99, alone->seams->p99);
    EXPECT_EQ(many->anywhere.total(), alone->anywhere.total());
    EXPECT_EQ(many->worst.front().place, alone->worst.front().place);
}

TEST_F(GroundChecks, WrongMapsAndBodiesAreRefused) {
    const auto file = write("hills.raw", 100, 100, hills);
    const WorldField field = bake(file, spec(""), false);
    const auto other = write("other.raw", 120, 120, hills);
    const auto refused = [&](const std::filesystem::path& map, const HeightsSpec& heights, ErrorCode code,
                             const char* words) {
        const Result<GroundAccuracy> result = check(map, heights, field, 100);
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, code);
        EXPECT_NE(result.error().message.find(words), std::string::npos) << result.error().message;
    };
    refused(
        other, spec(""), ErrorCode::kInvalidInput,
        "other.raw: its ground lies from (0, 0) to (119, 119) in x and z, and that of ground from (0, 0) to "
        "(99, 99); give");
    refused(file, spec("spacing=2"), ErrorCode::kInvalidInput, "to (198, 198)");
    refused(folder_.path() / "none.raw", spec(""), ErrorCode::kIo, "none.raw");
    LoadedWorld turned = field.loaded();
    turned.world.bodies[0].rotation = {0.0F, 1.0F, 0.0F, 0.0F};
    const Result<GroundAccuracy> result = check(file, spec(""), WorldField(std::move(turned)), 100);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("turned or scaled"), std::string::npos);
    EXPECT_EQ(check(file, spec(""), field, kGroundSamplesMax + 1).error().code, ErrorCode::kLimit);
}

}  // namespace
}  // namespace relief::test
