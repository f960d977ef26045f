// SPDX-License-Identifier: Apache-2.0
#include "bake/verdict/check_report.h"

#include <glm/geometric.hpp>

#include "bake/verdict/report_text.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// "0.4123 %"
std::string precisely(double percent) {
    return shortNumber(percent) + " %";
}

std::string sideText(double inside_percent) {
    if (inside_percent >= 95.0) {
        return "classified as inside";
    }
    return inside_percent <= 5.0 ? "classified as outside"
                                 : percentText(inside_percent) + " of them classified as inside";
}

/// Returns "map 2 (front-back along 0/0/-1)", or "no map" for −1.
std::string mapWords(const Collider& collider, int map) {
    if (map < 0) {
        return "no map";
    }
    const DepthMap& of = collider.maps[static_cast<std::size_t>(map)];
    const std::string name = "map " + std::to_string(map) + " (" + mapFormatName(of.format);
    const auto row = [&](int i) { return glm::dvec3(of.object_to_map.row[i]); };
    if (of.projection() == Projection::kOrthographic) {
        const glm::dvec3 d = row(2) / glm::length(row(2)) + 0.0;
        return name + " along " + roughly(d.x) + "/" + roughly(d.y) + "/" + roughly(d.z) + ")";
    }
    if (of.projection() == Projection::kLocal) {
        return name + ")";
    }
    // The rows of a cube are parallel to the axes.
    glm::vec3 center;
    for (int i = 0; i < 3; ++i) {
        center[i] = -of.object_to_map.row[i].w / of.object_to_map.row[i][i] + 0.0F;
    }
    return name + " around " + positionText(center) + ")";
}

/// Returns "below the texel size: map 2 (…) decides, and its texels are 0.02 wide".
std::string causeText(const WorstPlace& place, const Collider& collider) {
    const std::string map = mapWords(collider, place.map);
    const std::string decides = place.map < 0 ? "no map votes" : map + " decides";
    const std::string texels = "texels are " + lengthText(place.texel, collider.unit) + " wide";
    switch (place.cause) {
        case WrongCause::kSheet:
            return "a sheet: the surface has no inside here; " + decides;
        case WrongCause::kOpen:
            return "an open mesh: " + (place.map < 0 ? "a map" : map) +
                   " looks into the object through an opening";
        case WrongCause::kUnseen:
            return "unseen by any map; " + decides;
        case WrongCause::kSilhouette:
            return "behind a silhouette: " + decides + ", and another part occludes the surface";
        case WrongCause::kTexel:
            break;
    }
    if (place.map >= 0 &&
        collider.maps[static_cast<std::size_t>(place.map)].projection() == Projection::kLocal) {
        return "finer than the patches: " + decides + ", and its heights are " +
               lengthText(place.texel, collider.unit) + " apart here";
    }
    return "below the texel size: " + decides + ", and its " + texels;
}

}  // namespace

std::string gradeOf(double wrong_percent) {
    return wrong_percent <= kGoodPercent ? "good" : wrong_percent <= kFairPercent ? "fair" : "poor";
}

std::string verdictText(double wrong_percent) {
    return percentText(wrong_percent) + " wrong near the surface: " + gradeOf(wrong_percent);
}

std::string insideGradeOf(const InsideAccuracy& accuracy) {
    return accuracy.points < kInsidePointsMin                ? "unknown"
           : accuracy.far_face_percent <= kGoodInsidePercent ? "good"
           : accuracy.far_face_percent <= kFairInsidePercent ? "fair"
                                                             : "poor";
}

std::string insideVerdictText(const InsideAccuracy& accuracy) {
    const std::string grade = insideGradeOf(accuracy);
    return grade == "good" || grade == "unknown"
               ? ""
               : "at " + percentText(accuracy.far_face_percent) +
                     " of the points inside, the nearest face does not decide: " + grade;
}

