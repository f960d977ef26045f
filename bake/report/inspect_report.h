// SPDX-License-Identifier: Apache-2.0
// A container by itself, as `relief check FILE` reports it.
#pragma once

#include <string>
#include <vector>

#include "bake/report/collider_report.h"
#include "formats/inspect.h"

namespace relief {

/// "sound", "suspicious" or "damaged"
[[nodiscard]] std::string_view inspectionVerdict(const Inspection& inspection);

/// A line for the verdict, a line for each issue, a table of the maps, and which parts can be trusted.
/// \param name  of the file, for people
[[nodiscard]] std::string inspectionText(const Inspection& inspection, const std::string& name);

// --- The same as fields.

void fields(FieldVisitor& visit, const Issue& issue);

struct MapInspectionReport {
    std::size_t index = 0;
    const MapInspection& map = kNone<MapInspection>;
};

void fields(FieldVisitor& visit, const MapInspectionReport& report);

/// `relief check FILE --json`
struct InspectionReport {
    const Inspection& inspection = kNone<Inspection>;
    std::string name;  ///< of the file

    [[nodiscard]] std::vector<MapInspectionReport> maps() const;
};

void fields(FieldVisitor& visit, const InspectionReport& report);

}  // namespace relief
