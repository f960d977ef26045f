// The report of relief check of ground against its height map.
#pragma once

#include <optional>
#include <string>

#include "bake/ground/ground_check.h"
#include "bake/report/bake_report.h"
#include "bake/report/collider_report.h"
#include "bake/report/report_text.h"
#include "formats/fields/field.h"

namespace relief {

/// \param name  of the collider or the world, for people
[[nodiscard]] std::string groundCheckText(const GroundAccuracy& accuracy, const std::string& name);

template <class Visitor, FieldsOf<GroundNear> N>
void fields(Visitor& visit, N& near) {
    visit("points", near.points, {"Points, as many in each square with ground"});
    fields(visit, near.wrong);
    const auto distances = [&](auto& inner) {
        inner("mean", near.mean, {"Mean of them; upwards is positive", "m"});
        inner("mean_abs", near.mean_abs, {"Mean of their absolute values", "m", kFromZero});
        inner("p99", near.p99, {"99 % of their absolute values are smaller", "m", kFromZero});
        inner("max", near.most, {"The largest absolute value", "m", kFromZero});
    };
    visit("error", group(distances), {"Distances along y from the height map's surface to the collider's"});
    visit("missing", near.missing, {"Points where the collider has no surface so near; not in error"});
}

template <class Visitor, FieldsOf<GroundWorstPlace> P>
void fields(Visitor& visit, P& place) {
    visit("place", place.place, {"On the surface of the height map", "[x, y, z]"});
    visit("node", place.node, {"The tile there; empty of a single collider"});
    visit("error", place.error, {"Distance along y to the collider's surface; null: none is so near", "m"});
    visit("rise", place.rise, {"Rise of the square there, in its sides", {}, kFromZero});
}

/// `relief check --heights --json`
struct GroundCheckJson {
    const GroundAccuracy& accuracy = kNone<GroundAccuracy>;
    std::string file{};
    std::string heights{};  ///< the settings
    std::optional<float> max_error{};
};

template <class Visitor, FieldsOf<GroundCheckJson> R>
void fields(Visitor& visit, R& report) {
    const GroundAccuracy& a = report.accuracy;
    visit("tool", std::string("relief ") + RELIEF_VERSION, {"Name and version of the program"});
    visit("file", report.file, {"File of the collider or the world"});
    visit("map", a.map, {"File of the height map"});
    visit("hash", a.hash, {.help = "XXH3-128 of the height map's file", .pattern = kHashPattern});
    visit("heights", report.heights, {"Effective settings, as --heights takes them"});
    visit("unit", std::string("m"), {.help = "Unit of lengths", .words = kWords<"m">});
    visit("columns", a.columns, {"Samples in a row, along +x", {}, {2.0}});
    visit("rows", a.rows, {"Rows of samples, along +z", {}, {2.0}});
    visit("squares", a.squares, {"Squares with ground", {}, kFromOne});
    visit("steep_squares", a.steep, {"Those of them that are steeper than 71 degrees"});
    visit("holes", a.holes, {"Squares without ground"});
    visit("within", a.within,
          {"Largest distance of points near the surface from it, along y", "m", kFromZero});
    visit("near", a.near, {"Points near the surface"});
    visit("seams", a.seams,
          {"Those within a leaf, four squares, of a seam between tiles; null where there is none"});
    const auto anywhere = [&](auto& inner) {
        inner("points", a.anywhere_points, {"Points"});
        fields(inner, a.anywhere);
    };
    visit("anywhere", group(anywhere),
          {"Points of the map's whole box and a square around it: from what ground must be solid down to, "
           "holes and edges included"});
    visit("worst", a.worst, {"At most ten places, the worst first"});
    visit("max_error_percent", report.max_error, {"--max-error; null without it", "%", kPercentRange});
    visit("warnings", a.warnings, {"Warnings, one line each"});
    visit("seconds", a.seconds, {"Time of the measurement", "s", kFromZero});
}

}  // namespace relief
