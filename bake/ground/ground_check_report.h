// SPDX-License-Identifier: Apache-2.0
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

void fields(FieldVisitor& visit, const GroundNear& near);

void fields(FieldVisitor& visit, const GroundWorstPlace& place);

/// `relief check --heights --json`
struct GroundCheckJson {
    const GroundAccuracy& accuracy = kNone<GroundAccuracy>;
    std::string file{};
    std::string heights{};  ///< the settings
    std::optional<float> max_error{};
};

void fields(FieldVisitor& visit, const GroundCheckJson& report);

}  // namespace relief