std::string accuracyText(const ColliderAccuracy& accuracy, const TruthSamples& samples,
                         const std::string& unit) {
    const FieldAccuracy& field = accuracy.field;
    const std::string units = " " + unitText(unit);
    const auto wrongRow = [](const char* where, const WrongPercent& share) {
        return std::vector<std::string>{where, precisely(share.total()), precisely(share.false_inside),
                                        precisely(share.false_outside)};
    };
    const auto degrees = [](double value) { return shortNumber(value) + " degrees"; };
    const auto length = [&](double value) {
        return shortNumber(value) + units + " (" + precisely(100.0 * value / samples.longest_side) + ")";
    };
    std::string text = table({{"points on the wrong side", "all>", "false inside>", "false outside>"},
                              wrongRow("near the surface", field.near),
                              wrongRow("anywhere in the box", field.uniform)});
    text += "\n";
    text +=
        table({{"error", "mean", "99th percentile"},
               {"signed distance near the surface", length(field.distance_mean), length(field.distance_p99)},
               {"normal at the surface", degrees(field.normal_mean), degrees(field.normal_p99)},
               {"depth inside", length(field.inside.depth_mean), length(field.inside.depth_p99)},
               {"normal inside", degrees(field.inside.normal_mean), degrees(field.inside.normal_p99)}});
    text += "\n";
    std::vector<std::vector<std::string>> rows = {
        {"near the surface, outside without a distance", precisely(field.far_percent)},
        {"near the surface, no map votes", precisely(field.unknown_percent)},
        {"on the surface, no normal", precisely(field.no_normal_percent)},
        {"surface that no map sees", precisely(accuracy.unseen_percent)},
        {"inside, the nearest face does not decide", precisely(field.inside.far_face_percent)}};
    if (accuracy.buried_percent > 0.0) {
        rows.push_back({"surface inside the object, not measured", precisely(accuracy.buried_percent)});
    }
    rows.push_back({"on the GPU", bytesText(accuracy.gpu_bytes)});
    text += table(rows);
    text += "\nLengths in percent are of the longest side, " + shortNumber(samples.longest_side) + units +
            ". " + std::to_string(samples.options.samples) + " points of each kind, " +
            std::to_string(field.inside.points) + " inside, seed " + std::to_string(samples.options.seed) +
            ".\nThe distance of points near the surface has a standard deviation of " +
            precisely(100.0 * samples.options.sigma_fraction) + ".\n";
    return text;
}

std::string proofText(const DepthProof& proof, double longest_side, const std::string& unit) {
    if (!proof.unproven.empty()) {
        return "The depth of errors is not proven: " + proof.unproven + ".\n";
    }
    const auto length = [&](double value) {
        return lengthText(value, unit) + " (" + percentText(100.0 * value / longest_side) + ")";
    };
    return "Proven: no point farther than " + length(proof.depth) +
           " from every triangle is on the wrong side.\n" +
           (proof.deepest > 0.0 ? "The deepest error found is " + length(proof.deepest) +
                                      " from the nearest triangle, at " + positionText(proof.place) + ".\n"
                                : "");
}

std::string placesText(std::span<const WorstPlace> places, const Collider& collider) {
    if (places.empty()) {
        return "";
    }
    std::string text = places.size() == 1 ? "The worst place:\n" : "The worst places:\n";
    for (std::size_t i = 0; i < places.size(); ++i) {
        const WorstPlace& place = places[i];
        text += "  " + std::to_string(i + 1) + "  " + positionText(place.position) + ", " +
                lengthText(place.size(), collider.unit) +
                " across: " + percentText(place.contribution_percent) + " of the wrong points, " +
                sideText(place.false_inside_percent) + "\n     " + causeText(place, collider) + "\n";
    }
    return text;
}

