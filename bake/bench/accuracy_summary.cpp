#include "bake/bench/accuracy_summary.h"

#include <algorithm>
#include <cstdio>

#include "formats/base/byte_count.h"
#include "formats/base/portable_math.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// %.3g keeps 0.042 and 12.3 legible in one column.
std::string ratioText(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g", value);
    return text;
}

std::string ratioText(const std::optional<double>& value) {
    return value ? ratioText(*value) : "not measured";
}

std::string secondsText(double seconds) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.2f s", seconds);
    return text;
}

void raise(std::optional<NamedValue>& largest, const std::string& mesh, double value) {
    if (!largest || value > largest->value) {
        largest = NamedValue{mesh, value};
    }
}

std::string namesText(const std::vector<NamedValue>& values) {
    std::string text;
    for (const NamedValue& value : values) {
        text += (text.empty() ? "" : ", ") + value.mesh + " (" + ratioText(value.value) + ")";
    }
    return text.empty() ? "none" : text;
}

std::vector<std::string> missedTargets(const BudgetSummary& summary) {
    std::vector<std::string> missed;
    const std::string at = " at " + budgetText(summary.budget);
    if (summary.our_mean && *summary.our_mean > kRatioMax) {
        missed.push_back("ours/volume " + ratioText(*summary.our_mean) + at);
    }
    if (!summary.closed_above.empty()) {
        missed.push_back(std::to_string(summary.closed_above.size()) + " closed above the volume" + at);
    }
    if (summary.slowest && summary.budget == kTimedBudget && summary.slowest->value > kBakeSecondsMax) {
        missed.push_back("a bake of " + secondsText(summary.slowest->value) + at);
    }
    return missed;
}

}  // namespace

Result<std::vector<std::uint64_t>> parseBudgets(std::span<const std::string> texts) {
    std::vector<std::uint64_t> budgets;
    for (const std::string& text : texts) {
        const std::optional<std::uint64_t> bytes = parseByteCount(text);
        if (!bytes) {
            return fail(ErrorCode::kUsage, "--budgets has '" + cleanUtf8(text) + "'; write 0.25MB,1MB,4MB");
        }
        if (std::find(budgets.begin(), budgets.end(), *bytes) != budgets.end()) {
            return fail(ErrorCode::kUsage,
                        "--budgets has " + std::to_string(*bytes) + " bytes twice; name each budget once");
        }
        budgets.push_back(*bytes);
    }
    if (budgets.empty()) {
        return fail(ErrorCode::kUsage, "--budgets names none; write 0.25MB,1MB,4MB");
    }
    return budgets;
}

std::optional<double> geometricMean(std::span<const double> values) {
    if (values.empty()) {
        return std::nullopt;
    }
    double sum = 0.0;
    for (const double value : values) {
        sum += portable::log(value);
    }
    return portable::exp(sum / static_cast<double>(values.size()));
}

double wrongRatio(double percent, double volume_percent, std::uint32_t samples) {
    const double least = 0.5 * 100.0 / samples;
    return std::max(percent, least) / std::max(volume_percent, least);
}

std::vector<BudgetSummary> summarize(std::span<const AccuracyRow> rows,
                                     std::span<const std::uint64_t> budgets) {
    std::vector<BudgetSummary> summaries;
    for (const std::uint64_t budget : budgets) {
        BudgetSummary summary;
        summary.budget = budget;
        std::vector<double> ours;
        std::vector<double> papers;
        for (const AccuracyRow& row : rows) {
            if (row.budget != budget) {
                continue;
            }
            if (row.paper_ratio) {
                papers.push_back(*row.paper_ratio);
            }
            if (row.our_ratio) {
                ours.push_back(*row.our_ratio);
                raise(summary.worst, row.mesh, *row.our_ratio);
                if (row.closed && *row.our_ratio > 1.0) {
                    summary.closed_above.push_back({row.mesh, *row.our_ratio});
                }
            }
            if (row.bake_seconds) {
                raise(summary.slowest, row.mesh, *row.bake_seconds);
            }
        }
        summary.meshes = ours.size();
        summary.our_mean = geometricMean(ours);
        summary.paper_mean = geometricMean(papers);
        summary.missed = missedTargets(summary);
        summaries.push_back(std::move(summary));
    }
    return summaries;
}

std::string budgetText(std::uint64_t budget) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.4g MB", static_cast<double>(budget) * 1e-6);
    return text;
}

std::string summaryText(std::span<const BudgetSummary> summaries) {
    std::string text;
    std::string missed;
    bool judged = false;
    for (const BudgetSummary& summary : summaries) {
        text += budgetText(summary.budget) + ", " + std::to_string(summary.meshes) +
                (summary.meshes == 1 ? " mesh" : " meshes") + ": ours/volume " + ratioText(summary.our_mean) +
                " (target at most " + ratioText(kRatioMax) + "), paper/volume " +
                ratioText(summary.paper_mean);
        if (summary.worst) {
            text += "; worst " + summary.worst->mesh + " (" + ratioText(summary.worst->value) +
                    "); closed with ours above the volume: " + namesText(summary.closed_above);
        }
        if (summary.slowest) {
            text +=
                "; slowest bake " + summary.slowest->mesh + " (" + secondsText(summary.slowest->value) +
                (summary.budget == kTimedBudget ? ", target at most " + secondsText(kBakeSecondsMax) : "") +
                ")";
        }
        text += "\n";
        judged = judged || summary.our_mean;
        for (const std::string& target : summary.missed) {
            missed += (missed.empty() ? "" : "; ") + target;
        }
    }
    return text + "verdict: " +
           (!missed.empty() ? "missed: " + missed
            : judged        ? "every target is met"
                            : "ours was not measured against the volume") +
           "\n";
}

}  // namespace relief
