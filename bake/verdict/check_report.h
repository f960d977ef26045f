// SPDX-License-Identifier: Apache-2.0
// Reports of a collider measured against its mesh, for `relief check`: numbers, a verdict, the worst places, and
// advice.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "bake/measure/accuracy.h"
#include "bake/measure/depth_proof.h"
#include "bake/measure/grades.h"
#include "bake/measure/worst_places.h"
#include "formats/collider.h"

namespace relief {

/// Returns "good", "fair" or "poor", by kGoodPercent and kFairPercent.
[[nodiscard]] std::string gradeOf(double wrong_percent);
/// Returns a line like "0.4 % wrong near the surface: good".
[[nodiscard]] std::string verdictText(double wrong_percent);

/// Returns the grade of the votes at points inside, by InsideAccuracy::far_face_percent; "unknown" with fewer than
/// kInsidePointsMin points.
[[nodiscard]] std::string insideGradeOf(const InsideAccuracy& accuracy);
/// Returns a line like "at 12 % of the points inside, the nearest face does not decide: poor"; "" if the grade is good
/// or unknown.
[[nodiscard]] std::string insideVerdictText(const InsideAccuracy& accuracy);

/// Returns a few lines: the measurement and its results.
/// \param unit  of lengths: "m", or "" for object units
[[nodiscard]] std::string accuracyText(const ColliderAccuracy& accuracy, const TruthSamples& samples,
                                       const std::string& unit);

/// Returns a sentence or two: the proven depth of errors and the deepest one found, or why no depth is proven.
/// \param longest_side  of the mesh, object units
[[nodiscard]] std::string proofText(const DepthProof& proof, double longest_side, const std::string& unit);

/// Returns a few lines per place; "" without places.
[[nodiscard]] std::string placesText(std::span<const WorstPlace> places, const Collider& collider);

/// A suggested command.
struct Advice {
    std::string command;      ///< one line for a shell
    std::string description;  ///< "twice the bytes"
    /// Percentage of misclassified points near the surface in a trial in memory; nullopt: not tried.
    std::optional<double> wrong_percent;
    std::string untried_reason;  ///< reason for not trying it; empty if tried
    bool helps = false;          ///< in the trial, at most 90 % of the wrong points remained
};

/// Lists the commands, best first, then those that did not help; "" without advice.
[[nodiscard]] std::string adviceText(std::span<const Advice> advice, double wrong_percent);

// --- The same data as fields.

/// \param longest_side  of the mesh: lengths are also reported as percentages of it.
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

struct DepthProofReport {
    const DepthProof& proof = kNone<DepthProof>;
    double longest_side = 1.0;
};

void fields(FieldVisitor& visit, const DepthProofReport& report);

}  // namespace relief
