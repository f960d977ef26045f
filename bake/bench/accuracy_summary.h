// What relief-accuracy concludes from its measurements: ratios, means over meshes, and the verdict on the
// claims of bake/measure/README.md. Arithmetic alone.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// The budgets of a command line, each as parseByteCount reads it.
/// Errors: kUsage (none, a text that is no number of bytes, the same budget twice).
[[nodiscard]] Result<std::vector<std::uint64_t>> parseBudgets(std::span<const std::string> texts);

/// exp of the mean logarithm. nullopt without values.
/// \param values  all above 0.
[[nodiscard]] std::optional<double> geometricMean(std::span<const double> values);

/// Wrong points over wrong points. Half a point stands for none, so that ratios and their logarithms exist;
/// nothing over nothing is 1.
/// \param samples  the number of points that both percentages are of, not 0.
[[nodiscard]] double wrongRatio(double percent, double volume_percent, std::uint32_t samples);

/// The wrong points that we allow ourselves for those of a volume of as many bytes.
inline constexpr double kRatioMax = 0.2;

/// Bakes at this budget are to stay within kBakeSecondsMax.
inline constexpr std::uint64_t kTimedBudget = 1'000'000;
inline constexpr double kBakeSecondsMax = 3.0;

/// What one mesh and one budget came to.
struct AccuracyRow {
    std::string mesh;
    bool closed = false;
    std::uint64_t budget = 0;
    std::optional<double> paper_ratio;  ///< wrongRatio of the paper's maps; nullopt: not measured
    std::optional<double> our_ratio;
    std::optional<double> bake_seconds;  ///< ours
};

/// A mesh and how it did.
struct NamedValue {
    std::string mesh;
    double value = 0.0;
};

struct BudgetSummary {
    std::uint64_t budget = 0;
    std::size_t meshes = 0;                ///< with ours measured against the volume
    std::optional<double> our_mean;        ///< geometric, over those
    std::optional<double> paper_mean;      ///< geometric
    std::vector<NamedValue> closed_above;  ///< closed, and ours has more wrong points than the volume
    std::optional<NamedValue> worst;       ///< largest of our ratios
    std::optional<NamedValue> slowest;     ///< seconds of our bakes
    std::vector<std::string> missed;       ///< targets, in words; empty: all met
};

/// One for each budget, in their order. Only what was measured is judged.
[[nodiscard]] std::vector<BudgetSummary> summarize(std::span<const AccuracyRow> rows,
                                                   std::span<const std::uint64_t> budgets);

/// "0.25 MB"
[[nodiscard]] std::string budgetText(std::uint64_t budget);

/// A line for each budget, and one with the verdict on all.
[[nodiscard]] std::string summaryText(std::span<const BudgetSummary> summaries);

}  // namespace relief
