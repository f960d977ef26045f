#include "bake/report/diff_report.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "bake/report/report_text.h"

namespace relief {
namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g", value);
    return text;
}

std::string percent(double value) {
    return number(value) + " %";
}

/// formats/compare puts what comes from a file in quotes.
std::string unquoted(const std::string& text) {
    return text.size() >= 2 && text.front() == '\'' ? text.substr(1, text.size() - 2) : text;
}

std::string lines(const std::vector<Difference>& differences, const std::string& indent) {
    std::string text;
    for (const Difference& difference : differences) {
        text += indent + difference.what + ": " + difference.a + " and " + difference.b + "\n";
    }
    return text;
}

/// Those of `from` that are not in `other`, each as often as it is there once more.
std::string alone(const char* whose, const std::vector<std::string>& from, std::vector<std::string> other) {
    std::string text;
    for (const std::string& option : from) {
        if (const auto same = std::ranges::find(other, option); same != other.end()) {
            other.erase(same);
        } else {
            text += "    " + option + "\n";
        }
    }
    return text.empty() ? "" : std::string("  options of ") + whose + " alone:\n" + text;
}

/// Long lists of options by what differs, a line each.
std::string provenanceLines(const std::vector<Difference>& differences) {
    std::string text;
    for (const Difference& one : differences) {
        if (one.what != "options") {
            text += lines({one}, "  ");
            continue;
        }
        const std::vector<std::string> a = optionList(unquoted(one.a));
        const std::vector<std::string> b = optionList(unquoted(one.b));
        const std::string differing = alone("a", a, b) + alone("b", b, a);
        text += differing.empty() ? "  options: the same in another order\n" : differing;
    }
    return text;
}

std::string fieldsVerdict(const DiffSummary& summary) {
    for (const Difference& one : summary.difference.structure) {
        if (one.what == "unit") {
            return "unit differs";  // so that their lengths cannot be compared
        }
    }
    const PointsDifference near = summary.fields ? summary.fields->near : PointsDifference();
    const DiffLimits& limits = summary.limits;
    if (limits.max_sides && near.sidesPercent() > *limits.max_sides) {
        return percent(near.sidesPercent()) + " of the points near the surfaces are on another side";
    }
    if (limits.max_distance && near.distance.percentile_99 > *limits.max_distance) {
        return "1 % of the distances near the surfaces differ by " + number(near.distance.percentile_99) +
               " or more";
    }
    return {};
}

std::string mapsVerdict(const ColliderDifference& difference) {
    if (!difference.structure.empty()) {
        return difference.structure.front().what + " differ";
    }
    for (std::size_t i = 0; i < difference.maps.size(); ++i) {
        const MapDifference& map = difference.maps[i];
        if (!map.structure.empty() || !map.same_texels) {
            return "map " + std::to_string(i) + ": " +
                   (map.structure.empty() ? "texels differ" : map.structure.front().what + " differs");
        }
    }
    return {};
}

std::string pointsText(const std::string& where, const PointsDifference& points, const std::string& unit) {
    std::string text = "  " + where + ", " + std::to_string(points.points) +
                       " points: " + percent(points.sidesPercent()) + " on another side (" +
                       std::to_string(points.only_a) + " inside of a alone, " +
                       std::to_string(points.only_b) + " of b alone); ";
    text += points.distances == 0
                ? "no distances"
                : "distances differ by " + number(points.distance.mean) + " in the mean, 99 % by " +
                      number(points.distance.percentile_99) + " at most, all by " +
                      number(points.distance.max) + " " + unitText(unit);
    return text +
           (points.one_known == 0 ? ""
                                  : "; at " + std::to_string(points.one_known) + " only one has a distance") +
           "\n";
}

}  // namespace

std::string diffVerdict(const DiffSummary& summary) {
    const DiffLimits& limits = summary.limits;
    const std::vector<Difference>& provenance = summary.difference.provenance;
    std::string why =
        limits.max_sides || limits.max_distance ? fieldsVerdict(summary) : mapsVerdict(summary.difference);
    if (why.empty() && limits.strict_metadata && !provenance.empty()) {
        why = provenance.front().what + " differs, and --strict-metadata is set";
    }
    return why;
}

std::string diffText(const DiffSummary& summary) {
    const ColliderDifference& difference = summary.difference;
    if (summary.same_bytes) {
        return summary.a + " and " + summary.b + " are identical\n";
    }
    if (!difference.any()) {
        return summary.a + " and " + summary.b + " hold the same collider" +
               (difference.provenance.empty() ? ", stored differently\n" : "; they come from:\n") +
               provenanceLines(difference.provenance);
    }
    std::string text = summary.a + " (a) and " + summary.b + " (b) differ\n";
    text += lines(difference.structure, "  ");
    text += provenanceLines(difference.provenance);
    for (std::size_t i = 0; i < difference.maps.size(); ++i) {
        const MapDifference& map = difference.maps[i];
        const std::string name = "  map " + std::to_string(i) + ": ";
        text += lines(map.structure, name);
        text += name + (map.same_texels ? "texels are the same\n" : "texels differ\n");
    }
    if (summary.fields) {
        text += "at the same points:\n" + pointsText("in the box", summary.fields->box, summary.unit) +
                pointsText("near the surfaces", summary.fields->near, summary.unit);
    }
    return text + (diffVerdict(summary).empty() ? "within the limits\n" : "");
}

std::vector<MapDifferenceReport> DiffSummary::maps() const {
    std::vector<MapDifferenceReport> rows;
    for (std::size_t i = 0; i < difference.maps.size(); ++i) {
        rows.push_back({i, difference.maps[i]});
    }
    return rows;
}

}  // namespace relief
