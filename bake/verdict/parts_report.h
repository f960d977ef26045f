// SPDX-License-Identifier: Apache-2.0
// Reports of the parts of a mesh that a collider loses: their names and sizes, and how to keep them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/measure/part_accuracy.h"
#include "bake/mesh/surface_parts.h"
#include "bake/verdict/check_report.h"
#include "formats/collider.h"

namespace relief {

struct Verdict {
    std::string grade;  ///< "good", "fair" or "poor"
    std::string text;   ///< one line
};

void fields(FieldVisitor& visit, const Verdict& verdict);
void fields(FieldVisitor& visit, const IgnoredParts& ignored);

/// Returns a line like "4 of 812 parts, at most 0.003 m long, are not represented; 2 of 812 parts are thicker than in
/// the mesh; the smallest 200 parts are not measured"; "" if none is ignored.
[[nodiscard]] std::string ignoredText(const IgnoredParts& ignored, const std::string& unit);
/// \param but  the reason for a grade below gradeOf(wrong_percent)
/// \return "0.3 % wrong near the surface, but 27 of 82 parts are lost: poor", followed by ignoredText().
[[nodiscard]] Verdict verdictOf(double wrong_percent, const std::string& grade, const std::string& but,
                                const IgnoredParts& ignored, const std::string& unit);
/// The grade is the worse of gradeOf(wrong_percent) and the grade of the parts: poor if a part is lost, fair if a part
/// is coarse and accuracy.minor_counts is set.
[[nodiscard]] Verdict verdictOf(double wrong_percent, const PartsAccuracy& accuracy, const std::string& unit);

/// Returns how to keep a lost or coarse part: a budget, a resolution, a thickness, or a separate bake.
[[nodiscard]] std::string partFix(const SurfacePart& part, const Collider& collider);

/// Lists the worst parts, named nodes and named materials, and states which parts do not lower the
/// grade. Returns "" if all parts are represented.
[[nodiscard]] std::string partsText(const PartsAccuracy& accuracy, const SurfaceParts& parts,
                                    const Collider& collider);
/// Returns a warning without the name of the mesh, in one line; nullopt if no part is lost.
[[nodiscard]] std::optional<std::string> lostPartsWarning(const PartsAccuracy& accuracy,
                                                          const SurfaceParts& parts,
                                                          const Collider& collider);
/// Returns a line about parts far from all others; nullopt if there are none.
[[nodiscard]] std::optional<std::string> outlierText(const SurfaceParts& parts, const std::string& unit);
/// Returns outlierText(), and one line about all sheets whose --thickness is at least a quarter of their length.
[[nodiscard]] std::vector<std::string> partWarnings(const SurfaceParts& parts, const std::string& unit);

// --- The same data as fields.

struct PartsReport {
    const PartsAccuracy& accuracy = kNone<PartsAccuracy>;
    const SurfaceParts& parts = kNone<SurfaceParts>;
    const Collider& collider = kNone<Collider>;
};

void fields(FieldVisitor& visit, const PartsReport& report);

}  // namespace relief
