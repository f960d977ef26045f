// The report of `relief diff` on two colliders, for people and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/compare.h"
#include "formats/fields/field.h"

namespace relief {

/// A property that two colliders have different values of.
struct Difference {
    std::string what;
    std::string a;  ///< its value as JSON
    std::string b;
};

struct DiffReport {
    std::string a;  ///< file names as in messages
    std::string b;
    std::string unit;                     ///< of lengths; "" where none is known
    bool same_bytes = false;              ///< of the two files
    std::optional<double> max_sides;      ///< percent of the points that may be on another side
    std::optional<double> max_distance;   ///< object units, for 99 % of the distances
    std::vector<Difference> header;       ///< number of maps, bounds, unit
    std::vector<std::string> provenance;  ///< fields that differ
    std::vector<std::vector<std::string>>
        maps;                                ///< the same of map i of both; "texels" if any bit of them does
    std::optional<PointsDifference> points;  ///< where the colliders differ

    /// Compares two valid colliders.
    void compare(const Collider& of_a, const Collider& of_b);

    /// Whether nothing but the provenance differs.
    [[nodiscard]] bool same() const;
    /// Why the difference is beyond the limits, or, without limits, that there is one; else empty.
    [[nodiscard]] std::string verdict() const;
    [[nodiscard]] std::string text() const;
};

template <class Visitor, FieldsOf<Difference> D>
void fields(Visitor& visit, D& difference) {
    visit("what", difference.what, {"Name of the property"});
    visit("a", difference.a, {"Its value in A, as JSON"});
    visit("b", difference.b, {"Its value in B, as JSON"});
}

template <class Visitor, FieldsOf<PointsDifference> D>
void fields(Visitor& visit, D& points) {
    visit("points", points.points, {"Points compared"});
    visit("only_a", points.only_a, {"Points inside A alone"});
    visit("only_b", points.only_b, {"Points inside B alone"});
    visit("sides_percent", points.sidesPercent(),
          {"Share of all points on different sides", "%", kPercentRange});
    visit("distances", points.distances, {"Points with a distance to the nearest surface in both"});
    visit("mean", points.mean, {"Mean difference of the distances", "object units", kFromZero});
    visit("percentile_99", points.percentile_99,
          {"99th percentile of the differences of the distances", "object units", kFromZero});
}

template <class Visitor, FieldsOf<DiffReport> R>
void fields(Visitor& visit, R& report) {
    visit("a", report.a, {"File A"});
    visit("b", report.b, {"File B"});
    visit("identical", report.same_bytes, {"The files have the same bytes"});
    visit("same_collider", report.same(), {"The maps and their descriptions are the same"});
    visit("within_limits", report.verdict().empty(), {"The difference is within the limits: exit code 0"});
    visit("max_sides", report.max_sides,
          {"Points that may be on different sides; null without --max-sides", "%", kFromZero});
    visit("max_distance", report.max_distance,
          {"Difference allowed for 99 % of the distances; null without --max-distance", "object units",
           kFromZero});
    visit("header", report.header, {"Differences of the colliders' descriptions"});
    visit("provenance", report.provenance, {"Fields that differ in the colliders' origins"});
    visit("maps", report.maps, {"Of each map that both have, the fields that differ, and texels"});
    visit("points", report.points,
          {"Values of both at the same points near the surfaces; null if the colliders are the same"});
}

}  // namespace relief
