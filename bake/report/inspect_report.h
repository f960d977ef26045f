// SPDX-License-Identifier: Apache-2.0
// Reports of a container that is checked without its mesh, for `relief check FILE`.
#pragma once

#include <string>

#include "bake/report/collider_report.h"
#include "formats/inspect.h"

namespace relief {

/// Returns a line for the verdict, a line per issue, a table of the maps, and the intact sections.
/// \param name  of the file, as shown to people
[[nodiscard]] std::string inspectionText(const Inspection& inspection, const std::string& name);

// --- The same data as fields.

/// The report of `relief check FILE --json`.
struct InspectionReport {
    const Inspection& inspection = kNone<Inspection>;
    std::string name;  ///< of the file
};

void fields(FieldVisitor& visit, const InspectionReport& report);

}  // namespace relief
