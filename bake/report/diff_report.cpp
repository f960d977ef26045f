#include "bake/report/diff_report.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "bake/report/report.h"
#include "runtime/tool/json_text.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g", value);
    return text;
}

std::string percent(double value) {
    return number(value) + " %";
}

/// Why one end of a map is beyond the limits, or "".
std::string endVerdict(const EndDifference& end, const DiffLimits& limits) {
    if (end.coveragePercent() > limits.max_coverage) {
        return percent(end.coveragePercent()) + " of the texels have a surface in one file alone";
    }
    if (end.beyondPercent() > limits.max_texels) {
        return percent(end.beyondPercent()) + " of the surfaces differ by more than " +
               number(limits.surface.max_depth) + " steps of depth or " + number(limits.surface.max_normal) +
               " degrees";
    }
    return {};
}

bool sameCollider(const DiffSummary& summary) {
    return !summary.difference.structureDiffers() && !summary.difference.texelsDiffer();
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

std::vector<std::string> row(const std::string& map, const std::string& name, const std::string& unit,
                             const EndDifference& end) {
    return {map,
            name,
            std::to_string(end.both),
            std::to_string(end.only_a),
            std::to_string(end.only_b),
            std::to_string(end.depth.differing),
            number(end.depth.max),
            number(end.depth.mean),
            number(end.depth.percentile_99),
            unit,
            std::to_string(end.normal.differing),
            number(end.normal.max),
            number(end.normal.mean),
            number(end.normal.percentile_99),
            std::to_string(end.beyond)};
}

Json jsonDifferences(const std::vector<Difference>& differences) {
    Json list = Json::array();
    for (const Difference& one : differences) {
        list.push_back({{"what", one.what}, {"a", one.a}, {"b", one.b}});
    }
    return list;
}

Json jsonStatistics(const DifferenceStatistics& statistics) {
    return {{"differing", statistics.differing},
            {"max", statistics.max},
            {"mean", statistics.mean},
            {"percentile_99", statistics.percentile_99}};
}

Json jsonEnd(const EndDifference& end) {
    return {{"ends", end.ends},
            {"both", end.both},
            {"only_a", end.only_a},
            {"only_b", end.only_b},
            {"coverage_percent", end.coveragePercent()},
            {"beyond", end.beyond},
            {"beyond_percent", end.beyondPercent()},
            {"depth", jsonStatistics(end.depth)},
            {"normal_degrees", jsonStatistics(end.normal)}};
}

/// Why the fields are beyond the limits, or "".
std::string fieldsVerdict(const ColliderDifference& difference, const FieldsDifference& fields,
                          const DiffLimits& limits) {
    for (const Difference& one : difference.structure) {
        if (one.what == "unit") {
            return "unit differs";  // so that their lengths cannot be compared
        }
    }
    const PointsDifference& near = fields.near;
    if (limits.max_sides && near.sidesPercent() > *limits.max_sides) {
        return percent(near.sidesPercent()) + " of the points near the surfaces are on another side";
    }
    if (limits.max_distance && near.distance.percentile_99 > *limits.max_distance) {
        return "1 % of the distances near the surfaces differ by " + number(near.distance.percentile_99) +
               " or more";
    }
    return {};
}

std::string pointsText(const std::string& where, const PointsDifference& points, const std::string& unit) {
    const std::string of_length = unit.empty() ? " object units" : " " + unit;
    std::string text = "  " + where + ", " + std::to_string(points.points) +
                       " points: " + percent(points.sidesPercent()) + " on another side (" +
                       std::to_string(points.only_a) + " inside of a alone, " +
                       std::to_string(points.only_b) + " of b alone); ";
    text += points.distances == 0 ? "no distances"
                                  : "distances differ by " + number(points.distance.mean) +
                                        " in the mean, 99 % by " + number(points.distance.percentile_99) +
                                        " at most, all by " + number(points.distance.max) + of_length;
    return text +
           (points.one_known == 0 ? ""
                                  : "; at " + std::to_string(points.one_known) + " only one has a distance") +
           "\n";
}

std::string fieldsText(const DiffSummary& summary) {
    if (!summary.fields) {
        return {};
    }
    const std::string& unit = summary.collider_a.unit;
    return "what they say of the same points:\n" + pointsText("in the box", summary.fields->box, unit) +
           pointsText("near the surfaces", summary.fields->near, unit);
}

Json jsonPoints(const PointsDifference& points) {
    return {{"points", points.points},
            {"only_a", points.only_a},
            {"only_b", points.only_b},
            {"sides_percent", points.sidesPercent()},
            {"distances", points.distances},
            {"one_known", points.one_known},
            {"distance", jsonStatistics(points.distance)}};
}

Json jsonFields(const std::optional<FieldsDifference>& fields) {
    return fields ? Json{{"box", jsonPoints(fields->box)}, {"near", jsonPoints(fields->near)}}
                  : Json(nullptr);
}

/// Why the maps are beyond the limits, or "".
std::string mapsVerdict(const ColliderDifference& difference, const DiffLimits& limits) {
    if (!difference.structure.empty()) {
        return difference.structure.front().what + " differ";
    }
    for (const MapDifference& map : difference.maps) {
        const std::string name = "map " + std::to_string(map.index) + ": ";
        if (!map.structure.empty()) {
            return name + map.structure.front().what + " differs";
        }
        for (const EndDifference* end : {&map.front, &map.back}) {
            if (const std::string why = endVerdict(*end, limits); !why.empty()) {
                return name + why;
            }
        }
    }
    return {};
}

}  // namespace

