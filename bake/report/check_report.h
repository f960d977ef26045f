// A collider measured against its mesh, as `relief check` reports it: numbers, a verdict, the places where it is wrong most
// and what to do about them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/measure/worst_places.h"
#include "formats/collider.h"

namespace relief {

/// Verdicts, by the percentage of points near the surface that are on the wrong side.
inline constexpr double kGoodPercent = 1.0;
inline constexpr double kFairPercent = 5.0;

/// "good", "fair" or "poor"
[[nodiscard]] std::string gradeOf(double wrong_percent);
/// "0.4 % wrong near the surface: good"
[[nodiscard]] std::string verdictText(double wrong_percent);

/// A few lines: what was measured, and the results.
/// \param unit  of lengths: "m", or "" for object units
[[nodiscard]] std::string accuracyText(const ColliderAccuracy& accuracy, const TruthSamples& samples,
                                       const std::string& unit);

/// "map 2 (front-back along 0/0/-1)", "no map" for −1.
[[nodiscard]] std::string mapWords(const Collider& collider, int map);
/// "0.41 m across: 4.5 % of the wrong points, 86 % of them called inside"
[[nodiscard]] std::string placeText(const WorstPlace& place, const std::string& unit);
/// "below the texel size: map 2 (…) decides, whose texels are 0.02 wide"
[[nodiscard]] std::string causeText(const WorstPlace& place, const Collider& collider);
/// A few lines for each place; "" without places.
[[nodiscard]] std::string placesText(std::span<const WorstPlace> places, const Collider& collider);

/// Something to try.
struct Advice {
    std::string command;  ///< one line for a shell
    std::string about;    ///< "twice the bytes"
    /// Points near the surface left on the wrong side by a trial in memory; nullopt: not tried.
    std::optional<double> wrong_percent;
    std::string untried;  ///< the reason; empty if tried
    bool helps = false;   ///< tried, and at most nine tenths are left
};

/// The commands, the best first, then what did not help; "" without advice.
[[nodiscard]] std::string adviceText(std::span<const Advice> advice, double wrong_percent);

// --- The same as fields.

/// \param longest_side  of the mesh: lengths are also given in percent of it.
struct FieldAccuracyReport {
    const FieldAccuracy& field = kNone<FieldAccuracy>;
    double longest_side = 1.0;
};

template <class Visitor, FieldsOf<FieldAccuracyReport> R>
void fields(Visitor& visit, R& report) {
    const FieldAccuracy& field = report.field;
    visit("near", field.near, {"Sides of the points near the surface"});
    visit("uniform", field.uniform, {"Sides of the points anywhere in the box"});
    const auto distance = [&](auto& visit_error) {
        const double to_percent = 100.0 / report.longest_side;
        visit_error("mean", finite(field.distance_mean), {"Mean", "object units", kFromZero});
        visit_error("p99", finite(field.distance_p99), {"99th percentile", "object units", kFromZero});
        visit_error("mean_percent", finite(field.distance_mean * to_percent),
                    {"Mean", "% of the longest side", kFromZero});
        visit_error("p99_percent", finite(field.distance_p99 * to_percent),
                    {"99th percentile", "% of the longest side", kFromZero});
    };
    visit("distance_error", group(distance), {"Error of the signed distance near the surface"});
    visit("far_percent", field.far_percent,
          {"Points near the surface that are outside without a known distance", "%", kPercentRange});
    visit("unknown_percent", field.unknown_percent,
          {"Points near the surface for which no map votes", "%", kPercentRange});
    const auto normal = [&](auto& visit_error) {
        visit_error("mean", finite(field.normal_mean), {"Mean", "degrees", kFromZero});
        visit_error("p99", finite(field.normal_p99), {"99th percentile", "degrees", kFromZero});
    };
    visit("normal_error_degrees", group(normal), {"Error of the normal at the surface"});
    visit("no_normal_percent", field.no_normal_percent,
          {"Points on the surface without a normal", "%", kPercentRange});
}

struct ColliderAccuracyReport {
    const ColliderAccuracy& accuracy = kNone<ColliderAccuracy>;
    double longest_side = 1.0;
};

template <class Visitor, FieldsOf<ColliderAccuracyReport> R>
void fields(Visitor& visit, R& report) {
    const ColliderAccuracy& accuracy = report.accuracy;
    const FieldAccuracyReport field{accuracy.field, report.longest_side};
    fields(visit, field);
    visit("unseen_area_percent", accuracy.unseen_percent,
          {"Area of the surface that no map sees", "%", kPercentRange});
    visit("buried_area_percent", accuracy.buried_percent,
          {"Area of the surface that lies inside the object and is not measured", "%", kPercentRange});
    visit("gpu_bytes", accuracy.gpu_bytes, {"Size of the maps on the GPU", "bytes"});
}

template <class Visitor, FieldsOf<TruthSamples> S>
void fields(Visitor& visit, S& samples) {
    visit("samples", samples.options.samples, {"Points of each kind"});
    visit("seed", samples.options.seed, {"Seed of the points"});
    visit("sigma", samples.options.sigma_share * samples.longest_side,
          {"Standard deviation of the distance of the points near the surface", "object units", kFromZero});
    visit("sigma_percent", 100.0 * samples.options.sigma_share,
          {"The same deviation", "% of the longest side", kFromZero});
    visit("step", kSurfaceStep * samples.longest_side,
          {"Distance from the surface at which normals are measured", "object units", kFromZero});
    visit("longest_side", samples.longest_side,
          {"Longest side of the mesh's box", "object units", kFromZero});
}

struct WorstPlaceReport {
    const WorstPlace& place = kNone<WorstPlace>;
    const Collider& collider = kNone<Collider>;
};

template <class Visitor, FieldsOf<WorstPlaceReport> R>
void fields(Visitor& visit, R& report) {
    const WorstPlace& place = report.place;
    const bool has_map = place.map >= 0;
    visit("position", place.position, {"A point on the wrong side, amid the others", "object units"});
    visit("size", place.size(),
          {"Longest side of the box of its points on the wrong side", "object units", kFromZero});
    visit("points", place.points, {"Points near the surface on the wrong side", {}, kFromOne});
    visit("share_percent", place.share_percent,
          {"Share of all points near the surface that are on the wrong side", "%", kPercentRange});
    visit("false_inside_percent", place.inside_percent,
          {"Share of its points that are classified as inside", "%", kPercentRange});
    visit("map", onlyIf(has_map, place.map),
          {"Index of the map that decides most of its points; null if no map votes", {}, kFromZero});
    visit("map_percent", place.map_percent, {"Share of its points decided by that map", "%", kPercentRange});
    visit("cause", place.cause, {"Cause at most of its points (bake/measure/README.md)"});
    visit("cause_percent", place.cause_percent,
          {"Share of the examined points with this cause", "%", kPercentRange});
    visit("texel", onlyIf(has_map, place.texel),
          {"Side of that map's texels at the position; null if no map votes", "object units", kFromZero});
    visit("why", causeText(place, report.collider), {"Explanation in one line"});
}

template <class Visitor, FieldsOf<Advice> A>
void fields(Visitor& visit, A& advice) {
    visit("command", advice.command, {"One line for a shell"});
    visit("about", advice.about, {"Description of the command"});
    visit("tried", advice.wrong_percent.has_value(), {"The command was tried in memory"});
    visit("wrong_percent", advice.wrong_percent,
          {"Share of at most 50000 points near the surface that the trial left on the wrong side; null if "
           "not tried",
           "%", kPercentRange});
    visit("helps", advice.helps, {"The trial left at most nine tenths of the points on the wrong side"});
    visit("untried", nonEmpty(advice.untried), {"Reason why the command was not tried; null if it was"});
}

}  // namespace relief
