// SPDX-License-Identifier: Apache-2.0
// A collider measured against its mesh, as `relief check` reports it: numbers, a verdict, the places where it is wrong most
// and what to do about them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/measure/grades.h"
#include "bake/measure/worst_places.h"
#include "formats/collider.h"

namespace relief {

/// "good", "fair" or "poor", by kGoodPercent and kFairPercent
[[nodiscard]] std::string gradeOf(double wrong_percent);
/// "0.4 % wrong near the surface: good"
[[nodiscard]] std::string verdictText(double wrong_percent);

/// Grade of the votes inside, by InsideAccuracy::far_face_percent; "unknown" with fewer than kInsidePointsLeast points.
[[nodiscard]] std::string insideGradeOf(const InsideAccuracy& accuracy);
/// "at 12 % of the points inside the nearest face does not decide: poor"; "" if it is good or unknown.
[[nodiscard]] std::string insideVerdictText(const InsideAccuracy& accuracy);

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

void fields(FieldVisitor& visit, const FieldAccuracyReport& report);

struct ColliderAccuracyReport {
    const ColliderAccuracy& accuracy = kNone<ColliderAccuracy>;
    double longest_side = 1.0;
};

void fields(FieldVisitor& visit, const ColliderAccuracyReport& report);

void fields(FieldVisitor& visit, const TruthSamples& samples);

struct WorstPlaceReport {
    const WorstPlace& place = kNone<WorstPlace>;
    const Collider& collider = kNone<Collider>;
};

void fields(FieldVisitor& visit, const WorstPlaceReport& report);

void fields(FieldVisitor& visit, const Advice& advice);

}  // namespace relief