std::string diffVerdict(const ColliderDifference& difference, const std::optional<FieldsDifference>& fields,
                        const DiffLimits& limits) {
    const std::string why = limits.ofFields() && fields ? fieldsVerdict(difference, *fields, limits)
                                                        : mapsVerdict(difference, limits);
    if (!why.empty()) {
        return why;
    }
    if (limits.strict_metadata && !difference.provenance.empty()) {
        return difference.provenance.front().what + " differs, and --strict-metadata is set";
    }
    return {};
}

std::string diffText(const DiffSummary& summary) {
    const ColliderDifference& difference = summary.difference;
    if (summary.same_bytes) {
        return summary.a + " and " + summary.b + " are identical\n";
    }
    if (sameCollider(summary)) {
        return summary.a + " and " + summary.b + " hold the same collider" +
               (difference.provenance.empty() ? ", stored differently\n" : "; they come from:\n") +
               provenanceLines(difference.provenance);
    }
    std::string text = summary.a + " (a) and " + summary.b + " (b) differ\n";
    text += lines(difference.structure, "  ");
    text += provenanceLines(difference.provenance);
    std::vector<std::vector<std::string>> rows = {{"map", "end", "both>", "only a>", "only b>", "depth>",
                                                   "max>", "mean>", "p99>", "unit", "normal>", "max°>",
                                                   "mean°>", "p99°>", "beyond>"}};
    for (const MapDifference& map : difference.maps) {
        const std::string index = std::to_string(map.index);
        text += lines(map.structure, "  map " + index + ": ");
        if (!map.compared) {
            text += "  map " + index + ": texels of another format or size cannot be compared\n";
        } else if (map.texels_differing > 0) {
            const DepthMap& from = summary.collider_a.maps[map.index];
            const char* unit = depthUnit(from.format);
            const bool two = isFrontBack(from.format);
            rows.push_back(row(index, two ? "front" : "", unit, map.front));
            if (two) {
                rows.push_back(row(index, "back", unit, map.back));
            }
        } else {
            text += "  map " + index + ": texels are the same\n";
        }
    }
    if (rows.size() > 1) {
        rows.push_back(row("all", "", "", difference.total));
        text += table(rows);
    }
    text += fieldsText(summary);
    if (diffVerdict(difference, summary.fields, summary.limits).empty()) {
        text += "within the limits\n";
    }
    return text;
}

std::string diffJson(const DiffSummary& summary) {
    const ColliderDifference& difference = summary.difference;
    const DiffLimits& limits = summary.limits;
    const auto given = [](const std::optional<double>& limit) {
        return limit ? Json(*limit) : Json(nullptr);
    };
    Json maps = Json::array();
    for (const MapDifference& map : difference.maps) {
        const MapFormat format = summary.collider_a.maps[map.index].format;
        const auto compared = [&](Json value) { return map.compared ? std::move(value) : Json(nullptr); };
        maps.push_back({{"index", map.index},
                        {"structure", jsonDifferences(map.structure)},
                        {"compared", map.compared},
                        {"depth_unit", compared(depthUnit(format))},
                        {"texels", compared(map.texels)},
                        {"texels_differing", compared(map.texels_differing)},
                        {"front", compared(jsonEnd(map.front))},
                        {"back", isFrontBack(format) ? compared(jsonEnd(map.back)) : Json(nullptr)}});
    }
    return jsonText({{"a", summary.a},
                     {"b", summary.b},
                     {"identical", summary.same_bytes},
                     {"same_collider", sameCollider(summary)},
                     {"within_limits", diffVerdict(difference, summary.fields, limits).empty()},
                     {"limits",
                      {{"max_coverage", limits.max_coverage},
                       {"max_depth", limits.surface.max_depth},
                       {"max_normal", limits.surface.max_normal},
                       {"max_texels", limits.max_texels},
                       {"strict_metadata", limits.strict_metadata},
                       {"max_sides", given(limits.max_sides)},
                       {"max_distance", given(limits.max_distance)}}},
                     {"structure", jsonDifferences(difference.structure)},
                     {"provenance", jsonDifferences(difference.provenance)},
                     {"maps", maps},
                     {"total", jsonEnd(difference.total)},
                     {"fields", jsonFields(summary.fields)}});
}

}  // namespace relief
