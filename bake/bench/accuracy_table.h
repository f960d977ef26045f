// What relief-accuracy measured, as tables for people and as JSON.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bake/bench/accuracy_summary.h"
#include "bake/measure/truth.h"

namespace relief {

/// One mesh, budget and method.
struct AccuracyEntry {
    std::string mesh;
    bool closed = false;
    std::uint64_t budget = 0;
    std::string method;  ///< "volume", "paper" or "ours"
    std::string what;    ///< lattice or maps
    std::size_t maps = 0;
    std::uint64_t bytes = 0;
    std::optional<double> build_seconds;  ///< of maps: acceleration structure, plan, rays and fit
    nlohmann::ordered_json accuracy;      ///< of jsonFieldAccuracy or jsonColliderAccuracy

    [[nodiscard]] double number(const char* group, const char* name) const {
        return accuracy.at(group).at(name).get<double>();
    }
    [[nodiscard]] double wrong() const { return number("near", "wrong_percent"); }
};

[[nodiscard]] nlohmann::ordered_json toJson(const AccuracyEntry& entry);
[[nodiscard]] nlohmann::ordered_json toJson(const BudgetSummary& summary);

/// One row for each mesh and budget.
/// \param entries  those of one mesh and budget are neighbours
/// \param samples  points that each percentage is of
[[nodiscard]] std::vector<AccuracyRow> summaryRows(const std::vector<AccuracyEntry>& entries,
                                                   std::uint32_t samples);

struct AccuracyTableOptions {
    AccuracyOptions accuracy;  ///< what was measured
    bool details = false;      ///< one line for each method
    bool markdown = false;     ///< for a README
};

/// The table, its legend and the verdict.
[[nodiscard]] std::string accuracyTable(const std::vector<AccuracyEntry>& entries,
                                        const std::vector<BudgetSummary>& summaries,
                                        const AccuracyTableOptions& options);

}  // namespace relief
