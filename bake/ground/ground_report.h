// SPDX-License-Identifier: Apache-2.0
// The report of a bake of a height map, for people and for programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/ground/ground_bake.h"
#include "bake/report/bake_report.h"
#include "bake/report/collider_report.h"
#include "formats/fields/field.h"

namespace relief {

/// One line. \param output  the file or the folder, for messages.
[[nodiscard]] std::string groundText(const GroundResult& result, const std::string& output, double ms);

void fields(FieldVisitor& visit, const GroundTile& tile);

/// `relief bake --heights --json`
struct GroundJson {
    const GroundResult& result = kNone<GroundResult>;
    std::string output{};
    std::string heights{};  ///< the settings
    double ms = 0.0;
};

void fields(FieldVisitor& visit, const GroundJson& report);

}  // namespace relief
