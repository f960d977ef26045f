// SPDX-License-Identifier: Apache-2.0
// The smallest budget for an error target: it meets the target, wastes little, respects its bounds, and fails if the
// target is unreachable.
#include "bake/maps/budget_search.h"

#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

BudgetSearchOptions optionsFor(double percent) {
    BudgetSearchOptions options;
    options.max_error_percent = percent;
    options.bake.quality = Quality::kFast;
    options.accuracy.samples = 10'000;
    return options;
}

TEST(BudgetSearch, KeepsTheTargetWithFewExtraBytes) {
    constexpr double kPercent = 0.1;  // the smallest budget misses this target
    const MeshQuery query = queryOf(makeTorusMesh(1.0, 0.4, 64, 32));
    BudgetSearchOptions options = optionsFor(kPercent);
    std::size_t told = 0;
    options.tried = [&](const BudgetTry&) { ++told; };
    const BudgetSearchResult found = required(bakeForError(query, query, options));
    EXPECT_LE(found.chosen.wrong_percent, kPercent);
    EXPECT_EQ(found.chosen.bytes, found.baked.collider.texelBytes());
    EXPECT_LE(found.chosen.bytes, found.chosen.budget);
    EXPECT_EQ(told, found.tries.size());
    // Measuring the result gives the reported error.
    const TruthSamples truth = sampleTruth(query, options.accuracy);
    EXPECT_EQ(measureField(truth, fieldOf(found.baked.collider)).near.total(), found.chosen.wrong_percent);
    // The search tried a budget at most a tenth smaller, which misses the target.
    bool narrow = false;
    for (const BudgetTry& made : found.tries) {
        EXPECT_GE(made.budget, 32'000U);
        const double of_chosen = static_cast<double>(made.budget) / static_cast<double>(found.chosen.budget);
        narrow = narrow || (made.wrong_percent > kPercent && of_chosen < 1.0 && of_chosen > 1.0 / 1.1);
    }
    EXPECT_TRUE(narrow);
}

// Two boxes so far apart that the finest cell of the smallest budget contains neither.
TEST(BudgetSearch, TriesMoreBytesIfTheSmallestBudgetIsEmpty) {
    const TriangleMesh mesh =
        joined({makeBoxMesh({5, 5, 5}, glm::dvec3(5.0)), makeBoxMesh({1e7, 0.5, 0.5}, glm::dvec3(0.5))});
    const MeshQuery query = queryOf(mesh);
    BudgetSearchOptions options = optionsFor(50.0);
    EXPECT_GT(required(bakeForError(query, query, options)).chosen.budget, options.budget_min);
    options.budget_max = options.budget_min;
    EXPECT_EQ(bakeForError(query, query, options).error().code, ErrorCode::kFailure);
}

TEST(BudgetSearch, EasyTargetNeedsTheSmallestBudget) {
    const MeshQuery query = queryOf(makeTorusMesh(1.0, 0.4, 64, 32));
    const BudgetSearchResult found = required(bakeForError(query, query, optionsFor(50.0)));
    EXPECT_EQ(found.chosen.budget, 32'000U);
    EXPECT_EQ(found.tries.size(), 1U);
    // A slightly stricter target needs a larger budget.
    const double promise = 0.75 * found.chosen.wrong_percent;
    const BudgetSearchResult better = required(bakeForError(query, query, optionsFor(promise)));
    EXPECT_LE(better.chosen.wrong_percent, promise);
    EXPECT_GT(better.chosen.budget, 32'000U);
}

TEST(BudgetSearch, ReportsTheBestIfTheTargetIsUnreachable) {
    const MeshQuery query = queryOf(makeTorusMesh(1.0, 0.4, 64, 32));
    BudgetSearchOptions options = optionsFor(0.0);
    options.budget_max = 50'000;
    std::vector<BudgetTry> tries;
    options.tried = [&](const BudgetTry& made) { tries.push_back(made); };
    const Result<BudgetSearchResult> found = bakeForError(query, query, options);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, ErrorCode::kDifference);
    ASSERT_EQ(tries.size(), 2U);
    EXPECT_EQ(tries[1].budget, 50'000U) << "the limit itself must be tried";
    // The best budget is not always the largest: rounding can favour fewer texels.
    const BudgetTry& best = tries[0].wrong_percent <= tries[1].wrong_percent ? tries[0] : tries[1];
    EXPECT_NE(found.error().message.find(std::to_string(best.bytes) + " bytes"), std::string::npos)
        << found.error().message;
    // A limit below the usual start is the only budget.
    options.budget_max = 20'000;
    tries.clear();
    EXPECT_FALSE(bakeForError(query, query, options));
    ASSERT_EQ(tries.size(), 1U);
    EXPECT_EQ(tries[0].budget, 20'000U);
    options.budget_max = 10;
    EXPECT_EQ(bakeForError(query, query, options).error().code, ErrorCode::kUsage)
        << "too small for any tree";
}

}  // namespace
}  // namespace relief::test
