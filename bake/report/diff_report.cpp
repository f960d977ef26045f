#include "bake/report/diff_report.h"

#include <algorithm>

#include "bake/report/collider_report.h"
#include "formats/base/text.h"
#include "formats/fields/json.h"

namespace relief {
namespace {

/// Names of the members that differ.
std::vector<std::string> differing(const Json& a, const Json& b) {
    std::vector<std::string> names;
    for (const auto& [name, value] : a.items()) {
        if (value != b.at(name)) {
            names.push_back(name);
        }
    }
    return names;
}

std::string join(const std::vector<std::string>& names) {
    return listed(std::vector<std::string_view>(names.begin(), names.end()));
}

Json headerOf(const Collider& collider) {
    return {{"maps", collider.maps.size()}, {"bounds", jsonOf(collider.bounds)}, {"unit", collider.unit}};
}

/// Its place and size in the file left out.
Json description(const DepthMap& map) {
    Json json = jsonOf(ColliderMapReport{0, map});
    json["decode"] = decodeName(map.decode);
    return json;
}

}  // namespace

void DiffReport::compare(const Collider& of_a, const Collider& of_b) {
    unit = of_a.unit;
    const Json header_a = headerOf(of_a);
    const Json header_b = headerOf(of_b);
    for (const std::string& what : differing(header_a, header_b)) {
        header.push_back({what, header_a[what].dump(), header_b[what].dump()});
    }
    provenance = differing(jsonOf(of_a.provenance), jsonOf(of_b.provenance));
    for (std::size_t i = 0; i < std::min(of_a.maps.size(), of_b.maps.size()); ++i) {
        maps.push_back(differing(description(of_a.maps[i]), description(of_b.maps[i])));
        if (of_a.maps[i].texels != of_b.maps[i].texels) {
            maps.back().emplace_back("texels");
        }
    }
    if (!same()) {
        points = comparePoints(of_a, of_b);
    }
}

bool DiffReport::same() const {
    return header.empty() && std::ranges::all_of(maps, [](const auto& names) { return names.empty(); });
}

std::string DiffReport::verdict() const {
    if (same()) {
        return {};
    }
    if (!max_sides && !max_distance) {
        if (!header.empty()) {
            return header.front().what;
        }
        const auto map = std::ranges::find_if(maps, [](const auto& names) { return !names.empty(); });
        return "map " + std::to_string(map - maps.begin()) + ": " + join(*map);
    }
    if (!header.empty() && header.back().what == "unit") {
        return "units differ, so that lengths cannot be compared";
    }
    if (!points || points->distances == 0) {
        return "no point has a distance to both";
    }
    if (max_sides && points->sidesPercent() > *max_sides) {
        return percentText(points->sidesPercent()) + " of the points near the surfaces are on another side";
    }
    if (max_distance && points->percentile_99 > *max_distance) {
        return "1 % of the distances near the surfaces differ by " + shortNumber(points->percentile_99) +
               " or more";
    }
    return {};
}

std::string DiffReport::text() const {
    const std::string made =
        provenance.empty() ? "" : "  provenance: " + join(provenance) + " (see relief info)\n";
    if (same_bytes) {
        return a + " and " + b + " are identical\n";
    }
    if (same()) {
        return a + " and " + b + " hold the same collider, stored differently\n" + made;
    }
    std::string lines = a + " (a) and " + b + " (b) differ\n";
    for (const Difference& one : header) {
        lines += "  " + one.what + ": " + one.a + " and " + one.b + "\n";
    }
    lines += made;
    for (std::size_t i = 0; i < maps.size(); ++i) {
        lines += "  map " + std::to_string(i) + ": " + (maps[i].empty() ? "same" : join(maps[i])) + "\n";
    }
    if (points) {
        lines += "  near the surfaces, " + std::to_string(points->points) +
                 " points: " + percentText(points->sidesPercent()) + " on another side (" +
                 std::to_string(points->only_a) + " inside of a alone, " + std::to_string(points->only_b) +
                 " of b alone); " +
                 (points->distances == 0
                      ? "no distances"
                      : "distances differ by " + shortNumber(points->mean) + " in the mean, 99 % by " +
                            shortNumber(points->percentile_99) + " " + unitText(unit) + " at most") +
                 "\n";
    }
    return lines + (verdict().empty() ? "within the limits\n" : "");
}

}  // namespace relief
