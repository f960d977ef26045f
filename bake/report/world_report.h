// SPDX-License-Identifier: Apache-2.0
// Reports of a bake of a level and of a check of a world, for people and programs.
#pragma once

#include <optional>
#include <string>

#include "bake/report/bake_report.h"
#include "bake/report/collider_report.h"
#include "bake/verdict/parts_report.h"
#include "bake/verdict/report_text.h"
#include "bake/world/world_bake.h"
#include "bake/world/world_check.h"
#include "formats/fields/field.h"

namespace relief {

/// Returns a table of the colliders if `verbose`, and a summary line.
[[nodiscard]] std::string worldBakeText(const WorldBakeResult& result, const std::string& folder, double ms,
                                        bool verbose);

/// The report of `relief bake --world --json`.
struct WorldBakeJson {
    const WorldBakeResult& result = kNone<WorldBakeResult>;
    std::string output{};
    double ms = 0.0;
};

void fields(FieldVisitor& visit, const WorldBakeJson& report);

// --- Check.

/// Returns the worse of gradeOf(accuracy.all) and the grade of the parts: poor if accuracy.lost is not empty, fair
/// if accuracy.coarse > 0.
[[nodiscard]] Verdict verdictOf(const WorldAccuracy& accuracy, const std::string& unit);

/// Returns the contents of the world, and its accuracy. \param accuracy  null without a level.
[[nodiscard]] std::string worldCheckText(const WorldField& field, const std::string& name,
                                         const WorldAccuracy* accuracy);

/// The report of `relief check world.json --json`.
struct WorldCheckJson {
    std::string file{};
    const WorldField* field = nullptr;
    const WorldAccuracy* accuracy = nullptr;  ///< null without --mesh
    std::optional<float> max_error{};
};

void fields(FieldVisitor& visit, const WorldCheckJson& report);

}  // namespace relief
