// SPDX-License-Identifier: Apache-2.0
// Ground measured against its height map: known offsets and missing tiles must be found.
#include "bake/ground/ground_check.h"

#include "tests/bake/ground/height_grids.h"
#include "tests/bake/threads.h"

namespace relief::test {
namespace {

class GroundChecks : public RawHeights {
  protected:
    /// A collider, or a world if `tiles` is true.
    [[nodiscard]] WorldField baked(const char* name, const HeightsSpec& heights, bool tiles = false) const {
        const GroundResult result = bake(name, heights, tiles ? world() : std::filesystem::path());
        if (tiles) {
            return load();
        }
        LoadedWorld alone;
        alone.world.colliders.emplace_back();
        alone.world.bodies.emplace_back();
        alone.colliders.push_back(*readContainer(result.container));
        return WorldField(std::move(alone));
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
