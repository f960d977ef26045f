// SPDX-License-Identifier: Apache-2.0
// The report of a bake of a level, for people and for programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/report/bake_report.h"
#include "bake/report/collider_report.h"
#include "bake/world/world_bake.h"
#include "formats/fields/field.h"

namespace relief {

/// The table of colliders with verbose, and a last line for all.
[[nodiscard]] std::string worldBakeText(const WorldBakeResult& result, const std::string& folder, double ms,
                                        bool verbose);

struct WorldColliderReport {
    const WorldColliderResult& collider = kNone<WorldColliderResult>;
};

void fields(FieldVisitor& visit, const WorldColliderReport& report);

/// `relief bake --world --json`
struct WorldBakeJson {
    const WorldBakeResult& result = kNone<WorldBakeResult>;
    std::string output{};
    double ms = 0.0;
};

void fields(FieldVisitor& visit, const WorldBakeJson& report);

}  // namespace relief
