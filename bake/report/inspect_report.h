// What `relief check FILE` says of a container alone, as text and as JSON.
#pragma once

#include <string>

#include "formats/inspect.h"

namespace relief {

/// A line of result, a line an issue, a table of the maps, and what can be trusted.
/// \param name  of the file, for people.
[[nodiscard]] std::string inspectionText(const Inspection& inspection, const std::string& name);

/// formats/schemas/check-file.schema.json.
[[nodiscard]] std::string inspectionJson(const Inspection& inspection, const std::string& name);

}  // namespace relief
