// The report of `relief diff` on two colliders, for people and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/compare.h"
#include "formats/fields/field.h"

namespace relief {

/// By how much the fields of two files may differ. Either limit makes the fields count instead of the maps.
struct DiffLimits {
    std::optional<double> max_sides;  ///< percent of the points near the surfaces that may be on another side
    std::optional<double> max_distance;  ///< object units, for 99 % of the points near the surfaces
    bool strict_metadata = false;        ///< provenance counts
};

struct MapDifferenceReport {
    std::size_t index = 0;
    const MapDifference& map = kNone<MapDifference>;
};

struct DiffSummary {
    std::string a;  ///< file names as in messages
    std::string b;
    std::string unit;  ///< of lengths; "" where none is known
    ColliderDifference difference;
    std::optional<FieldsDifference> fields;  ///< where the colliders differ
    DiffLimits limits;
    bool same_bytes = false;  ///< of the two files

    [[nodiscard]] std::vector<MapDifferenceReport> maps() const;
};

/// The first reason why the difference is beyond the limits: "map 2: texels differ"; empty where it is within.
[[nodiscard]] std::string diffVerdict(const DiffSummary& summary);

[[nodiscard]] std::string diffText(const DiffSummary& summary);

// --- The same as fields.

template <class Visitor, FieldsOf<Difference> D>
void fields(Visitor& visit, D& difference) {
    visit("what", difference.what, {"Name of the property"});
    visit("a", difference.a, {"Its value in A"});
    visit("b", difference.b, {"Its value in B"});
}

template <class Visitor, FieldsOf<PointsDifference> D>
void fields(Visitor& visit, D& points) {
    visit("points", points.points, {"Points compared"});
    visit("only_a", points.only_a, {"Points inside A alone"});
    visit("only_b", points.only_b, {"Points inside B alone"});
    visit("sides_percent", points.sidesPercent(),
          {"Share of all points on different sides", "%", kPercentRange});
    visit("distances", points.distances, {"Points with a distance to the nearest surface in both"});
    visit("one_known", points.one_known, {"Points with a distance in one alone"});
    const auto distance = [&](auto& visit_distance) {
        const DifferenceStatistics& all = points.distance;
        visit_distance("differing", all.differing, {"Points whose distances differ at all"});
        visit_distance("max", all.max, {"Maximum", "object units", kFromZero});
        visit_distance("mean", all.mean, {"Mean", "object units", kFromZero});
        visit_distance("percentile_99", all.percentile_99, {"99th percentile", "object units", kFromZero});
    };
    visit("distance", group(distance), {"Differences of the distances"});
}

template <class Visitor, FieldsOf<FieldsDifference> D>
void fields(Visitor& visit, D& difference) {
    visit("box", difference.box, {"Points all over the box of both"});
    visit("near", difference.near, {"Points near the surfaces of both"});
}

template <class Visitor, FieldsOf<DiffLimits> L>
void fields(Visitor& visit, L& limits) {
    visit("strict_metadata", limits.strict_metadata, {"Provenance must be the same, too"});
    visit("max_sides", limits.max_sides,
          {"Points near the surfaces that may be on different sides; null without --max-sides", "%",
           kFromZero});
    visit("max_distance", limits.max_distance,
          {"Difference allowed for 99 % of the distances near the surfaces; null without --max-distance",
           "object units", kFromZero});
}

template <class Visitor, FieldsOf<MapDifferenceReport> R>
void fields(Visitor& visit, R& report) {
    visit("index", report.index, {"Position in both"});
    visit("structure", report.map.structure, {"Differences of the map's description"});
    visit("same_texels", report.map.same_texels, {"All texels are the same, in every bit"});
}

template <class Visitor, FieldsOf<DiffSummary> S>
void fields(Visitor& visit, S& summary) {
    const ColliderDifference& difference = summary.difference;
    visit("a", summary.a, {"File A"});
    visit("b", summary.b, {"File B"});
    visit("identical", summary.same_bytes, {"The files have the same bytes"});
    visit("same_collider", !difference.any(), {"The maps and their descriptions are the same"});
    visit("within_limits", diffVerdict(summary).empty(),
          {"The difference is within the limits: exit code 0"});
    visit("limits", summary.limits, {"Differences allowed"});
    visit("structure", difference.structure, {"Differences of the colliders' descriptions"});
    visit("provenance", difference.provenance, {"Differences of the colliders' origins"});
    visit("maps", summary.maps(), {"Maps that both have"});
    visit("fields", summary.fields,
          {"Values of both at the same points; null if the colliders are the same"});
}

}  // namespace relief
