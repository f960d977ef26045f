#include "bake/bench/accuracy_table.h"

#include <cstdio>

#include "bake/report/report.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

std::string fixedText(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.*f", digits, value);
    return text;
}

Json orNull(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

using Rows = std::vector<std::vector<std::string>>;

/// GitHub's tables; a heading that ends in '>' goes right, as in table().
std::string markdown(const Rows& rows) {
    std::string text;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::string rule = "|";
        text += "|";
        for (const std::string& cell : rows[i]) {
            const bool right = i == 0 && cell.ends_with('>');
            text += " " + (right ? cell.substr(0, cell.size() - 1) : cell) + " |";
            rule += right ? " ---: |" : " --- |";
        }
        text += "\n" + (i == 0 ? rule + "\n" : "");
    }
    return text;
}

/// All of every entry, one a line.
Rows detailRows(const std::vector<AccuracyEntry>& entries) {
    Rows rows = {{"mesh", "budget>", "method", "wrong %>", "in>", "out>", "box %>", "dist mean %>", "p99 %>",
                  "normal>", "unseen %>", "bytes>", "s>", "what"}};
    for (const AccuracyEntry& entry : entries) {
        rows.push_back({entry.mesh, budgetText(entry.budget), entry.method, fixedText(entry.wrong(), 3),
                        fixedText(entry.number("near", "false_inside_percent"), 3),
                        fixedText(entry.number("near", "false_outside_percent"), 3),
                        fixedText(entry.number("uniform", "wrong_percent"), 3),
                        fixedText(entry.number("distance_error", "mean_percent"), 4),
                        fixedText(entry.number("distance_error", "p99_percent"), 4),
                        fixedText(entry.number("normal_error_degrees", "mean"), 2),
                        entry.accuracy.contains("unseen_area_percent")
                            ? fixedText(entry.accuracy["unseen_area_percent"], 2)
                            : "-",
                        std::to_string(entry.bytes),
                        entry.build_seconds ? fixedText(*entry.build_seconds, 2) : "-", entry.what});
    }
    return rows;
}

/// The entries of one mesh and budget side by side; null where a method was not measured.
struct Contest {
    const AccuracyEntry* volume = nullptr;
    const AccuracyEntry* paper = nullptr;
    const AccuracyEntry* ours = nullptr;

    [[nodiscard]] const AccuracyEntry& any() const { return ours ? *ours : paper ? *paper : *volume; }
    [[nodiscard]] std::optional<double> ratio(const AccuracyEntry* maps, std::uint32_t samples) const {
        return maps && volume ? std::optional(wrongRatio(maps->wrong(), volume->wrong(), samples))
                              : std::nullopt;
    }
};

std::vector<Contest> contestsOf(const std::vector<AccuracyEntry>& entries) {
    std::vector<Contest> contests;
    for (const AccuracyEntry& entry : entries) {  // neighbours: they were measured one after the other
        if (contests.empty() || contests.back().any().mesh != entry.mesh ||
            contests.back().any().budget != entry.budget) {
            contests.emplace_back();
        }
        Contest& contest = contests.back();
        (entry.method == "volume"  ? contest.volume
         : entry.method == "paper" ? contest.paper
                                   : contest.ours) = &entry;
    }
    return contests;
}

