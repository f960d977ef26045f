// SPDX-License-Identifier: Apache-2.0
// Reports a bake of a height map, or a check against it, as text and as JSON.
#pragma once

#include <optional>
#include <string>

#include "bake/ground/ground_bake.h"
#include "bake/ground/ground_check.h"
#include "bake/report/bake_report.h"
#include "bake/report/collider_report.h"
#include "formats/fields/field.h"

namespace relief {

/// Returns one line. \param output  the file or folder, for the message.
[[nodiscard]] std::string groundText(const GroundResult& result, const std::string& output, double ms);

/// `relief bake --heights --json`
struct GroundJson {
    const GroundResult& result = kNone<GroundResult>;
    std::string output{};
    std::string heights{};  ///< effective settings, in the syntax of --heights
    double ms = 0.0;
};

void fields(FieldVisitor& visit, const GroundJson& report);

/// Returns the report as text. \param name  of the collider or world.
[[nodiscard]] std::string groundCheckText(const GroundAccuracy& accuracy, const std::string& name);

/// `relief check --heights --json`
struct GroundCheckJson {
    const GroundAccuracy& accuracy = kNone<GroundAccuracy>;
    std::string file{};
    std::string heights{};  ///< effective settings, in the syntax of --heights
    std::optional<float> max_error{};
};

void fields(FieldVisitor& visit, const GroundCheckJson& report);

}  // namespace relief
