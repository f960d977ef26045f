// Bytes of a level, shared.
#include "bake/world/budget_share.h"

#include <gtest/gtest.h>

#include <vector>

namespace relief {
namespace {

std::vector<std::uint64_t> shared(std::uint64_t budget, const std::vector<double>& weights) {
    std::vector<BudgetShare> shares;
    for (const double weight : weights) {
        shares.push_back({weight});
    }
    EXPECT_TRUE(shareBudget(budget, shares));
    std::vector<std::uint64_t> bytes;
    for (const BudgetShare& share : shares) {
        bytes.push_back(share.bytes);
    }
    return bytes;
}

TEST(BudgetShares, StepsAreEighthsOfAnOctave) {
    for (const std::uint64_t bytes :
         {1ULL, 2ULL, 3ULL, 4096ULL, 5000ULL, 1'000'000ULL, 1'048'576ULL, 1ULL << 40}) {
        const std::uint64_t step = roundDownToEighth(bytes);
        EXPECT_LE(step, bytes);
        EXPECT_GT(static_cast<double>(step), static_cast<double>(bytes) / 1.0906 - 1.0);
        EXPECT_EQ(roundDownToEighth(step), step);
    }
    EXPECT_EQ(roundDownToEighth(1'048'576), 1'048'576U);
}

TEST(BudgetShares, HalfIsByAreaAndHalfIsEven) {
    const std::vector<std::uint64_t> bytes = shared(1 << 20, {3.0, 1.0});
    EXPECT_EQ(bytes[0], roundDownToEighth((1 << 18) + (1 << 17) * 3));
    EXPECT_EQ(bytes[1], roundDownToEighth((1 << 18) + (1 << 17)));
    EXPECT_EQ(shared(1 << 20, {0.0, 0.0}), (std::vector<std::uint64_t>(2, 1 << 18))) << "no area at all";
}

TEST(BudgetShares, SmallPartsOfALargeLevelKeepTheirHalf) {
    std::vector<double> weights(51, 8.0);
    weights[0] = 1e6;
    const std::vector<std::uint64_t> bytes = shared(16'000'000, weights);
    EXPECT_GT(bytes[1], 140'000U);
    EXPECT_GT(bytes[0], 7'000'000U);
    std::uint64_t sum = 0;
    for (const std::uint64_t share : bytes) {
        sum += share;
    }
    EXPECT_LE(sum, 16'000'000U);
    // A prop that grows leaves the others theirs.
    weights[7] = 16.0;
    std::vector<std::uint64_t> after = shared(16'000'000, weights);
    after[7] = bytes[7];
    EXPECT_EQ(after, bytes);
}

TEST(BudgetShares, TooFewBytesAreRefusedWithTheLeastThatWouldDo) {
    std::vector<BudgetShare> shares(100);
    const Result<void> shared = shareBudget(819'199, shares);
    ASSERT_FALSE(shared);
    EXPECT_EQ(shared.error().code, ErrorCode::kUsage);
    EXPECT_NE(shared.error().message.find("at least 819200"), std::string::npos) << shared.error().message;
    EXPECT_TRUE(shareBudget(819'200, shares));
}

}  // namespace
}  // namespace relief
