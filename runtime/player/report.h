// What relief-sim prints after a run.
#pragma once

#include <string>

#include "runtime/player/player.h"

namespace relief {

/// One JSON object, indented, with a trailing newline. Keys: README.md beside this file, "The report".
[[nodiscard]] std::string reportJson(const PlayerReport& report);

/// A few lines for a person.
[[nodiscard]] std::string reportText(const PlayerReport& report);

}  // namespace relief
