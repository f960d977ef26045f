// What is concluded from measured accuracy: by numbers that can be checked in the head.
#include "bake/bench/accuracy_summary.h"

#include <gtest/gtest.h>

namespace relief::test {
namespace {

using Texts = std::vector<std::string>;

TEST(Budgets, AreReadInTheirOrder) {
    const auto budgets = parseBudgets(Texts{"4MB", "0.25MB", "1 MB"});
    ASSERT_TRUE(budgets);
    EXPECT_EQ(*budgets, (std::vector<std::uint64_t>{4'000'000, 250'000, 1'000'000}));
}

TEST(Budgets, WhatIsNoneOrTwiceIsRefused) {
    for (const Texts& texts : {Texts{}, Texts{""}, Texts{"1MB", "ours"}, Texts{"1MB", "1000kB"}}) {
        const auto budgets = parseBudgets(texts);
        ASSERT_FALSE(budgets);
        EXPECT_EQ(budgets.error().code, ErrorCode::kUsage);
        EXPECT_NE(budgets.error().message.find("--budgets"), std::string::npos);
    }
}

TEST(GeometricMean, OfReciprocalsIsOne) {
    // The arithmetic mean would be 2.05.
    EXPECT_DOUBLE_EQ(*geometricMean(std::vector{4.0, 0.25, 1.0}), 1.0);
    EXPECT_DOUBLE_EQ(*geometricMean(std::vector{0.1, 0.1, 0.8}), 0.2);
    EXPECT_DOUBLE_EQ(*geometricMean(std::vector{0.3}), 0.3);
    EXPECT_EQ(geometricMean({}), std::nullopt);
}

TEST(WrongRatio, CountsHalfAPointForNone) {
    EXPECT_DOUBLE_EQ(wrongRatio(0.5, 2.0, 200'000), 0.25);
    // One point of 200 000 is 0.0005 %.
    EXPECT_DOUBLE_EQ(wrongRatio(0.0, 0.0005, 200'000), 0.5);
    EXPECT_DOUBLE_EQ(wrongRatio(0.0005, 0.0, 200'000), 2.0);
    EXPECT_DOUBLE_EQ(wrongRatio(0.0, 0.0, 200'000), 1.0);
}

AccuracyRow row(const char* mesh, bool closed, std::uint64_t budget, double ours, double seconds) {
    return {mesh, closed, budget, 2.0 * ours, ours, seconds};
}

TEST(Summary, MeetsItsTargets) {
    const std::vector<AccuracyRow> rows = {
        row("a", true, 250'000, 0.1, 9.0), row("b", true, 250'000, 0.225, 1.0),
        row("a", true, 1'000'000, 0.2, 2.9), row("b", false, 1'000'000, 0.05, 1.0)};
    const auto summaries = summarize(rows, std::vector<std::uint64_t>{250'000, 1'000'000});
    ASSERT_EQ(summaries.size(), 2U);
    EXPECT_EQ(summaries[0].meshes, 2U);
    EXPECT_DOUBLE_EQ(*summaries[0].our_mean, 0.15);
    EXPECT_DOUBLE_EQ(*summaries[0].paper_mean, 0.3);
    EXPECT_DOUBLE_EQ(*summaries[1].our_mean, 0.1);
    EXPECT_EQ(summaries[1].slowest->mesh, "a");
    EXPECT_TRUE(summaries[0].missed.empty());  // bakes are timed at 1 MB
    EXPECT_TRUE(summaries[1].missed.empty());
    EXPECT_NE(summaryText(summaries).find("verdict: every target is met"), std::string::npos);
}

TEST(Summary, AnOpenMeshMayBeAboveTheVolumeAClosedOneMayNot) {
    const std::vector<std::uint64_t> budgets = {4'000'000};
    std::vector<AccuracyRow> rows = {row("good", true, 4'000'000, 0.01, 1.0),
                                     row("bad", false, 4'000'000, 1.5, 1.0)};
    EXPECT_TRUE(summarize(rows, budgets)[0].missed.empty());
    EXPECT_EQ(summarize(rows, budgets)[0].worst->mesh, "bad");
    rows[1].closed = true;
    const auto summaries = summarize(rows, budgets);
    ASSERT_EQ(summaries[0].closed_above.size(), 1U);
    EXPECT_EQ(summaries[0].closed_above[0].mesh, "bad");
    EXPECT_EQ(summaries[0].missed.size(), 1U);
    EXPECT_NE(summaryText(summaries).find("verdict: missed: 1 closed"), std::string::npos);
}

TEST(Summary, SaysWhichTargetsAreMissed) {
    const std::vector<AccuracyRow> rows = {row("a", true, 250'000, 0.21, 1.0),
                                           row("a", true, 1'000'000, 0.21, 3.1)};
    const auto summaries = summarize(rows, std::vector<std::uint64_t>{250'000, 1'000'000});
    EXPECT_EQ(summaries[0].missed.size(), 1U);
    EXPECT_EQ(summaries[1].missed.size(), 2U);
}

TEST(Summary, JudgesOnlyWhatWasMeasured) {
    std::vector<AccuracyRow> rows = {row("a", true, 1'000'000, 0.5, 1.0)};
    rows[0].our_ratio.reset();
    const auto summaries = summarize(rows, std::vector<std::uint64_t>{1'000'000});
    EXPECT_EQ(summaries[0].meshes, 0U);
    EXPECT_FALSE(summaries[0].our_mean);
    EXPECT_TRUE(summaries[0].paper_mean);
    EXPECT_NE(summaryText(summaries).find("verdict: ours was not measured"), std::string::npos);
}

}  // namespace
}  // namespace relief::test