std::string adviceText(std::span<const Advice> advice, double wrong_percent) {
    std::string commands;
    std::string failed;
    for (const Advice& one : advice) {
        if (one.wrong_percent && !one.helps) {
            failed +=
                (failed.empty() ? "" : ", ") + one.description + " (" + percentText(*one.wrong_percent) + ")";
            continue;
        }
        commands += "  " + one.command + "\n     " + one.description + "; ";
        commands += one.wrong_percent ? "tried: " + percentText(*one.wrong_percent) + " wrong instead of " +
                                            percentText(wrong_percent)
                                      : "not tried: " + one.untried_reason;
        commands += "\n";
    }
    return (commands.empty() ? "" : "What to do:\n" + commands) +
           (failed.empty() ? "" : "Tried without success: " + failed + "\n");
}

void fields(FieldVisitor& visit, const FieldAccuracyReport& report) {
    const FieldAccuracy& field = report.field;
    visit("near", field.near, {"Sides of the points near the surface"});
    visit("uniform", field.uniform, {"Sides of the points anywhere in the box"});
    const auto lengths = [&](double mean, double p99) {
        return [to_percent = 100.0 / report.longest_side, mean, p99](FieldVisitor& visit_error) {
            visit_error("mean", finite(mean), {"Mean", "object units", kFromZero});
            visit_error("p99", finite(p99), {"99th percentile", "object units", kFromZero});
            visit_error("mean_percent", finite(mean * to_percent),
                        {"Mean", "% of the longest side", kFromZero});
            visit_error("p99_percent", finite(p99 * to_percent),
                        {"99th percentile", "% of the longest side", kFromZero});
        };
    };
    const auto angles = [](double mean, double p99) {
        return [mean, p99](FieldVisitor& visit_error) {
            visit_error("mean", finite(mean), {"Mean", "degrees", kFromZero});
            visit_error("p99", finite(p99), {"99th percentile", "degrees", kFromZero});
        };
    };
    const auto distance = lengths(field.distance_mean, field.distance_p99);
    visit("distance_error", group(distance), {"Error of the signed distance near the surface"});
    visit("far_percent", field.far_percent,
          {"Points near the surface that are outside without a known distance", "%", kPercentRange});
    visit("unknown_percent", field.unknown_percent,
          {"Points near the surface for which no map votes", "%", kPercentRange});
    const auto normal = angles(field.normal_mean, field.normal_p99);
    visit("normal_error_degrees", group(normal), {"Error of the normal at the surface"});
    visit("no_normal_percent", field.no_normal_percent,
          {"Points on the surface without a normal", "%", kPercentRange});
    const auto inside = [&](FieldVisitor& visit_inside) {
        const auto depth_error = lengths(field.inside.depth_mean, field.inside.depth_p99);
        const auto normal_error = angles(field.inside.normal_mean, field.inside.normal_p99);
        visit_inside("points", field.inside.points, {"Points that were measured"});
        visit_inside("far_face_percent", field.inside.far_face_percent,
                     {"Points where the nearest face does not decide: classified as outside, with a normal "
                      "that points away from the face, or with more than 1.25 times the depth",
                      "%", kPercentRange});
        visit_inside("depth_error", group(depth_error), {"Error of the depth"});
        visit_inside("normal_error_degrees", group(normal_error),
                     {"Angle between the normal and the direction to the nearest face"});
    };
    visit("inside", group(inside), {"Votes at points inside, up to 0.45 of the thickness below a face"});
}

void fields(FieldVisitor& visit, const ColliderAccuracyReport& report) {
    const ColliderAccuracy& accuracy = report.accuracy;
    const FieldAccuracyReport field{accuracy.field, report.longest_side};
    fields(visit, field);
    visit("unseen_area_percent", accuracy.unseen_percent,
          {"Area of the surface that no map sees", "%", kPercentRange});
    visit("buried_area_percent", accuracy.buried_percent,
          {"Area of the surface that is inside the object and not measured", "%", kPercentRange});
    visit("gpu_bytes", accuracy.gpu_bytes, {"Size of the maps on the GPU", "bytes"});
}

