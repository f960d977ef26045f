// SPDX-License-Identifier: Apache-2.0
// The report of `relief bake`, as text and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/pipeline/bake.h"
#include "bake/recipe/depfile.h"
#include "bake/report/collider_report.h"

namespace relief {

/// Returns the report for people: a few lines and a table. \param output  as on the command line
[[nodiscard]] std::string bakeText(const BakeResult& result, const std::string& output, std::size_t file_size,
                                   bool verbose);
/// Returns one line with a line feed: "shape: 2 solids, 1 sheet (0.01 m thick)"; empty if no shapes were made.
[[nodiscard]] std::string shapeText(const ShapeReport& report, const std::string& unit);
/// Returns the report, or nullopt if no shapes were made.
[[nodiscard]] std::optional<ShapeReport> shapesIfAny(const ShapeReport& report);

// --- The same data as fields.

void fields(FieldVisitor& visit, const InputFile& input);

/// The report of `relief bake --json`.
struct BakeJson {
    const BakeResult& result = kNone<BakeResult>;
    const ContainerInfo& info = kNone<ContainerInfo>;
    std::string output = {};     ///< as on the command line
    std::uint32_t compress = 0;  ///< zstd level
};

void fields(FieldVisitor& visit, const BakeJson& report);

/// Visits "tool", the program and its version.
void toolField(FieldVisitor& visit);
/// Visits the last fields of a report of a bake into a folder.
/// \param removed  removed containers
void folderFields(FieldVisitor& visit, const std::vector<std::string>& removed, double ms,
                  const std::vector<InputFile>& inputs, const std::vector<std::string>& warnings);

}  // namespace relief