Rows contestRows(const std::vector<AccuracyEntry>& entries, std::uint32_t samples) {
    Rows rows = {{"mesh", "budget>", "volume %>", "paper %>", "ours %>", "ours/volume>", "in %>", "out %>",
                  "mean: volume>", "paper>", "ours>", "p99: volume>", "paper>", "ours>", "no distance %>",
                  "bytes>", "maps>", "ms>"}};
    for (const Contest& c : contestsOf(entries)) {
        const auto number = [](const AccuracyEntry* entry, const char* group, const char* name, int digits) {
            return entry ? fixedText(entry->number(group, name), digits) : std::string("-");
        };
        const auto wrong = [&](const AccuracyEntry* entry) {
            return number(entry, "near", "wrong_percent", 3);
        };
        const auto mean = [&](const AccuracyEntry* e) {
            return number(e, "distance_error", "mean_percent", 4);
        };
        const auto p99 = [&](const AccuracyEntry* e) {
            return number(e, "distance_error", "p99_percent", 3);
        };
        const std::optional<double> ratio = c.ratio(c.ours, samples);
        const double no_distance = c.ours ? c.ours->accuracy.at("far_percent").get<double>() +
                                                c.ours->accuracy.at("unknown_percent").get<double>()
                                          : 0.0;
        rows.push_back(
            {c.any().mesh + (c.any().closed ? "" : " (open)"), budgetText(c.any().budget), wrong(c.volume),
             wrong(c.paper), wrong(c.ours), ratio ? fixedText(*ratio, 3) : "-",
             number(c.ours, "near", "false_inside_percent", 3),
             number(c.ours, "near", "false_outside_percent", 3), mean(c.volume), mean(c.paper), mean(c.ours),
             p99(c.volume), p99(c.paper), p99(c.ours), c.ours ? fixedText(no_distance, 2) : "-",
             c.ours ? std::to_string(c.ours->bytes) : "-", c.ours ? std::to_string(c.ours->maps) : "-",
             c.ours && c.ours->build_seconds ? fixedText(1000.0 * *c.ours->build_seconds, 0) : "-"});
    }
    return rows;
}

/// \param gap  goes between the lines.
std::string legend(const AccuracyOptions& options, const std::string& gap) {
    const std::string lines[] = {
        "%: points near the surface on the wrong side of it; in, out: ours, false inside and false "
        "outside. " +
            std::to_string(options.samples) + " points, seed " + std::to_string(options.seed) + ", " +
            fixedText(100.0 * options.sigma_share, 1) +
            " % of the longest side off the surface (standard deviation).",
        "mean, p99: error of the signed distance at those points, in % of the longest side. Where maps say "
        "outside and no more (infinitely far, or no vote) they have no distance and no error: no distance is "
        "the share of such points in ours.",
        "ms: one bake of ours with acceleration structure, plan, rays and fit. open: computed, some edge has "
        "an "
        "odd number of triangles."};
    std::string text;
    for (const std::string& line : lines) {
        text += (text.empty() ? "" : gap) + line;
    }
    return text + "\n";
}

}  // namespace

Json toJson(const AccuracyEntry& entry) {
    return {{"mesh", entry.mesh},        {"closed", entry.closed},
            {"budget", entry.budget},    {"method", entry.method},
            {"what", entry.what},        {"maps", entry.maps},
            {"bytes", entry.bytes},      {"build_seconds", orNull(entry.build_seconds)},
            {"accuracy", entry.accuracy}};
}

Json toJson(const BudgetSummary& summary) {
    Json above = Json::array();
    for (const NamedValue& mesh : summary.closed_above) {
        above.push_back(mesh.mesh);
    }
    return {{"budget", summary.budget},
            {"meshes", summary.meshes},
            {"ours_over_volume", orNull(summary.our_mean)},
            {"paper_over_volume", orNull(summary.paper_mean)},
            {"target", kRatioMax},
            {"closed_above_volume", above},
            {"slowest_bake_seconds", summary.slowest ? Json(summary.slowest->value) : Json()},
            {"missed", summary.missed}};
}

std::vector<AccuracyRow> summaryRows(const std::vector<AccuracyEntry>& entries, std::uint32_t samples) {
    std::vector<AccuracyRow> rows;
    for (const Contest& c : contestsOf(entries)) {
        rows.push_back({c.any().mesh, c.any().closed, c.any().budget, c.ratio(c.paper, samples),
                        c.ratio(c.ours, samples), c.ours ? c.ours->build_seconds : std::nullopt});
    }
    return rows;
}

std::string accuracyTable(const std::vector<AccuracyEntry>& entries,
                          const std::vector<BudgetSummary>& summaries, const AccuracyTableOptions& options) {
    const Rows rows = options.details ? detailRows(entries) : contestRows(entries, options.accuracy.samples);
    return options.markdown
               ? markdown(rows) + "\n" + legend(options.accuracy, "<br>\n") + "\n```text\n" +
                     summaryText(summaries) + "```\n"
               : table(rows) + "\n" + legend(options.accuracy, "\n") + "\n" + summaryText(summaries);
}

}  // namespace relief