void fields(FieldVisitor& visit, const TruthSamples& samples) {
    visit("samples", samples.options.samples, {"Points of each kind"});
    visit("seed", samples.options.seed, {"Seed of the points"});
    visit("sigma", samples.options.sigma_fraction * samples.longest_side,
          {"Standard deviation of the distance of the points near the surface", "object units", kFromZero});
    visit("sigma_percent", 100.0 * samples.options.sigma_fraction,
          {"The same standard deviation", "% of the longest side", kFromZero});
    visit("step", kSurfaceStep * samples.longest_side,
          {"Distance from the surface at which normals are measured", "object units", kFromZero});
    visit("longest_side", samples.longest_side,
          {"Longest side of the mesh's box", "object units", kFromZero});
}

void fields(FieldVisitor& visit, const WorstPlaceReport& report) {
    const WorstPlace& place = report.place;
    const bool has_map = place.map >= 0;
    visit("position", place.position, {"A point on the wrong side, surrounded by others", "object units"});
    visit("size", place.size(),
          {"Longest side of the box of its points on the wrong side", "object units", kFromZero});
    visit("points", place.points, {"Points near the surface on the wrong side", {}, kFromOne});
    visit("contribution_percent", place.contribution_percent,
          {"Fraction of all wrong points near the surface", "%", kPercentRange});
    visit("false_inside_percent", place.false_inside_percent,
          {"Fraction of its points that are classified as inside", "%", kPercentRange});
    visit("map", onlyIf(has_map, place.map),
          {"Index of the map that decides most of its points; null if no map votes", {}, kFromZero});
    visit("map_percent", place.map_percent,
          {"Fraction of its points that the map decides", "%", kPercentRange});
    visit("cause", place.cause, {"Cause at most of its points (bake/measure/README.md)"});
    visit("cause_percent", place.cause_percent,
          {"Fraction of the examined points with this cause", "%", kPercentRange});
    visit("texel", onlyIf(has_map, place.texel),
          {"Side of the map's texels at the position; null if no map votes", "object units", kFromZero});
    visit("explanation", causeText(place, report.collider), {"Explanation in one line"});
}

void fields(FieldVisitor& visit, const DepthProofReport& report) {
    const DepthProof& proof = report.proof;
    const bool proven = proof.unproven.empty();
    const bool found = proof.deepest > 0.0;
    visit("depth", onlyIf(proven, proof.depth),
          {"No point farther than this from every triangle is on the wrong side; null if not proven",
           "object units", kFromZero});
    visit("depth_percent", onlyIf(proven, 100.0 * proof.depth / report.longest_side),
          {"The same depth", "% of the longest side", kFromZero});
    visit("deepest", onlyIf(found, proof.deepest),
          {"Distance from the nearest triangle to the deepest error found; null if none is found",
           "object units", kFromZero});
    visit("place", onlyIf(found, proof.place),
          {"Position of that error, for `relief query`", "object units"});
    visit("boxes", proof.boxes, {"Boxes that the proof examined"});
    visit("unproven", nonEmpty(proof.unproven), {"Why no depth is proven; null if one is"});
}

void fields(FieldVisitor& visit, const Advice& advice) {
    visit("command", advice.command, {"One line for a shell"});
    visit("description", advice.description, {"Description of the command"});
    visit("tried", advice.wrong_percent.has_value(), {"Whether the command was tried in memory"});
    visit("wrong_percent", advice.wrong_percent,
          {"Points, out of at most 50000 near the surface, that the trial left on the wrong side; null if "
           "not tried",
           "%", kPercentRange});
    visit("helps", advice.helps, {"Whether the trial left at most nine tenths of the wrong points"});
    visit("untried_reason", nonEmpty(advice.untried_reason),
          {"Reason why the command was not tried; null if it was"});
}

}  // namespace relief
